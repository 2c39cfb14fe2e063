"""Dose and response: bins, the logistic curve, and the dose at which half of the runs fail."""

import random
from math import exp, inf, log

import pytest

from disturbances import KINDS
from response import DOSES, Curve, Dose, Run, bins, fit, half

SLIP = DOSES["slip"]
HOURS = [
    *(0.50, 0.75, 1.00, 1.25, 1.50, 1.75, 1.75, 2.00, 2.25, 2.50),
    *(2.75, 3.00, 3.25, 3.50, 4.00, 4.25, 4.50, 4.75, 5.00, 5.50),
]
PASSED = [int(each) for each in "00000010101010111111"]


def runs_with(odds: float, growth: float, number: int = 400) -> list[Run]:
    """Runs that fail by a logistic law."""
    draw = random.Random(number)
    doses = [draw.uniform(SLIP.low, SLIP.high) for _ in range(number)]
    return [(dose, draw.random() > 1 / (1 + exp(-odds - growth * dose))) for dose in doses]


def test_the_ranges_are_those_that_doses_are_drawn_from() -> None:
    ranges = {name: (kind.least, kind.most) for name, kind in KINDS.items()}
    assert {name: (dose.low, dose.high) for name, dose in DOSES.items()} == ranges


def test_bins_have_equal_widths_and_all_runs() -> None:
    found = bins([(0.0, True), (0.11, False), (0.12, True), (0.6, False), (0.59, True)], SLIP)
    assert [(each.done, each.runs) for each in found] == [(1, 2), (1, 1), (0, 0), (0, 0), (1, 2)]
    assert [each.low for each in found] == pytest.approx([0, 0.12, 0.24, 0.36, 0.48])
    assert found[2].interval == (0, 1)


def test_the_curve_is_that_of_a_published_example() -> None:
    """Hours of study and passed exams, the example of logistic regression in Wikipedia: -4.0777 + 1.5046 hours."""
    dose = Dose("hours", "h", 0.5, 5.5)
    curve = fit([(hours, not passed) for hours, passed in zip(HOURS, PASSED, strict=True)], dose)
    assert curve.growth / 5 == pytest.approx(1.5046, rel=0.03)
    assert curve.half == pytest.approx(4.0777 / 1.5046, abs=0.05)
    assert curve.done(1.0) == pytest.approx(1 - 0.07, abs=0.01)


@pytest.mark.parametrize(("odds", "growth"), [(-3.0, 10.0), (0.0, 0.0), (2.0, -5.0)])
def test_no_neighbouring_curve_is_more_likely(odds: float, growth: float) -> None:
    runs = runs_with(odds, growth)
    best = fit(runs, SLIP)

    def likelihood(curve: Curve) -> float:
        return sum(log(curve.done(dose) if done else 1 - curve.done(dose)) for dose, done in runs)

    for start, more in ((0.1, 0), (-0.1, 0), (0, 0.3), (0, -0.3), (0.1, -0.3)):
        assert likelihood(best) > likelihood(Curve(SLIP, best.start + start, best.growth + more))


def test_half_of_the_runs_fail_where_the_law_says_so() -> None:
    found = half(runs_with(-3.0, 10.0), SLIP)
    assert found.interval.low < 0.3 < found.interval.high
    assert found.value == pytest.approx(0.3, abs=0.04)
    assert found.interval.high - found.interval.low < 0.1


def test_a_dose_that_separates_runs_has_a_finite_curve() -> None:
    runs = [(dose / 100, dose < 30) for dose in range(61)]
    curve = fit(runs, SLIP)
    assert curve.half == pytest.approx(0.295, abs=0.01)
    assert curve.growth < 1000


@pytest.mark.parametrize(("done", "value", "text"), [(True, inf, "above 0.6"), (False, -inf, "below 0")])
def test_runs_that_all_end_alike_have_no_such_dose(done: bool, value: float, text: str) -> None:
    found = half([(dose / 100, done) for dose in range(61)], SLIP)
    assert (found.value, str(found)) == (value, text)


def test_half_says_on_which_side_of_the_range_its_limits_are() -> None:
    draw = random.Random(5)
    found = half([(draw.uniform(0, 60), draw.random() < 0.55) for _ in range(30)], DOSES["door"])
    assert str(found).endswith("(below 0 s to above 60 s)")


def test_the_bootstrap_is_the_same_for_the_same_runs() -> None:
    runs = runs_with(-2.0, 8.0, 40)
    assert half(runs, SLIP, "patrol") == half(runs, SLIP, "patrol")
    assert half(runs, SLIP, "patrol").interval != half(runs, SLIP, "square").interval


@pytest.mark.parametrize(
    ("kind", "value", "text"), [("slip", 0.305, "0.3"), ("late", 0.256, "0.26 s"), ("battery", 80.0, "80 %")]
)
def test_a_dose_has_its_unit(kind: str, value: float, text: str) -> None:
    assert DOSES[kind].text(value) == text
