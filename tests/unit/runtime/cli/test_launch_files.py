"""The launch file of the examples, with stand-ins of ROS 2's ``launch`` that make command lines as `launch_ros` does."""

import sys
from collections.abc import Sequence
from pathlib import Path
from runpy import run_path
from types import ModuleType
from typing import Any

import pytest
from click import Context

from jacaros.runtime.cli.main import jacaros
from jacaros.runtime.cli.ros_arguments import as_options, read_parameters

FILE = Path(__file__).parents[4] / "examples" / "04_patrol" / "patrol_launch.py"


class Description(list[Any]):
    """The result of a launch file."""


class Node:
    """A node to be started."""

    def __init__(self, *, package: str, executable: str, name: str, **rest: Any) -> None:
        assert (package, executable) == ("jacaros", "jacaros")
        self.name = name
        self.arguments: list[str] = rest["arguments"]
        self.parameters: list[dict[str, object]] = rest.get("parameters", [])

    def command_line(self, folder: Path) -> list[str]:
        """Return the arguments of the process: names after ``--ros-args``, and a parameter file."""
        line = [*self.arguments, "--ros-args", "-r", f"__node:={self.name}"]
        for parameters in self.parameters:
            file = folder / "launch_params"
            lines = "".join(f"    {name}: {str(value).lower()}\n" for name, value in parameters.items())
            file.write_text(f"/**:\n  ros__parameters:\n{lines}", encoding="utf-8")
            line += ["--params-file", str(file)]
        return line


@pytest.fixture
def nodes(monkeypatch: pytest.MonkeyPatch) -> Sequence[Node]:
    monkeypatch.delenv("JACAROS_ROS", raising=False)
    for name, members in {
        "launch": {"LaunchDescription": Description},
        "launch_ros": {},
        "launch_ros.actions": {"Node": Node},
    }.items():
        module = ModuleType(name)
        vars(module).update(members)
        monkeypatch.setitem(sys.modules, name, module)
    found: Sequence[Node] = run_path(str(FILE))["generate_launch_description"]()
    return found


def test_the_launch_file_starts_a_world_and_the_agents(nodes: Sequence[Node], tmp_path: Path) -> None:
    told: list[str] = []
    read = {}
    for node in nodes:
        line = as_options(node.command_line(tmp_path), told.append)
        with Context(jacaros) as context:
            _, command, rest = jacaros.resolve_command(context, line)
            assert command is not None
            read[node.name] = command.make_context(str(command.name), rest).params
    assert told == []
    world, agents = read["world"], read["patrol"]
    assert (world["ros"], world["node_name"], world["publish_clock"]) == ("ros2", "world", True)
    assert (agents["ros"], agents["node_name"]) == ("ros2", "patrol")
    assert read_parameters((), agents["params_file"], "patrol") == {"use_sim_time": True}
    assert Path(world["world"]).is_file()
    assert agents["file"].is_file()
