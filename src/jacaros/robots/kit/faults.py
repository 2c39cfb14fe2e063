"""Bad messages of a topic: counted, reported on the 1st, 10th, 100th, … occurrence, and never acted on.

A plan receives them as the signal ``bad_message(Topic, Why)``:

=====================  ======================================================================  ==============
Why                    problem                                                                 the message is
=====================  ======================================================================  ==============
not_finite(What)       a number is NaN or infinite; What is its field, or the property         dropped
wrong_frame(Frame)     its frame is not that of earlier messages, or not the requested one     dropped
out_of_order(S)        its stamp is S seconds older than that of an earlier message            dropped
clock_jumped(S)        all stamps are now S seconds older than before: the clock was set back  used
stamp_off(S)           its stamp differs from our clock by S seconds (10 or more; past: < 0)   used
out_of_range(What)     a number is impossible, such as a negative charge; What is its field    dropped
late(S)                its delay is S seconds (0.5 or more) longer than that of earlier ones   used [1]_
=====================  ======================================================================  ==============

.. [1] Not for driving: a motion stops as if odometry were missing.

A stamp alone does not show how old a message is, because senders have clocks of their own.  But apart from transport, the
time from stamp to arrival is constant: a message whose delay is much longer than that of others was held up.  When a clock
is set back, stamps go back too; when messages are late, they do not.

`MessageCallback` logs exceptions in message callbacks in the same way.
"""

import math
from collections.abc import Callable
from typing import Any

from jacaros.artifacts.env.values import Structure
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.node import Sample
from jacaros.runtime.clock import Clock
from jacaros.runtime.files.texts import is_worth_a_line

Report = Callable[[Structure, str], None]
"""Called with the reason, and with a text for the log."""

SILENCE = 5.0
"""Seconds without a good message after which a new frame is accepted: the sender was restarted."""


class BadMessages:
    """Count the bad messages of one topic, and report them without flooding the log.

    Args:
        topic: absolute name.
        report: called on the 1st, 10th, 100th, … message of a kind.

    Attributes:
        counts: number of messages of each kind, such as ``not_finite``.
    """

    def __init__(self, topic: str, report: Report) -> None:
        self.counts: dict[str, int] = {}
        self._topic, self._report = topic, report

    @property
    def total(self) -> int:
        """Number of bad messages."""
        return sum(self.counts.values())

    def add(self, why: Structure, text: str) -> None:
        """Count a bad message.

        Args:
            why: the reason for programs.
            text: what was found, and what happens to the message.
        """
        times = self.counts[why.functor] = self.counts.get(why.functor, 0) + 1
        if is_worth_a_line(times):
            again = f" ({times} times so far)" if times > 1 else ""
            self._report(why, f"{self._topic}: {text}{again}")

    def not_finite(self, what: str, number: float) -> None:
        """Count a message that was dropped because a number is not finite."""
        self.add(Structure("not_finite", (what,)), f"{what} is {number}; message dropped")

    def out_of_range(self, what: str, number: float) -> None:
        """Count a message that was dropped because a number is impossible."""
        self.add(
            Structure("out_of_range", (what,)),
            f"{what} is {number:g}, which is out of range; message dropped",
        )


Complain = Callable[[str, BaseException], None]
"""Log an exception, with its place in the code."""


class MessageCallback:
    """Call a callback for each message. Log its exceptions on the 1st, 10th, 100th, … occurrence.

    A sensor may send a thousand messages a second, so a faulty callback must not flood the log.

    Args:
        topic: for the log.
        callback: called with each message.
        complain: logs an exception.
    """

    def __init__(self, topic: str, callback: Callable[[Sample], None], complain: Complain) -> None:
        self.heard = False
        """Whether a message has arrived."""
        self._topic, self._callback, self._complain = topic, callback, complain
        self._faults: dict[str, int] = {}

    def __call__(self, sample: Sample) -> None:
        """Handle a message."""
        self.heard = True
        try:
            self._callback(sample)
        except Exception as error:
            self._fault(error)

    def _fault(self, error: Exception) -> None:
        kind = f"{type(error).__name__} {_line(error)}"
        times = self._faults[kind] = self._faults.get(kind, 0) + 1
        if is_worth_a_line(times):
            again = f" ({times} times so far)" if times > 1 else ""
            self._complain(f"the callback of topic {self._topic} failed{again}:", error)


def _line(error: Exception) -> int:
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return trace.tb_lineno if trace is not None else 0


FAR = 10.0
"""Seconds between a stamp and our clock that are reported; the clocks of two machines usually differ by less."""

STRAGGLING = 1.0
"""Seconds by which one message may overtake another. If a clock is set back by less, its stamps soon catch up."""

