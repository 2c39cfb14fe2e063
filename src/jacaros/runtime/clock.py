"""Time as a port: the wall clock, and a virtual clock that jumps when all agents wait.

Agents, artifacts and the embedded world take time only from a `Clock`. The virtual clock belongs to an event loop made
by `new_event_loop`. When no callback is ready and no other thread works for the loop, it moves to the next timer instead
of sleeping, so a run is reproducible and as fast as the machine.

A clock can be paused: it stands still and no timer rings. On a virtual clock, pending callbacks of the run are then
held, too, so pausing does not change a run. `of_run` marks them; the loop continues to serve everything else, such as a
page that shows the run.
"""

import asyncio
import contextvars
import selectors
import signal
import sys
import threading
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Coroutine, Iterator, Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from typing import Any, TypeVar

from jacaros.runtime.timers import Timer as Timer
from jacaros.runtime.timers import TimerQueue

VIRTUAL_EPOCH = 1_577_836_800.0
"""2020-01-01 00:00:00 UTC, in seconds since the Unix epoch: the start of every virtual run."""

real_time = time.monotonic
"""Seconds of a monotonic clock, independent of the run's clock: to bound how long something keeps the machine busy."""

T = TypeVar("T")


class Clock(ABC):
    """The one source of time for agents, artifacts and the world.

    Attributes:
        virtual: whether time moves in jumps.
        paused: whether time and timers stand still.
        speed: seconds of this clock per second of real time; 0.0 for a clock that does not follow real time.
        has_speed: whether the speed can be set.
    """

    virtual = False
    paused = False
    speed = 1.0
    has_speed = False

    def __init__(self) -> None:
        self._timers = TimerQueue()

    elapsed: float
    """Seconds since some moment, as `call_later` counts them; never decreases, whatever `now` does."""

    @abstractmethod
    def now(self) -> float:
        """Return seconds since the Unix epoch."""

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* on the loop after *delay* seconds; calls for the same moment keep their order."""
        return self._timers.add(self.elapsed + max(0.0, delay), callback)

    async def sleep(self, delay: float) -> None:
        """Wait for *delay* seconds."""
        done: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        timer = self.call_later(delay, lambda: None if done.done() else done.set_result(None))
        try:
            await done
        finally:
            timer.cancel()

    def busy(self, cycles: int) -> None:  # noqa: B027 - other time moves anyway
        """Report that agents made *cycles* reasoning cycles without becoming idle."""

    @abstractmethod
    def pause(self) -> None:
        """Stop time and timers until `resume`; no effect on a paused clock."""

    @abstractmethod
    def resume(self) -> None:
        """Let time continue: pending timers ring after the rest of their delays."""


_OF_RUN: contextvars.ContextVar[bool] = contextvars.ContextVar("jacaros_of_run", default=False)
"""Whether the running code belongs to a run, and is therefore held while a virtual clock is paused."""


@contextmanager
def of_run(belongs: bool = True) -> Iterator[None]:
    """Mark callbacks and tasks started inside, and those that they start, as parts of a run."""
    token = _OF_RUN.set(belongs)
    try:
        yield
    finally:
        _OF_RUN.reset(token)


def outside_run() -> AbstractContextManager[None]:
    """Mark code started inside as independent of a run: a paused virtual clock does not hold it."""
    return of_run(False)


def run_context() -> contextvars.Context:
    """Return a context in which started code is part of a run."""
    context = contextvars.copy_context()
    context.run(_OF_RUN.set, True)
    return context


class WallClock(Clock):
    """The time of day; delays are measured on the monotonic clock.

    Until it is paused or its speed changes, `now` is exactly the machine's time of day. After that, it continues from
    its last value.

    Args:
        speed: seconds of this clock per second of real time, greater than 0.
    """

    has_speed = True

    def __init__(self, speed: float = 1.0) -> None:
        super().__init__()
        self._speed = 1.0
        self._reached = self._began = 0.0
        """Seconds of this clock, and of the monotonic clock, at the last pause, resumption or change of speed."""
        self._ahead: float | None = None
        """`now` minus `elapsed`; None while `now` is the time of day."""
        self._loop: asyncio.AbstractEventLoop | None = None
        self._alarm: asyncio.TimerHandle | None = None
        self._alarm_at = 0.0
        self._ringing = False
        if speed != 1.0:
            self.speed = speed

    @property
    def elapsed(self) -> float:  # type: ignore[override]  # it cannot be set
        """Seconds of the monotonic clock, as far as this clock followed it."""
        if self.paused:
            return self._reached
        return self._reached + (time.monotonic() - self._began) * self._speed

    @property
    def speed(self) -> float:
        """Seconds of this clock per second of real time."""
        return self._speed

    @speed.setter
    def speed(self, speed: float) -> None:
        if not 0.0 < speed < float("inf"):
            raise ValueError(f"expected a speed greater than 0, found {speed}")
        self._note_day()
        self._note_moment()
        self._speed = speed
        self._set_alarm()

    def pause(self) -> None:
        if not self.paused:
            self._note_day()
            self.pause_timers()

    def pause_timers(self) -> None:
        """Stop timers until `resume`; `now` continues, as messages of real robots carry the time of day."""
        if not self.paused:
            self._note_moment()
            self.paused = True
            self._set_alarm()

    def resume(self) -> None:
        if self.paused:
            self._began = time.monotonic()
            self.paused = False
            self._set_alarm()

    def now(self) -> float:
        return time.time() if self._ahead is None else self._ahead + self.elapsed

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Call *callback* on the running loop after *delay* seconds."""
        loop = asyncio.get_running_loop()
        if loop is not self._loop:
            self._move_to_loop(loop)
        timer = super().call_later(delay, callback)
        if (self._alarm is None or timer.when < self._alarm_at) and not self._ringing:
            self._set_alarm()
        return timer

    def _note_day(self) -> None:
        """From now on, `now` follows this clock instead of the time of day."""
        if self._ahead is None:
            self._ahead = time.time() - self.elapsed

    def _note_moment(self) -> None:
        self._reached, self._began = self.elapsed, time.monotonic()

    def _move_to_loop(self, loop: asyncio.AbstractEventLoop) -> None:
        """Serve another loop; timers of a closed one are dropped."""
        if self._loop is not None and self._loop.is_closed():
            self._timers, self._alarm = TimerQueue(), None
        self._loop = loop

    def _set_alarm(self) -> None:
        """Schedule a call of the loop for the earliest timer."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
        moment = self._timers.first_moment()
        if moment is None or self.paused or self._loop is None or self._loop.is_closed():
            return
        self._alarm_at = moment
        self._alarm = self._loop.call_later(max(0.0, moment - self.elapsed) / self._speed, self._ring)

    def _ring(self) -> None:
        """Ring the timers that are due; those that they set ring in a later pass of the loop."""
        self._alarm = None
        moment = max(self._alarm_at, self.elapsed)  # the loop may be a billionth of a second early
        newest = self._timers.newest
        self._ringing = True
        try:
            while not self.paused and (timer := self._timers.next_due(moment, newest)) is not None:
                timer.ring()
        finally:
            self._ringing = False
            self._set_alarm()


def _ignore(*_: object) -> None:
    """Take the place of a callback that is held, or of a loop that is not there."""


class VirtualClock(Clock):
    """Discrete-event time: it starts at a fixed epoch and jumps to the next timer when all agents wait.

    Attributes:
        paused: whether it is paused: it does not jump, and its loop holds the callbacks of the run.
        when_paused: called with True after a pause begins, and with False after it ends.
    """

    virtual = True
    speed = 0.0
    elapsed = 0.0
    CYCLES_PER_MILLISECOND = 10_000
    """Time moves 1 ms per this number of busy cycles, so a plan that never ends cannot freeze the world."""

    def __init__(self, start: float = VIRTUAL_EPOCH) -> None:
        super().__init__()
        self.start = start
        self._cycles = 0
        self._context = run_context()
        self.when_paused: Callable[[bool], None] = _ignore

    def now(self) -> float:
        return self.start + self.elapsed

    def pause(self) -> None:
        """Stop jumping, and hold the callbacks of the run, until `resume`; no effect on a paused clock."""
        if not self.paused:
            self.paused = True
            self.when_paused(True)

    def resume(self) -> None:
        """Continue exactly where the clock was paused."""
        if self.paused:
            self.paused = False
            self.when_paused(False)

    def busy(self, cycles: int) -> None:
        """Move 1 ms for every 10,000 cycles that agents made without becoming idle.

        The loop calls timers that are due later, never in the middle of the caller's work.
        """
        self._cycles += cycles
        while self._cycles >= self.CYCLES_PER_MILLISECOND:
            self._cycles -= self.CYCLES_PER_MILLISECOND
            self._move_to(self.elapsed + 0.001)

    def advance(self, at_most: float | None = None) -> bool:
        """Jump to the next timer, and ring all timers of that moment; return False without a timer.

        Args:
            at_most: seconds to move if the next timer is further away or does not exist.
        """
        moment = self._timers.first_moment()
        if at_most is not None and (moment is None or moment > self.elapsed + at_most):
            moment = self.elapsed + at_most
        if moment is None:
            return False
        self._cycles = 0
        self._move_to(moment)
        return True

    def pending(self) -> Sequence[Timer]:
        """The pending timers, in no order."""
        return self._timers.pending()

    def _move_to(self, moment: float) -> None:
        while (timer := self._timers.next_due(moment)) is not None:
            self.elapsed = max(self.elapsed, timer.when)
            self._call_soon(timer)
        if moment > self.elapsed:
            self.elapsed = moment

    def _call_soon(self, timer: Timer) -> None:
        """Let the running loop ring a timer, so that its handler gets errors; without a loop, ring it now."""
        try:
            loop = asyncio.get_running_loop()
        except RuntimeError:
            timer.ring()
        else:
            loop.call_soon(timer.ring, context=self._context)


class VirtualSelector(selectors.DefaultSelector):
    """Turns the loop's "sleep until something happens" into a jump of the virtual clock."""

    PATIENCE = 8
    """While the loop is busy, it checks for external events only once per this number of passes."""

    def __init__(self, clock: VirtualClock) -> None:
        super().__init__()
        self.clock = clock
        self.foreign_work = 0
        self.when_stuck: list[Callable[[], bool]] = []
        self._passed = 0
        self.ready: deque[asyncio.Handle] = deque()
        self.held: deque[asyncio.Handle] = deque()
        clock.when_paused = self._hold

    def _hold(self, paused: bool) -> None:
        if not paused:
            self.ready.extend(self.held)
            self.held.clear()
            return
        for place in range(len(self.ready)):  # other threads may append meanwhile
            handle = self.ready[place]
            if _is_of_run(handle):
                self.held.append(handle)
                # The loop has counted the callbacks of this pass: put something in its place.
                self.ready[place] = asyncio.Handle(_ignore, (), asyncio.get_running_loop())

    def hold_run(self) -> None:
        """While the clock is paused, set the ready callbacks of the run aside; the others stay."""
        for _ in range(len(self.ready)):
            handle = self.ready.popleft()
            (self.held if _is_of_run(handle) else self.ready).append(handle)

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if self.clock.paused:
            self.hold_run()
            return super().select(0 if timeout is not None and timeout <= 0 else None)
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
            if timeout is None and [watcher for watcher in self.when_stuck if watcher()]:
                return []
        return super().select(timeout)


