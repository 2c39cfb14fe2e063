"""Intervals and tests for shares of runs: Wilson, Newcombe, McNemar, Holm. All intervals are of 95 %."""

from collections.abc import Iterable, Sequence
from math import comb, sqrt
from typing import NamedTuple

Z = 1.959964
"""Quantile of the normal distribution for a two-sided interval of 95 %."""


class Interval(NamedTuple):
    """A lower and an upper limit."""

    low: float
    high: float

    @property
    def excludes_zero(self) -> bool:
        """Whether both limits are on the same side of zero."""
        return self.low > 0 or self.high < 0


class Pairs(NamedTuple):
    """Pairs of runs with the same seed: in how many both runs, only one, or neither has the outcome asked for."""

    both: int
    only_first: int
    only_second: int
    neither: int

    @classmethod
    def of(cls, pairs: Iterable[tuple[bool, bool]]) -> "Pairs":
        """Count pairs."""
        found = list(pairs)
        return cls(
            *(found.count(each) for each in ((True, True), (True, False), (False, True), (False, False)))
        )

    @property
    def first(self) -> int:
        """Runs of the first side with the outcome."""
        return self.both + self.only_first

    @property
    def second(self) -> int:
        """Runs of the second side with the outcome."""
        return self.both + self.only_second

    @property
    def difference(self) -> float:
        """Share of the first side minus that of the second; 0 without pairs."""
        return (self.only_first - self.only_second) / max(1, sum(self))


def wilson(successes: int, runs: int) -> Interval:
    """Return Wilson's score interval of a share; everything is possible without runs."""
    if not runs:
        return Interval(0.0, 1.0)
    share, shift = successes / runs, Z * Z / runs
    middle, half = share + shift / 2, Z * sqrt(share * (1 - share) / runs + shift / (4 * runs))
    # At the ends, rounding must not leave the share outside of its interval.
    return Interval(
        min(share, max(0.0, (middle - half) / (1 + shift))),
        max(share, min(1.0, (middle + half) / (1 + shift))),
    )


def newcombe(pairs: Pairs) -> Interval:
    """Return the interval of the difference of paired shares: method 10 of Newcombe (1998).

    It joins the Wilson intervals of both shares, narrowed by their correlation. R. G. Newcombe: Improved confidence
    intervals for the difference between binomial proportions based on paired data. Statistics in Medicine 17, 2635-2650.
    """
    runs = sum(pairs)
    if not runs:
        return Interval(-1.0, 1.0)
    first, second = pairs.first / runs, pairs.second / runs
    one, other, phi = wilson(pairs.first, runs), wilson(pairs.second, runs), _correlation(pairs)

    def joined(a: float, b: float) -> float:
        return sqrt(max(0.0, a * a - 2 * phi * a * b + b * b))

    below = joined(first - one.low, other.high - second)
    above = joined(one.high - first, second - other.low)
    return Interval(pairs.difference - below, pairs.difference + above)


def _correlation(pairs: Pairs) -> float:
    """Phi of a table of pairs; a positive one is corrected for continuity, which is what method 10 adds to method 8."""
    both, one, other, neither = pairs
    margins = (both + one) * (other + neither) * (both + other) * (one + neither)
    if not margins:
        return 0.0
    product = both * neither - one * other
    return (max(0.0, product - sum(pairs) / 2) if product > 0 else product) / sqrt(margins)


def mcnemar(pairs: Pairs) -> float:
    """Return p of McNemar's exact test, two-sided: only pairs that differ count."""
    differing, less = pairs.only_first + pairs.only_second, min(pairs.only_first, pairs.only_second)
    return min(1.0, sum(comb(differing, each) for each in range(less + 1)) / 2.0 ** (differing - 1))


def holm(p_values: Sequence[float]) -> list[float]:
    """Return the p values of a family of tests, adjusted by Holm's method, in their order."""
    adjusted, highest = [0.0] * len(p_values), 0.0
    for rank, place in enumerate(sorted(range(len(p_values)), key=p_values.__getitem__)):
        highest = max(highest, min(1.0, (len(p_values) - rank) * p_values[place]))
        adjusted[place] = highest
    return adjusted
