"""Options set by environment variables: weaker than a project's world, and named in messages."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from command_lab import Outcome

HELLO = "!start.\n+!start <- .print(hello); .stopMAS.\n"


@pytest.fixture(autouse=True)
def projects(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a program, a project in the world `patrol`, and a project that names no world."""
    for variable in ("JACAROS_WORLD", "JACAROS_ROS", "JACAROS_CLOCK"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hello.asl").write_text(HELLO)
    (tmp_path / "worldless.jcm").write_text("mas worldless { agent hello : hello.asl }")
    (tmp_path / "patrol.jcm").write_text("mas patrol { agent hello : hello.asl\n world: patrol }")
    return tmp_path


WorldOf = Callable[..., tuple[str, str]]


@pytest.fixture
def world_of(outcome: Outcome) -> WorldOf:
    """Runs a project; the name of its world, and the standard error output."""

    def run(*arguments: str) -> tuple[str, str]:
        code, _, errors = outcome("run", *arguments, "--ground-truth", "truth.jsonl", "--clock", "fast")
        assert code == 0, errors
        return json.loads(Path("truth.jsonl").read_text().splitlines()[0])["world"]["name"], errors

    return run


def test_a_project_overrides_the_world_of_the_environment(monkeypatch: pytest.MonkeyPatch, world_of: WorldOf):
    monkeypatch.setenv("JACAROS_WORLD", "house")
    world, errors = world_of("patrol.jcm")
    assert world == "patrol"
    note = "note: patrol.jcm names the world `patrol`; JACAROS_WORLD=house is ignored (to use it: --world house)\n"
    assert errors == note
    assert world_of("worldless.jcm") == ("house", "")
    assert world_of("patrol.jcm", "--world", "flat") == ("flat", "")


@pytest.mark.parametrize("where", [["patrol.jcm"], ["worldless.jcm", "--world", "patrol"]])
def test_a_world_is_not_sent_to_the_graph_of_the_environment(
    where: list[str], monkeypatch: pytest.MonkeyPatch, world_of: WorldOf
) -> None:
    monkeypatch.setenv("JACAROS_ROS", "rosbridge")
    world, errors = world_of(*where)
    assert world == "patrol"
    assert "JACAROS_ROS=rosbridge is ignored (to use it: --ros rosbridge)" in errors


def test_the_world_of_the_environment_is_not_simulated_in_a_real_graph(monkeypatch, outcome):
    monkeypatch.setenv("JACAROS_WORLD", "house")
    closed = ("--ros", "rosbridge", "--bridge", "ws://127.0.0.1:9")
    for arguments in (["run", "hello.asl", *closed], ["ros", "list", *closed, "--timeout", "0.1"]):
        _, _, errors = outcome(*arguments)
        assert "(--ros rosbridge); JACAROS_WORLD=house is ignored (to use it: --world house)" in errors
        assert "--world needs" not in errors


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
    variable: str, value: str, arguments: str, option: str, monkeypatch: pytest.MonkeyPatch, outcome: Outcome
) -> None:
    monkeypatch.setenv(variable, value)
    code, _, errors = outcome(*arguments.split())
    assert code in (1, 2)
    note = f"note: {option} was set by the environment variable {variable}; to ignore it, unset {variable}\n"
    assert errors.startswith("error: ")
    assert errors.endswith(note)
    assert "short" not in errors, "a token is a secret"


def test_an_error_of_something_else_does_not_name_the_variables(monkeypatch, outcome):
    monkeypatch.setenv("JACAROS_WORLD", "house")
    (Path("wrong.asl")).write_text("!start.\n+!start <- .print(\n")
    assert "JACAROS_WORLD" not in outcome("run", "wrong.asl")[2]
    assert "JACAROS_WORLD" not in outcome("run", "missing.asl")[2]
