"""`jacaros ros check`: mapping files compared with the graph of the embedded world; and what `ros map` writes is run."""

from collections.abc import Callable
from pathlib import Path

import pytest
from command_lab import Outcome

from jacaros.runtime.cli.main import call

Checked = Callable[..., str]


@pytest.fixture
def checked(outcome: Outcome, tmp_path: Path) -> Checked:
    """Return the report about a mapping that does not match."""

    def check(text: str, *options: str) -> str:
        file = tmp_path / "robot.yaml"
        file.write_text(text, encoding="utf-8")
        code, output, errors = outcome("ros", "check", str(file), "--world", "house", *options)
        assert code == 1
        assert "Traceback" not in errors
        return output.replace(f"{tmp_path}/", "")

    return check


def test_problems_are_reported_once_in_line_order_and_names_suggested(
    tmp_path: Path, checked: Checked
) -> None:
    told = checked("properties:\n  a: {topic: odom, type: nav_msgs/msg/Odometri}\n")
    assert "expected the type `nav_msgs/msg/Odometry`, found `nav_msgs/msg/Odometri`" in told
    assert "is not known here" not in told
    told = checked("namespace: r1\nproperties:\n  pose: {topic: odom}\n")
    assert "no node publishes `/r1/odom`" in told
    assert "did you mean `/odom`?" in told
    told = checked("properties:\n  a: {topic: aa}\n  b: {topic: bb}\n  c: odom\n")
    assert told.index("robot.yaml:2:") < told.index("robot.yaml:3:")
    assert "robot.yaml:4:" not in told


@pytest.mark.parametrize(
    ("text", "problem", "help"),
    [
        (
            "properties:\n  pose: {topic: odm}\n",
            "robot.yaml:2:17: no node publishes `/odm`",
            "did you mean `odom`?",
        ),
        (
            "properties:\n  pose: {topic: wheels, type: nav_msgs/msg/Odometry}\n",
            "no node publishes `/wheels`",
            "did you mean `odom`?",
        ),
        (
            "operations:\n  go: {action: navigate, type: irobot_create_msgs/action/Undock}\n",
            "no node offers the action `/navigate`",
            "did you mean `undock`?",
        ),
        (
            "properties:\n  pose: {topic: cmd_vel}\n",
            "robot.yaml:2:17: no node publishes `/cmd_vel`; it has only subscriptions, by /world",
            "`publish`",
        ),
        (
            "properties:\n  pose: {topic: odom, type: nav_msgs/msg/Path}\n",
            "robot.yaml:2:29: expected the type `nav_msgs/msg/Odometry`, found `nav_msgs/msg/Path`",
            "type: nav_msgs/msg/Odometry",
        ),
        (
            "properties:\n  pose: {topic: odom, fields: [pose.pose.positon.x]}\n",
            "geometry_msgs/msg/Pose has no field `positon`",
            "did you mean `position`?",
        ),
        (
            "properties:\n  pose: {topic: odom, qos: latched}\n",
            "incompatible QoS with /world on /odom: the subscription requests transient_local",
            "write qos: default",
        ),
        (
            "operations:\n  go: {parameters: [x], publish: cmd_vl, type: geometry_msgs/Twist, fields: {linear.x: $x}}\n",
            "no node subscribes to `/cmd_vl`",
            "did you mean `cmd_vel`?",
        ),
        (
            "operations:\n  go: {action: navigate_to_pos, type: nav2_msgs/action/NavigateToPose}\n",
            "robot.yaml:2:16: no node offers the action `/navigate_to_pos`",
            "did you mean `navigate_to_pose`",
        ),
        (
            "operations:\n  go: {action: dock, type: nav2_msgs/action/DockRobot}\n",
            "expected the type `irobot_create_msgs/action/Dock`, found `nav2_msgs/action/DockRobot`",
            "type: irobot_create_msgs/action/Dock",
        ),
        (
            "operations:\n  ask: {service: nothing, type: std_srvs/srv/Trigger}\n",
            "no node offers the service `/nothing`",
            "`jacaros ros list` shows all names",
        ),
        (
            "frames:\n  pose: {target: map, source: base_footprnt}\n",
            "robot.yaml:2:3: unknown frame `base_footprnt`",
            "did you mean `base_footprint`?",
        ),
        (
            "namespace: r1\nframes:\n  pose: {target: map, source: base_footprint}\n",
            "unknown frame `r1/base_footprint`",
            'write tf_prefix: ""',
        ),
        (
            "operations:\n  limit: {set_parameter: speed, node: wrld, value: 1}\n",
            "robot.yaml:2:3: unknown node `/wrld`",
            "did you mean `/world`?",
        ),
        (
            "operations:\n  limit: {parameters: [v], set_parameter: nothing, node: world, value: $v}\n",
            "unknown parameter `nothing` of node `/world`",
            "its parameters: ",
        ),
    ],
)
def test_each_problem_has_a_location_and_a_suggested_fix(
    tmp_path: Path, text: str, problem: str, help: str, checked: Checked
) -> None:
    told = checked(text)
    assert problem in told
    assert help in told


