"""Each operator against the naive evaluator, on random streams; late events; bounded memory."""

import math
import sys
from collections import deque
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import Event, shown

from jacaros.robots.streams import Pattern, Spec, Values

STEP = 0.25
"""Times are multiples of it, so that sums of them are exact."""

STATES = [
    Spec("count", ("a",), {"within": 2.0}),
    Spec("count", ("a",), {"within": 2.0, "at_least": 3}),
    Spec("hysteresis", ("a",), {"on_above": 3.0, "off_below": 1.0}),
    Spec("hysteresis", ("a",), {"on_below": 1.0, "off_above": 3.0}, 1),
    Spec("held", ("a",), {"for": 1.5, "above": 1.0}),
    Spec("held", ("a",), {"for": 1.0, "equals": 1.0}),
    Spec("held", ("a",), {"for": 1.5}),
    Spec("absent", ("a",), {"for": 1.5}),
]
NUMBERS = st.integers(0, 4).map(float)


def streams(count: int) -> st.SearchStrategy[list[Event]]:
    """Events of *count* streams, in order."""
    values = st.one_of(st.tuples(NUMBERS, NUMBERS), st.tuples(NUMBERS, NUMBERS), st.none())
    event = st.tuples(st.integers(0, count - 1), st.integers(0, 6), values)

    def timed(made: list[tuple[int, int, Values | None]]) -> list[Event]:
        time, found = 0.0, []
        for stream, wait, each in made:
            time += wait * STEP
            found.append((stream, time, each))
        return found

    return st.lists(event, max_size=25).map(timed)


class Run:
    """A pattern, with its outputs."""

    def __init__(self, spec: Spec) -> None:
        self.now = 0.0
        self.outputs: list[tuple[str, float]] = []
        self.pattern = Pattern(spec, 0.0, lambda kind, values: self.outputs.append((kind, self.now)))

    def until(self, time: float) -> None:
        """Advance the pattern at each deadline."""
        while self.pattern.deadline <= time:
            self.now = self.pattern.deadline
            self.pattern.advance(self.now)
        self.now = time


def _same(one: Values | None, other: Values | None) -> bool:
    if one is None or other is None:
        return one is other
    return len(one) == len(other) and all(
        math.isclose(float(x), float(y), rel_tol=1e-9, abs_tol=1e-9)  # type: ignore[arg-type]
        for x, y in zip(one, other, strict=True)
    )


@pytest.mark.parametrize("spec", STATES, ids=lambda spec: f"{spec.operator}-{len(spec.options)}")
@given(data=st.data())
@settings(max_examples=25, deadline=None)
def test_states_equal_those_of_the_naive_evaluator(spec: Spec, data: st.DataObject) -> None:
    events = data.draw(streams(len(spec.sources)))
    run = Run(spec)
    left = deque(events)
    end = (events[-1][1] if events else 0.0) + 6.0
    for step in range(1 + int(end / STEP)):
        now = step * STEP
        run.until(now)
        while left and left[0][1] <= now:
            run.pattern.take(*left.popleft())
        assert _same(run.pattern.shown, shown(spec, events, now)), f"at {now}"


def test_an_event_that_took_long_counts_when_it_comes() -> None:
    run = Run(Spec("count", ("a",), {"within": 2.0}))
    run.pattern.take(0, 1.0, ())
    run.until(3.0)
    assert run.pattern.shown is None
    run.pattern.take(0, 2.9, ())
    assert run.pattern.shown == (1,)
    run.until(4.9)
    assert run.pattern.shown == (1,)
    run.until(5.0)
    assert run.pattern.shown is None


def _size(thing: object, seen: set[int]) -> int:
    """Entries in the containers of an object."""
    if id(thing) in seen:
        return 0
    seen.add(id(thing))
    inner: list[Any] = []
    if isinstance(thing, list | tuple | deque):
        inner = list(thing)
    else:
        for kind in type(thing).__mro__:
            inner += [getattr(thing, name) for name in getattr(kind, "__slots__", ()) if hasattr(thing, name)]
    return len(inner) + sum(
        _size(each, seen) for each in inner if not isinstance(each, str | int | float | type(None))
    )


EVERYTHING = [*STATES, Spec("together", ("a", "b"), {"within": 0.1}, lateness=1.0)]


@pytest.mark.parametrize("spec", EVERYTHING, ids=lambda spec: f"{spec.operator}-{len(spec.options)}")
def test_memory_is_bounded_by_the_window(spec: Spec) -> None:
    pattern = Pattern(spec, 0.0, lambda kind, values: None)
    sizes = []
    for step in range(3000):
        value = float(step * 7 % 5)
        pattern.take(step * 5 % len(spec.sources), step * 0.01, (value, 4.0 - value))
        if step in (1000, 2999):
            sizes.append(_size(pattern, set()))
    assert sizes[1] <= sizes[0] * 1.2 + 50
    assert sys.getsizeof(pattern) < 300


def test_samples_with_nearby_stamps_are_joined() -> None:
    made: list[Values] = []
    spec = Spec("together", ("scan", "odom"), {"within": 0.05}, lateness=0.5)
    pattern = Pattern(spec, 100.0, lambda kind, values: made.append(values))
    pattern.take(1, 100.00, ("o0",))
    pattern.take(1, 100.10, ("o1",))
    pattern.take(0, 100.08, ("s0",))  # later than an odometry that is nearer than the one before
    pattern.take(0, 100.20, ("s1",))
    pattern.take(1, 100.30, ("o3",))  # too far from s1
    pattern.take(1, 100.21, ("o2",))  # late, and in time
    assert made == [("s0", "o1"), ("s1", "o2")]
    pattern.take(0, 99.0, ("old",))
    assert pattern.dropped == 1


@given(st.lists(st.tuples(st.integers(0, 1), st.integers(0, 40)), max_size=40))
@settings(max_examples=25, deadline=None)
def test_sets_are_close_ordered_and_disjoint(events: list[tuple[int, int]]) -> None:
    made: list[Values] = []
    spec = Spec("together", ("a", "b"), {"within": 2 * STEP}, lateness=100.0)
    pattern = Pattern(spec, 0.0, lambda kind, values: made.append(values))
    for number, (stream, tick) in enumerate(events):
        pattern.take(stream, tick * STEP, ((tick * STEP, number),))
    for stream in (0, 1):
        samples = [values[stream] for values in made]
        assert len(set(samples)) == len(samples)
        assert [each[0] for each in samples] == sorted(each[0] for each in samples)  # type: ignore[index]
    assert all(abs(one[0] - other[0]) <= 2 * STEP for one, other in made)  # type: ignore[index]
