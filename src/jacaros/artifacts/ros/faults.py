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
"""

import math
from collections.abc import Callable
from typing import Any

from jacaros.artifacts.ros.stamps import Stamps
from jacaros.clock import Clock
from jacaros.env.values import Structure
from jacaros.ros.backend import Sample
from jacaros.ros.message import to_seconds

Tell = Callable[[Structure, str], None]
"""Takes the reason, and a text for people."""

SILENCE = 5.0
"""Seconds without a good message after which one in another frame is taken: its sender was started anew."""


class Faults:
    """Counts the bad messages of one topic, and tells of them without filling the log.

    Args:
        topic: absolute name.
        tell: told of the first of a kind, the tenth, the hundredth and so on.

    Attributes:
        counts: how many there were of each kind, such as ``not_finite``.
    """

    def __init__(self, topic: str, tell: Tell) -> None:
        self.counts: dict[str, int] = {}
        self._topic, self._tell = topic, tell

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
            self._tell(why, f"{self._topic}: {text}{again}")

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
