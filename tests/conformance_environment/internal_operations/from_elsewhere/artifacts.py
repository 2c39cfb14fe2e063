"""The artifacts of this case, written from its spec.md."""

import asyncio

from jacaros.artifacts import Artifact, internal_operation


class Sensor(Artifact):
    """Is worked by a thread."""

    def init(self, times: int) -> None:
        self.define_property("level", 0)
        self.start(self.watch, times)

    @internal_operation
    async def watch(self, times: int) -> None:
        for _ in range(times):
            await self.sleep(0.01)
            await self.step(asyncio.get_running_loop().run_in_executor(None, self.measure))
        self.signal("over")

    def measure(self) -> None:
        self.start(self.rise)

    @internal_operation
    def rise(self) -> None:
        self.update_property("level", self.value("level") + 1)
        self.update_property("level", self.value("level") + 10)
