"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Burst(Artifact):
    """Counts, also several times in one step."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)

    @operation
    def inc(self) -> None:
        self.update_property("count", self.value("count") + 1)

    @operation
    def burst(self, times: int) -> None:
        for _ in range(times):
            self.inc()

    @operation
    async def pauses(self, times: int) -> None:
        for _ in range(times):
            self.inc()
            await self.sleep(0.01)

    @operation
    def flash(self) -> None:
        self.define_property("tmp", 1)
        self.remove_property("tmp")
