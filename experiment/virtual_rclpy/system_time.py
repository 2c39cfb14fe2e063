"""The system's time and waits of a program: ``time``, ``datetime`` and ``threading`` follow the run's virtual clock.

Only the program sees the virtual time: code that runs outside of a program's context, such as the event loop and other
threads, continues to see the machine's. So a module that was imported during a run works after it, too.
"""

import datetime
import functools
import queue
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from virtual_rclpy.graph import VirtualGraph, current_or_none


@contextmanager
def virtual_system_time(spins: Callable[[Any], bool]) -> Iterator[None]:
    """Let programs in this context read the virtual clock, and wait on it.

    Args:
        spins: whether a thread with this target only spins nodes; their callbacks run in the program's own thread.
    """
    places: list[tuple[Any, str, Any]] = [
        (time, "time", lambda graph: graph.clock.now()),
        (time, "time_ns", lambda graph: round(graph.clock.now() * 1e9)),
        (time, "sleep", lambda graph, seconds: graph.wait(lambda: False, seconds)),
        (threading.Condition, "wait", _wait),
        (threading.Thread, "start", functools.partial(_start, spins)),
    ]
    for name in ("monotonic", "perf_counter"):
        places.append((time, name, lambda graph: graph.clock.elapsed))
        places.append((time, f"{name}_ns", lambda graph: round(graph.clock.elapsed * 1e9)))
    for module, name in ((threading, "_time"), (queue, "time")):  # how they import time.monotonic
        places.append((module, name, lambda graph: graph.clock.elapsed))
    before = [(place, name, getattr(place, name)) for place, name, _ in places]
    for (place, name, virtual), (_, _, real) in zip(places, before, strict=True):
        setattr(place, name, _either(real, virtual))
    genuine, datetime.datetime = datetime.datetime, _Datetime  # type: ignore[misc]
    try:
        yield
    finally:
        datetime.datetime = genuine  # type: ignore[misc]
        for place, name, real in before:
            setattr(place, name, real)


def _either(real: Callable[..., Any], virtual: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that calls *virtual* with the graph in a program of a run, and *real* elsewhere."""

    @functools.wraps(real)
    def either(*arguments: Any, **named: Any) -> Any:
        graph = current_or_none()
        return real(*arguments, **named) if graph is None else virtual(graph, *arguments, **named)

    return either


def _wait(graph: VirtualGraph, condition: Any, timeout: float | None = None) -> bool:
    """``threading.Condition.wait``, on which events, semaphores, barriers and queues are built."""
    if not condition._is_owned():
        raise RuntimeError("cannot wait on un-acquired lock")
    waiter = threading.Lock()
    waiter.acquire()
    condition._waiters.append(waiter)
    state = condition._release_save()
    notified = False
    try:
        notified = graph.wait(lambda: not waiter.locked(), timeout)
    finally:
        condition._acquire_restore(state)
        if not notified and waiter in condition._waiters:
            condition._waiters.remove(waiter)
    return notified


def _start(spins: Callable[[Any], bool], graph: VirtualGraph, thread: Any) -> None:
    """``threading.Thread.start``, for timers and threads that spin."""
    if isinstance(thread, threading.Timer):
        graph.clock.call_later(thread.interval, lambda: graph.call(_ring, thread))
    elif spins(thread._target):
        graph.spinning = True
    else:
        raise RuntimeError(
            f"thread {thread.name}: on the virtual clock a thread can only spin a node\n"
            "  = help: use a timer of the node, or threading.Timer"
        )


def _ring(timer: threading.Timer) -> None:
    if not timer.finished.is_set():
        timer.function(*timer.args, **timer.kwargs)
        timer.finished.set()


class _AnyDatetime(type):
    def __instancecheck__(cls, value: Any) -> bool:
        return isinstance(value, datetime.date) and hasattr(value, "hour")


class _Datetime(datetime.datetime, metaclass=_AnyDatetime):
    @classmethod
    def now(cls, tz: datetime.tzinfo | None = None) -> Any:
        return cls.fromtimestamp(time.time(), tz)

    @classmethod
    def today(cls) -> Any:
        return cls.now()

    @classmethod
    def utcnow(cls) -> Any:
        return cls.now(datetime.UTC).replace(tzinfo=None)
