"""Bad messages of a topic: counted, told once and then at 10, 100, 1000 …, never acted on.

A plan hears of them by the signal ``bad_message(Topic, Why)``:

=====================  ======================================================================  ==============
Why                    what is wrong                                                           the message is
=====================  ======================================================================  ==============
not_finite(What)       a number is NaN or infinite; What is its field, or the property          dropped
wrong_frame(Frame)     it is given in another frame than the messages before, or than wanted    dropped
out_of_order(S)        its stamp is S seconds older than that of a message before               dropped
clock_jumped(S)        all stamps are now S seconds older than before: the clock was set back   used
stamp_off(S)           its stamp is S seconds (10 or more) off our clock, minus: in the past    used
out_of_range(What)     a number cannot be true, such as a negative charge; What is its field            dropped
late(S)                it came S seconds (0.5 or more) later after its stamp than those before  used [1]_
=====================  ======================================================================  ==============

.. [1] Not for driving: a motion stands as if no odometry came.

A stamp alone does not tell how old a message is: senders have clocks of their own.  But the time from stamp to arrival
stays the same, but for the way: what comes much later after its stamp than others did was held up.  When a clock was set
back, stamps go back too; when messages are late, they do not.

Faults in the code that hears messages (`Listener`) are logged in the same way.
"""

import math
from collections.abc import Callable
from typing import Any

from jacaros.clock import Clock
from jacaros.env.values import Structure
from jacaros.ros.backend import Sample
from jacaros.ros.message import to_seconds

Report = Callable[[Structure, str], None]
"""Takes the reason, and a text for people."""

SILENCE = 5.0
"""Seconds without a good message after which one in another frame is taken: its sender was started anew."""


class Faults:
    """Counts the bad messages of one topic, and tells of them without filling the log.

    Args:
        topic: absolute name.
        report: told of the first of a kind, the tenth, the hundredth and so on.

    Attributes:
        counts: how many there were of each kind, such as ``not_finite``.
    """

    def __init__(self, topic: str, report: Report) -> None:
        self.counts: dict[str, int] = {}
        self._topic, self._report = topic, report

    @property
    def total(self) -> int:
        """How many there were."""
        return sum(self.counts.values())

    def add(self, why: Structure, text: str) -> None:
        """Note a bad message.

        Args:
            why: the reason for programs.
            text: what was found and what becomes of the message, for people.
        """
        times = self.counts[why.functor] = self.counts.get(why.functor, 0) + 1
        if str(times).strip("0") == "1":
            again = f" ({times} times by now)" if times > 1 else ""
            self._report(why, f"{self._topic}: {text}{again}")

    def not_finite(self, what: str, number: float) -> None:
        """Note that a message was dropped because of a number."""
        self.add(Structure("not_finite", (what,)), f"{what} is {number}; the message is dropped")

    def out_of_range(self, what: str, number: float) -> None:
        """Note that a message was dropped because of a number that cannot be true."""
        self.add(Structure("out_of_range", (what,)), f"{what} is {number:g}; the message is dropped")


class Header:
    """Judges the headers (``std_msgs/msg/Header``) of one topic's messages.

    A stamp of zero and an empty frame say nothing and are never wrong.

    Args:
        faults: where bad ones are noted.
        clock: measures how late messages are.
        frame: the only frame that is right; empty: that of the first message.
    """

    def __init__(self, faults: Faults, clock: Clock, frame: str = "") -> None:
        self._faults = faults
        self._wanted = frame.strip("/")
        self._frame = self._wanted
        self._good_at = -math.inf
        self._stamps = Stamps(faults, clock)

    @property
    def frame(self) -> str:
        """The frame in which messages are believed now; empty while it is not known."""
        return self._frame

    @property
    def late(self) -> float:
        """By how many seconds the newest message was later than others before; 0 when it was not."""
        return self._stamps.late

    def accepts(self, sample: Sample) -> bool:
        """Whether a message may be used; notes it when not."""
        header: Any = sample.message.header
        frame = header.frame_id
        good = (not frame or frame == self._frame or self._is_in_frame(frame, sample.stamp)) and (
            self._stamps.accept(to_seconds(header.stamp), sample.stamp)
        )
        if good:
            self._good_at = sample.stamp
        return good

    def _is_in_frame(self, given: str, now: float) -> bool:
        frame = given.strip("/")
        if not frame or frame == self._frame:
            return True
        if not self._wanted and (not self._frame or not 0.0 <= now - self._good_at < SILENCE):
            self._frame = frame
            return True
        text = f"the frame is {frame}, not {self._frame}; the message is dropped"
        self._faults.add(Structure("wrong_frame", (frame,)), text)
        return False


Complain = Callable[[str, BaseException], None]
"""Logs what went wrong, with the place in the code."""


class Listener:
    """Calls back for each message; what is raised is logged, and told again at 10, 100, 1000 … times.

    A sensor may send a thousand messages a second, so a mistake in the code that hears them must not fill the log.

    Args:
        topic: for the log.
        callback: takes a message.
        complain: logs a fault.
    """

    def __init__(self, topic: str, callback: Callable[[Sample], None], complain: Complain) -> None:
        self._topic, self._callback, self._complain = topic, callback, complain
        self._faults: dict[str, int] = {}

    def __call__(self, sample: Sample) -> None:
        """Take a message."""
        try:
            self._callback(sample)
        except Exception as error:
            self._fault(error)

    def _fault(self, error: Exception) -> None:
        kind = f"{type(error).__name__} {_line(error)}"
        times = self._faults[kind] = self._faults.get(kind, 0) + 1
        if times == 1:
            self._complain(f"the callback of topic {self._topic} failed:", error)
        elif str(times).strip("0") == "1":
            self._complain(f"the callback of topic {self._topic} has failed {times} times:", error)


def _line(error: Exception) -> int:
    """The line that raised *error*."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return trace.tb_lineno if trace is not None else 0


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


class Stamps:
    """Judges the stamps of one topic's messages.

    Args:
        faults: where bad ones are noted.
        clock: measures how late messages are.

    Attributes:
        late: by how many seconds the newest message was later than others before.
    """

    def __init__(self, faults: Faults, clock: Clock) -> None:
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
