"""The command line: exit codes, outputs and errors."""

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from command_lab import Outcome

from jacaros.robots.world import GroundTruth
from jacaros.runtime.alarm import SIGNAL

LONG = 300 * "b"
"""No file can have this name."""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "house.yaml").write_text("name: house", encoding="utf-8")
    (tmp_path / "hello.asl").write_text("!go. +!go <- .print(hi); .stopMAS(0, 3).", encoding="utf-8")
    return tmp_path


def test_a_program_prints_sets_the_exit_code_and_restores_signal_handlers(folder: Path, outcome: Outcome):
    before = [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM, SIGNAL)]
    assert outcome("run", "hello.asl", "--clock", "fast") == (3, "[hello] hi\n", "")
    assert [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM, SIGNAL)] == before


def test_run_is_the_default_command(folder: Path, outcome: Outcome) -> None:
    assert outcome("hello.asl")[:2] == (3, "[hello] hi\n")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["run", "hallo.asl"], "did you mean `hello.asl`?"),
        (["run", "."], "is a folder"),
        (["run", "hello.asl", "--clock", "fast", "--ros", "ros1"], "use --clock real"),
        (["run", "hello.asl", "--clock", "ros"], "--clock fast"),
        (["run", "hello.asl", "--remap", "odom"], "FROM:=TO"),
        (["run", "hello.asl", "--remap", "a:=b", "--remap", "a:=c"], "two new names: `b` and `c`"),
        (["run", "hello.asl", "--domain-id", "3"], "--ros ros2"),
        (["run", "hello.asl", "--clok", "fast"], "--clock"),
        (["run", "hello.asl", "--clock", "slow"], "slow"),
        (["run"], "FILE"),
        (["nonsense"], "error: unknown command: `nonsense`\n  = help: `jacaros --help` lists the commands"),
        (["chek"], "did you mean `check`?"),
        (["run", "house.yaml"], "--mapping house.yaml"),
        (["run", "hello.asl", "--worl", "x"], "error: unknown option: `--worl`\n  = help: did you mean"),
        (["run"], "error: missing argument: `FILE`"),
        (
            ["sim", "empty"],
            "error: missing option: `--ros`\n  = help: `jacaros sim --help` lists the options",
        ),
        (["run", "hello.asl", "--for", "x"], "error: --for: 'x' is not a valid float"),
        (["run", "hello"], "did you mean `hello.asl`?"),
        (["run", "hello.asl", "--ros-args", "-q"], "unknown argument after --ros-args: `-q`"),
        (["sim", "empty", "--ros", "ros2", "--clock", "fast"], "--ros memory"),
        (["sim", "empty", "--ros", "ros1", "--domain-id", "3"], "--ros ros2"),
        (["describe", "ArtOdometri"], "did you mean `ArtOdometry`"),
        (["run", "hello.asl", "--maping", "robot.yaml"], "= help: did you mean `--mapping` or"),
        (["run", f"{LONG}.asl"], "file not found"),
        (["fmt", f"{LONG}.asl"], "file not found"),
        (["describe", LONG], "unknown artifact type"),
        (["new", LONG], "File name too long"),
        (["run", "hello.asl", "--record", f"{LONG}.jsonl"], "File name too long"),
    ],
)
def test_wrong_usage_exits_with_code_2(folder: Path, outcome: Outcome, arguments: list[str], told: str):
    code, output, errors = outcome(*arguments)
    assert (code, output) == (2, "")
    assert told in errors
    assert "Traceback" not in errors


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("wrong.asl", '!go.\n+!go <- .print("hi".', "wrong.asl:2:"),
        ("wrong.mas2j", "MAS wrong { agents: absent; }", "wrong.mas2j:1:"),
        ("wrong.txt", "", "unsupported file type: wrong.txt (expected .mas2j, .jcm, .asl or .py)"),
    ],
)
def test_an_error_in_a_project_exits_with_code_1(folder: Path, outcome, name: str, text: str, told: str):
    (folder / name).write_text(text, encoding="utf-8")
    code, output, errors = outcome("run", name)
    assert (code, output) == (1, "")
    assert told in errors
    assert "Traceback" not in errors


def test_an_unhandled_failure_logs_a_warning_with_a_suggestion(folder: Path, outcome: Outcome) -> None:
    program = '!go. +!go <- makeArtifact("m", "ArtCmdVel", [], M); moveForwad(1).'
    (folder / "a.asl").write_text(program, encoding="utf-8")
    code, output, errors = outcome("run", "a.asl", "--clock", "fast", "--until-idle")
    assert (code, output) == (0, "")
    assert "did you mean `moveForward/1` of 'm'" in errors


def test_a_run_can_be_recorded_and_replayed(folder: Path, outcome: Outcome) -> None:
    arguments = ["run", "hello.asl", "--clock", "fast", "--record", "r.jsonl", "--replay", "r.html"]
    assert outcome(*arguments)[:2] == (3, "[hello] hi\n")
    kinds = [json.loads(line)["kind"] for line in (folder / "r.jsonl").read_text().splitlines()]
    assert kinds[0] == "world"
    assert "text" in kinds
    assert "<html" in (folder / "r.html").read_text()


