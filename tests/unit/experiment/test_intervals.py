"""Intervals and tests of the experiment, against published figures and against their definitions."""

import itertools
import random
from math import sqrt

import pytest

from intervals import Interval, Pairs, Z, holm, mcnemar, newcombe, wilson


@pytest.mark.parametrize(
    ("successes", "runs", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_wilson_gives_the_published_intervals(successes: int, runs: int, low: float, high: float) -> None:
    """Newcombe: Two-sided confidence intervals for the single proportion. Statistics in Medicine 17 (1998), table I."""
    assert wilson(successes, runs) == pytest.approx((low, high), abs=5e-5)


@pytest.mark.parametrize("successes", [1, 7, 19])
def test_the_limits_of_wilson_are_where_the_score_test_turns(successes: int) -> None:
    for limit in wilson(successes, 20):
        assert abs(successes / 20 - limit) == pytest.approx(Z * sqrt(limit * (1 - limit) / 20))


def test_wilson_holds_its_share_and_stays_between_zero_and_one() -> None:
    for runs in range(1, 40):
        for successes in range(runs + 1):
            low, high = wilson(successes, runs)
            assert 0 <= low <= successes / runs <= high <= 1
    assert wilson(0, 0) == (0, 1)


@pytest.mark.parametrize(
    ("pairs", "low", "high"),
    [
        # Newcombe: Improved confidence intervals for the difference between binomial proportions based on paired data.
        # Statistics in Medicine 17 (1998), method 10 in the table of worked examples.
        (Pairs(36, 12, 2, 0), 0.0569, 0.3404),
        (Pairs(20, 12, 2, 16), 0.0562, 0.3292),
        # Fagerland, Lydersen, Laake: Recommended tests and confidence intervals for paired binomial proportions.
        # Statistics in Medicine 33 (2014): airway hyper-responsiveness before and after stem cell transplantation.
        (Pairs(1, 1, 7, 12), -0.507, -0.026),
    ],
)
def test_newcombe_gives_the_published_intervals(pairs: Pairs, low: float, high: float) -> None:
    assert newcombe(pairs) == pytest.approx((low, high), abs=5e-4)


def test_newcombe_of_swapped_sides_is_the_mirror_image() -> None:
    low, high = newcombe(Pairs(20, 12, 2, 16))
    assert newcombe(Pairs(20, 2, 12, 16)) == pytest.approx((-high, -low))


def test_newcombe_holds_the_difference_for_all_small_tables() -> None:
    for counts in itertools.product(range(4), repeat=4):
        pairs = Pairs(*counts)
        low, high = newcombe(pairs)
        assert -1 - 1e-9 <= low <= pairs.difference <= high <= 1 + 1e-9


def test_newcombe_covers_the_true_difference() -> None:
    """Of 2,000 drawn tables of 50 pairs, 95 % hold the true difference of 0.15; with 2,000, two deviations are 1 %."""
    draw = random.Random(1)
    cells = [(True, True), (True, False), (False, True), (False, False)]
    covered = 0
    for _ in range(2000):
        low, high = newcombe(Pairs.of(draw.choices(cells, [0.4, 0.25, 0.1, 0.25], k=50)))
        covered += low <= 0.15 <= high
    assert 0.94 <= covered / 2000 <= 0.97


def test_pairs_are_counted_by_what_each_side_has() -> None:
    pairs = Pairs.of([(True, True), (True, False), (True, False), (False, True), (False, False)])
    assert pairs == (1, 2, 1, 1)
    assert (pairs.first, pairs.second, pairs.difference) == (3, 2, pytest.approx(0.2))


def test_mcnemar_gives_the_published_p() -> None:
    """Fagerland, Lydersen, Laake (2014), as above: 0.070."""
    assert mcnemar(Pairs(1, 1, 7, 12)) == pytest.approx(0.0703, abs=5e-5)


@pytest.mark.parametrize(("one", "other"), [(0, 0), (3, 3), (0, 6), (7, 2), (1, 9)])
def test_mcnemar_is_the_share_of_all_coin_tosses_as_uneven(one: int, other: int) -> None:
    tosses = list(itertools.product((-1, 1), repeat=one + other))
    as_uneven = sum(abs(sum(each)) >= abs(one - other) for each in tosses)
    assert mcnemar(Pairs(5, one, other, 5)) == pytest.approx(as_uneven / len(tosses))


def test_holm_gives_the_published_example() -> None:
    """The example of the Holm-Bonferroni method in Wikipedia: the first and the last are rejected at 0.05."""
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])


def test_holm_rejects_as_the_procedure_does_step_by_step() -> None:
    draw = random.Random(2)
    for _ in range(200):
        values = [draw.random() ** 3 for _ in range(6)]
        rejected = set()
        for rank, place in enumerate(sorted(range(6), key=values.__getitem__)):
            if values[place] * (6 - rank) >= 0.05:
                break
            rejected.add(place)
        assert {place for place, p in enumerate(holm(values)) if p < 0.05} == rejected


@pytest.mark.parametrize(
    ("low", "high", "excludes"), [(-0.1, 0.1, False), (0.0, 0.2, False), (-0.3, -0.1, True)]
)
def test_an_interval_knows_whether_it_excludes_zero(low: float, high: float, excludes: bool) -> None:
    assert Interval(low, high).excludes_zero == excludes
