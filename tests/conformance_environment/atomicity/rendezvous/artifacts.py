"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Out, operation


class Rendezvous(Artifact):
    """Lets go when all are there, again and again."""

    def init(self, number: int) -> None:
        self._number = number
        self._here: list[Atom] = []

    @operation
    async def meet(self, who: Atom, all_here: Out) -> None:
        here = self._here
        here.append(who)
        if len(here) == self._number:
            self._here = []
        await self.until(lambda: len(here) == self._number)
        all_here.set(here)
