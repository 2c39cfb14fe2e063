"""Time as a port: the wall clock, and a virtual clock that jumps when everybody waits.

Agents, artifacts and the embedded world take time from a `Clock` alone.  The virtual clock belongs to an
event loop made by `new_event_loop`: when no callback is ready and no other thread is at work for the loop,
it moves to the next timer instead of sleeping, so a run is exactly repeatable and as fast as the machine.
"""

import asyncio
import heapq
import itertools
import selectors
import threading
import time
from collections import deque
from collections.abc import Callable, Coroutine, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any, Protocol, TypeVar

VIRTUAL_EPOCH = 1_577_836_800.0
"""2020-01-01 00:00:00 UTC, in seconds since the Unix epoch: where every virtual run begins."""

real_time = time.monotonic
"""Seconds of a steady clock, whatever the clock of a run says: to bound how long something keeps the machine busy."""

T = TypeVar("T")


class Timer(Protocol):
    """A call that is to come; it can be taken back."""

    def cancel(self) -> None:
        """Take the call back; nothing happens when it is past."""


class Clock(Protocol):
    """Where everybody takes the time from."""

    @property
    def virtual(self) -> bool:
        """True when time moves in jumps."""

    @property
    def elapsed(self) -> float:
        """Seconds from some moment on, as `call_later` counts them: they never go back, whatever `now` does."""

    def now(self) -> float:
        """Seconds since the Unix epoch."""

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* on the loop after *delay* seconds; equal moments keep their order."""

    async def sleep(self, delay: float) -> None:
        """Wait for *delay* seconds."""

    def busy(self, cycles: int) -> None:
        """Be told that agents made *cycles* reasoning cycles without getting idle."""


class WallClock:
    """The time of day, as the machine tells it; delays are measured on the monotonic clock."""

    virtual = False

    @property
    def elapsed(self) -> float:
        """Seconds on the monotonic clock: nobody sets it."""
        return time.monotonic()

    def now(self) -> float:
        """Seconds since the Unix epoch."""
        return time.time()

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* on the running loop after *delay* seconds."""
        return asyncio.get_running_loop().call_later(delay, callback)

    async def sleep(self, delay: float) -> None:
        """Wait for *delay* seconds."""
        await asyncio.sleep(max(0.0, delay))

    def busy(self, cycles: int) -> None:
        """Nothing: the wall clock moves by itself."""


class _VirtualTimer:
    __slots__ = ("callback", "cancelled", "number", "when")

    def __init__(self, when: float, number: int, callback: Callable[[], None]) -> None:
        self.when, self.number, self.cancelled = when, number, False
        self.callback: Callable[[], None] | None = callback

    def __lt__(self, other: "_VirtualTimer") -> bool:
        return (self.when, self.number) < (other.when, other.number)

    def cancel(self) -> None:
        self.cancelled = True
        self.callback = None  # what it holds may be large, and the moment far

    def ring(self) -> None:
        callback, self.callback = self.callback, None
        if callback is not None:
            callback()


