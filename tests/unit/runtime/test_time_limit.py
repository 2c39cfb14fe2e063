"""The time limit of a computation, on a clock of the test."""

from collections.abc import Callable, Iterator
from cProfile import Profile
from weakref import ref

import pytest

from jacaros.runtime import time_limit
from jacaros.runtime.time_limit import within


class Thing:
    """Something that can go."""


class Noisy:
    """Something that calls functions when it goes."""

    def __del__(self) -> None:
        len(repr(self))


def generator() -> Iterator[int]:
    """Return something that calls functions when it goes."""

    def numbers() -> Iterator[int]:
        try:
            yield 1
        finally:
            len("")

    made = numbers()
    next(made)
    return made


@pytest.mark.parametrize("make", [Thing, Noisy, generator])
def test_the_end_of_an_object_does_not_lose_the_limit(
    make: Callable[[], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The interpreter ignores an exception in a callback, and would go on without a limit."""
    now = [0.0]
    monkeypatch.setattr(time_limit, "real_time", lambda: now[0])
    things = [make()]
    watched = ref(things[0], lambda _: len(""))
    ended: list[object] = []

    def compute() -> str:
        now[0] = 100.0
        del things[0]
        ended.append(None)
        return "too late"

    assert within(1.0, compute) is None
    assert not things
    assert watched() is None
    assert not ended


@pytest.mark.parametrize("seconds", [60.0, -1.0])
def test_a_profiler_continues_afterwards(seconds: float) -> None:
    profiler = Profile()
    profiler.enable()
    within(seconds, lambda: repr(Thing()))
    generator()
    profiler.disable()
    called = {entry.code for entry in profiler.getstats()}
    assert generator.__code__ in called
