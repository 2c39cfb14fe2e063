"""A clock that ticks for agents."""

from jacaros.env import Artifact, internal_operation, operation

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