class VirtualClock:
    """Discrete-event time: it starts at a fixed epoch and jumps to the next timer when all wait."""

    virtual = True
    CYCLES_PER_MILLISECOND = 10_000
    """An endless plan moves time too: 1 ms for so many busy cycles, so it cannot freeze the world."""

    def __init__(self, start: float = VIRTUAL_EPOCH) -> None:
        self.start = start
        self.elapsed = 0.0
        self._timers: list[_VirtualTimer] = []
        self._numbers = itertools.count()
        self._cycles = 0

    def now(self) -> float:
        """Seconds since the Unix epoch."""
        return self.start + self.elapsed

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* after *delay* seconds of virtual time."""
        timer = _VirtualTimer(self.elapsed + max(0.0, delay), next(self._numbers), callback)
        heapq.heappush(self._timers, timer)
        return timer

    async def sleep(self, delay: float) -> None:
        """Wait for *delay* seconds of virtual time."""
        done: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        timer = self.call_later(delay, partial(_wake, done))
        try:
            await done
        finally:
            timer.cancel()

    def busy(self, cycles: int) -> None:
        """Move 1 ms on for every 10,000 cycles that agents made without getting idle.

        What is due then is called by the loop later, never in the middle of the caller's work.
        """
        self._cycles += cycles
        while self._cycles >= self.CYCLES_PER_MILLISECOND:
            self._cycles -= self.CYCLES_PER_MILLISECOND
            self._move_to(self.elapsed + 0.001)

    def advance(self, at_most: float | None = None) -> bool:
        """Jump to the next timer, with it ring all of that moment; False when there is none.

        Args:
            at_most: seconds to move if the next timer is further away, or if there is none.
        """
        timers = self._timers
        while timers and timers[0].cancelled:
            heapq.heappop(timers)
        moment = timers[0].when if timers else None
        if at_most is not None and (moment is None or moment > self.elapsed + at_most):
            moment = self.elapsed + at_most
        if moment is None:
            return False
        self._cycles = 0
        self._move_to(moment)
        return True

    def pending(self) -> Sequence[Timer]:
        """The timers that are still to ring, in no order."""
        return [timer for timer in self._timers if not timer.cancelled]

    def _move_to(self, moment: float) -> None:
        timers = self._timers
        while timers and timers[0].when <= moment:
            timer = heapq.heappop(timers)
            if not timer.cancelled:
                if timer.when > self.elapsed:
                    self.elapsed = timer.when
                _call_soon(timer.ring)
        if moment > self.elapsed:
            self.elapsed = moment


def _wake(sleeper: asyncio.Future[None]) -> None:
    if not sleeper.done():
        sleeper.set_result(None)


def _call_soon(callback: Callable[[], None]) -> None:
    """Let the running loop call *callback*, so that errors reach its handler; without a loop call it now."""
    try:
        loop = asyncio.get_running_loop()
    except RuntimeError:
        callback()
    else:
        loop.call_soon(callback)


class _VirtualSelector(selectors.DefaultSelector):
    """Lets the loop's "sleep until something happens" become a jump of the virtual clock."""

    PATIENCE = 8
    """As long as the loop has other things to do, it is only this often that it looks for something from outside."""

    def __init__(self, clock: VirtualClock) -> None:
        super().__init__()
        self.clock = clock
        self.foreign_work = 0
        self.when_stuck: list[Callable[[], bool]] = []
        self._passed = 0

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if timeout is not None and timeout <= 0:
            self._passed += 1
            if self._passed < self.PATIENCE:
                return []
            self._passed = 0
            return super().select(0)
        events = super().select(0)
        if events:
            return events
        if not self.foreign_work:
            if self.clock.advance(timeout):
                return []
            if timeout is None and [told for told in self.when_stuck if told()]:
                return []
        return super().select(timeout)


def start_thread(work: Callable[[], T]) -> asyncio.Future[T]:
    """Run *work* in a daemon thread; the future has its result, or what it raised.

    The end of the process waits for the threads of asyncio's own executor, for ever if one never returns.
    """
    loop = asyncio.get_running_loop()
    future: asyncio.Future[T] = loop.create_future()

    def bring(deliver: Callable[[], None]) -> None:
        if not future.done():
            deliver()

    def run_work() -> None:
        deliver: Callable[[], None]
        try:
            deliver = partial(future.set_result, work())
        except StopIteration as error:  # which no future takes
            deliver = partial(future.set_exception, RuntimeError(f"the thread raised {error!r}"))
        except BaseException as error:
            deliver = partial(future.set_exception, error)
        with suppress(RuntimeError):  # the loop has been closed
            loop.call_soon_threadsafe(bring, deliver)

    threading.Thread(target=run_work, name="jacaros work", daemon=True).start()
    return future


