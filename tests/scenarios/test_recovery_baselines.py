"""The baselines with the recovery tree of Nav2: what their recoveries do in the world."""

import sys
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.testing import RunResult

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

from scenarios import SCENARIOS, Scenario
from virtual_run import run_baseline

ABORTED = "faults:\n  f: {kind: aborted_action, action: /navigate_to_pose, at: 2, for: 14}\n"
EMPTY = "  g: {kind: battery_drop, to: 15, at: 7}\n"
RIGHT_ANGLE = 1.57


def with_recoveries(name: str) -> Scenario:
    baseline = SCENARIOS[name].baseline
    return SCENARIOS[name]._replace(baseline=baseline.with_name(f"recovery_{name}.py"))


def yaw_at(result: RunResult, time: float) -> float:
    return float(next(sample for sample in result.ground_truth.path() if sample[0] >= time)[3])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["patrol", "house_cleaning"])
def test_without_a_disturbance_the_run_is_that_of_the_baseline(name: str) -> None:
    result, plain = run_baseline(with_recoveries(name)), run_baseline(name)
    assert SCENARIOS[name].judge(result).complaints == []
    assert (result.lines, result.errors, result.exit_code) == (plain.lines, [], 0)
    assert [*result.ground_truth.path()] == [*plain.ground_truth.path()]


def test_aborted_goals_make_the_robot_spin_wait_and_back_up() -> None:
    result = run_baseline(with_recoveries("patrol"), seconds=25.0, faults=ABORTED)
    path = [sample[:4] for sample in result.ground_truth.path()]
    x, y = path[-1][1:3]
    turned = [(time, y) for time, _, y, yaw in path if abs(yaw - RIGHT_ANGLE) < 0.1 and time < 14.0]
    still = [time for time, y in turned if abs(y) < 0.01]
    assert still[-1] - still[0] > 5.0, "it waits after a turn to the left"
    assert turned[-1][1] == pytest.approx(-0.3, abs=0.03), "then it backs up"
    assert yaw_at(result, 17.0) == pytest.approx(2 * RIGHT_ANGLE, abs=0.1), (
        "and clears costmaps, and turns again"
    )
    assert (x, y) == pytest.approx((2.0, 0.0), abs=0.1), "after the disturbance it arrives"
    assert result.errors == []


def test_a_goal_that_interrupts_recoveries_begins_with_its_own() -> None:
    result = run_baseline(with_recoveries("patrol"), seconds=12.0, faults=ABORTED + EMPTY)
    assert yaw_at(result, 6.9) == pytest.approx(RIGHT_ANGLE, abs=0.1), "it waits"
    assert yaw_at(result, 10.0) == pytest.approx(2 * RIGHT_ANGLE, abs=0.1), "it does not wait on, but turns"


def test_recoveries_that_do_not_help_are_left_out(tmp_path: Path) -> None:
    world = tmp_path / "blocked.yaml"
    text = (EXAMPLES / "04_patrol/patrol.yaml").read_text(encoding="utf-8")
    wall = "walls:\n  - box: {from: [1.8, -0.2], to: [2.2, 0.2]}\n"
    world.write_text(text.replace("walls:\n", wall, 1), encoding="utf-8")
    result = run_baseline(with_recoveries("patrol"), world)
    assert result.lines == ["[patrol] I need help: Corner 1 cannot be reached"]
    assert result.exit_code == 1
    assert result.seconds < 7.0, "three goals with two pauses"
    assert result.ground_truth.odometer() == 0.0
