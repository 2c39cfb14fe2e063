"""The way between a run and a door that serves it in a thread of its own.

A door has its own loop, so that slow clients, and real time, do not disturb a run, whose clock may be virtual. Requests
cross to the loop of the run through a `Crossing`, events cross back through an `Outbox`.
"""

import asyncio
import threading
import time
from collections import deque
from collections.abc import Awaitable, Callable, Coroutine, Hashable
from concurrent.futures import Future
from contextlib import suppress
from functools import partial
from typing import Any, Generic, TypeVar

from jacaros.serving.callers import RequestError

T = TypeVar("T")
M = TypeVar("M")
SLICE = 0.005
"""Seconds of requests that the loop of the run executes before it gives agents their turns."""
PATIENCE = 30.0
"""Seconds that a request waits for the run, which may be in the middle of a long step."""
MOST_KEPT = 5_000
"""Maximum number of messages that wait for one reader."""


class Lane:
    """Functions that another thread passes to a loop, which executes them in order and in batches.

    Args:
        loop: the loop.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.loop = loop
        self._waiting: deque[Callable[[], object]] = deque()
        self._lock = threading.Lock()
        self._is_scheduled = False

    def post(self, function: Callable[[], object]) -> None:
        """Execute a function on the loop, without waiting for it.

        Raises:
            RequestError: the loop is closed.
        """
        with self._lock:
            self._waiting.append(function)
            if self._is_scheduled:
                return
            self._is_scheduled = True
        try:
            self.loop.call_soon_threadsafe(self._execute)
        except RuntimeError:  # the loop is closed
            raise RequestError("ended", "the run has ended") from None

    def _execute(self) -> None:
        until = time.perf_counter() + SLICE
        while True:
            with self._lock:
                if not self._waiting:
                    self._is_scheduled = False
                    return
                function = self._waiting.popleft()
            try:
                function()
            except BaseException:
                self.loop.call_soon(
                    self._execute
                )  # the loop handles the error; the next function is executed
                raise
            if time.perf_counter() > until:
                self.loop.call_soon(self._execute)
                return


class Reply(Generic[T]):
    """The answer of a run to one request of a door.

    Args:
        back: the way to the door, whose loop runs in this thread.

    Attributes:
        future: the answer, for the door. To cancel it withdraws a request that has not begun.
    """

    def __init__(self, back: Lane) -> None:
        self._back, self._begun = back, threading.Lock()
        self.future: asyncio.Future[T] = back.loop.create_future()
        self._patience = back.loop.call_later(PATIENCE, self._give_up)
        self.future.add_done_callback(self._withdraw)

    def begin(self, request: "Callable[[Reply[T]], object]") -> None:
        """Execute a request, unless the door no longer wants it. Belongs to the loop of the run."""
        if not self._begun.acquire(blocking=False):
            return
        try:
            request(self)
        except Exception as error:
            self.fail(error)

    def give(self, answer: T) -> None:
        """Answer. Belongs to the loop of the run."""
        self._settle(self.future.set_result, answer)

    def fail(self, error: BaseException) -> None:
        """Raise an exception in the door. Belongs to the loop of the run."""
        self._settle(self.future.set_exception, error)

    def _settle(self, settle: Callable[[Any], None], outcome: object) -> None:
        def arrive() -> None:
            if not self.future.done():
                settle(outcome)

        with suppress(RequestError):  # the door is closed
            self._back.post(arrive)

    def _give_up(self) -> None:
        if self._begun.acquire(blocking=False):
            message = f"the run has not responded for {PATIENCE:g} s"
            self.future.set_exception(RequestError("unresponsive", message))

    def _withdraw(self, _: object) -> None:
        self._begun.acquire(blocking=False)
        self._patience.cancel()


class Crossing:
    """Executes requests of a door on the loop of the run.

    Args:
        loop: the loop of the run.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._run = Lane(loop)
        self._door: Lane | None = None
        self.post = self._run.post

    def ask(self, request: Callable[[Reply[T]], object]) -> "asyncio.Future[T]":
        """Call *request* on the loop of the run with what takes the answer, now or later. Return the future answer.

        It ends with a `RequestError` if the run does not respond, or has ended. The request is then not executed.
        """
        if self._door is None:
            self._door = Lane(asyncio.get_running_loop())
        reply = Reply[T](self._door)
        try:
            self.post(partial(reply.begin, request))
        except RequestError as error:
            reply.future.set_exception(error)
        return reply.future

    async def call(self, function: Callable[..., T], *args: Any) -> T:
        """Call a function on the loop of the run. Return its result, or raise its exception."""
        return await self.ask(lambda reply: reply.give(function(*args)))

    async def wait(self, function: Callable[..., Coroutine[Any, Any, T]], *args: Any) -> T:
        """Await a coroutine function on the loop of the run. Return its result, or raise its exception."""
        tasks: list[asyncio.Task[T]] = []

        def start(reply: Reply[T]) -> None:
            tasks.append(self._run.loop.create_task(function(*args)))
            tasks[0].add_done_callback(partial(_pass_on, reply))

        try:
            return await self.ask(start)
        except asyncio.CancelledError:
            with suppress(RequestError):  # the run has ended
                self.post(lambda: [each.cancel() for each in tasks])
            raise


