"""The only place where another thread passes work to the loop, and the loop passes work to another thread."""

import asyncio
import concurrent.futures
import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any, Generic, TypeVar

from jacaros.robots.ros.waiting import settle

T = TypeVar("T")


class Handoff(Generic[T]):
    """A bounded queue from a client library's threads to the loop.

    However fast the sender is, at most *depth* items wait and one wake-up of the loop is pending, so a burst can
    neither fill the memory nor starve the agents. The oldest item is dropped first.

    Args:
        loop: the loop on which *deliver* is called.
        depth: maximum number of waiting items.
        deliver: called with one item, on the loop.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, depth: int, deliver: Callable[[T], None]) -> None:
        self._loop = loop
        self._deliver = deliver
        self._waiting: deque[T] = deque(maxlen=depth)
        self._lock = threading.Lock()
        self._woken = False
        self._closed = False

    def put(self, item: T) -> None:
        """Queue *item*; callable from any other thread."""
        with self._lock:
            if self._closed:
                return
            self._waiting.append(item)
            if self._woken:
                return
            self._woken = True
        if not post(self._loop, self._deliver_next):
            self.close()

    def put_here(self, *items: T) -> None:
        """Deliver *items*, which reached the loop together, the oldest first: one now if none is waiting, the others
        in turn."""
        with self._lock:
            if self._closed or not items:
                return
            self._waiting.extend(items)
            if self._woken:
                return
            # This turn is used: later items wait for the next one.
            self._woken = True
            item = self._waiting.popleft()
        self._loop.call_soon(self._deliver_next)
        self._deliver(item)

    def close(self) -> None:
        """Discard waiting items and accept no others."""
        with self._lock:
            self._closed = True
            self._waiting.clear()

    def deliver_all(self) -> None:
        """Deliver all waiting items now, on the loop: the caller has something that must not overtake them."""
        with self._lock:
            waiting = list(self._waiting)
            self._waiting.clear()
        for item in waiting:
            self._deliver(item)

    def _deliver_next(self) -> None:
        # One item per turn of the loop: other callbacks run between two messages of a burst.
        with self._lock:
            if not self._waiting:
                self._woken = False
                return
            item = self._waiting.popleft()
            self._woken = bool(self._waiting)
            again = self._woken
        if again:
            self._loop.call_soon(self._deliver_next)
        self._deliver(item)


def post(loop: asyncio.AbstractEventLoop, callback: Callable[..., object], *arguments: Any) -> bool:
    """Call *callback* on *loop*, from any thread. Return False if the loop has ended."""
    try:
        loop.call_soon_threadsafe(callback, *arguments)
    except RuntimeError:  # the loop is closed: the process is ending
        return False
    return True


class LoopEnded(Exception):
    """Raised when the loop ended before it answered."""


def ask(
    loop: asyncio.AbstractEventLoop,
    question: Callable[[Callable[[T | None, Exception | None], None]], None],
    ending: Callable[[], bool],
) -> T:
    """Call *question* on *loop*, and wait in this other thread for what it passes to its argument.

    Args:
        loop: the loop.
        question: takes a function to call with the answer, or with the exception.
        ending: returns whether to stop waiting.

    Raises:
        LoopEnded: no answer can arrive.
        Exception: the exception that was passed.
    """
    answer: concurrent.futures.Future[Any] = concurrent.futures.Future()
    alive = post(loop, question, partial(settle, answer))
    while alive:
        # Not `result(timeout)`, because the passed exception may be a TimeoutError itself.
        if concurrent.futures.wait([answer], timeout=0.2).done:
            result: T = answer.result()
            return result
        alive = not loop.is_closed() and not ending()
    raise LoopEnded


def in_thread(loop: asyncio.AbstractEventLoop, work: Callable[[], T], name: str) -> asyncio.Future[T]:
    """Run blocking *work* in a daemon thread of its own; the future gets its result or exception.

    A thread pool would do for work that ends. But calls into a middleware may block forever, and must neither exhaust
    a pool nor keep the process from ending.
    """
    future: asyncio.Future[T] = loop.create_future()

    def body() -> None:
        try:
            result = work()
        except BaseException as problem:
            post(loop, settle, future, None, problem)
        else:
            post(loop, settle, future, result, None)

    threading.Thread(target=body, name=name, daemon=True).start()
    return future
