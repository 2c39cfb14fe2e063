"""CArtAgO's tools for agents that wait: a latch that is set once and for all, a barrier, a clock that ticks."""

from jacaros.env import Artifact, internal_operation, operation


class Latch(Artifact):
    """Holds back those who call ``waitForSet`` until somebody calls ``set``; from then on everybody passes."""

    def init(self) -> None:
        """Not be set."""
        self._is_set = False

    @operation(name="set")
    def set_it(self) -> None:
        """Let everybody pass."""
        self._is_set = True

    @operation(name="waitForSet", guard="is_set")
    def wait_for_set(self) -> None:
        """Wait until it is set."""

    def is_set(self) -> bool:
        """Whether everybody passes."""
        return self._is_set


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


MILLISECONDS = 1000


class Clock(Artifact):
    """Ticks between ``start`` and ``stop``, a hundred times in a second unless ``setFrequency`` says otherwise.

    Properties:
        nticks(Milliseconds): the time for which it has ticked; every tick adds its length.

    Signals:
        tick: it has ticked.
    """

    def init(self) -> None:
        """Stand still at zero."""
        self._length = 10
        self._process = 0
        self._ticking = False
        self.define_property("nticks", 0)

    @operation(name="start")
    def start_ticking(self) -> None:
        """Begin to tick, at once; without effect while it ticks."""
        if not self._ticking:
            self._ticking = True
            self._process += 1
            self.start(self.tick, self._process)

    @operation
    def stop(self) -> None:
        """Tick no more."""
        self._ticking = False

    @operation(name="setFrequency")
    def set_frequency(self, hertz: int) -> None:
        """Tick so often in a second, from the next tick on; 1 to 1000."""
        if not 1 <= hertz <= MILLISECONDS:
            self.fail(
                f"a clock cannot tick {hertz} times in a second, only 1 to 1000", "wrong_frequency", hertz
            )
        self._length = MILLISECONDS // hertz

    @internal_operation
    async def tick(self, process: int) -> None:
        """Tick until it is stopped, or started again."""
        while self._ticking and self._process == process:
            length = self._length
            self.update_property("nticks", self.value("nticks") + length)
            self.signal("tick")
            await self.sleep(length / MILLISECONDS)