def _pass_on(reply: Reply[T], task: "asyncio.Task[T]") -> None:
    if task.cancelled():
        reply.fail(RequestError("ended", "the run has ended"))
    elif (error := task.exception()) is not None:
        reply.fail(error)
    else:
        reply.give(task.result())


class Lagging(Exception):
    """Raised for a reader that has left more than `MOST_KEPT` messages unread."""


class Outbox(Generic[M]):
    """Messages for one reader, in order. Any thread may add messages; memory is bounded.

    Args:
        loop: the loop of the reader, which runs in this thread.
        most: maximum number of messages.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, most: int = MOST_KEPT) -> None:
        self._loop, self._most, self._thread = loop, most, threading.get_ident()
        self._messages: dict[Hashable, M] = {}
        self._number = 0
        self._lock = threading.Lock()
        self._arrived = asyncio.Event()
        self._lags = False

    def put(self, message: M, subject: Hashable = None) -> None:
        """Add a message. Of unread messages with the same subject, only the newest is kept."""
        with self._lock:
            if self._lags:
                return
            is_first = not self._messages
            self._number += 1
            key = self._number if subject is None else subject
            self._messages.pop(key, None)
            self._messages[key] = message
            if len(self._messages) > self._most:
                self._lags = True
                self._messages.clear()
        if not is_first:
            return
        if threading.get_ident() == self._thread:
            self._arrived.set()
        elif not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._arrived.set)

    async def take(self) -> list[M]:
        """Wait for messages. Return all unread ones.

        Raises:
            Lagging: there were too many; the reader must be disconnected.
        """
        await self._arrived.wait()
        with self._lock:
            self._arrived.clear()
            if self._lags:
                raise Lagging
            found = list(self._messages.values())
            self._messages.clear()
        return found


Main = Callable[[Crossing], Awaitable[None]]
"""What a door does on its loop, until it is cancelled."""


class DoorThread:
    """A thread with a loop of its own.

    Args:
        name: name of the thread.
        main: what it does.
        failed: called in the thread with the exception that ended *main*.
    """

    def __init__(self, name: str, main: Main, failed: Callable[[Exception], object]) -> None:
        self._main, self._failed = main, failed
        self._crossing = Crossing(asyncio.get_running_loop())
        self._ended: Future[None] = Future()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task[Any] | None = None
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._stops = threading.Event()
        self._thread.start()

    async def close(self) -> None:
        """Cancel what it does, and wait for its end."""
        self._stops.set()
        if self._loop is not None and self._task is not None and not self._ended.done():
            with suppress(RuntimeError):  # it has just ended
                self._loop.call_soon_threadsafe(self._task.cancel)
        await asyncio.wrap_future(self._ended)

    def _run(self) -> None:
        try:
            asyncio.run(self._serve())
        except asyncio.CancelledError:
            pass
        except Exception as error:
            self._failed(error)
        finally:
            self._ended.set_result(None)

    async def _serve(self) -> None:
        self._loop, self._task = asyncio.get_running_loop(), asyncio.current_task()
        if self._stops.is_set():
            return
        await self._main(self._crossing)
