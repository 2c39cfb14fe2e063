"""Projects of JaCaMo whose artifacts are in Java."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.runtime.cli.main import call

PROJECT = """mas room {
    agent ann : ann.asl { ag-arch: devices.SlowArch focus: hall.heater }
    workspace hall { artifact heater: TYPE(30) }
}
"""
JAVA = """package devices;

import cartago.*;

public class Heater extends Artifact {
    void init(int start) {
        defineObsProperty("temperature", start);
    }
}
"""
PORTED = """
from jacaros.artifacts import Artifact


class Heater(Artifact):
    def init(self, start: int) -> None:
        self.define_property("temperature", start)
"""


Outcome = Callable[..., tuple[int, str]]


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ann.asl").write_text("+temperature(T) <- .print(T); .stopMAS.\n")
    (tmp_path / "src/env/devices").mkdir(parents=True)
    (tmp_path / "src/env/devices/Heater.java").write_text(JAVA)
    return tmp_path


@pytest.fixture
def outcome(room: Path, capsys: pytest.CaptureFixture[str]) -> Outcome:
    """Exit code and output of a command with the project."""

    def run(type_name: str, command: str = "check") -> tuple[int, str]:
        (room / "room.jcm").write_text(PROJECT.replace("TYPE", type_name))
        code = call([command, "room.jcm"])
        captured = capsys.readouterr()
        return code, captured.out + captured.err

    return run


@pytest.mark.parametrize("command", ["check", "run"])
def test_an_artifact_in_java_is_named_with_the_command_that_ports_it(command: str, outcome: Outcome) -> None:
    code, told = outcome("devices.Heater", command)
    assert code == 1
    assert "artifact type `devices.Heater` is in Java (src/env/devices/Heater.java)" in told
    assert "= help: jacaros port src/env/devices/Heater.java -o artifacts/heater.py\n" in told
    assert "did you mean" not in told


def test_the_command_of_the_help_makes_the_project_run(outcome: Outcome) -> None:
    help = outcome("devices.Heater")[1].partition("= help: jacaros ")[2].partition("\n")[0]
    assert call(help.split()) == 0
    code, told = outcome("devices.Heater", "run")
    assert code == 0
    assert "[ann] 30" in told


def test_the_port_turns_no_warning_into_an_error(room: Path, outcome: Outcome) -> None:
    (room / "devices.py").write_text(PORTED)
    code, told = outcome("devices.Heater")
    assert code == 0
    assert "warning: the architecture `devices.SlowArch` has no effect" in told
    code, told = outcome("devices.Heater", "run")
    assert code == 0
    assert "[ann] 30" in told


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("devices.Heatr", "devices.Heater"),
        ("cartago.tools.Consol", "cartago.tools.Console"),
        ("Blackbord", "Blackboard"),
    ],
)
def test_a_suggested_type_exists(written: str, meant: str, room: Path, outcome: Outcome) -> None:
    (room / "devices.py").write_text(PORTED)
    assert f"unknown artifact type `{written}`; did you mean `{meant}`?" in outcome(written)[1]
    assert "unknown artifact type" not in outcome(meant)[1]


def test_an_unrelated_type_is_not_suggested(room: Path, outcome: Outcome) -> None:
    told = outcome("devices.Cooker")[1]
    assert "did you mean" not in told
    assert "write `class Cooker(Artifact)` in devices.py or artifacts.py beside the project file" in told


def test_java_beside_the_folder_of_a_lone_program_is_found(
    room: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (room / "src" / "asl").mkdir()
    (room / "src" / "asl" / "lone.asl").write_text('!go. +!go <- makeArtifact("h", "devices.Heater", [], _).')
    assert call(["check", "src/asl/lone.asl"]) == 0
    assert "`devices.Heater` is in Java (src/env/devices/Heater.java)" in capsys.readouterr().out