def test_mistakes_in_the_mapping_file_itself_are_reported(tmp_path: Path, outcome: Outcome) -> None:
    file = tmp_path / "wrong.yaml"
    file.write_text("propertys: {}\n", encoding="utf-8")
    code, _, errors = outcome("ros", "check", str(file))
    assert code == 1
    assert "did you mean `properties`?" in errors
    code, _, errors = outcome("ros", "check", str(tmp_path / "absent.yaml"))
    assert code == 1
    assert "mapping file not found" in errors


PROGRAM = """
!go.

+!go
  <- .wait(odom(_, _, _));
     navigate_to(1, 0.5, 90);
     ?pose(X, Y, _);
     ?battery(_, Status);
     .print(math.round(X * 2) / 2, " ", math.round(Y * 2) / 2, " ", Status);
     drive(0.2, 0, 1);
     stop;
     .stopMAS.
"""


def test_a_generated_mapping_is_valid_matches_the_graph_and_runs(tmp_path: Path, outcome: Outcome) -> None:
    file, program = str(tmp_path / "robot.yaml"), tmp_path / "go.asl"
    program.write_text(PROGRAM, encoding="utf-8")
    assert outcome("ros", "map", "--world", "house", "-o", file)[0] == 0
    assert outcome("check", file, "--strict")[0] == 0
    assert outcome("ros", "check", file, "--world", "house") == (
        0,
        f"{file} matches this graph\n",
        "",
    )
    run = ("run", str(program), "--mapping", file, "--world", "house", "--clock", "fast", "--for", "300")
    code, output, errors = outcome(*run)
    assert (code, output) == (0, "[go] 1 0.5 discharging\n"), errors


@pytest.mark.parametrize("world", ["house", "two_robots"])
def test_everything_of_a_graph_can_be_mapped(tmp_path: Path, world: str, outcome: Outcome) -> None:
    code, listed, _ = outcome("ros", "list", "--world", world)
    names = [line.split()[1] for line in listed.splitlines() if not line.startswith("node")]
    assert len(names) > 20
    file = str(tmp_path / "all.yaml")
    assert outcome("ros", "map", *names, "--world", world, "-o", file)[0] == 0
    code, _, errors = outcome("check", file, "--strict")
    assert code == 0, errors
    code, output, _ = outcome("ros", "check", file, "--world", world)
    assert code == 0, output


def test_lists_of_poses_are_filled(tmp_path: Path, outcome: Outcome) -> None:
    file, program = str(tmp_path / "ways.yaml"), tmp_path / "go.asl"
    program.write_text(
        "!go. +!go <- follow_waypoints([place(0.4, 0, 0), place(0.4, 0.4, 90)]); .print(there); .stopMAS.",
        encoding="utf-8",
    )
    assert outcome("ros", "map", "/follow_waypoints", "--world", "house", "-o", file)[0] == 0
    run = ("run", str(program), "--mapping", file, "--world", "house", "--clock", "fast", "--for", "300")
    code, output, errors = outcome(*run)
    assert (code, output) == (0, "[go] there\n"), errors


def test_the_namespace_option_applies_to_frames(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "frames.yaml"
    file.write_text("frames: {pose: {target: odom, source: base_footprint}}\n", encoding="utf-8")
    arguments = ["ros", "check", str(file), "--world", "two_robots", "--namespace"]
    assert call([*arguments, "robot_1"]) == 0
    assert call([*arguments, "robot_7"]) == 1
    assert "unknown frame `robot_7/odom`" in capsys.readouterr().out
