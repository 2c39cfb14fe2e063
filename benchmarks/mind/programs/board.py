"""The artifact of the programs ``percepts`` and ``operations``: many observable properties, some of which change."""

from jacaros.artifacts import Artifact, Out, operation


class Board(Artifact):
    """Counters ``value0``, ``value1``, ..."""

    def init(self, size: int) -> None:
        """Define *size* properties."""
        for place in range(int(size)):
            self.define_property(f"value{place}", 0)
        self._round = 0

    @operation
    def change(self, count: int) -> None:
        """Give the first *count* properties new values."""
        self._round += 1
        for place in range(int(count)):
            self.update_property(f"value{place}", self._round)

    @operation(name="next")
    def count_down(self, number: float, result: Out) -> None:
        """Give back one less than *number*."""
        result.set(number - 1)
