"""Readings: which of a sensor's messages become property updates (thesis, section 6.3).

One `ReadingPolicy` puts together what keeps a sensor from flooding the minds that watch it, and from deceiving them:

=============  ==========================================================================================
policy         what it does
=============  ==========================================================================================
dead band      equal values and small changes are dropped; one figure for all fields or one for each
rate           what is left is spread out
on demand      nothing is passed until somebody asks
latest only    the next value waits until the one before has been taken up, and then the newest is passed
expire         values that nobody confirmed for some seconds are withdrawn
finite         values with NaN or an infinite number are refused
=============  ==========================================================================================

The range of view, for messages that hold many elements, is in `view`.
"""

import asyncio
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from jacaros.artifacts.kit.options import Reader, bands, one_of, positive, yes_or_no
from jacaros.clock import Clock, Timer
from jacaros.ros.waiting import within
from jacaros.trace import Cause

Values = tuple[object, ...]

READING_OPTIONS: dict[str, Reader] = {
    "mode": one_of("verbose", "on_demand"),
    "rate": positive,
    "dead_band": bands,
    "latest_only": yes_or_no,
    "expire": positive,
}
"""Options of artifacts that read sensors: ``mode(on_demand)``, ``rate(Hz)``, ``dead_band(D)``, ``latest_only(false)``,
``expire(S)``."""

TURNS = 20
"""So many turns of the loop in a row a value that waits looks whether it may pass; no time passes meanwhile."""

LOOK_AGAIN = 0.005
"""Seconds between two looks after that."""

LONGEST_WAIT = 1.0
"""Seconds after which a value passes although the one before was not taken up: observers may never take it up."""


@dataclass(frozen=True, slots=True)
class ReadingPolicy:
    """When values are passed on.

    Attributes:
        on_demand: never by themselves, only by `Reading.passed`.
        rate: at most so many times a second; None: no limit.
        dead_band: a value is passed when some number field differs by more than this from the one passed
            before; one figure for all fields or one for each. 0 drops equal values only.
        latest_only: while observers have not taken up the value before, nothing is passed; then the newest is.
            For states, such as poses; not for messages of which each counts.
        expire: values are withdrawn when no message came for so many seconds; None: never.
        finite: values with NaN or an infinite number are no message at all.
    """

    on_demand: bool = False
    rate: float | None = None
    dead_band: float | tuple[float, ...] = 0.0
    latest_only: bool = False
    expire: float | None = None
    finite: bool = True

    @classmethod
    def from_options(
        cls, options: Mapping[str, object], on_demand: bool = False, latest_only: bool = True
    ) -> "ReadingPolicy":
        """Make the policy that `READING_OPTIONS` ask for; *on_demand* and *latest_only* hold when they say nothing."""
        mode = options.get("mode", "on_demand" if on_demand else "verbose")
        rate, band = options.get("rate"), options.get("dead_band", 0.0)
        expire = options.get("expire")
        assert rate is None or isinstance(rate, float)
        assert expire is None or isinstance(expire, float)
        assert isinstance(band, float | tuple)
        return cls(mode == "on_demand", rate, band, bool(options.get("latest_only", latest_only)), expire)

    def differ(self, old: Values, new: Values) -> bool:
        """Whether *new* is worth passing after *old*."""
        if old == new:
            return False
        if self.dead_band == 0.0 and self.finite:
            return True
        if len(old) != len(new):
            return True
        for index, value in enumerate(new):  # noqa: SIM110 - most differ in the first field: no generator for that
            if self._field_differs(index, old[index], value):
                return True
        return False

    def _field_differs(self, index: int, old: object, new: object) -> bool:
        if isinstance(old, int | float) and isinstance(new, int | float):
            return abs(new - old) > self._band(index) or math.isnan(old) != math.isnan(new)
        return old != new

    def _band(self, index: int) -> float:
        if isinstance(self.dead_band, tuple):
            return self.dead_band[index] if index < len(self.dead_band) else 0.0
        return self.dead_band


@dataclass(frozen=True, slots=True)
class Outlet:
    """What else somebody who takes values wants to be told, and is asked.

    Attributes:
        withdraw: the values passed last are out of date.
        refuse: values were no message at all, because of this number that they hold.
        behind: whether the values passed last have still to be taken up.
    """

    withdraw: Callable[[], None] = lambda: None
    refuse: Callable[[float], None] = lambda number: None
    behind: Callable[[], bool] = lambda: False


ALOOF = Outlet()
"""Wants to be told nothing, and is always up to date."""


