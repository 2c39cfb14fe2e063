"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Slow(Artifact):
    """Takes its time."""

    def init(self) -> None:
        self.define_property("begun", 0)
        self.define_property("done", 0)

    @operation
    async def slow(self) -> None:
        self.update_property("begun", self.value("begun") + 1)
        await self.sleep(0.5)
        self.update_property("done", self.value("begun"))

    @operation(guard="never")
    def guarded(self) -> None:
        self.update_property("done", 100)

    def never(self) -> bool:
        return False