IN_A_ROW = 3
"""Number of consecutive older stamps that show that the sender's clock was set back."""

LATE = 0.5
"""Additional delay, in seconds, that is reported."""

DRIFT = 1e-3
"""Seconds per second by which two clocks may drift apart: a clock that is being adjusted drifts this fast, none
faster."""


class Stamps:
    """Check the stamps of the messages of a topic.

    Args:
        faults: counts bad messages.
        clock: measures how late messages are.

    Attributes:
        late: how many seconds later than earlier messages the newest one arrived.
    """

    def __init__(self, faults: BadMessages, clock: Clock) -> None:
        self.late = 0.0
        self._faults, self._clock = faults, clock
        self._newest = 0.0
        self._dropped = 0
        self._stragglers: list[float] = []
        self._least: float | None = None
        self._heard = 0.0

    def accept(self, stamp: float, now: float) -> bool:
        """Return whether a message may be used. Both times are in seconds since the epoch, *stamp* on the sender's
        clock.

        Args:
            stamp: stamp of the message; 0.0: none.
            now: time on our clock; 0.0: not known yet.
        """
        if stamp == 0.0:
            return True
        # A clock that follows /clock is at 0 until its first message, and odometry may arrive before that.
        if now != 0.0 and abs(stamp - now) >= FAR:
            off = round(stamp - now, 3)
            text = f"the stamp differs from our clock by {off:g} s; do both follow the same clock (use_sim_time)?"
            self._faults.add(Structure("stamp_off", (off,)), text)
        if stamp >= self._newest or self._has_jumped(stamp):
            if self._dropped >= IN_A_ROW:
                self._least = None  # the sender's clock was set back slightly
            if stamp > self._newest or self._least is None:
                self._note_delay(stamp)
            self._newest = stamp
            self._dropped = 0
            self._stragglers.clear()
            return True
        self._dropped += 1
        late = round(self._newest - stamp, 3)
        text = f"the stamp is {late:g} s older than that of an earlier message; message dropped"
        self._faults.add(Structure("out_of_order", (late,)), text)
        return False

    def _has_jumped(self, stamp: float) -> bool:
        """Return whether this older stamp and the ones before it show that the sender's clock was set back."""
        late = round(self._newest - stamp, 3)
        if late < STRAGGLING or (self._stragglers and stamp < self._stragglers[-1]):
            self._stragglers.clear()
        if late >= STRAGGLING:
            self._stragglers.append(stamp)
        if len(self._stragglers) < IN_A_ROW:
            return False
        self._faults.add(Structure("clock_jumped", (late,)), f"the stamps went back by {late:g} s")
        self._least = None
        return True

    def _note_delay(self, stamp: float) -> None:
        """Compare the delay of a message with the shortest so far; the limit grows as the clocks drift apart."""
        now = self._clock.elapsed
        delay = now - stamp  # the zero is arbitrary; only differences count
        if self._least is not None:
            self._least = min(delay, self._least + DRIFT * (now - self._heard))
        else:
            self._least = delay
        self._heard = now
        self.late = delay - self._least
        if self.late >= LATE:
            late = round(self.late, 3)
            text = f"the message arrived {late:g} s later than earlier ones; motions do not use it"
            self._faults.add(Structure("late", (late,)), text)


class Header(Stamps):
    """Check the headers (``std_msgs/msg/Header``) of the messages of a topic.

    A zero stamp and an empty frame carry no information and are accepted.

    Args:
        faults: counts bad messages.
        clock: measures how late messages are.
        frame: the only accepted frame; empty: that of the first message.

    Attributes:
        frame: the frame that is accepted now; empty while it is unknown.
    """

    def __init__(self, faults: BadMessages, clock: Clock, frame: str = "") -> None:
        super().__init__(faults, clock)
        self._wanted = self.frame = frame.strip("/")
        self._good_at = -math.inf

    def accepts(self, sample: Sample) -> bool:
        """Return whether a message may be used; count it if not."""
        header: Any = sample.message.header
        frame = header.frame_id
        good = (not frame or frame == self.frame or self._is_in_frame(frame, sample.stamp)) and (
            self.accept(to_seconds(header.stamp), sample.stamp)
        )
        if good:
            self._good_at = sample.stamp
        return good

    def _is_in_frame(self, given: str, now: float) -> bool:
        frame = given.strip("/")
        if not frame or frame == self.frame:
            return True
        if not self._wanted and (not self.frame or not 0.0 <= now - self._good_at < SILENCE):
            self.frame = frame
            return True
        text = f"expected frame {self.frame}, found {frame}; message dropped"
        self._faults.add(Structure("wrong_frame", (frame,)), text)
        return False
