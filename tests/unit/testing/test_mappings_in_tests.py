"""Tests of agents with mapping files, whose other nodes a Python test plays."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.qos import LATCHED
from jacaros.runtime.mas.system import System
from jacaros.testing import run_project
from jacaros.testing.suites import Outcome, suite_of
from jacaros.testing.trial import TrialOptions, run_suite

MAPPING = """
properties:
  odom:
    topic: odom
    type: nav_msgs/msg/Odometry
    fields: [pose.pose.position.x, {path: pose.pose.orientation, as: yaw, unit: degrees, round: 1}]
operations:
  drive:
    parameters: [speed, seconds]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed}
    rate: 10
    duration: $seconds
  light: {parameters: [on], service: light, type: std_srvs/srv/SetBool, request: {data: $on}}
"""
PROGRAM = """
+odom(X, Yaw) : X > 1 <- .print("far, towards ", Yaw); !back.
+!back <- drive(-0.5, 1); light(true); .print("back").
-!back[error_msg(Text)] <- .print("no way: ", Text).
"""

Run = Callable[..., list[Outcome]]


@pytest.fixture
def files(tmp_path: Path) -> Path:
    (tmp_path / "robot.yaml").write_text(MAPPING, encoding="utf-8")
    return tmp_path


@pytest.fixture
def run(files: Path) -> Run:
    """Runs tests with the given bodies; each has the mapping."""

    def run_tests(
        *bodies: str, label: str = '[test, mapping("robot.yaml")]', **options: object
    ) -> list[Outcome]:
        path = files / "robot_test.asl"
        tests = [f"@t{number}{label} +!t{number} <- {body}." for number, body in enumerate(bodies)]
        path.write_text("\n".join([PROGRAM, *tests]), encoding="utf-8")
        suite = suite_of(path)
        assert suite.error is None
        return list(run_suite(suite, TrialOptions(timeout=20.0, **options)))  # type: ignore[arg-type]

    return run_tests


def told(outcome: Outcome) -> str:
    return "\n".join(line for problem in outcome.problems for line in problem.lines())


def test_the_graph_is_empty_unless_a_world_is_named(run: Run) -> None:
    [outcome] = run(".wait(2000); !assert_false(odom(_, _))")
    assert outcome.passed, told(outcome)
    [outcome] = run(".wait(2000); !assert_true(odom(0, 0))", world="empty")
    assert outcome.passed, told(outcome)


def test_the_option_gives_all_tests_a_mapping(run: Run, files: Path) -> None:
    [outcome] = run(
        "!fake_action(light(true)); +odom(2, 90); .wait(2000); !assert_did(drive(-0.5, 1))",
        label="[test]",
        mappings=(str(files / "robot.yaml"),),
    )
    assert outcome.passed, told(outcome)


def test_an_invalid_mapping_is_reported(run: Run, files: Path) -> None:
    [outcome] = run("true", label='[test, mapping("robt.yaml")]')
    assert "mapping file not found: robt.yaml" in told(outcome)
    (files / "robot.yaml").write_text("properties: {a: {topik: b}}\n", encoding="utf-8")
    outcomes = run("true", "true")
    assert all("did you mean `topic`?" in told(each) for each in outcomes)


def test_a_label_without_a_file_is_an_error(files: Path) -> None:
    path = files / "robot_test.asl"
    path.write_text("@t[test, mapping(robot)] +!t.\n", encoding="utf-8")
    error = suite_of(path).error
    assert error is not None
    assert "mapping(...) expects a file name" in error


def test_python_tests_play_the_graph_of_a_whole_run(files: Path) -> None:
    program = files / "robot.asl"
    program.write_text(
        PROGRAM + "+!back : false.\n!stop.\n+!stop <- .wait(3000); .stopMAS.\n", encoding="utf-8"
    )
    speeds: list[float] = []
    requests: list[bool] = []

    def serve(request: Any) -> dict[str, bool]:
        requests.append(request.data)
        return {"success": True}

    def play(mas: System) -> None:
        node = mas.ros.companion("test")
        node.subscription(
            "cmd_vel", "geometry_msgs/msg/Twist", lambda sample: speeds.append(sample.message.linear.x)
        )
        node.service("light", "std_srvs/srv/SetBool", serve)
        odom = node.publisher("odom", "nav_msgs/msg/Odometry", LATCHED)
        odom.publish(odom.message(pose={"pose": {"position": {"x": 2.0}}}))

    result = run_project(
        program, mappings=[files / "robot.yaml"], world="none", when_started=play, seconds=5.0
    )
    assert result.lines == ["[robot] far, towards 0", "[robot] back"], result.errors
    assert speeds == [-0.5] * 10 + [0.0]
    assert requests == [True]
    assert result.ground_truth is None
