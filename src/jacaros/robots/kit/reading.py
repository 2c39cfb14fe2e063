"""Readings: which messages of a sensor update a property (thesis, section 6.3).

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

`RangeOfView` is for messages with many elements.
"""

import asyncio
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from jacaros.artifacts.streams import ReadingPolicy as ReadingPolicy
from jacaros.artifacts.streams import Values
from jacaros.robots.kit.options import ReadOption, bands, one_of, positive, yes_or_no
from jacaros.robots.ros.waiting import within
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.trace import Cause

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
        passes = self._delivered is None or self.policy.differ(self._delivered, self.newest)
        if passes:
            if self.policy.latest_only and self.behind() and self._queue.wait():
                return False
            self._delivered = self.newest
            if self.policy.rate is not None:
                self._pause = self.clock.call_later(1.0 / self.policy.rate, self._end_pause)
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


MOVED = 0.01
"""Metres that a robot must move before the elements in view are computed again."""


def _position(element: Values) -> tuple[float, float]:
    x, y = element[:2]
    assert isinstance(x, int | float)
    assert isinstance(y, int | float)
    return float(x), float(y)


class RangeOfView:
    """The elements of the newest message within a range of the robot; their first two values are x and y in metres.

    Until the robot's position is known, nothing is in view.

    Args:
        reach: metres, inclusive.
        show: called with the elements in view, in the order of the message, whenever they change.
    """

    def __init__(self, reach: float, show: Callable[[list[Values], Cause | None], None]) -> None:
        self._reach, self._show = reach, show
        self._elements: list[tuple[float, float, Values]] = []
        self._here: tuple[float, float] | None = None
        self._shown: list[Values] = []

    def take(self, elements: Iterable[Values], cause: Cause | None = None) -> None:
        """Take the elements of a message; an element whose position is not finite is never in view."""
        self._elements = [(*_position(each), each) for each in elements]
        self._look(cause)

    def stand(self, x: float, y: float, cause: Cause | None = None) -> None:
        """Update the position of the robot."""
        before = self._here
        if before is None or math.dist(before, (x, y)) > MOVED:
            self._here = (x, y)
            self._look(cause)

    def _look(self, cause: Cause | None) -> None:
        if self._here is None:
            return
        here_x, here_y = self._here
        seen = [
            element for x, y, element in self._elements if math.hypot(x - here_x, y - here_y) <= self._reach
        ]
        if seen != self._shown:
            self._shown = seen
            self._show(seen, cause)
