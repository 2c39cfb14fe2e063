"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Lane(Artifact):
    """Keeps the trace of who ran."""

    def init(self) -> None:
        self.define_property("trace", [])

    @operation
    async def run(self, name: str, steps: int, pause: int) -> None:
        for number in range(1, steps + 1):
            self._append(f"{name}{number}")
            await self.sleep(pause / 1000)

    @operation
    def mark(self, name: str) -> None:
        self._append(name)

    def _append(self, text: str) -> None:
        self.update_property("trace", [*self.value("trace"), text])
