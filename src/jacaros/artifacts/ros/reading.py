"""Readings: which of a sensor's messages become property updates (thesis, section 6.3).

Four policies keep a sensor from flooding the minds that watch it: equal values are dropped, a dead band
drops small changes, a rate limit spreads out what is left, and on demand nothing is passed until asked for.
"""

import asyncio
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from jacaros.artifacts.ros.options import Reader, bands, one_of, positive
from jacaros.clock import Clock, Timer
from jacaros.ros.waiting import within
from jacaros.trace import Cause

Values = tuple[object, ...]

READING_OPTIONS: dict[str, Reader] = {
    "mode": one_of("verbose", "on_demand"),
    "rate": positive,
    "dead_band": bands,
}
"""Options of artifacts that read sensors: ``mode(on_demand)``, ``rate(Hz)``, ``dead_band(D)``."""


@dataclass(frozen=True, slots=True)
class ReadingPolicy:
    """When values are passed on.

    Attributes:
        on_demand: never by themselves, only by `Reading.refresh`.
        rate: at most so many times a second; None: no limit.
        dead_band: a value is passed when some number field differs by more than this from the one passed
            before; one figure for all fields or one for each. 0 drops equal values only.
    """

    on_demand: bool = False
    rate: float | None = None
    dead_band: float | tuple[float, ...] = 0.0

    @classmethod
    def from_options(cls, options: Mapping[str, object], on_demand: bool = False) -> "ReadingPolicy":
        """Make the policy that `READING_OPTIONS` ask for; *on_demand* is the mode when they say nothing."""
        mode = options.get("mode", "on_demand" if on_demand else "verbose")
        rate, band = options.get("rate"), options.get("dead_band", 0.0)
        assert rate is None or isinstance(rate, float)
        assert isinstance(band, float | tuple)
        return cls(mode == "on_demand", rate, band)

    def differ(self, old: Values, new: Values) -> bool:
        """Whether *new* is worth passing after *old*."""
        if old == new:
            return False
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


class Reading:
    """The newest values of one sensor, and the decision when to pass them on.

    The first message always passes.  Under a rate limit the newest value of a pause is passed when the
    pause is over: the last message of a burst is late at most, never lost.

    Args:
        policy: when to pass values on.
        clock: the time for the rate limit.
        deliver: takes the values that are passed, and the cause that led to them.
    """

    def __init__(
        self, policy: ReadingPolicy, clock: Clock, deliver: Callable[[Values, Cause | None], None]
    ) -> None:
        self.policy = policy
        self.newest: Values | None = None
        self._clock = clock
        self._deliver = deliver
        self._delivered: Values | None = None
        self._cause: Cause | None = None
        self._pause: Timer | None = None
        self._expecting: list[asyncio.Future[None]] = []

    def take(self, values: Values, cause: Cause | None = None) -> None:
        """Take a message's values, and pass them on now, later or never."""
        self.newest, self._cause = values, cause
        for expected in self._expecting:
            if not expected.done():
                expected.set_result(None)
        if not self.policy.on_demand and self._pause is None:
            self._deliver_if_new()

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
        if self._pause is not None:
            self._pause.cancel()

    def _deliver_if_new(self) -> None:
        if self.newest is None:
            return
        if self._delivered is None or self.policy.differ(self._delivered, self.newest):
            self._delivered = self.newest
            self._begin_pause()
            self._deliver(self.newest, self._cause)

    def _begin_pause(self) -> None:
        if self.policy.rate is not None:
            self._pause = self._clock.call_later(1.0 / self.policy.rate, self._end_pause)

    def _end_pause(self) -> None:
        self._pause = None
        self._deliver_if_new()
