"""A barrier: agents wait until all have arrived."""

from jacaros.env import Artifact, operation


class Barrier(Artifact):
    """Lets those who wait pass when the given number of participants has arrived; then it begins anew.

    A participant calls ``hit`` when it has arrived, and ``waitForAll`` when it must not go on without the others.
    """

    def init(self, participants: int) -> None:
        """Be for so many participants, at least one."""
        if participants < 1:
            self.fail("a barrier needs a participant", "wrong_number", participants)
        self._participants = participants
        self._hits = 0
        # For each agent: the round of its last hit, and the last round that it has seen complete.
        self._hit_in: dict[str | None, int] = {}
        self._passed: dict[str | None, int] = {}

    @operation
    def hit(self) -> None:
        """Arrive."""
        self._hit_in[self.caller] = self._hits // self._participants + 1
        self._hits += 1

    @operation(name="waitForAll", guard="all_are_there")
    def wait_for_all(self) -> None:
        """Wait until all have arrived."""
        self._passed[self.caller] = max(self._complete(), self._passed.get(self.caller, 0))

    def all_are_there(self) -> bool:
        """Whether the round is complete that the caller waits for: of its last hit, or the first it has not seen."""
        passed, hit_in = self._passed.get(self.caller, 0), self._hit_in.get(self.caller, 0)
        return self._complete() >= (hit_in if hit_in > passed else passed + 1)

    def _complete(self) -> int:
        return self._hits // self._participants
