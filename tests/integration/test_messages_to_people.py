"""Mistakes, and what people read about them: the whole text on standard error, with place and help."""

import os
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import pytest

JACAROS = str(Path(sys.executable).parent / "jacaros")

NO_ROSPY = """\
error: --ros ros1 needs the package rospy (No module named 'rospy')
  = help: on Debian 12 install python3-rospy and the message packages with apt-get and use a venv made by \
`/usr/bin/python3 -m venv --system-site-packages`; tools/install_ros1.sh does both. \
On a robot with its own ROS 1, source its setup file first
"""
NO_RCLPY = """\
error: --ros ros2 needs the package rclpy (No module named 'rclpy')
  = help: on Linux x86-64 run `pip install 'jacaros[ros2]'`; tools/install_ros2.sh makes a complete venv. \
On a robot with its own ROS 2, source its setup file first
"""

COUNTER = """\
from jacaros.artifacts import Artifact, operation


class Counter(Artifact):
    def init(self, start: int = 0) -> None:
        self.define_property("count", start)

    @operation
    def check(self, limit: int) -> None:
        if self.value("count") > limit:
            self.fail("too many", "too_many", self.value("count"))
"""


class Project:
    """A folder with the files of a mistaken user."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def write(self, name: str, text: str) -> None:
        (self._folder / name).write_text(dedent(text), encoding="utf-8")

    def run(self, *arguments: str, **environment: str) -> tuple[int, str, str]:
        """Call ``jacaros`` in the folder; exit code, standard output and standard error with plain paths."""
        done = subprocess.run(
            [JACAROS, *arguments],
            cwd=self._folder,
            env=os.environ | environment,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )
        assert "Traceback" not in done.stderr
        return done.returncode, done.stdout, done.stderr.replace(f"{self._folder}/", "")

    def run_file(self, name: str) -> tuple[int, str, str]:
        """Run a project file until all agents are idle."""
        return self.run("run", name, "--clock", "fast", "--until-idle")


def told(code: int, errors: str) -> tuple[int, str, str]:
    """What a call gives that ends with *code* and says *errors*, after the agents have printed nothing."""
    return code, "", dedent(errors)


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return Project(tmp_path)


def test_a_syntax_error_in_a_program(project: Project) -> None:
    project.write(
        "robot.asl",
        """\
        !start.

        +!start : ready
          <- .print("a");
             .print("b"
             .print("c").
        """,
    )
    assert project.run_file("robot.asl") == told(
        1,
        """\
        robot.asl:6:6: error: unclosed `(`: expected `)`, found `.print`
          5 |      .print("b"
            |            ^
          6 |      .print("c").
            |      ^^^^^^
          = help: close it with `)`; it was opened at line 5, column 12
        """,
    )


def test_a_syntax_error_in_a_jcm_file(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    project.write(
        "house.jcm",
        """\
        mas house {
            agent robot : robot.asl
            workspace kitchen {
                artifact clock Clock(1)
            }
        }
        """,
    )
    assert project.run_file("house.jcm") == told(
        1,
        """\
        house.jcm:4:24: error: expected `:`, found `Clock`
          4 |         artifact clock Clock(1)
            |                        ^^^^^
          = help: write `artifact name : Class(arguments)`
        """,
    )


def test_a_syntax_error_in_a_mas2j_file(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    project.write("house.mas2j", "MAS house {\n    agents: robot\n}\n")
    assert project.run_file("house.mas2j") == told(
        1,
        """\
        house.mas2j:3:1: error: expected `;` after agent `robot`, found `}`
          3 | }
            | ^
          = help: end each agent with `;`
        """,
    )


def test_an_unknown_artifact_class_in_a_program(project: Project) -> None:
    project.write("robot.asl", '!start.\n+!start\n  <- makeArtifact("odom", "ArtOdometri").\n')
    assert project.run_file("robot.asl") == told(
        0,
        "[robot] warning: the goal !start failed and has no plan for its failure: action_failed, "
        "unknown artifact type `ArtOdometri`; "
        "did you mean `ArtOdometry` or `ArtOdometryOnDemand`? (robot.asl:3)\n"
        '  step: makeArtifact("odom","ArtOdometri")\n'
        '  reason: env_failure_reason(makeArtifactFailure("unknown_artifact_template","ArtOdometri"))\n',
    )


def test_an_unknown_artifact_class_in_a_jcm_file(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    project.write("artifacts.py", COUNTER)
    project.write(
        "house.jcm",
        """\
        mas house {
            agent robot : robot.asl
            workspace kitchen {
                artifact visitors : Countr(1)
            }
        }
        """,
    )
    assert project.run_file("house.jcm") == told(
        1,
        """\
        house.jcm:4:29: error: unknown artifact type `Countr`; did you mean `Counter`?
          4 |         artifact visitors : Countr(1)
            |                             ^^^^^^
        """,
    )


def test_an_unknown_operation(project: Project) -> None:
    project.write("artifacts.py", COUNTER)
    project.write("robot.asl", '!start.\n+!start\n  <- makeArtifact("visitors", "Counter");\n     chek(3).\n')
    assert project.run_file("robot.asl") == told(
        0,
        "[robot] warning: the goal !start failed and has no plan for its failure: action_failed, "
        "no artifact of workspace /main has an operation chek/1; did you mean `check/1` of 'visitors'? "
        "(robot.asl:4)\n"
        '  step: chek(3)\n  reason: env_failure_detail(unknown_operation("chek/1"))\n',
    )


def test_an_unknown_internal_action(project: Project) -> None:
    project.write("robot.asl", "!start.\n+!start\n  <- .nosuchaction(3).\n")
    assert project.run_file("robot.asl")[2].endswith(
        "action_failed, no artifact of workspace /main has an operation .nosuchaction/1; unknown internal action "
        "`.nosuchaction` (robot.asl:3)\n"
        "  step: .nosuchaction(3)\n"
        '  reason: env_failure_detail(unknown_operation(".nosuchaction/1"))\n'
    )


def test_an_argument_of_the_wrong_type(project: Project) -> None:
    project.write("artifacts.py", COUNTER)
    project.write("robot.asl", '!start.\n+!start\n  <- makeArtifact("c", "Counter");\n     check("many").\n')
    assert project.run_file("robot.asl") == told(
        0,
        "[robot] warning: the goal !start failed and has no plan for its failure: action_failed, "
        'operation check/1 of artifact c: argument 1 (limit): expected an integer, found "many" '
        "(robot.asl:4)\n"
        '  step: check("many")\n  reason: env_failure_reason(wrong_op_arguments(cobj_3,"check/1"))\n',
    )


def test_an_argument_of_the_wrong_type_for_a_declared_artifact(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    project.write("artifacts.py", COUNTER)
    project.write(
        "house.jcm",
        """\
        mas house {
            agent robot : robot.asl
            workspace kitchen {
                artifact visitors : Counter("none")
            }
        }
        """,
    )
    assert project.run_file("house.jcm") == told(
        1,
        """\
        house.jcm:4:18: error: cannot create artifact visitors (Counter): operation init/1 of artifact visitors: \
argument 1 (start): expected an integer, found "none"
          4 |         artifact visitors : Counter("none")
            |                  ^^^^^^^^
        """,
    )


def test_an_unknown_option_of_an_artifact(project: Project) -> None:
    project.write(
        "robot.asl", '!start.\n+!start\n  <- makeArtifact("battery", "ArtSimBattery", [drian(2)], _).\n'
    )
    assert project.run_file("robot.asl") == told(
        0,
        "[robot] warning: the goal !start failed and has no plan for its failure: action_failed, "
        "cannot create artifact battery (ArtSimBattery): ArtSimBattery has no option `drian`; "
        "its options: dock_timeout, drain, expire, level, low, medium, namespace, source, topic, watch_connection "
        "(robot.asl:3)\n"
        '  step: makeArtifact("battery","ArtSimBattery",[drian(2)],_)\n'
        '  reason: env_failure_reason(makeArtifactFailure("init_failed","battery"))\n',
    )


def test_a_mistake_in_the_projects_own_artifacts(project: Project) -> None:
    project.write("artifacts.py", COUNTER.replace("(Artifact):", "(Artifact)"))
    project.write("robot.asl", "!start. +!start <- .print(done).")
    assert project.run_file("robot.asl") == told(1, "error: artifacts.py:4: expected ':'\n")


def test_an_operation_that_fails_reaches_the_plan_with_its_reason(project: Project) -> None:
    project.write("artifacts.py", COUNTER)
    project.write(
        "robot.asl",
        """\
        !start.

        +!start
          <- makeArtifact("visitors", "Counter", [7]);
             !check(3);
             .print("and on").

        +!check(Limit)
          <- check(Limit).

        -!check(Limit)[error(Error), error_msg(Text), env_failure_reason(Reason), code(Code), code_line(Line)]
          <- .print(Error, "; ", Text, "; ", Reason, "; ", Code, "; ", Line).
        """,
    )
    assert project.run_file("robot.asl") == (
        0,
        "[robot] action_failed; too many; too_many(7); check(3); 9\n[robot] and on\n",
        "",
    )


@pytest.mark.parametrize(("kind", "message"), [("ros1", NO_ROSPY), ("ros2", NO_RCLPY)])
@pytest.mark.parametrize("command", [("run", "robot.asl"), ("sim", "empty")])
def test_a_missing_ros(project: Project, kind: str, message: str, command: tuple[str, str]) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    # Where the libraries are installed, these stand before them and are missing all the same.
    for library in ("rospy", "rclpy"):
        text = f"raise ModuleNotFoundError(\"No module named '{library}'\", name='{library}')\n"
        project.write(f"{library}.py", text)
    path = os.pathsep.join([".", *filter(None, [os.environ.get("PYTHONPATH")])])
    assert project.run(*command, "--ros", kind, PYTHONPATH=path) == told(1, message)


def test_the_fast_clock_with_a_real_graph(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    assert project.run("run", "robot.asl", "--ros", "ros1", "--clock", "fast") == told(
        2,
        "error: --clock fast excludes a real ROS graph (--ros ros1), whose nodes run in real time; "
        "use --clock real\n",
    )


def test_a_file_that_is_not_there(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    assert project.run("run", "robott.asl") == told(
        2,
        "error: file not found: `robott.asl`\n  = help: did you mean `robot.asl`?\n",
    )


def test_a_world_that_is_not_there(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    assert project.run("run", "robot.asl", "--world", "nowhere") == told(
        1,
        "error: world not found: `nowhere`\n"
        "  = help: give the path of a world file, or one of the shipped worlds: "
        "empty, flat, house, maze, office, patrol, three_robots, two_robots, warehouse\n",
    )


def test_a_project_that_names_no_world(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    project.write(
        "practice.jcm",
        """\
        mas practice {
          agent robot
          world: "patrl"
        }
        """,
    )
    wrong = (
        "practice.jcm:3:10: error: world not found: `patrl`{}\n"
        '  3 |   world: "patrl"\n'
        "    |          ^^^^^^^\n"
        "  = help: did you mean `patrol`?\n"
    )
    assert project.run("run", "practice.jcm") == told(1, wrong.format(""))
    code, output, _ = project.run("check", "practice.jcm")
    assert (code, output) == (1, wrong.format(" [wrong-project]") + "\n")


def test_a_mistake_in_a_world_file(project: Project) -> None:
    project.write("robot.asl", "!start. +!start <- .print(done).")
    project.write("yard.yaml", "robots:\n  - name: a\n    pos: {x: 1}\n")
    assert project.run("run", "robot.asl", "--world", "yard.yaml") == told(
        1,
        "yard.yaml:3:5: error: item 1 of 'robots' has no key 'pos'\n"
        "    3 |     pos: {x: 1}\n"
        "            ^\n"
        "  = help: did you mean `pose`?\n",
    )


def test_commands_without_a_subscriber_are_logged_once(project: Project) -> None:
    project.write(
        "robot.yaml",
        """\
        operations:
          drive:
            publish: cmd_velo
            type: geometry_msgs/msg/Twist
            fields: {linear.x: 0.1}
            rate: 5
            duration: 1
        """,
    )
    project.write("hasty.asl", "!go. +!go <- drive; drive; .print(done); .stopMAS.")
    code, output, errors = project.run(
        "run", "hasty.asl", "--mapping", "robot.yaml", "--world", "house", "--clock", "fast"
    )
    assert (code, output) == (0, "[hasty] done\n")
    assert errors == (
        "[robot] robot.yaml:3:14: no subscriber on topic /cmd_velo; publishing anyway\n"
        "    3 |     publish: cmd_velo\n"
        "                     ^\n"
        "  = help: start the node that subscribes to it; `jacaros ros list` shows the topics of the graph\n"
    )
