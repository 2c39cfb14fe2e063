"""Scenario 2: a square of one metre."""

import math
import re

import pytest
from examples_lab import checker, falsified, passed, run, run_of, truth_of

PROJECT = "02_square/square.jcm"
LINE = r"\[robot\] side (\d) done, at (-?\d+) cm, (-?\d+) cm"
check = checker("02_square").check


def test_the_robot_drives_the_square_and_comes_back() -> None:
    passed(check(truth_of(PROJECT)))


def test_the_agent_prints_the_corners() -> None:
    told = [re.fullmatch(LINE, line) for line in run_of(PROJECT).lines]
    sides = [[int(number) for number in match.groups()] for match in told if match is not None]
    assert [side for side, _, _ in sides] == [1, 2, 3, 4]
    for (_, x, y), corner in zip(sides, [(100, 0), (100, 100), (0, 100), (0, 0)], strict=True):
        assert math.dist((x, y), corner) <= 3


@pytest.mark.parametrize("file", ["square.mas2j", "robot.asl"])
def test_the_other_ways_to_run_it_do_the_same(file: str) -> None:
    other = run(f"02_square/{file}")
    assert other.lines == run_of(PROJECT).lines
    assert check(other.ground_truth).passed


@pytest.mark.parametrize(("corner_x", "corner_y"), [(1, 0), (1, 1), (0, 1)])
def test_the_checker_sees_a_corner_seven_centimetres_off(corner_x: float, corner_y: float) -> None:
    truth = truth_of(PROJECT)
    false = falsified(
        truth, lambda s: s._replace(x=s.x + 0.07) if math.dist((s.x, s.y), (corner_x, corner_y)) < 0.2 else s
    )
    assert not check(false).passed


def test_the_checker_sees_a_square_that_is_too_large_or_driven_the_other_way_round() -> None:
    false = falsified(truth_of(PROJECT), lambda s: s._replace(y=-s.y, yaw=-s.yaw))
    assert not check(false).passed
    assert not check(falsified(truth_of(PROJECT), lambda s: s._replace(x=1.1 * s.x, y=1.1 * s.y))).passed


def test_the_checker_sees_a_side_left_out_or_not_straight_and_a_robot_that_never_moved() -> None:
    truth = truth_of(PROJECT)
    assert not check(falsified(truth, lambda s: s if s.time < 0.8 * truth.latest().time else None)).passed
    false = falsified(
        truth_of(PROJECT),
        lambda s: s._replace(y=s.y - 0.08) if 0.4 < s.x < 0.6 and s.y < 0.5 else s,
    )
    assert [c.split(":")[0] for c in check(false).complaints] == ["metres beside the sides"]
    start = truth.path()[0]
    assert not check(falsified(truth, lambda s: start._replace(time=s.time))).passed