def _is_of_run(handle: asyncio.Handle) -> bool:
    context: contextvars.Context = handle._context  # type: ignore[attr-defined]
    return context.get(_OF_RUN, False)


def _work(work: Callable[[], T], done: Future[T]) -> None:
    """Deliver what *work* returns or raises to its future, which may have been cancelled."""
    if not done.set_running_or_notify_cancel():
        return
    try:
        result = work()
    except StopIteration as error:  # which a future of asyncio does not accept
        done.set_exception(RuntimeError(f"the thread raised {error!r}"))
    except BaseException as error:
        done.set_exception(error)
    else:
        done.set_result(result)


def start_thread(work: Callable[[], T], loop: asyncio.AbstractEventLoop | None = None) -> asyncio.Future[T]:
    """Run *work* in a daemon thread, during which a virtual clock continues; return a future with its result.

    At its end, a process waits for the threads of asyncio's own executor, forever if one never returns.

    Raises:
        RuntimeError: the machine has no thread left.
    """
    done: Future[T] = Future()
    loop = loop or asyncio.get_running_loop()
    if getattr(loop, "has_threads", True):
        threading.Thread(target=_work, args=(work, done), name="jacaros work", daemon=True).start()
    else:
        loop.call_soon(_work, work, done)
    return asyncio.wrap_future(done, loop=loop)


