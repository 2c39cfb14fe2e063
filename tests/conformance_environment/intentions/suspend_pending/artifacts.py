"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Worker(Artifact):
    """Takes its time."""

    def init(self) -> None:
        self.define_property("finished", 0)

    @operation
    async def work(self, pause: int, finished: Out) -> None:
        await self.sleep(pause / 1000)
        self.update_property("finished", self.value("finished") + 1)
        finished.set(self.value("finished"))

    @operation(name="workFail")
    async def work_fail(self, pause: int) -> None:
        await self.sleep(pause / 1000)
        self.fail("work failed", "no_work", pause)
