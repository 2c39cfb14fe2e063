"""Mapping files in runs, projects and checks: from the command line to the robot of the embedded world."""

from pathlib import Path
from textwrap import dedent

import pytest

from jacaros.runtime.cli.main import call

ROBOT = """
    properties:
      odom: {topic: odom, fields: [pose.pose.position.x, pose.pose.position.y], rate: 5}
    frames:
      pose: {target: map, source: base_link, rate: 5}
    operations:
      drive:
        parameters: [speed, seconds]
        publish: cmd_vel
        type: geometry_msgs/msg/Twist
        fields: {linear.x: $speed}
        rate: 10
        duration: $seconds
      navigate_to:
        parameters: [x, y]
        action: navigate_to_pose
        type: nav2_msgs/action/NavigateToPose
        goal: {pose.header.frame_id: map, pose.header.stamp: now, pose.pose.position.x: $x, pose.pose.position.y: $y}
        feedback: {left: [distance_remaining]}
        suspend: cancel
    """

DRIVE = """
    !start.
    +!start <- drive(0.5, 2); .wait(1000); ?odom(X, _); .print("at ", math.round(X * 10) / 10); .stopMAS.
    """


class Folder:
    """A folder with a mapping and a program, in which commands are called."""

    def __init__(self, path: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.path, self._capsys = path, capsys
        self.write("robot.yaml", ROBOT)
        self.write("drive.asl", DRIVE)

    def write(self, name: str, text: str) -> None:
        (self.path / name).write_text(dedent(text), encoding="utf-8")

    def call(self, *arguments: str) -> tuple[int, list[str], str]:
        """Exit code, lines and errors of a command; a run is on the virtual clock."""
        code = call([*arguments, *(["--clock", "fast"] if arguments[0] == "run" else [])])
        told = self._capsys.readouterr()
        return code, told.out.splitlines(), told.err


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Folder:
    monkeypatch.chdir(tmp_path)
    return Folder(tmp_path, capsys)


def test_a_lone_program_focuses_what_the_option_names(folder: Folder) -> None:
    assert folder.call("run", "drive.asl", "--mapping", "robot.yaml") == (0, ["[drive] at 1"], "")


def test_a_mapping_file_may_be_of_another_folder(folder: Folder) -> None:
    (folder.path / "maps").mkdir()
    (folder.path / "robot.yaml").rename(folder.path / "maps" / "turtle.yaml")
    assert folder.call("run", "drive.asl", "--mapping", "maps/turtle.yaml") == (0, ["[drive] at 1"], "")


JCM = 'mas p { agent drive { focus: main.robot }\n  mapping: "robot.yaml"\n}'
MAS2J = 'MAS p { mapping: "robot.yaml" agents: drive; }'


@pytest.mark.parametrize(("name", "project"), [("p.jcm", JCM), ("p.mas2j", MAS2J)])
def test_a_project_names_its_mapping(folder: Folder, name: str, project: str) -> None:
    folder.write(name, project)
    assert folder.call("run", name) == (0, ["[drive] at 1"], "")
    assert folder.call("check", "--strict", name) == (0, [], "nothing wrong in 3 files\n")


def test_a_check_knows_what_is_mapped(folder: Folder) -> None:
    folder.write("p.jcm", JCM)
    folder.write("drive.asl", "!start.\n\n+!start\n  <- driv(1, 2);\n     drive(1).\n")
    code, lines, _ = folder.call("check", "--strict", "p.jcm")
    assert code == 1
    assert [line for line in lines if ": warning:" in line or line.startswith("  = help")] == [
        "drive.asl:4:6: warning: unknown operation `driv/2`: no artifact of the project has it [unknown-operation]",
        "  = help: did you mean `drive`?",
        "drive.asl:5:6: warning: unknown operation `drive/1`: no artifact of the project has it [unknown-operation]",
        "  = help: did you mean `drive/2`?",
    ]


def test_a_check_of_a_project_covers_its_mapping_once(folder: Folder) -> None:
    folder.write("p.jcm", JCM)
    text = """\
        properties:
          odom: {topic: odom, type: nav_msgs/msg/Odometry, fields: [pose.x]}
          other: {topic: odom, mode: sometimes}
        """
    folder.write("robot.yaml", text)
    code, lines, _ = folder.call("check", "p.jcm")
    assert code == 1
    assert [line for line in lines if ": error:" in line] == [
        "robot.yaml:2:61: error: `pose.x`: geometry_msgs/msg/PoseWithCovariance has no field `x` [wrong-mapping]",
        "robot.yaml:3:30: error: 'mode' is 'sometimes' [wrong-mapping]",
    ]


def test_a_faulty_mapping_is_reported_before_anything_runs(folder: Folder) -> None:
    drive = "{publish: cmd_vel, type: geometry_msgs/msg/Twist, fields: {x: 1}}"
    folder.write("robot.yaml", f"operations:\n  drive: {drive}")
    code, lines, errors = folder.call("run", "drive.asl", "--mapping", "robot.yaml")
    assert (code, lines) == (1, [])
    assert "robot.yaml:2:72: error: `x`: geometry_msgs/msg/Twist has no field `x`" in errors
    fields = "linear (geometry_msgs/msg/Vector3), angular (geometry_msgs/msg/Vector3)"
    assert f"  = help: its fields: {fields}" in errors


def test_two_artifacts_of_one_name(folder: Folder) -> None:
    files = ("--mapping", "robot.yaml", "--mapping", "robot.yaml")
    code, _, errors = folder.call("run", "drive.asl", *files)
    assert code == 1
    assert "duplicate artifact `robot`" in errors


def test_an_agent_makes_the_artifact_of_a_file(folder: Folder) -> None:
    base = ROBOT.replace("\n    ", "\n      ").rstrip()
    folder.write("fleet.yaml", f"artifacts:\n  idle: {{}}\n  base:{base}")
    text = """\
        !start.
        +!start <- makeArtifact("r", "fleet.yaml#base", ["one"], Id); focus(Id);
                   drive(0.5, 1); .wait(odom(X, _) & X > 0.3); .print("driven"); !!wrong.
        +!wrong <- makeArtifact("s", "fleet.yaml", [], _).
        -!wrong[error_msg(Text)] <- .print(Text); .stopMAS.
        """
    folder.write("maker.asl", text)
    folder.write(
        "two.yaml", "robots: [{name: one, namespace: one}, {name: two, namespace: two, pose: {x: 2}}]"
    )
    code, lines, errors = folder.call("run", "maker.asl", "--world", "two.yaml")
    assert (code, errors) == (0, "")
    assert lines == [
        "[maker] driven",
        "[maker] `fleet.yaml` has 2 artifacts; write fleet.yaml#idle or fleet.yaml#base",
    ]
    assert folder.call("check", "maker.asl")[0] == 0


def test_a_robot_navigates_as_one_step_of_a_plan(folder: Folder) -> None:
    text = """\
        !start.
        +!start <- navigate_to(1, 1); ?pose(X, Y, _);
                   .print("at ", math.round(X * 10) / 10, " ", math.round(Y * 10) / 10); navigate_to(100, 1).
        +left(D) : D < 0.5 & not near <- +near; .print("nearly there").
        -!start[env_failure_reason(aborted(Code, _))] <- .print("aborted ", Code); .stopMAS.
        """
    folder.write("go.asl", text)
    lines = ["[go] nearly there", "[go] at 1 1", "[go] aborted 204"]
    assert folder.call("run", "go.asl", "--mapping", "robot.yaml") == (0, lines, "")


def test_dropping_the_intention_stops_the_robot(folder: Folder) -> None:
    text = """\
        !go. !stop.
        +!go <- navigate_to(2, 2).
        +!stop <- .wait(left(_)); .wait(1000); .drop_intention(go); .wait(2000); ?odom(X, Y);
                  .wait(2000); ?odom(X, Y); .print("stands"); .stopMAS.
        """
    folder.write("drop.asl", text)
    assert folder.call("run", "drop.asl", "--mapping", "robot.yaml") == (0, ["[drop] stands"], "")


def test_a_type_that_only_the_robot_knows_is_a_warning(folder: Folder) -> None:
    folder.write("robot.yaml", "properties: {a: {topic: t, type: acme_msgs/msg/Gripper}}")
    code, lines, _ = folder.call("check", "robot.yaml")
    assert code == 0
    assert lines[0].endswith(
        "warning: the type `acme_msgs/msg/Gripper` is not known here [unknown-message-type]"
    )
