"""Scenario 4: a patrol with recharging."""

from collections.abc import Callable
from pathlib import Path

import pytest
from examples_lab import (
    EXAMPLES,
    checker,
    doing_at,
    falsified,
    passed,
    run,
    run_of,
    spoilt,
    truth_of,
    world_with,
)

from jacaros.robots.world import PathSample, RobotEvent
from jacaros.testing import run_project

PROJECT = "04_patrol/patrol.jcm"
module = checker("04_patrol")
check = module.check


def test_ten_recharges_and_no_corner_left_out() -> None:
    verdict = passed(check(truth_of(PROJECT)))
    assert verdict.measured["recharges"] == 10


def test_the_lines_of_the_agent_agree_with_what_happened() -> None:
    stops = {line for line in run_of(PROJECT).lines if "battery low" in line}
    assert len(stops) == 4
    lines = run_of(PROJECT).lines
    verdict = check(truth_of(PROJECT))
    corners = int(verdict.measured["corners"])
    assert f"[robot] {corners} corners, that is {corners // 4} rounds and {corners % 4} of the next" in lines
    assert sum(line.startswith("[robot] round ") for line in lines) == corners


LEVELS = [
    pytest.param(25, "driving", id="in the middle of a side"),
    pytest.param(27.5, "driving", id="braking before a corner"),
    pytest.param(29, "driving", id="arriving at a corner"),
    pytest.param(30.2, "turning", id="in a turn"),
    pytest.param(31, "turning", id="at the end of a turn"),
    pytest.param(32.2, "driving", id="leaving a corner"),
]
"""Percent at the beginning, and what the robot is doing when its agent sees that the battery is low."""


@pytest.mark.slow
@pytest.mark.parametrize(("level", "doing"), LEVELS)
def test_the_battery_may_get_low_anywhere(level: float, doing: str, tmp_path: Path) -> None:
    world = world_with(tmp_path, EXAMPLES / "04_patrol/patrol.yaml", "level: 100", f"level: {level}")
    assert doing_at("battery low", PROJECT, "shift(1)", world) == doing
    result = run(PROJECT, "shift(1)", world)
    assert check(result.ground_truth, cycles=1).complaints == []


@pytest.mark.slow
def test_the_program_alone_runs_in_the_world_of_the_command_line() -> None:
    alone = run("04_patrol/robot.asl", "shift(1)", EXAMPLES / "04_patrol/patrol.yaml")
    assert check(alone.ground_truth, cycles=1).passed


def test_the_agent_gives_up_when_the_dock_gives_no_current(tmp_path: Path) -> None:
    text = (EXAMPLES / "04_patrol/patrol.yaml").read_text(encoding="utf-8")
    world = tmp_path / "world.yaml"
    world.write_text(
        text.replace("x: 1, y: 1,", "x: 1, y: 1.5,").replace("level: 100", "level: 30"), encoding="utf-8"
    )
    result = run_project(EXAMPLES / PROJECT, world=world, seconds=300)
    assert result.exit_code == 1
    assert result.lines[-1].startswith("[robot] I need help: the robot's battery is not charging")


def test_the_agent_leaves_out_a_corner_when_something_stands_in_its_way(tmp_path: Path) -> None:
    wall = "walls:\n  - box: {from: [1, -0.1], to: [1.1, 0]}\n"
    world = world_with(tmp_path, EXAMPLES / "04_patrol/patrol.yaml", "walls:\n", wall)
    lines = run_project(EXAMPLES / PROJECT, world=world, seconds=60).lines
    assert lines[0].startswith("[robot] I need help, or come back later: place 1 is out of reach, blocked(")
    assert lines[1].endswith("corner 2")


# The checker on runs that went otherwise.


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        (
            'on to corner ", Corner).',
            'on to corner ", Corner); .drop_desire(patrol(_)).',
            "no corner was visited after the last recharge",
        ),
        ("     operationRecharge; ", "     .wait(1000); ", "before the battery was full"),
        ("!!patrol([1, 2, 3, 4])", "!!patrol([1, 3, 2, 4])", "after corner 1 came corner 3"),
        ('diagnostics("Low Battery")', 'diagnostics("Medium Battery")', "which is not low"),
        ("place(dock, 1, 1, 0).", "place(dock, 1, 0.3, 0).", "0 recharges, not 1"),
    ],
)
def test_the_checker_sees_a_program_that_is_wrong(old: str, new: str, complaint: str, tmp_path: Path) -> None:
    result = run_project(spoilt(tmp_path, PROJECT, old, new), seconds=200)
    assert any(complaint in each for each in check(result.ground_truth, cycles=1).complaints)


def test_the_checker_sees_too_few_recharges_a_bump_and_an_empty_battery() -> None:
    assert check(truth_of(PROJECT), cycles=11).complaints == ["10 recharges, not 11"]
    empty = RobotEvent(100.0, "turtlebot", "battery_empty", 0.0, 1.0, 0.0, {"level": 0})
    assert check(falsified(truth_of(PROJECT), more=[empty])).complaints == ["the battery was empty"]
    bump = RobotEvent(3.0, "turtlebot", "bump", 1.6, 0.0, 0.0, {"side": "front"})
    assert not check(falsified(truth_of(PROJECT), more=[bump])).passed


def test_the_checker_sees_a_corner_left_out_and_the_way_driven_backwards() -> None:
    truth = truth_of(PROJECT)
    visit = module.visits(truth.path())[5]

    def away(sample: PathSample) -> PathSample:
        return sample._replace(x=sample.x + 0.2) if visit.begin <= sample.time <= visit.end else sample

    assert [c.split(" at ")[0] for c in check(falsified(truth, away)).complaints] == [
        "after corner 0 came corner 2"
    ]
    assert not check(falsified(truth_of(PROJECT), lambda s: s._replace(x=s.y, y=s.x))).passed


def test_the_checker_sees_a_patrol_that_continues_at_the_wrong_corner_or_ends_in_the_dock() -> None:
    truth = truth_of(PROJECT)
    stay = module.judge_recharging(module.Verdict(), truth)[0]

    def swapped(sample: PathSample) -> PathSample:
        return sample._replace(x=2.0 - sample.x, y=2.0 - sample.y) if sample.time > stay.begin else sample

    assert not check(falsified(truth, swapped)).passed


def test_the_checker_sees_a_patrol_that_ends_in_the_dock() -> None:
    truth = truth_of(PROJECT)
    last = module.judge_recharging(module.Verdict(), truth)[-1]
    false = falsified(truth, lambda s: s if s.time <= last.begin + 1.0 else None)
    assert "no corner was visited after the last recharge" in check(false).complaints


RECHARGES: dict[str, Callable[[RobotEvent], RobotEvent | None]] = {
    "outside of the dock": lambda e: e._replace(x=e.x + 0.5) if e.kind == "charging" else e,
    "left too early": lambda e: e if e.kind != "charged" else None,
    "with half a battery": lambda e: e._replace(data={"level": 50.0}) if e.kind == "charging" else e,
}


@pytest.mark.parametrize("event", RECHARGES.values(), ids=RECHARGES)
def test_the_checker_sees_a_recharge_that_is_wrong(event: Callable[[RobotEvent], RobotEvent | None]) -> None:
    assert not check(falsified(truth_of(PROJECT), event=event)).passed
