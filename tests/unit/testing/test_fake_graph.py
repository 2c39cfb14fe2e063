"""Tests of agents with mapping files: messages and services played by the test, publications and requests of the agents."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.mas.system import System
from jacaros.testing import FakeGraph, run_project
from jacaros.testing.run import Outcome, suite_of
from jacaros.testing.trial import TrialOptions, run_suite

MAPPING = """
properties:
  odom:
    topic: odom
    type: nav_msgs/msg/Odometry
    fields: [pose.pose.position.x, {path: pose.pose.orientation, as: yaw, unit: degrees, round: 1}]
  status: {topic: state, type: acme_msgs/msg/State, fields: [{path: mode, as: name}]}
interfaces: types
operations:
  drive:
    parameters: [speed, seconds]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed}
    rate: 10
    duration: $seconds
  report: {publish: report, type: std_msgs/msg/Header, fields: {stamp: now}}
  any_drive: {parameters: [speed], publish: velocity, fields: {linear.x: $speed}}
  light: {parameters: [on], service: light, type: std_srvs/srv/SetBool, request: {data: $on}}
"""
PROGRAM = """
+odom(X, Yaw) : X > 1 <- .print("far, towards ", Yaw); !back.
+!back <- drive(-0.5, 1); light(true); .print("back").
-!back[error_msg(Text)] <- .print("no way: ", Text).
"""
ODOM = '!fake_message("odom", "{pose.pose.position.x: 2, pose.pose.orientation: {value: 90, as: yaw, unit: degrees}}")'

Run = Callable[..., list[Outcome]]


@pytest.fixture
def files(tmp_path: Path) -> Path:
    (tmp_path / "types/acme_msgs/msg").mkdir(parents=True)
    (tmp_path / "types/acme_msgs/msg/State.msg").write_text(
        "uint8 MODE_IDLE=0\nuint8 MODE_BUSY=1\nuint8 mode\n", encoding="utf-8"
    )
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


def test_messages_become_beliefs_and_publications_are_recorded(run: Run) -> None:
    [outcome] = run(f"""
        !fake_service("light", "std_srvs/srv/SetBool", "success: true");
        {ODOM};
        !assert_true(odom(2, 90));
        .wait(2000);
        !assert_published("cmd_vel", "linear.x: -0.5", 10);
        !assert_published("/cmd_vel", "{{linear.x: 0, angular.z: 0}}");
        !assert_called("light", "data: true", 1);
        !assert_printed("far, towards 90");
        !assert_printed("back")
    """)
    assert outcome.passed, told(outcome)
    assert outcome.assertions == 6


def test_a_service_refuses_and_answers_can_be_replaced(run: Run) -> None:
    [outcome] = run(f"""
        !fake_service("light", "std_srvs/srv/SetBool", "success: true");
        !fake_service("light", "std_srvs/srv/SetBool", "{{success: false, message: broken}}");
        {ODOM};
        .wait(2000);
        !assert_printed("no way: service /light refused: broken")
    """)
    assert outcome.passed, told(outcome)


def test_types_of_the_users_own_and_names_of_constants(run: Run) -> None:
    [outcome] = run('!fake_message(state, "mode: MODE_BUSY"); !assert_true(status(busy))')
    assert outcome.passed, told(outcome)


def test_a_type_that_the_mapping_leaves_out_is_that_of_a_listener(run: Run) -> None:
    [outcome] = run("""
        !fake_subscriber("velocity", "geometry_msgs/msg/Twist");
        any_drive(0.2);
        !assert_published("velocity", "linear.x: 0.2")
    """)
    assert outcome.passed, told(outcome)


def test_the_graph_is_empty_unless_a_world_is_named(run: Run) -> None:
    [outcome] = run(".wait(2000); !assert_false(odom(_, _)); !assert_not_published(cmd_vel)")
    assert outcome.passed, told(outcome)
    [outcome] = run(".wait(2000); !assert_true(odom(0, 0))", world="empty")
    assert outcome.passed, told(outcome)


def test_the_option_gives_all_tests_a_mapping(run: Run, files: Path) -> None:
    [outcome] = run(
        f"{ODOM}; !assert_true(odom(2, 90))", label="[test]", mappings=(str(files / "robot.yaml"),)
    )
    assert outcome.passed, told(outcome)


def test_a_missing_message_is_reported_with_the_published_ones(run: Run) -> None:
    [outcome] = run(
        'drive(0.5, 1); !assert_published("cmd_vel", "linear.x: 0.7"); !assert_not_published("cmd_vel")'
    )
    assert "expected  a message on cmd_vel with linear.x: 0.7" in told(outcome)
    assert "but       found 10 times {linear: {x: 0.5}}, {}" in told(outcome)
    assert "expected  no message on cmd_vel" in told(outcome)
    [outcome] = run('!assert_published("cmd_vel", "linear.x: 0.7", 3)')
    assert "3 times a message on cmd_vel" in told(outcome)
    assert "found none" in told(outcome)


@pytest.mark.parametrize(
    ("body", "text"),
    [
        (
            '!fake_message("odm", "")',
            "unknown type of /odm, which has no subscription; did you mean `/odom`?",
        ),
        ('!fake_message("a", "")', "pass its type as the second argument"),
        ('!fake_message("odom", "pose.x: 1")', "has no field `x`"),
        ('!fake_message("odom", "{pose: {pose: 1}}")', "write their paths: pose.pose: ..."),
        ('!fake_message("odom", "{a: ")', "this bracket is never closed"),
        ('!fake_message("odom", "just words")', "must be a mapping"),
        ('!fake_message("a", "std_msgs/Strin", "")', "std_msgs/msg/Strin is not known here"),
        ('!fake_message("a b", "std_msgs/String", "")', "is not a ROS name"),
        ('!fake_service("a", "std_srvs/srv/Triger", "")', "std_srvs/srv/Triger is not known here"),
        ('!fake_subscriber("a", "std_srvs/srv/Trigger")', "std_srvs/srv/Trigger"),
        ('!assert_called("light", "")', "unknown service /light; call fake_service first"),
        ('drive(1, 0.1); !assert_published("cmd_vel", "linear.q: 1")', "has no field `q`"),
        ('!assert_published("a b", "x: 1")', "'a b' is not a ROS name"),
        ('!assert_not_published("a b")', "'a b' is not a ROS name"),
        ('!assert_called("a b", "")', "'a b' is not a ROS name"),
    ],
)
def test_mistakes_are_reported_at_the_assertion(run: Run, body: str, text: str) -> None:
    [outcome] = run(body)
    assert text in told(outcome)
    assert "robot_test.asl:" in told(outcome)
    assert "Traceback" not in told(outcome)


def test_times_are_compared_too(run: Run) -> None:
    [right, wrong] = run(
        'report; !assert_published("report", "stamp: now")', 'report; !assert_published("report", "stamp: 5")'
    )
    assert right.passed, told(right)
    assert "a message on report with stamp: 5" in told(wrong)


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
    held: list[FakeGraph] = []

    def play(mas: System) -> None:
        graph = FakeGraph(mas.ros)
        held.append(graph)
        graph.answer("light", "std_srvs/srv/SetBool", {"success": True})
        graph.publish("odom", {"pose": {"pose": {"position": {"x": 2.0}}}})

    result = run_project(
        program, mappings=[files / "robot.yaml"], world="none", when_started=play, seconds=5.0
    )
    assert result.lines == ["[robot] far, towards 0", "[robot] back"], result.errors
    assert [message.linear.x for message in held[0].published("cmd_vel")] == [-0.5] * 10 + [0.0]
    assert [request.data for request in held[0].asked("light")] == [True]
    assert result.ground_truth is None


def test_a_fake_service_that_no_artifact_can_call_is_reported(run: Run) -> None:
    serve = '!fake_service("{}", "std_srvs/srv/SetBool", "success: true")'
    [unused, misspelt] = run(serve.format("light"), serve.format("lihgt"))
    assert unused.problems == []
    assert "no artifact calls the service /lihgt of fake_service; did you mean `/light`?" in told(misspelt)
