"""Logged waiting: the start, a message with help after a few seconds, and the end."""

import asyncio
import math
from collections.abc import Callable
from types import TracebackType
from typing import Any, TypeVar

from jacaros.files.texts import is_worth_a_line
from jacaros.runtime.clock import Clock, Timer

T = TypeVar("T")

MISSING_AFTER = 3.0
"""Seconds after which an awaited thing is reported as missing. First discovery on ROS 2 can take two."""
RETRY = 0.1
"""Seconds between two attempts to call a missing service."""


class Absence:
    """Repeated waits for one thing that timed out: the 1st, 10th, 100th, … is logged."""

    def __init__(self) -> None:
        self._reported = False
        self._waits = 0

    def wait(self) -> bool:
        """Count a wait. Return whether to log it."""
        self._waits += 1
        return is_worth_a_line(self._waits)

    def report(self, log: Callable[[str], None], what: str) -> None:
        """Log that it is awaited."""
        self._reported = True
        log(f"waiting for the {what}")

    def end(self, log: Callable[[str], None], what: str) -> None:
        """Log that it was found, if the wait was logged; the next wait is the first again."""
        if self._reported:
            log(f"found the {what}")
        self._reported, self._waits = False, 0


class Waiting:
    """Logs the wait for something that is missing; a context manager around the wait.

    Args:
        clock: measures the wait.
        log: called with one line.
        what: the thing, as in ``service /add (example_interfaces/srv/AddTwoInts)``.
        help: what the user can do about it.
        quiet: seconds without a message: for repeated waits that usually end soon.
        absence: earlier waits that timed out.
    """

    def __init__(
        self,
        clock: Clock,
        log: Callable[[str], None],
        what: str,
        help: str,
        quiet: float = 0.0,
        absence: Absence | None = None,
    ) -> None:
        self._clock = clock
        self._log = log
        self._what = what
        self._help = help
        self._quiet = quiet
        self._absence = absence if absence is not None else Absence()
        self._timer: Timer | None = None

    def __enter__(self) -> "Waiting":
        if not self._absence.wait():
            return self
        if self._quiet > 0.0:
            self._timer = self._clock.call_later(self._quiet, self._report)
        else:
            self._report()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._timer is not None:
            self._timer.cancel()
        if kind is None:
            self._absence.end(self._log, self._what)

    def _report(self) -> None:
        self._absence.report(self._log, self._what)
        self._timer = self._clock.call_later(MISSING_AFTER, self._missing)

    def _missing(self) -> None:
        self._log(f"the {self._what} is missing; still trying; {self._help}")


class Deadline:
    """The end of a wait.

    Args:
        clock: measures the time.
        timeout: seconds from now; None: no limit.
    """

    def __init__(self, clock: Clock, timeout: float | None) -> None:
        self.timeout = timeout
        self._clock = clock
        self._end = math.inf if timeout is None else clock.elapsed + timeout

    @property
    def left(self) -> float | None:
        """The remaining seconds; None: no limit."""
        return None if self.timeout is None else self._end - self._clock.elapsed

    def comes_within(self, seconds: float) -> bool:
        """Return whether the wait ends in less than *seconds*."""
        return self._clock.elapsed + seconds > self._end

    def postpone(self, seconds: float) -> None:
        """Do not count *seconds* of the wait."""
        self._end += seconds


async def within(clock: Clock, future: asyncio.Future[T], seconds: float | None) -> T:
    """Wait for *future*, at most *seconds* of the clock; None: no limit.

    Raises:
        TimeoutError: the time is over; the future fails with it, too.
    """

    def expire() -> None:
        if not future.done():
            future.set_exception(TimeoutError())

    timer = None if seconds is None else clock.call_later(max(0.0, seconds), expire)
    try:
        return await future
    finally:
        if timer is not None:
            timer.cancel()


def settle(future: asyncio.Future[Any], response: Any, problem: Exception | None) -> None:
    """Set the response or failure of a call, unless it has ended: timed out or cancelled."""
    if future.done():
        return
    if problem is not None:
        future.set_exception(problem)
    else:
        future.set_result(response)