def test_an_agent_in_python_is_run_recorded_checked_and_described(folder: Path, outcome: Outcome) -> None:
    program = "from jacaros import PythonAgent\nclass A(PythonAgent):\n    async def run(self):\n"
    program += "        self.print('hi')\n        self.stop_system(3)\n"
    (folder / "a.py").write_text(program, encoding="utf-8")
    assert outcome("a.py", "--clock", "fast") == (3, "[a] hi\n", "")
    arguments = ["run", "a.py", "--clock", "fast", "--record", "r.jsonl", "--replay", "r.html"]
    assert outcome(*arguments)[:2] == (3, "[a] hi\n")
    assert '"agent": "a", "text": "hi"' in (folder / "r.jsonl").read_text()
    (folder / "m.jcm").write_text("mas m { agent a: a.py }", encoding="utf-8")
    assert outcome("check", "a.py", "m.jcm") == (0, "", "nothing wrong in 2 files\n")
    assert "agent a: a.py" in outcome("describe", "m.jcm")[1]
    (folder / "b.py").write_text("x = 1", encoding="utf-8")
    code, output, _ = outcome("check", "b.py")
    assert (code, "no subclass of jacaros.PythonAgent in b.py" in output) == (1, True)


def test_a_world_runs_alone(folder: Path, outcome: Outcome) -> None:
    world = ["sim", "empty", "--ros", "memory", "--clock", "fast"]
    assert outcome(*world, "--for", "2", "--ground-truth", "t.jsonl")[0] == 0
    last = json.loads((folder / "t.jsonl").read_text().splitlines()[-1])
    assert last["kind"] == "end"
    assert last["time"] == pytest.approx(2.0)


def test_types_and_projects_are_described(folder: Path, outcome: Outcome) -> None:
    code, output, _ = outcome("describe", "ArtCmdVel")
    assert code == 0
    assert "moveForward(length: a number)" in output
    assert "agent hello: hello.asl" in outcome("describe", "hello.asl")[1]


def test_version_and_help_are_printed(outcome: Outcome) -> None:
    code, output, _ = outcome("version")
    assert code == 0
    assert output.startswith("jacaros 0.")
    assert outcome("--version") == (0, output.splitlines()[0] + "\n", "")
    code, output, _ = outcome("--help")
    assert code == 0
    assert "Run an agent program or a project." in output


def test_an_internal_error_prints_a_traceback_and_the_command(folder: Path, outcome, monkeypatch):
    def broken(*_: object, **__: object) -> int:
        raise ZeroDivisionError("oh")

    monkeypatch.setattr("jacaros.runtime.cli.run.launch", broken)
    code, _, errors = outcome("run", "hello.asl")
    assert code == 1
    assert "Traceback" in errors
    assert "internal error: oh; please file an issue" in errors


NOT_FOR_A_LONE_PROGRAM = (
    # other people's: robots, worlds, pictures
    *("msgspec", "numpy", "rosbags", "rich", "ruamel", "rclpy", "rospy", "yaml"),
    *("starlette", "uvicorn", "anyio", "h11", "httptools", "prompt_toolkit", "mcp", "mcp_types"),
    # Python's own that are slow to load
    *("argparse", "decimal", "difflib", "http.server", "importlib.metadata", "importlib.resources"),
    *("multiprocessing", "sqlite3", "tempfile", "unittest", "xml", "zipfile"),
    # ours: what other commands, projects and robots need
    *("jacaros.agents.language.formatting", "jacaros.agents.body", "jacaros.agents.python", "jacaros.look"),
    "jacaros.serving",
    *(f"jacaros.runtime.mas.{name}" for name in ("checks.files", "project.jcm", "project.mas2j")),
    *("jacaros.runtime.mas.project.reading", "jacaros.runtime.mas.environment", "jacaros.testing"),
    *("jacaros.robots.world", "jacaros.artifacts", "jacaros.robots.streams"),
    # of the middleware a run needs only the owner of its signals, jacaros.robots.ros.lifetime
    *("jacaros.robots.ros.backend", "jacaros.robots.ros.message", "jacaros.robots.ros.node"),
)
"""Modules that a program without robots must not import at start."""


def test_a_program_without_robots_loads_only_what_it_needs(folder: Path) -> None:
    script = (
        "import sys; from jacaros.runtime.cli.main import call; call(['run', 'hello.asl']); "
        f"print([m for m in {NOT_FOR_A_LONE_PROGRAM} if m in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert result.stdout == "[hello] hi\n[]\n"


def test_a_run_writes_the_ground_truth(folder: Path, outcome: Outcome) -> None:
    program = '!go. +!go <- makeArtifact("w", "ArtCmdVel"); moveForward(0.5); .stopMAS.'
    (folder / "drive.asl").write_text(program, encoding="utf-8")
    arguments = ("run", "drive.asl", "--clock", "fast", "--ground-truth", "truth.jsonl")
    assert outcome(*arguments) == (0, "", "")
    truth = GroundTruth.read("truth.jsonl")
    assert truth.pose().x == pytest.approx(0.5, abs=0.02)
    assert '"kind": "end"' in Path("truth.jsonl").read_text(encoding="utf-8").splitlines()[-1]


def test_low_batteries_are_logged_by_sim(folder: Path, outcome: Outcome) -> None:
    world = ["sim", "house", "--ros", "memory", "--clock", "fast", "--for", "400"]
    code, _, errors = outcome(*world)
    assert code == 0
    assert "`turtlebot` is at 20 %" in errors
    assert "`turtlebot` is empty" in errors
    assert "--full-battery" in errors
    assert outcome(*world, "--full-battery")[2] == ""


@pytest.mark.parametrize("arguments", [[], ["ros"], ["world"]])
def test_a_command_alone_prints_its_help(arguments: list[str], outcome: Outcome) -> None:
    code, output, errors = outcome(*arguments)
    assert (code, errors) == (0, "")
    assert output.startswith(" ".join(["Usage: jacaros", *arguments]))
    assert "Commands:" in output