class Reading:
    """The newest values of one sensor, and the decision when to pass them on.

    The first message always passes.  Under a rate limit the newest value of a pause is passed when the
    pause is over: the last message of a burst is late at most, never lost.

    Args:
        policy: when to pass values on.
        clock: the time for rate limit and expiry.
        deliver: takes the values that are passed, and the cause that led to them; None for a reading that is only asked.
        outlet: is told the rest.
        name: of the property that shows the values, if there is one.
    """

    def __init__(
        self,
        policy: ReadingPolicy,
        clock: Clock,
        deliver: Callable[[Values, Cause | None], None] | None = None,
        outlet: Outlet = ALOOF,
        name: str = "",
    ) -> None:
        self.policy, self.name = policy, name
        self.newest: Values | None = None
        self._clock = clock
        self._deliver = deliver
        self._outlet = outlet
        self._delivered: Values | None = None
        self._cause: Cause | None = None
        self._pause: Timer | None = None
        self._expiry: Timer | None = None
        self._taken = 0.0
        self._queue = Queue(clock, self._deliver_if_new)
        self._expecting: list[asyncio.Future[None]] = []

    def take(self, values: Values, cause: Cause | None = None) -> None:
        """Take a message's values, and pass them on now, later or never."""
        if self.policy.finite and (why := not_finite(values)) is not None:
            self._outlet.refuse(why)
        else:
            self.take_finite(values, cause)

    def take_finite(self, values: Values, cause: Cause | None = None) -> None:
        """Take a message's values whose numbers are known to be finite, and pass them on now, later or never."""
        if self.offer(values, cause):
            self._deliver_newest()

    def offer(self, values: Values, cause: Cause | None) -> bool:
        """Take values whose numbers are known to be finite; True when they count as passed on, which the caller does."""
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
        """The newest values, passed on by the caller; empty before the first message.

        Equal values are not passed on again afterwards.
        """
        if self.newest is None:
            return ()
        self._delivered = self.newest
        return self.newest

    async def first(self, timeout: float) -> None:
        """Wait for the first message.

        Raises:
            TimeoutError: none came in *timeout* seconds.
        """
        if self.newest is not None:
            return
        expected: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._expecting.append(expected)
        try:
            await within(self._clock, expected, timeout)
        finally:
            self._expecting.remove(expected)

    def close(self) -> None:
        """Pass nothing on any more."""
        self._deliver, self._outlet = None, ALOOF
        self._queue.close()
        for timer in (self._pause, self._expiry):
            if timer is not None:
                timer.cancel()

    def _deliver_if_new(self) -> None:
        if self._may_pass():
            self._deliver_newest()

    def _deliver_newest(self) -> None:
        assert self._deliver is not None
        assert self.newest is not None
        self._deliver(self.newest, self._cause)

    def _may_pass(self) -> bool:
        """Whether the newest values are passed on now; if so they count as passed."""
        if self.newest is None or self._deliver is None:
            return False
        passes = self._delivered is None or self.policy.differ(self._delivered, self.newest)
        if passes:
            if self.policy.latest_only and self._outlet.behind() and self._queue.wait():
                return False
            self._delivered = self.newest
            if self.policy.rate is not None:
                self._pause = self._clock.call_later(1.0 / self.policy.rate, self._end_pause)
        self._queue.waits = False
        return passes

    def _end_pause(self) -> None:
        self._pause = None
        if not self._queue.waits:
            self._deliver_if_new()

    def _confirm(self, seconds: float) -> None:
        # One timer looks after any number of messages: a fast sensor costs no more than a slow one.
        self._taken = self._clock.elapsed
        if self._expiry is None:
            self._expiry = self._clock.call_later(seconds, self._look_at_age)

    def _look_at_age(self) -> None:
        assert self.policy.expire is not None
        left = self._taken + self.policy.expire - self._clock.elapsed
        if left > 1e-9:
            self._expiry = self._clock.call_later(left, self._look_at_age)
            return
        self._expiry = None
        self.withdraw()

    def withdraw(self) -> None:
        """What was passed holds no more; the next values are passed whatever they are."""
        self.newest = self._delivered = self._cause = None
        self._outlet.withdraw()


class Queue:
    """The wait of at most one value until the one before has been taken up.

    Args:
        clock: measures the wait.
        look: called again and again while something waits; calls `wait`, or ends the waiting.

    Attributes:
        waits: whether something waits; set to False to end that.
    """

    def __init__(self, clock: Clock, look: Callable[[], None]) -> None:
        self.waits = False
        self._clock, self._look = clock, look
        self._turns = 0
        self._began = 0.0
        self._timer: Timer | None = None
        self._closed = False

    def wait(self) -> bool:
        """Look again soon; False when it has waited long enough."""
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
        """Look no more."""
        self._closed = True
        if self._timer is not None:
            self._timer.cancel()

    def _look_again(self) -> None:
        if not self._closed:
            self._look()


def not_finite(values: Values) -> float | None:
    """The first number of *values* that is NaN or infinite, those in lists too; None when there is none."""
    for value in values:
        if isinstance(value, float):
            if not math.isfinite(value):
                return value
        elif isinstance(value, list | tuple) and (found := not_finite(tuple(value))) is not None:
            return found
    return None