class _DaemonThreads(asyncio.BaseEventLoop):
    """The part of a loop that runs work of ``asyncio.to_thread`` in daemon threads."""

    THREADS = 32
    """Threads at a time, as asyncio has at most."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._threads = 0
        self._queued: deque[tuple[asyncio.Future[Any], Callable[[], Any]]] = deque()

    def run_in_executor(  # type: ignore[override]  # the typed signature differs between Python versions
        self, executor: Any, func: Any, *args: Any
    ) -> Any:
        """Run *func* in a thread of *executor*, or in a daemon thread if that is None."""
        if executor is not None:
            return super().run_in_executor(executor, func, *args)
        future = self.create_future()
        self._queued.append((future, partial(func, *args)))
        self._start_threads()
        return future

    def _start_threads(self) -> None:
        while self._queued and self._threads < self.THREADS:
            future, work = self._queued.popleft()
            if not future.done():
                self._threads += 1
                start_thread(work).add_done_callback(partial(self._thread_done, future))

    def _thread_done(self, future: asyncio.Future[Any], done: asyncio.Future[Any]) -> None:
        self._threads -= 1
        error = done.exception()
        if not future.done():
            if error is not None:
                future.set_exception(error)
            else:
                future.set_result(done.result())
        self._start_threads()


class VirtualEventLoop(_DaemonThreads, asyncio.SelectorEventLoop):
    """An asyncio loop whose waiting is done on a virtual clock: ``asyncio.sleep`` and time-outs take no real time."""

    def __init__(self, clock: VirtualClock) -> None:
        self._virtual_clock = clock
        self.virtual_selector = _VirtualSelector(clock)
        super().__init__(self.virtual_selector)

    def when_stuck(self, told: Callable[[], bool]) -> Callable[[], None]:
        """Call *told* when everybody waits and no timer is left: only something from outside could go on then.

        It gives True when it has given somebody something to do.  Gives what ends that.
        """
        watchers = self.virtual_selector.when_stuck
        watchers.append(told)
        return lambda: watchers.remove(told) if told in watchers else None

    def time(self) -> float:
        """Seconds of virtual time since the beginning."""
        return self._virtual_clock.elapsed

    def run_in_executor(  # type: ignore[override]  # the typed signature differs between Python versions
        self, executor: Any, func: Any, *args: Any
    ) -> Any:
        """Run *func* in a thread; virtual time stands still until it is done."""
        self.virtual_selector.foreign_work += 1
        future = super().run_in_executor(executor, func, *args)
        future.add_done_callback(lambda _: self._foreign_work_done())
        return future

    def _foreign_work_done(self) -> None:
        self.virtual_selector.foreign_work -= 1


_Loop: Any = getattr(asyncio, "ProactorEventLoop", asyncio.SelectorEventLoop)  # the former on Windows


class _RealEventLoop(_DaemonThreads, _Loop):  # type: ignore[misc]
    """The loop of asyncio, with daemon threads."""


@contextmanager
def standing_still(loop: asyncio.AbstractEventLoop) -> Iterator[None]:
    """Let virtual time stand still while another thread works for *loop*; the wall clock goes on."""
    selector = loop.virtual_selector if isinstance(loop, VirtualEventLoop) else None
    if selector is not None:
        selector.foreign_work += 1
    try:
        yield
    finally:
        if selector is not None:
            selector.foreign_work -= 1


def new_event_loop(clock: Clock) -> asyncio.AbstractEventLoop:
    """Make the event loop that goes with *clock*."""
    return VirtualEventLoop(clock) if isinstance(clock, VirtualClock) else _RealEventLoop()


def clock_of(loop: asyncio.AbstractEventLoop) -> Clock:
    """The clock of an event loop: the virtual one that `new_event_loop` made it for, or the wall clock."""
    return loop.virtual_selector.clock if isinstance(loop, VirtualEventLoop) else WallClock()


def run(main: Callable[[], Coroutine[Any, Any, T]], clock: Clock) -> T:
    """Run the coroutine function *main* to its end on a fresh loop of *clock*."""
    with asyncio.Runner(loop_factory=lambda: new_event_loop(clock)) as runner:
        return runner.run(main())
