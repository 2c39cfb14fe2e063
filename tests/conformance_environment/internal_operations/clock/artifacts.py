"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, internal_operation, operation


class Clock(Artifact):
    """Ticks by itself."""

    def init(self, pause: int) -> None:
        self.define_property("running", "no")
        self._pause = pause / 1000

    @operation(name="start")
    def start_ticking(self, most: int) -> None:
        self.update_property("running", "yes")
        self.start(self.work, most)

    @operation
    def stop(self) -> None:
        self.update_property("running", "no")

    @internal_operation
    async def work(self, most: int) -> None:
        tick = 1
        while self.value("running") == "yes" and tick <= most:
            await self.sleep(self._pause)
            if self.value("running") == "yes":
                self.signal("tick", tick)
            tick += 1
        self.update_property("running", "no")
