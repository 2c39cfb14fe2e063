"""The share of a core used by 60 patterns at 1,000 events per second, compared with reactivex and a hand-written filter.

    patterns.py [--seconds S] [--turns N]

Twenty properties change fifty times a second each, and three patterns look at each: a count in a window, a hysteresis
and a condition that has held for a while. Times are simulated; what is measured is the processor's time, as a
share of the simulated time. All systems run in turns within one run, and the medians are printed. reactivex
(``pip install reactivex``) is left out if it is not installed.
"""

import argparse
import gc
import importlib.util
import random
import time
from collections import deque
from collections.abc import Callable
from typing import Any

PROPERTIES = 20
RATE = 1000
"""Events per second, over all properties."""
WITHIN, ENOUGH, ON, OFF, LASTING = 1.0, 40, 7.0, 3.0, 0.2

Sample = tuple[float, int, float]
"""Time, number of the property, value."""

Go = Callable[[], int]
"""Processes all samples; returns the number of outputs."""


def main() -> None:
    """Measure in turn, and print the medians."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=5.0, help="simulated seconds of each turn")
    parser.add_argument("--turns", type=int, default=5)
    arguments = parser.parse_args()
    samples = made(arguments.seconds)
    systems: dict[str, Callable[[list[Sample]], Go]] = {
        "patterns": patterns,
        "by hand": by_hand,
    }
    if importlib.util.find_spec("reactivex") is not None:
        systems["reactivex"] = reactive
    else:
        print("reactivex is not installed: it is left out")
    found: dict[str, list[float]] = {name: [] for name in systems}
    outputs = {}
    for _ in range(arguments.turns):
        for name, run in systems.items():
            go = run(samples)  # making patterns
            gc.collect()
            began = time.process_time()
            outputs[name] = go()
            found[name].append((time.process_time() - began) / arguments.seconds)
    print(f"{3 * PROPERTIES} patterns, {RATE} events a second, median of {arguments.turns} turns:")
    for name, shares in found.items():
        print(f"  {name:<15} {100 * median(shares):5.1f} % of a core  ({outputs[name]} outputs)")


def median(figures: list[float]) -> float:
    """Return the median."""
    return sorted(figures)[len(figures) // 2]


def made(seconds: float) -> list[Sample]:
    """Random walks, the same in every run."""
    chance = random.Random(1)
    values = [5.0] * PROPERTIES
    found = []
    for number in range(int(seconds * RATE)):
        which = number % PROPERTIES
        values[which] = min(10.0, max(0.0, values[which] + chance.uniform(-1.0, 1.0)))
        found.append((number / RATE, which, values[which]))
    return found


# --- ours ------------------------------------------------------------------------------------------------------


def patterns(samples: list[Sample]) -> Go:
    """The operators alone."""
    from jacaros.robots.streams import Pattern, Spec

    outputs = 0

    def count(kind: str, values: object) -> None:
        nonlocal outputs
        outputs += 1

    specs = [
        Spec("count", ("p",), {"within": WITHIN, "at_least": ENOUGH}),
        Spec("hysteresis", ("p",), {"on_above": ON, "off_below": OFF}),
        Spec("held", ("p",), {"above": ON, "for": LASTING}),
    ]
    all_ = [[Pattern(spec, 0.0, count) for spec in specs] for _ in range(PROPERTIES)]

    def go() -> int:
        for at, which, value in samples:
            values = (value,)
            for each in all_[which]:
                each.take(0, at, values)
        return outputs

    return go


# --- by hand ---------------------------------------------------------------------------------------------------


class ByHand:
    """The three patterns of one property, written by hand."""

    def __init__(self) -> None:
        self.times: deque[float] = deque()
        self.since: float | None = None
        self.states = [False] * 3
        self.outputs = 0

    def take(self, at: float, value: float) -> None:
        """Process a sample."""
        old = at - WITHIN
        self.times.append(at)
        while self.times[0] <= old:
            self.times.popleft()
        if value <= ON:
            self.since = None
        elif self.since is None:
            self.since = at
        states = [
            len(self.times) >= ENOUGH,
            value > ON or (self.states[1] and value >= OFF),
            self.since is not None and at >= self.since + LASTING,
        ]
        if states != self.states:
            self.outputs += sum(one != other for one, other in zip(states, self.states, strict=True))
            self.states = states


def by_hand(samples: list[Sample]) -> Go:
    """The filter written by hand."""
    filters = [ByHand() for _ in range(PROPERTIES)]

    def go() -> int:
        for at, which, value in samples:
            filters[which].take(at, value)
        return sum(each.outputs for each in filters)

    return go


# --- reactivex -------------------------------------------------------------------------------------------------


def reactive(samples: list[Sample]) -> Go:
    """The same with operators of reactivex, on its virtual clock."""
    from reactivex import operators as ops
    from reactivex.scheduler import VirtualTimeScheduler
    from reactivex.subject import Subject

    scheduler = VirtualTimeScheduler()
    outputs = 0

    def count(value: object) -> None:
        nonlocal outputs
        outputs += 1

    def windowed(
        window: deque[tuple[float, float]], sample: tuple[float, float]
    ) -> deque[tuple[float, float]]:
        window.append(sample)
        while window[0][0] <= sample[0] - WITHIN:
            window.popleft()
        return window

    def switched(state: bool, sample: tuple[float, float]) -> bool:
        return sample[1] > ON or (state and sample[1] >= OFF)

    subjects: list[Any] = []
    for _ in range(PROPERTIES):
        subject: Any = Subject()
        subjects.append(subject)
        pipes = [
            subject.pipe(ops.scan(windowed, deque()), ops.map(lambda each: len(each) >= ENOUGH)),
            subject.pipe(ops.scan(switched, False)),
            subject.pipe(
                ops.map(lambda each: each[1] > ON),
                ops.distinct_until_changed(),
                ops.debounce(LASTING, scheduler=scheduler),
            ),
        ]
        for pipe in pipes:
            pipe.pipe(ops.distinct_until_changed()).subscribe(count)

    def go() -> int:
        for at, which, value in samples:
            scheduler.advance_to(at)
            subjects[which].on_next((at, value))
        return outputs

    return go


if __name__ == "__main__":
    main()
