"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Out, operation


class Meeting(Artifact):
    """Waits in the middle of an operation until enough have come."""

    def init(self) -> None:
        self._there = 0

    @operation
    async def meet(self, who: Atom, wanted: int, there: Out) -> None:
        self.signal("phase", who, Atom("waits"))
        await self.until(lambda: self._there >= wanted)
        self.signal("phase", who, Atom("goes_on"))
        there.set(self._there)

    @operation
    def come(self, number: int) -> None:
        self._there += number
        self.signal("phase", Atom("arrivals"), self._there)
