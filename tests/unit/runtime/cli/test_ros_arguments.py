"""Arguments added by ``ros2 run``, launch files, rosrun and roslaunch are translated."""

from pathlib import Path

import pytest

from jacaros.runtime.cli.main import call
from jacaros.runtime.cli.ros_arguments import as_options, has_ros_arguments
from jacaros.runtime.errors import UsageError


@pytest.fixture(autouse=True)
def no_kind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("JACAROS_ROS", raising=False)


def options(*arguments: str) -> tuple[list[str], list[str]]:
    """Return the options and the warnings."""
    told: list[str] = []
    assert has_ros_arguments(arguments)
    return as_options(arguments, told.append), told


LAUNCHED = ("run", "guard.asl", "--ros-args")


@pytest.mark.parametrize(
    ("written", "read"),
    [
        (("-r", "__node:=guard", "-r", "__ns:=/r1"), ["--node-name", "guard", "--namespace", "/r1"]),
        (("--remap", "odom:=/odometry/filtered"), ["--remap", "odom:=/odometry/filtered"]),
        (("-p", "use_sim_time:=true"), ["--param", "use_sim_time:=true"]),
        (("--params-file", "f.yaml", "-p", "a.b:=[1]"), ["--params-file", "f.yaml", "--param", "a.b:=[1]"]),
        (("--log-level", "info", "-e", "/", "--disable-stdout-logs"), []),
        (("--disable-rosout-logs",), ["--no-rosout"]),
    ],
)
def test_arguments_of_ros2_become_options(written: tuple[str, ...], read: list[str]) -> None:
    assert options(*LAUNCHED, *written) == (["run", "guard.asl", *read, "--ros", "ros2"], [])


def test_arguments_after_two_dashes_and_options_of_our_own_win(monkeypatch: pytest.MonkeyPatch) -> None:
    assert options("guard.asl", "--ros-args", "-r", "a:=b", "--", "--mapping", "robot.yaml") == (
        ["guard.asl", "--mapping", "robot.yaml", "--remap", "a:=b", "--ros", "ros2"],
        [],
    )
    own = ("run", "a.asl", "--ros", "memory", "--param", "speed:=1")
    assert options(*own, "--ros-args") == (list(own), [])
    monkeypatch.setenv("JACAROS_ROS", "rosbridge")
    assert options("run", "a.asl", "--ros-args") == (["run", "a.asl", "--ros", "rosbridge"], [])


def test_sim_drops_parameters_and_keeps_an_empty_namespace(tmp_path: Path) -> None:
    file = tmp_path / "parameters.yaml"
    file.write_text(
        "/**: {ros__parameters: {use_sim_time: true}}\nhouse: {ros__parameters: {b: {c: 1}}}",
        encoding="utf-8",
    )
    given = ("-r", "__node:=house", "-p", "use_sim_time:=true", "-p", "a:=1", "--params-file", str(file))
    read, told = options("sim", "house", "--ros-args", "--enable-rosout-logs", *given)
    assert read == ["sim", "house", "--rosout", "--node-name", "house", "--ros", "ros2"]
    assert [line.split(" has ")[0] for line in told] == ["parameter `b.c`", "parameter `a`"]
    read, _ = options("sim", "house", "--ros-args", "-r", "__ns:=")
    assert read == ["sim", "house", "--namespace", "", "--ros", "ros2"]


def test_arguments_of_ros1_become_options() -> None:
    names = ("odom:=/odometry", "__name:=guard", "__log:=/tmp/log", "_speed:=1")
    read, told = options("run", "a.asl", "--remap", "x:=y", *names)
    assert read == [
        *("run", "a.asl", "--remap", "x:=y", "--remap", "odom:=/odometry", "--node-name", "guard"),
        *("--param", "speed:=1", "--ros", "ros1"),
    ]
    assert told == []


def test_other_commands_and_option_values_are_unchanged() -> None:
    assert not has_ros_arguments(["run", "a.asl", "--remap", "x:=y"])
    assert not has_ros_arguments(["run", "a.asl", "--remap=x:=y"])
    assert not has_ros_arguments(["run", "a.asl", "--param", "x:=1"])
    assert not has_ros_arguments(["check", "a:=b"])
    assert not has_ros_arguments([])


@pytest.mark.parametrize(
    ("written", "told"),
    [
        (("--ros-args", "--clock", "ros"), "or `--` before other arguments"),
        (("--ros-args", "-r"), "missing value after `-r`"),
        (("--ros-args", "-r", "odom"), "invalid value of -r"),
        (("--ros-args", "-r", "other:odom:=x"), "unexpected node name"),
        (("--ros-args", "-p", "x"), "invalid value of -p"),
        (("__ip:=127.0.0.1",), "ROS_IP"),
    ],
)
def test_mistakes_are_reported(written: tuple[str, ...], told: str) -> None:
    with pytest.raises(UsageError, match=told):
        options("run", "a.asl", *written)


def test_a_run_accepts_ros_arguments(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "who.asl").write_text(
        '!go. +!go <- makeArtifact(r, "ArtRos", [], I); focus(I); ?node(N); .print(N); .stopMAS.',
        encoding="utf-8",
    )
    arguments = ["who.asl", "--ros", "memory", "--clock", "fast"]
    assert call([*arguments, "--ros-args", "-r", "__node:=left", "-r", "__ns:=/r1"]) == 0
    assert capsys.readouterr().out == "[who] /r1/left\n"
