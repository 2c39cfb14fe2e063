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

DONE = "!start. +!start <- .print(done)."
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


HOUSE = """\
mas house {
    agent robot : robot.asl
    workspace kitchen {
        artifact ARTIFACT
    }
}
"""


class Project:
    """A folder with the files of a mistaken user: a program, an artifact, and what a test adds."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.write("robot.asl", DONE)
        self.write("artifacts.py", COUNTER)

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
        """Run a file until all agents are idle."""
        return self.run("run", name, "--clock", "fast", "--until-idle")


def told(code: int, errors: str) -> tuple[int, str, str]:
    """What a call gives that ends with *code* and says *errors*, after the agents have printed nothing."""
    return code, "", dedent(errors)


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return Project(tmp_path)


FILES = {
    "a syntax error in a program": (
        "robot.asl",
        """\
        !start.

        +!start : ready
          <- .print("a");
             .print("b"
             .print("c").
        """,
        """\
        robot.asl:6:6: error: unclosed `(`: expected `)`, found `.print`
          5 |      .print("b"
            |            ^
          6 |      .print("c").
            |      ^^^^^^
          = help: close it with `)`; it was opened at line 5, column 12
        """,
    ),
    "a syntax error in a jcm file": (
        "house.jcm",
        HOUSE.replace("ARTIFACT", "clock Clock(1)"),
        """\
        house.jcm:4:24: error: expected `:`, found `Clock`
          4 |         artifact clock Clock(1)
            |                        ^^^^^
          = help: write `artifact name : Class(arguments)`
        """,
    ),
    "a syntax error in a mas2j file": (
        "house.mas2j",
        "MAS house {\n    agents: robot\n}\n",
        """\
        house.mas2j:3:1: error: expected `;` after agent `robot`, found `}`
          3 | }
            | ^
          = help: end each agent with `;`
        """,
    ),
    "an unknown artifact class": (
        "house.jcm",
        HOUSE.replace("ARTIFACT", "visitors : Countr(1)"),
        """\
        house.jcm:4:29: error: unknown artifact type `Countr`; did you mean `Counter`?
          4 |         artifact visitors : Countr(1)
            |                             ^^^^^^
        """,
    ),
    "an argument of the wrong type": (
        "house.jcm",
        HOUSE.replace("ARTIFACT", 'visitors : Counter("none")'),
        """\
        house.jcm:4:18: error: cannot create artifact visitors (Counter): operation init/1 of artifact visitors: \
argument 1 (start): expected an integer, found "none"
          4 |         artifact visitors : Counter("none")
            |                  ^^^^^^^^
        """,
    ),
    "an artifact of the project": (
        "artifacts.py",
        COUNTER.replace("(Artifact):", "(Artifact)"),
        "error: artifacts.py:4: expected ':'\n",
    ),
}


@pytest.mark.parametrize("mistake", FILES)
def test_a_mistake_in_a_file(project: Project, mistake: str) -> None:
    name, text, errors = FILES[mistake]
    project.write(name, text)
    assert project.run_file(name.replace("artifacts.py", "robot.asl")) == told(1, errors)


NO_OPERATION = "no artifact of workspace /main has an operation"
BATTERY = "dock_timeout, drain, expire, level, low, medium, namespace, source, topic, watch_connection"
STEPS = {
    "an unknown artifact class": (
        'makeArtifact("odom","ArtOdometri")',
        "unknown artifact type `ArtOdometri`; did you mean `ArtOdometry` or `ArtOdometryOnDemand`?",
        'env_failure_reason(makeArtifactFailure("unknown_artifact_template","ArtOdometri"))',
    ),
    "an unknown operation": (
        "chek(3)",
        f"{NO_OPERATION} chek/1; did you mean `check/1` of 'visitors'?",
        'env_failure_detail(unknown_operation("chek/1"))',
    ),
    "an unknown internal action": (
        ".nosuchaction(3)",
        f"{NO_OPERATION} .nosuchaction/1; unknown internal action `.nosuchaction`",
        'env_failure_detail(unknown_operation(".nosuchaction/1"))',
    ),
    "an argument of the wrong type": (
        'check("many")',
        'operation check/1 of artifact visitors: argument 1 (limit): expected an integer, found "many"',
        'env_failure_reason(wrong_op_arguments(cobj_3,"check/1"))',
    ),
    "an unknown option of an artifact": (
        'makeArtifact("battery","ArtSimBattery",[drian(2)],_)',
        f"cannot create artifact battery (ArtSimBattery): ArtSimBattery has no option `drian`; its options: {BATTERY}",
        'env_failure_reason(makeArtifactFailure("init_failed","battery"))',
    ),
}
"""Wrong steps, and what is read about their goals: the message and the reason."""
UNKNOWN_ACTION = """\
robot.asl:4:6: warning: unknown internal action `.nosuchaction`
  4 |      .nosuchaction(3).
    |      ^^^^^^^^^^^^^^^^
"""


@pytest.mark.parametrize("mistake", STEPS)
def test_a_mistake_in_a_step(project: Project, mistake: str) -> None:
    step, message, reason = STEPS[mistake]
    program = f'!start.\n+!start\n  <- makeArtifact("visitors", "Counter");\n     {step}.\n'
    lost = "[robot] warning: the goal !start failed and has no plan for its failure: action_failed, "
    errors = f"{lost}{message} (robot.asl:4)\n  step: {step}\n  reason: {reason}\n"
    before = UNKNOWN_ACTION if step.startswith(".") else ""
    project.write("robot.asl", program)
    assert project.run_file("robot.asl") == told(0, before + errors)


def test_an_operation_that_fails_reaches_the_plan_with_its_reason(project: Project) -> None:
    program = """\
        !start.

        +!start
          <- makeArtifact("visitors", "Counter", [7]);
             !check(3);
             .print("and on").

        +!check(Limit)
          <- check(Limit).

        -!check(Limit)[error(Error), error_msg(Text), env_failure_reason(Reason), code(Code), code_line(Line)]
          <- .print(Error, "; ", Text, "; ", Reason, "; ", Code, "; ", Line).
        """
    output = "[robot] action_failed; too many; too_many(7); check(3); 9\n[robot] and on\n"
    project.write("robot.asl", program)
    assert project.run_file("robot.asl") == (0, output, "")


@pytest.mark.parametrize(("kind", "message"), [("ros1", NO_ROSPY), ("ros2", NO_RCLPY)])
@pytest.mark.parametrize("command", [("run", "robot.asl"), ("sim", "empty")])
def test_a_missing_ros(project: Project, kind: str, message: str, command: tuple[str, str]) -> None:
    # Where the libraries are installed, these stand before them and are missing all the same.
    for library in ("rospy", "rclpy"):
        text = f"raise ModuleNotFoundError(\"No module named '{library}'\", name='{library}')\n"
        project.write(f"{library}.py", text)
    path = os.pathsep.join([".", *filter(None, [os.environ.get("PYTHONPATH")])])
    assert project.run(*command, "--ros", kind, PYTHONPATH=path) == told(1, message)


COMMANDS = {
    "the fast clock with a real graph": (
        ("robot.asl", "--ros", "ros1", "--clock", "fast"),
        2,
        """\
        error: --clock fast excludes a real ROS graph (--ros ros1), whose nodes run in real time; use --clock real
        """,
    ),
    "a file that is not there": (
        ("robott.asl",),
        2,
        """\
        error: file not found: `robott.asl`
          = help: did you mean `robot.asl`?
        """,
    ),
    "a world that is not there": (
        ("robot.asl", "--world", "nowhere"),
        1,
        """\
        error: world not found: `nowhere`
          = help: give the path of a world file, or one of the shipped worlds: \
empty, flat, house, maze, office, patrol, three_robots, two_robots, warehouse
        """,
    ),
}


@pytest.mark.parametrize("mistake", COMMANDS)
def test_a_mistake_in_a_command(project: Project, mistake: str) -> None:
    arguments, code, errors = COMMANDS[mistake]
    assert project.run("run", *arguments) == told(code, errors)


def test_a_project_that_names_no_world(project: Project) -> None:
    project.write("practice.jcm", 'mas practice {\n  agent robot\n  world: "patrl"\n}\n')
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
    project.write("yard.yaml", "robots:\n  - name: a\n    pos: {x: 1}\n")
    assert project.run("run", "robot.asl", "--world", "yard.yaml") == told(
        1,
        "yard.yaml:3:5: error: item 1 of 'robots' has no key 'pos'\n"
        "    3 |     pos: {x: 1}\n"
        "            ^\n"
        "  = help: did you mean `pose`?\n",
    )


def test_commands_without_a_subscriber_are_logged_once(project: Project) -> None:
    mapping = """\
        operations:
          drive:
            publish: cmd_velo
            type: geometry_msgs/msg/Twist
            fields: {linear.x: 0.1}
            rate: 5
            duration: 1
        """
    project.write("robot.yaml", mapping)
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
