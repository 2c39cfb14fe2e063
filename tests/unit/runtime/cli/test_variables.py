"""Options set by environment variables: weaker than a project's world, and named in messages."""

import json
from pathlib import Path

import pytest

from jacaros.runtime.cli.main import call

HELLO = "!start.\n+!start <- .print(hello); .stopMAS.\n"


@pytest.fixture
def projects(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a program, a project in the world `patrol`, and a project that names no world."""
    for variable in ("JACAROS_WORLD", "JACAROS_ROS", "JACAROS_CLOCK"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hello.asl").write_text(HELLO)
    (tmp_path / "worldless.jcm").write_text("mas worldless { agent hello : hello.asl }")
    (tmp_path / "patrol.jcm").write_text("mas patrol { agent hello : hello.asl\n world: patrol }")
    return tmp_path


def outcome(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str]:
    """The exit code of a command, and its standard error output."""
    code = call([*arguments])
    return code, capsys.readouterr().err


def world_of(capsys: pytest.CaptureFixture[str], project: str, *options: str) -> tuple[str, str]:
    """The name of the world that a run takes place in, and the standard error output of the run."""
    code, errors = outcome(
        capsys, "run", project, "--ground-truth", "truth.jsonl", "--clock", "fast", *options
    )
    assert code == 0, errors
    name: str = json.loads(Path("truth.jsonl").read_text().splitlines()[0])["world"]["name"]
    return name, errors


@pytest.mark.usefixtures("projects")
def test_a_project_overrides_the_world_of_the_environment(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JACAROS_WORLD", "house")
    world, errors = world_of(capsys, "patrol.jcm")
    assert world == "patrol"
    note = "note: patrol.jcm names the world `patrol`; JACAROS_WORLD=house is ignored (to use it: --world house)\n"
    assert errors == note
    assert world_of(capsys, "worldless.jcm") == ("house", "")
    assert world_of(capsys, "patrol.jcm", "--world", "flat") == ("flat", "")


@pytest.mark.usefixtures("projects")
@pytest.mark.parametrize("where", [["patrol.jcm"], ["worldless.jcm", "--world", "patrol"]])
def test_a_world_is_not_sent_to_the_graph_of_the_environment(
    where: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JACAROS_ROS", "rosbridge")
    world, errors = world_of(capsys, *where)
    assert world == "patrol"
    assert "JACAROS_ROS=rosbridge is ignored (to use it: --ros rosbridge)" in errors


@pytest.mark.usefixtures("projects")
def test_the_world_of_the_environment_is_not_simulated_in_a_real_graph(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JACAROS_WORLD", "house")
    closed = ("--ros", "rosbridge", "--bridge", "ws://127.0.0.1:9")
    for arguments in (["run", "hello.asl", *closed], ["ros", "list", *closed, "--timeout", "0.1"]):
        _, errors = outcome(capsys, *arguments)
        assert "(--ros rosbridge); JACAROS_WORLD=house is ignored (to use it: --world house)" in errors
        assert "--world needs" not in errors


@pytest.mark.usefixtures("projects")
@pytest.mark.parametrize(
    ("variable", "value", "arguments", "option"),
    [
        ("JACAROS_WORLD", "lab.yaml", "run hello.asl", "--world"),
        ("JACAROS_ROS", "ros3", "run hello.asl", "--ros"),
        ("JACAROS_ROS", "ros3", "run hello.asl --ros-args -r a:=b", "--ros"),
        ("JACAROS_CLOCK", "fast", "run hello.asl --ros ros2", "--clock"),
        ("JACAROS_CLOCK", "quick", "run hello.asl", "--clock"),
        ("JACAROS_GUARD_TIMEOUT", "0.01", "guard robot --ros ros2", "--timeout"),
        ("JACAROS_VIEW_TOKEN", "short", "run hello.asl --view", "--view-token"),
    ],
)
def test_an_error_in_a_variable_names_it(
    variable: str,
    value: str,
    arguments: str,
    option: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(variable, value)
    code, errors = outcome(capsys, *arguments.split())
    assert code in (1, 2)
    note = f"note: {option} was set by the environment variable {variable}; to ignore it, unset {variable}\n"
    assert errors.startswith("error: ")
    assert errors.endswith(note)
    assert "short" not in errors, "a token is a secret"


@pytest.mark.usefixtures("projects")
def test_an_error_of_something_else_does_not_name_the_variables(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JACAROS_WORLD", "house")
    (Path("wrong.asl")).write_text("!start.\n+!start <- .print(\n")
    assert "JACAROS_WORLD" not in outcome(capsys, "run", "wrong.asl")[1]
    assert "JACAROS_WORLD" not in outcome(capsys, "run", "missing.asl")[1]
