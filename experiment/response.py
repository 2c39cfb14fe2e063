"""Dose and response: how the share of runs that fail grows with the dose of a disturbance."""

import random
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from math import exp, inf, log
from typing import NamedTuple

from intervals import Interval, wilson

BINS = 5
SAMPLES = 1000
"""Bootstrap samples of an interval."""

_RIDGE = 0.001
"""Penalty on the coefficients, without which the curve of runs that a dose separates has no steepest slope."""

_GRID = 50
"""Steps of the dose that a curve distinguishes: fewer points are faster, and no number of runs here shows half a step."""

_STEPS, _CLOSE = 60, 1e-3


class Dose(NamedTuple):
    """The doses of a kind of disturbance, as in PROTOCOL.md: what they are, their unit, and their range."""

    name: str
    unit: str
    low: float
    high: float

    def text(self, value: float) -> str:
        """Return a dose with its unit; outside of the range, on which side of it."""
        if value < self.low:
            return f"below {self._with_unit(self.low)}"
        return f"above {self._with_unit(self.high)}" if value > self.high else self._with_unit(value)

    def _with_unit(self, value: float) -> str:
        rounded = f"{value:.2f}" if self.high < 1 else f"{value:.1f}"
        return f"{rounded.rstrip('0').rstrip('.') if '.' in rounded else rounded} {self.unit}".rstrip()


DOSES: Mapping[str, Dose] = {
    "slip": Dose("share of the turning of wheels lost", "", 0, 0.6),
    "late": Dose("delay each way", "s", 0, 0.4),
    "lost": Dose("share of the messages lost", "", 0, 0.6),
    "carried": Dose("distance", "m", 0, 3),
    "battery": Dose("missing charge", "%", 60, 95),
    "aborted": Dose("time without navigation", "s", 0, 20),
    "door": Dose("time with a closed door", "s", 0, 60),
}
"""The kinds of the protocol, in its order."""

Run = tuple[float, bool]
"""A dose, and whether the run was done."""


class Bin(NamedTuple):
    """The runs with doses between two limits: how many, and how many of them were done."""

    low: float
    high: float
    done: int
    runs: int

    @property
    def interval(self) -> Interval:
        """Interval of the share that is done."""
        return wilson(self.done, self.runs)


class Curve(NamedTuple):
    """A logistic curve: the log odds of failing at the lowest dose, and how much they grow up to the highest."""

    dose: Dose
    start: float
    growth: float

    def done(self, dose: float) -> float:
        """Return the share of runs that is done at a dose."""
        place = (dose - self.dose.low) / (self.dose.high - self.dose.low)
        return 1 / (1 + exp(min(500.0, self.start + self.growth * place)))

    @property
    def half(self) -> float:
        """The dose at which half of the runs fail; infinite if fewer fail at the highest dose, or more at the lowest."""
        if self.start + self.growth < 0:
            return inf
        if self.start >= 0:
            return -inf
        return self.dose.low - self.start / self.growth * (self.dose.high - self.dose.low)


class Half(NamedTuple):
    """The dose at which half of the runs fail, with its interval."""

    dose: Dose
    value: float
    interval: Interval

    def __str__(self) -> str:
        limits = [self.dose.text(each) for each in self.interval]
        value = self.dose.text(self.value)
        return value if limits == [value, value] else f"{value} ({' to '.join(dict.fromkeys(limits))})"


def bins(runs: Iterable[Run], dose: Dose) -> list[Bin]:
    """Sort runs into bins of equal width."""
    width = (dose.high - dose.low) / BINS
    found: list[list[bool]] = [[] for _ in range(BINS)]
    for value, done in runs:
        found[max(0, min(BINS - 1, int((value - dose.low) / width)))].append(done)
    limits = [dose.low + number * width for number in range(BINS + 1)]
    return [
        Bin(low, high, sum(each), len(each))
        for low, high, each in zip(limits, limits[1:], found, strict=False)
    ]


def fit(runs: Iterable[Run], dose: Dose) -> Curve:
    """Return the most likely curve, by Newton's method."""
    return Curve(dose, *_fitted(_weighted(runs, dose), (0.0, 0.0)))


def half(runs: Sequence[Run], dose: Dose, seed: str = "") -> Half:
    """Return the dose at which half of the runs fail; the interval is of bootstrap samples drawn with *seed*."""
    curve, draw = fit(runs, dose), random.Random(f"{dose.name}/{seed}")
    if len({done for _, done in runs}) < 2:  # all samples are alike
        return Half(dose, curve.half, Interval(curve.half, curve.half))
    weighted = list(_weighted(runs, dose).elements())
    halves = sorted(
        Curve(
            dose, *_fitted(Counter(draw.choices(weighted, k=len(weighted))), (curve.start, curve.growth))
        ).half
        for _ in range(SAMPLES)
    )
    tail = round(0.025 * SAMPLES)
    return Half(dose, curve.half, Interval(halves[tail], halves[-tail - 1]))


def _weighted(runs: Iterable[Run], dose: Dose) -> "Counter[Run]":
    """How often each run occurs, with its dose as a share of the range, rounded so that few differ."""
    width = (dose.high - dose.low) / _GRID
    return Counter((round((value - dose.low) / width) / _GRID, done) for value, done in runs)


def _fitted(runs: "Counter[Run]", begin: tuple[float, float]) -> tuple[float, float]:
    """Return start and growth of the curve at which the penalised likelihood is highest."""
    points = [(dose, 0.0 if done else 1.0, count) for (dose, done), count in runs.items()]
    at = begin
    height, step = _newton(points, at)
    for _ in range(_STEPS):
        there = (at[0] + step[0], at[1] + step[1])
        new, further = _newton(points, there)
        if new >= height:
            at, height, step = there, new, further
        else:  # a step from far away can overshoot
            step = (step[0] / 2, step[1] / 2)
        if max(map(abs, step)) < _CLOSE:
            break
    return at


def _newton(
    points: Iterable[tuple[float, float, int]], at: tuple[float, float]
) -> tuple[float, tuple[float, float]]:
    """The penalised log likelihood of a curve, and Newton's step from it: the gradient, divided by the curvature."""
    start, growth = at
    height = -_RIDGE / 2 * (start * start + growth * growth)
    g0, g1 = -_RIDGE * start, -_RIDGE * growth
    h00, h01, h11 = _RIDGE, 0.0, _RIDGE
    for dose, failed, count in points:
        odds = start + growth * dose
        small = exp(-abs(odds))
        height += count * ((failed * odds) - max(odds, 0.0) - log(1 + small))
        share = (1.0 if odds > 0 else small) / (1 + small)
        missing, weight = count * (failed - share), count * share * (1 - share)
        g0 += missing
        g1 += missing * dose
        h00 += weight
        h01 += weight * dose
        h11 += weight * dose * dose
    scale = h00 * h11 - h01 * h01
    return height, ((h11 * g0 - h01 * g1) / scale, (h00 * g1 - h01 * g0) / scale)
