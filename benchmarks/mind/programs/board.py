"""The artifact of the program ``percepts``: many observable properties, some of which change."""

from jacaros.env import Artifact, operation


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