class Loop(asyncio.BaseEventLoop):
    """The part of a loop that runs work of ``asyncio.to_thread`` in daemon threads."""

    has_threads = True

    def run_in_executor(  # type: ignore[override]  # the typed signature differs between Python versions
        self, executor: Any, func: Any, *args: Any
    ) -> Any:
        """Run *func* in a thread of *executor*, or in a daemon thread if that is None."""
        if executor is None:
            return start_thread(partial(func, *args), self)
        return super().run_in_executor(executor, func, *args)


class VirtualEventLoop(Loop, asyncio.SelectorEventLoop):
    """An asyncio loop that waits on a virtual clock: ``asyncio.sleep`` and timeouts take no real time."""

    def __init__(self, clock: VirtualClock) -> None:
        self._virtual_clock = clock
        self.virtual_selector = VirtualSelector(clock)
        super().__init__(self.virtual_selector)
        self.virtual_selector.ready = self._ready  # type: ignore[attr-defined]
        self._wakes = sys.platform == "win32" and threading.current_thread() is threading.main_thread()
        if self._wakes:
            # There a signal does not interrupt `select`, and asyncio wakes its Proactor loop only.
            signal.set_wakeup_fd(self._csock.fileno())  # type: ignore[attr-defined]

    def close(self) -> None:
        """Close the loop."""
        if self._wakes:
            self._wakes = False
            signal.set_wakeup_fd(-1)
        super().close()

    def when_stuck(self, watcher: Callable[[], bool]) -> Callable[[], None]:
        """Call *watcher* when everything waits and no timer is left: only an external event could continue the run.

        *watcher* returns True if it has given something work to do. Return a function that ends this.
        """
        watchers = self.virtual_selector.when_stuck
        watchers.append(watcher)
        return lambda: watchers.remove(watcher) if watcher in watchers else None

    def time(self) -> float:
        """Return seconds of virtual time since the beginning."""
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


_UsualLoop: Any = getattr(asyncio, "ProactorEventLoop", asyncio.SelectorEventLoop)  # the former on Windows


class _RealEventLoop(Loop, _UsualLoop):  # type: ignore[misc]
    """The loop of asyncio, with daemon threads."""


def new_event_loop(clock: Clock) -> asyncio.AbstractEventLoop:
    """Make the event loop that goes with *clock*."""
    return VirtualEventLoop(clock) if isinstance(clock, VirtualClock) else _RealEventLoop()


def clock_of(loop: asyncio.AbstractEventLoop) -> Clock:
    """Return the clock of an event loop: the virtual one that `new_event_loop` made it for, or the wall clock."""
    return loop.virtual_selector.clock if isinstance(loop, VirtualEventLoop) else WallClock()


def run(main: Callable[[], Coroutine[Any, Any, T]], clock: Clock) -> T:
    """Run the coroutine function *main* to its end on a new loop of *clock*."""
    with asyncio.Runner(loop_factory=lambda: new_event_loop(clock)) as runner:
        return runner.run(main())
