"""Stamps of one topic's messages: whether they come in their order, and in time.

Senders have clocks of their own, so a stamp alone does not tell how old a message is.  But the time from stamp to arrival
stays the same, but for the way: what comes much later after its stamp than others did was held up.  When a clock was set
back, stamps go back too; when messages are late, they do not.
"""

from typing import Protocol

from jacaros.clock import Clock
from jacaros.env.values import Structure

FAR = 10.0
"""Seconds between a stamp and our clock that are worth a word; the clocks of two machines differ by less."""

STRAGGLING = 1.0
"""A message may be overtaken by so many seconds; of a clock that was set back by less, the stamps soon catch up."""

IN_A_ROW = 3
"""So many stamps one after the other that are still older are no stragglers: the clock of the sender was set back."""

LATE = 0.5
"""Seconds by which a message must be later than others before to be worth a word."""

DRIFT = 1e-3
"""Seconds by which two clocks may part in each second: a clock that is being corrected is that fast, none is faster."""


class Judge(Protocol):
    """Takes note of a fault."""

    def add(self, why: Structure, text: str) -> None:
        """Note a fault: the reason for plans, and a text for people."""


class Stamps:
    """Judges the stamps of one topic's messages.

    Args:
        faults: where bad ones are noted.
        clock: measures how late messages are.

    Attributes:
        late: by how many seconds the newest message was later than others before.
    """

    def __init__(self, faults: Judge, clock: Clock) -> None:
        self.late = 0.0
        self._faults, self._clock = faults, clock
        self._newest = 0.0
        self._dropped = 0
        self._stragglers: list[float] = []
        self._least: float | None = None
        self._heard = 0.0

    def accept(self, stamp: float, now: float) -> bool:
        """Return whether a message may be used; both times in seconds since the epoch, *stamp* by the sender's clock.

        Args:
            stamp: of the message; 0.0: it has none.
            now: by our clock; 0.0: it is not known yet.
        """
        if stamp == 0.0:
            return True
        # A clock that follows /clock stands at 0 until its first message, and odometry may come before that.
        if now != 0.0 and abs(stamp - now) >= FAR:
            off = round(stamp - now, 3)
            text = f"the stamp is {off:g} s off our clock; do both follow the same clock (use_sim_time)?"
            self._faults.add(Structure("stamp_off", (off,)), text)
        if stamp >= self._newest or self._has_jumped(stamp):
            if self._dropped >= IN_A_ROW:
                self._least = None  # the sender's clock was set back, by little
            if stamp > self._newest or self._least is None:
                self._note_delay(stamp)
            self._newest = stamp
            self._dropped = 0
            self._stragglers.clear()
            return True
        self._dropped += 1
        late = round(self._newest - stamp, 3)
        text = f"the stamp is {late:g} s older than that of a message before; the message is dropped"
        self._faults.add(Structure("out_of_order", (late,)), text)
        return False

    def _has_jumped(self, stamp: float) -> bool:
        """Whether this stamp, older than others, shows with those before it that the sender's clock was set back."""
        late = round(self._newest - stamp, 3)
        if late < STRAGGLING or (self._stragglers and stamp < self._stragglers[-1]):
            self._stragglers.clear()
        if late >= STRAGGLING:
            self._stragglers.append(stamp)
        if len(self._stragglers) < IN_A_ROW:
            return False
        self._faults.add(Structure("clock_jumped", (late,)), f"the stamps jumped back by {late:g} s")
        self._least = None
        return True

    def _note_delay(self, stamp: float) -> None:
        """Compare the time that the message took with the shortest so far, which clocks that part make longer."""
        now = self._clock.elapsed
        delay = now - stamp  # from another zero; only differences count
        if self._least is not None:
            self._least = min(delay, self._least + DRIFT * (now - self._heard))
        else:
            self._least = delay
        self._heard = now
        self.late = delay - self._least
        if self.late >= LATE:
            late = round(self.late, 3)
            text = f"a message came {late:g} s later after its stamp than others before: nobody drives by it"
            self._faults.add(Structure("late", (late,)), text)
