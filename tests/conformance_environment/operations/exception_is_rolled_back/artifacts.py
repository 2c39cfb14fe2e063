"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, internal_operation, operation


class Machine(Artifact):
    """Breaks down in several ways."""

    def init(self) -> None:
        self.define_property("parts", 0)

    @operation
    def break_down(self) -> None:
        self.update_property("parts", 90)
        raise ValueError("unexpected")

    @operation
    async def late(self) -> None:
        self.add()
        await self.sleep(0.01)
        self.break_down()

    @operation
    def start_process(self) -> None:
        self.start("process")

    @internal_operation
    def process(self) -> None:
        self.break_down()

    @operation
    def add(self) -> None:
        self.update_property("parts", self.value("parts") + 1)
