"""Parameters of our node on the command line: reading, precedence and errors."""

import sys
from pathlib import Path
from typing import Any

import pytest

from jacaros.runtime.cli.main import call
from jacaros.runtime.cli.ros_arguments import read_parameters
from jacaros.runtime.errors import UsageError

FILE = """
/**:
  ros__parameters: {use_sim_time: true, depth: {low: 1, high: 2}}
/r1/guard:
  ros__parameters: {speed: 1}
r1:
  "*":
    ros__parameters: {turn: 2}
other:
  ros__parameters: {colour: red}
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "parameters.yaml"
    made.write_text(FILE, encoding="utf-8")
    return made


def test_files_are_read_for_our_node(file: Path) -> None:
    everywhere = {"use_sim_time": True, "depth.low": 1, "depth.high": 2}
    assert read_parameters((), (file,), "/r1/guard") == everywhere | {"speed": 1, "turn": 2}
    assert read_parameters((), (file,), "other") == everywhere | {"colour": "red"}


def test_single_parameters_override_files_and_later_files_earlier_ones(file: Path, tmp_path: Path) -> None:
    later = tmp_path / "later.yaml"
    later.write_text("r1: {guard: {ros__parameters: {speed: 3, turn: 4}}}", encoding="utf-8")
    read = read_parameters(("speed:=5",), (file, later), "/r1/guard")
    assert (read["speed"], read["turn"], read["depth.low"]) == (5, 4, 1)


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("0.5", 0.5),
        ("1", 1),
        ("True", True),
        ("kitchen", "kitchen"),
        ("'1'", "1"),
        ("[kitchen, hall]", ["kitchen", "hall"]),
        ("1e-3", 0.001),
        ("a:=b", "a:=b"),
    ],
)
def test_values_are_yaml(written: str, value: object) -> None:
    read = read_parameters((f"p:={written}",), (), "node")["p"]
    assert (read, type(read)) == (value, type(value))


def test_nested_mappings_are_flattened() -> None:
    assert read_parameters(("wheels:={left: {radius: 0.1}}",), (), "node", "/") == {"wheels/left/radius": 0.1}


@pytest.mark.parametrize(
    ("written", "files", "told"),
    [
        (("speed=1",), (), "expected NAME:=VALUE, found `speed=1`"),
        (("x:={",), (), "--param x:1:2: this bracket is never closed"),
        (("x:=",), (), "parameter `x` has no value"),
        (("x:=&a [*a]",), (), "&a contains itself"),
        (("x:=" + "[" * 200 + "]" * 200,), (), "nested too deeply"),
        ((), ("deep.yaml",), "nested too deeply"),
        pytest.param(
            *((), ("/dev/zero",), "--params-file /dev/zero: it is not a regular file"),
            marks=pytest.mark.skipif(sys.platform == "win32", reason="Windows has no /dev"),
        ),
        (("x:=2001-99-99",), (), "not a valid timestamp"),
        ((), ("gone.yaml",), "gone.yaml: No such file"),
        ((), ("list.yaml",), "write NODE: {ros__parameters"),
        ((), ("latin.yaml",), "not UTF-8; save the file as UTF-8"),
    ],
)
def test_mistakes_are_reported(tmp_path: Path, written: tuple[str, ...], files: tuple[str, ...], told: str):
    (tmp_path / "list.yaml").write_text("- a", encoding="utf-8")
    (tmp_path / "deep.yaml").write_text(f"/**: {{ros__parameters: {{x: {'[' * 100_000}", encoding="utf-8")
    (tmp_path / "latin.yaml").write_bytes(b"a: \xe4")
    with pytest.raises(UsageError, match=told):
        read_parameters(written, [tmp_path / file for file in files], "node")


GUARD = """
!start.
+!start <- ?speed(S); ?places(P); .print(S, " ", P); .stopMAS.
"""
MAPPING = """
parameters:
  speed: {default: 0.4, minimum: 0.1, maximum: 1.0}
  places: {default: [hall], fields: {path: ., as: atom}}
"""


def run(folder: Path, *arguments: str) -> int:
    (folder / "guard.asl").write_text(GUARD, encoding="utf-8")
    (folder / "robot.yaml").write_text(MAPPING, encoding="utf-8")
    return call(["guard.asl", "--mapping", "robot.yaml", "--clock", "fast", *arguments])


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("JACAROS_ROS", raising=False)
    return tmp_path


def test_parameters_of_a_launch_file_reach_the_agent(folder: Path, capsys: pytest.CaptureFixture[str]):
    (folder / "launch_params").write_text("guard: {ros__parameters: {speed: 0.7}}", encoding="utf-8")
    given = ("--ros-args", "--params-file", "launch_params", "-p", "places:=[attic, hall]")
    assert run(folder, "--ros", "memory", *given) == 0
    assert capsys.readouterr() == ("[guard] 0.7 [attic,hall]\n", "")


def test_parameter_files_are_read_for_the_node_of_the_run(folder: Path, capsys: pytest.CaptureFixture[str]):
    (folder / "p.yaml").write_text("r1: {left: {ros__parameters: {speed: 0.9}}}", encoding="utf-8")
    assert run(folder, "--params-file", "p.yaml", "--node-name", "left", "--namespace", "r1") == 0
    assert capsys.readouterr().out == "[guard] 0.9 [hall]\n"


def test_an_undeclared_parameter_is_reported_once(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(folder, "--param", "spede:=1.0", "--param", "use_sim_time:=true") == 0
    out, told = capsys.readouterr()
    assert out == "[guard] 0.4 [hall]\n"
    assert told == ("[ros] parameter spede has no effect: nothing declares it; did you mean `speed`?\n")


def test_all_invalid_values_are_reported_in_one_pass(folder: Path, capsys: pytest.CaptureFixture[str]):
    assert run(folder, "--param", "speed:=1", "--param", "places:=1") == 1
    told = capsys.readouterr().err
    assert (
        "robot.yaml:3:3: error: parameter speed of /guard is of type float; 1 is of type int; write 1.0"
        in told
    )
    assert "such as --param speed:=0.4" in told
    assert (
        "robot.yaml:4:3: error: parameter places of /guard is of type list of text; 1 is of type int" in told
    )
    assert "--param 'places:=[\"hall\"]'" in told
    assert "has no effect" not in told


def test_unsupported_values_and_graphs_without_parameters_are_reported(folder: Path, capsys):
    assert run(folder, "--param", "speed:=[1, a]") == 2
    assert "--param speed: expected a bool" in capsys.readouterr().err
    arguments = ["guard.asl", "--ros", "rosbridge", "--param", "speed:=0.5"]
    assert call(arguments) == 2
    assert "no node of our own" in capsys.readouterr().err


def test_use_sim_time_is_true_or_false(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(folder, "--param", "use_sim_time:=yes") == 2
    assert "invalid parameter use_sim_time: expected true or false, found `'yes'`" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "follows"),
    [
        (("--param", "use_sim_time:=true"), True),
        (("--param", "use_sim_time:=false"), False),
        (("--param", "use_sim_time:=true", "--clock", "real"), False),
        (("--clock", "ros"), True),
    ],
)
def test_use_sim_time_selects_the_ros_clock(
    folder: Path, monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...], follows: bool
) -> None:
    seen: list[Any] = []
    monkeypatch.setattr(
        "jacaros.runtime.cli.run.launch", lambda project, options, *_, **__: seen.append(options)
    )
    (folder / "a.asl").write_text("!a. +!a.", encoding="utf-8")
    call(["a.asl", "--ros", "ros2", *arguments])
    assert [(each.ros_clock, dict(each.parameters)) for each in seen] == [(follows, {})]
