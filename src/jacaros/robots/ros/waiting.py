"""Logged waiting: the start, a message with help after a few seconds, and the end."""

import asyncio
import concurrent.futures
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.files.texts import is_worth_a_line

T = TypeVar("T")

MISSING_AFTER = 3.0
"""Seconds after which an awaited thing is reported as missing. First discovery on ROS 2 can take two."""
RETRY = 0.1
"""Seconds between two attempts to call a missing service."""


class WaitLog:
    """Logs waits for one thing: the start, a message with help after a few seconds, and the end.

    Of waits one after another in which it was not found, the 1st, 10th, 100th, … is logged.

    Args:
        clock: measures the waits.
        log: called with one line.
        what: the thing, as in ``service /add (example_interfaces/srv/AddTwoInts)``.
        help: what the user can do about it.
        quiet: seconds without a message: for repeated waits that usually end soon.
    """

    def __init__(
        self,
        clock: Clock,
        log: Callable[[str], None],
        what: str,
        help: str = "is the node that offers it running?",
        quiet: float = 0.0,
    ) -> None:
        self.clock = clock
        self.what = what
        self._log = log
        self._help = help
        self._quiet = quiet
        self._reported = False
        self._waits = 0

    def begin(self) -> Callable[[bool], None]:
        """Begin a wait. Return a function that ends it; it takes whether the thing was found."""
        self._waits += 1
        timer: Timer | None = None

        def report() -> None:
            nonlocal timer
            self._reported = True
            self._log(f"waiting for the {self.what}")
            timer = self.clock.call_later(MISSING_AFTER, self._missing)

        def end(found: bool) -> None:
            if timer is not None:
                timer.cancel()
            if found:
                self.found()

        if is_worth_a_line(self._waits):
            if self._quiet > 0.0:
                timer = self.clock.call_later(self._quiet, report)
            else:
                report()
        return end

    @contextmanager
    def during(self) -> Iterator[None]:
        """Wrap one wait, which fails with an exception."""
        found, end = False, self.begin()
        try:
            yield
            found = True
        finally:
            end(found)

    def found(self) -> None:
        """Log that the thing was found, if a wait was logged; the next wait is the first again."""
        if self._reported:
            self._log(f"found the {self.what}")
        self._reported, self._waits = False, 0

    def _missing(self) -> None:
        self._log(f"the {self.what} is missing; still trying; {self._help}")


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


def settle(
    future: asyncio.Future[Any] | concurrent.futures.Future[Any], response: Any, problem: BaseException | None
) -> None:
    """Set the response or failure of a call, unless it has ended: timed out or cancelled."""
    if future.done():
        return
    if problem is not None:
        future.set_exception(problem)
    else:
        future.set_result(response)
