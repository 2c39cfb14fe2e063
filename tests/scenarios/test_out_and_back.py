"""Scenario 1: drive out by time, turn around, come back."""

import math
import re

from examples_lab import checker, falsified, passed, run, run_of, truth_of

from jacaros.robots.world import RobotEvent

PROJECT = "01_out_and_back/out_and_back.jcm"
check = checker("01_out_and_back").check


def test_the_robot_comes_back_to_where_and_how_it_stood() -> None:
    passed(check(truth_of(PROJECT)))


def test_the_agent_prints_what_it_does() -> None:
    assert run_of(PROJECT).lines[:2] == ["[robot] driving out", "[robot] driving back"]


def test_the_program_alone_runs_in_the_default_world() -> None:
    alone = run("01_out_and_back/robot.asl")
    # Its floor is exact, that of the project's world is not: the millimetres differ.
    said, in_the_project = (
        [re.sub(r"\d+ mm", "N mm", line) for line in each.lines] for each in (alone, run_of(PROJECT))
    )
    assert said == in_the_project
    assert check(alone.ground_truth).passed


def test_the_checker_sees_an_end_six_centimetres_or_four_degrees_off() -> None:
    truth = truth_of(PROJECT)
    end = truth.latest().time
    false = falsified(truth, lambda s: s._replace(x=s.x + 0.06) if s.time >= end else s)
    assert not check(false).passed
    false = falsified(truth, lambda s: s._replace(yaw=s.yaw + math.radians(4.0)) if s.time >= end else s)
    assert [c.split(":")[0] for c in check(false).complaints] == ["degrees off at the end"]


def test_the_checker_sees_a_robot_that_never_moved_left_its_line_or_came_back_in_reverse() -> None:
    truth = truth_of(PROJECT)
    start = truth.path()[0]
    false = falsified(truth, lambda s: start._replace(time=s.time))
    assert len(check(false).complaints) == 2
    assert not check(falsified(truth, lambda s: s._replace(y=s.y + 0.06 * (s.x > 1.0)))).passed
    false = falsified(truth, lambda s: s._replace(yaw=0.0))
    assert check(false).complaints == ["the robot turned around 0 times, not twice"]


def test_the_checker_sees_a_bump() -> None:
    truth = truth_of(PROJECT)
    bump = RobotEvent(3.0, "turtlebot", "bump", 1.6, 0.0, 0.0, {"side": "front"})
    assert not check(falsified(truth, more=[bump])).passed
