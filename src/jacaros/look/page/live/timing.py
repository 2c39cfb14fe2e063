"""Real time for pages of a run on any clock: a beat, and the budget of each page."""

import asyncio
import threading
import time
from collections.abc import Callable, Coroutine, Generator
from types import coroutine
from typing import Any, TypeVar

from jacaros.runtime.clock import real_time

PERIOD = 1 / 30
"""Seconds between two beats."""


class Beat:
    """Wakes the waiting tasks of the running loop 30 times per second of real time.

    A thread wakes them like an external message, which does not advance a virtual clock. There, timers of the
    loop would fire as soon as all agents wait.
    """

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._waiting: list[asyncio.Future[None]] = []
        self._wanted = threading.Event()
        self._closed = False
        self._thread: threading.Thread | None = None

    async def next(self) -> None:
        """Wait for the next beat."""
        future: asyncio.Future[None] = self._loop.create_future()
        self._waiting.append(future)
        self._wanted.set()
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="jacaros beat", daemon=True)
            self._thread.start()
        await future

    def close(self) -> None:
        """End the thread, and wake all waiters."""
        self._closed = True
        self._wanted.set()
        self._ring()

    def _run(self) -> None:
        while not self._closed:
            self._wanted.wait()
            time.sleep(PERIOD)
            try:
                self._loop.call_soon_threadsafe(self._ring)
            except RuntimeError:  # the loop is closed
                return

    def _ring(self) -> None:
        waiting, self._waiting = self._waiting, []
        if not self._closed:
            self._wanted.clear()
        for future in waiting:
            if not future.done():
                future.set_result(None)


SHARE = 0.05
"""Share of the loop's time for the commands of all pages together."""
AHEAD = 1.0
"""Seconds that a page may be ahead of its share: single commands, and several at once, are executed immediately."""

T = TypeVar("T")


class Allowances:
    """Divides the share among the pages."""

    def __init__(self) -> None:
        self._pages = 0
        self._inherited = 0.0

    def begin(self) -> "Allowance":
        """Return the budget of another page. It takes over debts of former pages: reconnecting gains nothing."""
        self._pages += 1
        return Allowance(self, self._inherited)

    def end(self, allowance: "Allowance") -> None:
        """A page has gone."""
        self._pages -= 1
        self._inherited = max(self._inherited, allowance.paid_at)

    def wait_for(self, seconds: float) -> float:
        """Return after how many seconds that time of the loop is earned again."""
        return seconds * self._pages / SHARE


class Allowance:
    """The budget of one page.

    Attributes:
        paid_at: real time at which the share covers everything that the page has used.
    """

    def __init__(self, all_pages: Allowances, paid_at: float) -> None:
        self._all, self.paid_at = all_pages, paid_at

    @property
    def is_used_up(self) -> bool:
        """Whether the next command has to wait."""
        return self.paid_at > real_time() + AHEAD

    def spend(self, seconds: float) -> None:
        """Note time that the page has used."""
        self.paid_at = max(self.paid_at, real_time()) + self._all.wait_for(seconds)


@coroutine
def metered(work: Coroutine[Any, Any, T], spend: Callable[[float], object]) -> Generator[Any, Any, T]:
    """Run a coroutine, and pass the time that each of its turns on the loop takes to *spend*."""
    turn: Callable[[Any], Any] = work.send
    given: Any = None
    while True:
        begun = real_time()
        try:
            waiting = turn(given)
        except StopIteration as end:
            result: T = end.value
            return result
        finally:
            spend(real_time() - begun)
        try:
            turn, given = work.send, (yield waiting)
        except BaseException as error:  # such as a cancellation
            turn, given = work.throw, error
