"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Out, operation


class Server(Artifact):
    """Serves one after the other."""

    def init(self) -> None:
        self._served: list[Atom] = []

    @operation
    async def serve(self, who: Atom, milliseconds: int, number: Out) -> None:
        await self.clock.sleep(milliseconds / 1000)
        self._served.append(who)
        self.signal("served", len(self._served), who)
        number.set(len(self._served))

    @operation
    def report(self, served: Out) -> None:
        served.set(self._served)
