"""CArtAgO's synchronisation tools: a latch that is set once, a barrier, a clock."""

from jacaros.artifacts import Artifact, internal_operation, operation


class Latch(Artifact):
    """Blocks callers of ``waitForSet`` until an agent calls ``set``; from then on no caller waits."""

    def init(self) -> None:
        """Begin unset."""
        self._is_set = False

    @operation(name="set")
    def set_it(self) -> None:
        """Release all waiting agents."""
        self._is_set = True

    @operation(name="waitForSet", guard="is_set")
    def wait_for_set(self) -> None:
        """Wait until it is set."""

    def is_set(self) -> bool:
        """Return whether the latch is set."""
        return self._is_set


class Barrier(Artifact):
    """Blocks agents until the given number of participants has arrived; then a new round begins.

    A participant calls ``hit`` when it arrives, and ``waitForAll`` before it continues together with the others.
    """

    def init(self, participants: int) -> None:
        """Set the number of participants, at least one."""
        if participants < 1:
            self.fail("a barrier needs at least one participant", "wrong_number", participants)
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
        """Return whether the caller's round is complete: that of its last hit, or the first that it has not seen
        complete."""
        passed, hit_in = self._passed.get(self.caller, 0), self._hit_in.get(self.caller, 0)
        return self._complete() >= (hit_in if hit_in > passed else passed + 1)

    def _complete(self) -> int:
        return self._hits // self._participants


MILLISECONDS = 1000


class Clock(Artifact):
    """Ticks between ``start`` and ``stop``, a hundred times per second unless ``setFrequency`` changes it.

    Properties:
        nticks(Milliseconds): the total time of ticking; every tick adds its period.

    Signals:
        tick: the clock has ticked.
    """

    def init(self) -> None:
        """Begin stopped, at zero."""
        self._length = 10
        self._process = 0
        self._ticking = False
        self.define_property("nticks", 0)

    @operation(name="start")
    def start_ticking(self) -> None:
        """Start ticking immediately; no effect while it ticks."""
        if not self._ticking:
            self._ticking = True
            self._process += 1
            self.start(self.tick, self._process)

    @operation
    def stop(self) -> None:
        """Stop ticking."""
        self._ticking = False

    @operation(name="setFrequency")
    def set_frequency(self, hertz: int) -> None:
        """Set the number of ticks per second, from the next tick on; 1 to 1000."""
        if not 1 <= hertz <= MILLISECONDS:
            self.fail(f"expected a frequency of 1 to 1000 Hz, found {hertz}", "wrong_frequency", hertz)
        self._length = MILLISECONDS // hertz

    @internal_operation
    async def tick(self, process: int) -> None:
        """Tick until the clock is stopped, or started again."""
        while self._ticking and self._process == process:
            length = self._length
            self.update_property("nticks", self.value("nticks") + length)
            self.signal("tick")
            await self.sleep(length / MILLISECONDS)
