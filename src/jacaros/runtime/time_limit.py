"""A limit for code that no other limit stops, such as the unification of terms of exponential size."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, TypeVar

from jacaros.runtime.clock import real_time

T = TypeVar("T")


class TimeIsUp(BaseException):
    """Raised inside `time_limit`. Not an `Exception`, so that the code inside does not handle it."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise `TimeIsUp` in the code inside at its first call or return after *seconds*.

    The check is a profile function of the calling thread: it needs no other thread and no signal, and works on every
    system. A single call into C, such as the concatenation of two strings, is not interrupted.
    """
    until, before, hook = real_time() + seconds, sys.getprofile(), sys.unraisablehook

    def check(frame: FrameType, _event: str, _argument: object) -> None:
        if real_time() > until and frame.f_code is not go_on.__code__:
            raise TimeIsUp  # and the interpreter drops the profile function

    def go_on(ignored: "sys.UnraisableHookArgs") -> None:
        # Where an object goes, such as a generator, the interpreter ignores the exception. Raise it again after that.
        if ignored.exc_type is TimeIsUp:
            sys.setprofile(check)
        else:
            hook(ignored)

    try:
        sys.unraisablehook = go_on
        sys.setprofile(check)
        yield
    finally:
        _restore(before)
        sys.unraisablehook = hook


def _restore(profiler: Any) -> None:
    """Let a profile function, or a profiler in C such as `cProfile`, continue."""
    if profiler is None or callable(profiler):
        sys.setprofile(profiler)
    else:
        profiler.enable()


def within(seconds: float, compute: Callable[[], T]) -> T | None:
    """Return the result of *compute*; None if it takes longer than *seconds*."""
    try:
        with time_limit(seconds):
            return compute()
    except TimeIsUp:
        return None
