"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Out, Structure, operation


class Tray(Artifact):
    """Gives when there is enough."""

    def init(self) -> None:
        self._level = 0
        self._log: list[Structure] = []

    @operation
    def add(self, number: int) -> None:
        self._level += number

    @operation(guard="enough")
    def take(self, who: Atom, number: int) -> None:
        self._level -= number
        self._log.append(Structure("took", (who, number)))

    def enough(self, who: Atom, number: int) -> bool:
        return self._level >= number

    @operation
    def notes(self, entries: Out) -> None:
        entries.set(self._log)
