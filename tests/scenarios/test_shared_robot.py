"""The shared robot: an AgentSpeak agent and a behaviour tree use the same artifacts."""

import math
import subprocess
import sys
from pathlib import Path

import pytest
from examples_lab import EXAMPLES, checker, falsified, passed, run, run_of, spoilt, truth_of, world_with

from jacaros.artifacts import Session
from jacaros.robots.world import PathSample, RobotEvent
from jacaros.runtime.mas.system import System
from jacaros.testing import run_project

PROJECT = "07_shared_robot/shared_robot.jcm"
WORLD = EXAMPLES / "07_shared_robot/shared_robot.yaml"
module = checker("07_shared_robot")
check = module.check


def test_both_drive_the_robot_and_nothing_goes_wrong() -> None:
    verdict = passed(check(truth_of(PROJECT)))
    assert verdict.measured["corners"] == 16
    assert verdict.measured["recharges"] == 2


def test_one_command_runs_it_and_one_judges_it(tmp_path: Path) -> None:
    truth = tmp_path / "truth.jsonl"
    project = str(EXAMPLES / PROJECT)
    run = [sys.executable, "-m", "jacaros", "run", project, "--clock", "fast", "--ground-truth", str(truth)]
    ran = subprocess.run(run, capture_output=True, text=True, timeout=120, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")
    judge = [sys.executable, str(EXAMPLES / "07_shared_robot/check.py"), str(truth)]
    judged = subprocess.run(judge, capture_output=True, text=True, timeout=60, check=False)
    assert judged.stdout.splitlines()[-1] == "passed"
    assert judged.returncode == 0


def test_the_output_says_who_has_the_robot_and_why() -> None:
    lines = [line for line in run_of(PROJECT).lines if not line.startswith("[visitor]")]
    handover = [
        "[supervisor] I want the robot: 20 % left, enough to reach the dock",
        "[driver] hands the robot over",
        "[driver] asks for the robot",
    ]
    begin = lines.index(handover[0])
    assert lines[begin : begin + 3] == handover
    assert lines[begin + 3].startswith("[supervisor] recharge 1, with ")
    assert lines[begin + 4 : begin + 6] == [
        "[supervisor] the battery is full, the driver may have the robot",
        "[driver] patrols",
    ]
    assert lines[-1] == "[supervisor] the robot is at home: 4 rounds, 2 recharges"


@pytest.mark.slow
@pytest.mark.parametrize("level", [24.5, 26.5, 28.5, 29.5, 30.5, 33.5])
def test_the_robot_may_be_wanted_anywhere(level: float, tmp_path: Path) -> None:
    world = world_with(tmp_path, WORLD, "level: 100", f"level: {level}")
    result = run(PROJECT, world=world)
    assert check(result.ground_truth).complaints == []


def test_only_the_holder_of_the_robot_can_release_it() -> None:
    failures = []

    def started(mas: System) -> None:
        assert mas.environment is not None
        session = Session(mas.environment, "thief")
        mas.clock.call_later(
            2.0, lambda: failures.append(session.begin("hand_over", artifact="shift").outcome)
        )

    run_project(EXAMPLES / PROJECT, seconds=3.0, when_started=started)
    assert [str(each.reason) for each in failures] == ["not_on_duty(thief)"]


# Programs that are wrong.


@pytest.mark.slow
@pytest.mark.parametrize(
    ("program", "old", "new", "complaint"),
    [
        ("driver.py", "metres >= CLEAR", "metres >= 0", "the robot bumped into something"),
        ("driver.py", "children=[drive, Act", "children=[NextCorner(), drive, Act", "in the order"),
        ("driver.py", 'HasProperty("wanted_by", "supervisor")', 'HasProperty("wanted_by", "boss")', "recharges"),
        ("supervisor.asl", '+diagnostics("Low Battery")', '+diagnostics("Empty")', "the battery was empty"),
        ("supervisor.asl", "     operationRecharge;", "     .wait(1000);", "before the battery was full"),
        ("supervisor.asl", "dock(1, 1).", "dock(1, 0.3).", "recharges"),
    ],
)  # fmt: skip
def test_the_checker_sees_a_program_that_is_wrong(program: str, old: str, new: str, complaint: str, tmp_path):
    result = run_project(spoilt(tmp_path, PROJECT, old, new, program), seconds=200)
    assert any(complaint in each for each in check(result.ground_truth).complaints)


def test_when_the_tree_dies_the_robot_stops(tmp_path: Path) -> None:
    wrong = spoilt(tmp_path, PROJECT, "next(self._corners)", "next(self._corners)[9]", "driver.py")
    program = wrong.parent / "driver.py"
    text, stays = program.read_text(encoding="utf-8"), "        self._board.corner = ROUTE[0]\n"
    program.write_text(text.replace("        self.update()\n", stays), encoding="utf-8")
    result = run_project(wrong, seconds=30)
    assert any("IndexError" in line for line in result.errors)
    assert module.corners_of(result.ground_truth.path("turtlebot")) == [3, 0]
    assert result.ground_truth.odometer("turtlebot") == pytest.approx(2.0, abs=0.05)


# The checker on runs that went otherwise.


def test_the_checker_sees_too_few_recharges_or_rounds_and_a_bump() -> None:
    assert check(truth_of(PROJECT), recharges=3).complaints == ["2 recharges, not 3"]
    assert "in the order" in check(truth_of(PROJECT), rounds=5).complaints[0]
    bump = RobotEvent(3.0, "visitor", "collision", 1.6, 0.0, 0.0, {"with": "turtlebot", "side": "front"})
    complaints = check(falsified(truth_of(PROJECT), more=[bump])).complaints
    assert complaints == ["the robot bumped into something"]


def test_the_checker_sees_a_robot_near_the_visitor_or_moving_at_the_end() -> None:
    def nearer(sample: PathSample) -> PathSample:
        beside = abs(sample.x - 1.0) < 0.05 and sample.yaw > math.pi / 4
        return sample._replace(x=sample.x - 0.3) if beside else sample

    assert any("m of the visitor" in each for each in check(falsified(truth_of(PROJECT), nearer)).complaints)
    truth = truth_of(PROJECT)
    end = truth.latest("turtlebot").time

    def moving(sample: PathSample) -> PathSample:
        return sample._replace(odometer=sample.odometer + 0.02) if sample.time == end else sample

    assert "metres a second at the end" in check(falsified(truth, moving)).complaints[-1]
