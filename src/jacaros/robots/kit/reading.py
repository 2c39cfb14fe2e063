"""The messages of a sensor: which are bad, and which of the others update a property (thesis, section 6.3).

A `ReadingPolicy` keeps a sensor from flooding the agents that observe it, and from misleading them:

=============  ==========================================================================================
policy         effect
=============  ==========================================================================================
dead band      equal values and small changes are dropped; one number for all fields or one for each
rate           updates are spaced out
on demand      values are delivered on request only
latest only    newest-only delivery (conflation): while an observer has not processed the previous value,
               updates are held back, and then the newest is delivered
expire         values are withdrawn after some seconds without a message
finite         messages with NaN or an infinite number are refused
=============  ==========================================================================================

Bad messages are counted, reported on the 1st, 10th, 100th, … occurrence, and never acted on. A plan receives
them as the signal ``bad_message(Topic, Why)``:

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

import asyncio
import math
from collections.abc import Callable
from dataclasses import dataclass

from jacaros.artifacts.env.values import Structure
from jacaros.robots.kit.options import ReadOption, bands, one_of, positive, yes_or_no
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.waiting import within
from jacaros.robots.streams import ReadingPolicy as ReadingPolicy
from jacaros.robots.streams import Values
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.files.texts import is_worth_a_line
from jacaros.runtime.trace import Cause

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
    """Check the stamps of the messages of a topic, and the frames of their headers (``std_msgs/msg/Header``).

    A zero stamp and an empty frame carry no information and are accepted.

    Args:
        faults: counts bad messages.
        clock: measures how late messages are.
        frame: the only accepted frame; empty: that of the first message.

    Attributes:
        late: how many seconds later than earlier messages the newest one arrived.
        frame: the frame that is accepted now; empty while it is unknown.
    """

    def __init__(self, faults: BadMessages, clock: Clock, frame: str = "") -> None:
        self.late = 0.0
        self._wanted = self.frame = frame.strip("/")
        self._good_at = -math.inf
        self._faults, self._clock = faults, clock
        self._newest = 0.0
        self._dropped = 0
        self._stragglers: list[float] = []
        self._least: float | None = None
        self._heard = 0.0

    def accept(self, stamp: float, now: float, frame: str = "") -> bool:
        """Return whether a message may be used; count it if not. Both times are in seconds since the epoch, *stamp* on
        the sender's clock.

        Args:
            stamp: stamp of the message; 0.0: none.
            now: time on our clock; 0.0: not known yet.
            frame: frame of the message; empty: none.
        """
        if frame and frame != self.frame and not self._is_in_frame(frame, now):
            return False
        # A clock that follows /clock is at 0 until its first message, and odometry may arrive before that.
        if stamp != 0.0 and now != 0.0 and abs(stamp - now) >= FAR:
            self._report_off(round(stamp - now, 3))
        if stamp != 0.0 and (stamp >= self._newest or self._has_jumped(stamp)):
            if self._dropped >= IN_A_ROW:
                self._least = None  # the sender's clock was set back slightly
            if stamp > self._newest or self._least is None:
                elapsed = self._clock.elapsed
                delay = elapsed - stamp  # the zero is arbitrary; only differences count
                least = delay
                if self._least is not None:  # clocks drift apart, so the limit grows
                    least = min(delay, self._least + DRIFT * (elapsed - self._heard))
                self._least, self._heard, self.late = least, elapsed, delay - least
                if self.late >= LATE:
                    self._report_late()
            self._newest = stamp
            self._dropped = 0
            self._stragglers.clear()
        elif stamp != 0.0:
            self._report_old(stamp)
            return False
        self._good_at = now
        return True

    def _report_off(self, off: float) -> None:
        text = f"the stamp differs from our clock by {off:g} s; do both follow the same clock (use_sim_time)?"
        self._faults.add(Structure("stamp_off", (off,)), text)

    def _report_old(self, stamp: float) -> None:
        self._dropped += 1
        late = round(self._newest - stamp, 3)
        text = f"the stamp is {late:g} s older than that of an earlier message; message dropped"
        self._faults.add(Structure("out_of_order", (late,)), text)

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

    def _report_late(self) -> None:
        late = round(self.late, 3)
        text = f"the message arrived {late:g} s later than earlier ones; motions do not use it"
        self._faults.add(Structure("late", (late,)), text)

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


READING_OPTIONS: dict[str, ReadOption] = {
    "mode": one_of("verbose", "on_demand"),
    "rate": positive,
    "dead_band": bands,
    "latest_only": yes_or_no,
    "expire": positive,
}
"""Options of artifacts that read sensors: ``mode(on_demand)``, ``rate(Hz)``, ``dead_band(D)``,
``latest_only(false)``, ``expire(S)``."""

TURNS = 20
"""Turns of the loop in which a held value checks whether it may be delivered; no time passes meanwhile."""

LOOK_AGAIN = 0.005
"""Seconds between two checks after that."""

LONGEST_WAIT = 1.0
"""Seconds after which a held value is delivered although the previous one was not processed: an observer may never do
so."""


def _nothing(*_: object) -> None:
    """Ignore withdrawals and refusals."""


@dataclass(eq=False)
class Reading:
    """The newest values of one sensor, and the decision when to deliver them.

    The first message is always delivered. Under a rate limit the newest value of an interval is delivered at its end:
    the last message of a burst may be late, but is never lost.

    Args:
        policy: when to deliver values.
        clock: measures rate limit and expiry.
        deliver: called with the values and their cause; None for a reading that is only queried.
        name: name of the property that shows the values, if any.
        on_withdraw: called when the values delivered last are out of date.
        on_refuse: called with a number that is not finite; the message is not used.
        behind: returns whether the values delivered last are still unprocessed.
    """

    policy: ReadingPolicy
    clock: Clock
    deliver: Callable[[Values, Cause | None], None] | None = None
    name: str = ""
    on_withdraw: Callable[[], None] = _nothing
    on_refuse: Callable[[float], None] = _nothing
    behind: Callable[[], bool] = lambda: False

    def __post_init__(self) -> None:
        self.newest: Values | None = None
        self._delivered: Values | None = None
        self._cause: Cause | None = None
        self._pause: Timer | None = None
        self._expiry: Timer | None = None
        self._taken = 0.0
        self._queue = Queue(self.clock, self._deliver_if_new)
        self._expecting: list[asyncio.Future[None]] = []
        self._drops_equal = self.policy.dead_band == 0.0 and self.policy.finite
        """Whether all values that are not equal to the last ones are delivered."""

    def take(self, values: Values, cause: Cause | None = None) -> None:
        """Take the values of a message, and deliver them now, later or never."""
        if self.policy.finite and (why := not_finite(values)) is not None:
            self.on_refuse(why)
        elif self.offer(values, cause):
            self._deliver_newest()

    def offer(self, values: Values, cause: Cause | None) -> bool:
        """Take values whose numbers are known to be finite. Return True if the caller must deliver them now."""
        self.newest, self._cause = values, cause
        if self.policy.expire is not None:
            self._confirm(self.policy.expire)
        for expected in self._expecting:
            if not expected.done():
                expected.set_result(None)
        return (
            not self.policy.on_demand and self._pause is None and not self._queue.waits and self._may_pass()
        )

    def passed(self) -> Values:
        """Return the newest values, which the caller delivers; empty before the first message.

        Equal values are not delivered again afterwards.
        """
        if self.newest is None:
            return ()
        self._delivered = self.newest
        return self.newest

    async def first(self, timeout: float) -> None:
        """Wait for the first message.

        Raises:
            TimeoutError: none arrived within *timeout* seconds.
        """
        if self.newest is not None:
            return
        expected: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._expecting.append(expected)
        try:
            await within(self.clock, expected, timeout)
        finally:
            self._expecting.remove(expected)

    def close(self) -> None:
        """Stop delivering."""
        self.deliver, self.on_withdraw, self.on_refuse = None, _nothing, _nothing
        self._queue.close()
        for timer in (self._pause, self._expiry):
            if timer is not None:
                timer.cancel()

    def _deliver_if_new(self) -> None:
        if self._may_pass():
            self._deliver_newest()

    def _deliver_newest(self) -> None:
        assert self.deliver is not None
        assert self.newest is not None
        self.deliver(self.newest, self._cause)

    def _may_pass(self) -> bool:
        """Return whether to deliver the newest values now; if so, they count as delivered."""
        if self.newest is None or self.deliver is None:
            return False
        policy, newest, delivered = self.policy, self.newest, self._delivered
        passes = delivered is None or (
            delivered != newest if self._drops_equal else policy.differ(delivered, newest)
        )
        if passes:
            if policy.latest_only and self.behind() and self._queue.wait():
                return False
            self._delivered = newest
            if policy.rate is not None:
                self._pause = self.clock.call_later(1.0 / policy.rate, self._end_pause)
        self._queue.waits = False
        return passes

    def _end_pause(self) -> None:
        self._pause = None
        if not self._queue.waits:
            self._deliver_if_new()

    def _confirm(self, seconds: float) -> None:
        # One timer serves any number of messages, so a fast sensor costs no more than a slow one.
        self._taken = self.clock.elapsed
        if self._expiry is None:
            self._expiry = self.clock.call_later(seconds, self._look_at_age)

    def _look_at_age(self) -> None:
        assert self.policy.expire is not None
        left = self._taken + self.policy.expire - self.clock.elapsed
        if left > 1e-9:
            self._expiry = self.clock.call_later(left, self._look_at_age)
            return
        self._expiry = None
        self.withdraw()

    def withdraw(self) -> None:
        """Withdraw the values of the newest message, if any; the next values are delivered in any case."""
        if self.newest is not None:
            self.newest = self._delivered = self._cause = None
            self.on_withdraw()


class Queue:
    """Hold back at most one value until the previous one has been processed.

    Args:
        clock: measures the wait.
        look: called repeatedly while a value is held back; calls `wait`, or ends the wait.

    Attributes:
        waits: whether a value is held back; set it to False to end the wait.
    """

    def __init__(self, clock: Clock, look: Callable[[], None]) -> None:
        self.waits = False
        self._clock, self._look = clock, look
        self._turns = 0
        self._began = 0.0
        self._timer: Timer | None = None
        self._closed = False

    def wait(self) -> bool:
        """Check again soon. Return False if the wait has been long enough."""
        if not self.waits:
            self.waits, self._turns, self._began = True, 0, self._clock.elapsed
        elif self._clock.elapsed - self._began >= LONGEST_WAIT:
            return False
        self._turns += 1
        if self._turns <= TURNS:
            asyncio.get_running_loop().call_soon(self._look_again)
        else:
            self._timer = self._clock.call_later(LOOK_AGAIN, self._look_again)
        return True

    def close(self) -> None:
        """Stop checking."""
        self._closed = True
        if self._timer is not None:
            self._timer.cancel()

    def _look_again(self) -> None:
        if not self._closed:
            self._look()


def not_finite(values: Values) -> float | None:
    """Return the first NaN or infinite number in *values*, including lists; None if none exists."""
    for value in values:
        if isinstance(value, float):
            if not math.isfinite(value):
                return value
        elif isinstance(value, list | tuple) and (found := not_finite(tuple(value))) is not None:
            return found
    return None
