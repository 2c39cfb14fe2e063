"""The launch file of the examples, with stand-ins of ROS 2's ``launch`` that make command lines as `launch_ros` does."""

import sys
from collections.abc import Sequence
from pathlib import Path
from runpy import run_path
from types import ModuleType
from typing import Any, NamedTuple

import pytest
from click import Context

from jacaros.runtime.cli.main import jacaros
from jacaros.runtime.cli.ros_arguments import as_options, read_parameters

FILE = Path(__file__).parents[4] / "examples" / "04_patrol" / "patrol_launch.py"


class Description(list[Any]):
    """The result of a launch file."""


class Argument(NamedTuple):
    """An argument of the launch file, or its value."""

    name: str
    default_value: str = ""


class Condition(NamedTuple):
    """Whether a node is started."""

    argument: Argument
    wanted: bool


class Node:
    """A node to be started."""

    def __init__(self, *, package: str, executable: str, name: str, **rest: Any) -> None:
        assert (package, executable) == ("jacaros", "jacaros")
        self.name = name
        self.arguments: list[str] = rest["arguments"]
        self.parameters: list[dict[str, object]] = rest.get("parameters", [])
        self.condition: Condition | None = rest.get("condition")

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
def description(monkeypatch: pytest.MonkeyPatch) -> Description:
    monkeypatch.delenv("JACAROS_ROS", raising=False)
    modules: dict[str, dict[str, Any]] = {
        "launch": {"LaunchDescription": Description},
        "launch.actions": {"DeclareLaunchArgument": Argument},
        "launch.conditions": {
            "IfCondition": lambda argument: Condition(argument, True),
            "UnlessCondition": lambda argument: Condition(argument, False),
        },
        "launch.substitutions": {"LaunchConfiguration": Argument},
        "launch_ros": {},
        "launch_ros.actions": {"Node": Node, "LifecycleNode": Node},
    }
    for name, members in modules.items():
        module = ModuleType(name)
        vars(module).update(members)
        monkeypatch.setitem(sys.modules, name, module)
    found: Description = run_path(str(FILE))["generate_launch_description"]()
    return found


def started(description: Description, lifecycle: str = "") -> list[Node]:
    """Return the nodes that are started, with an argument of ``ros2 launch`` or its default."""
    (argument,) = (each for each in description if isinstance(each, Argument))
    is_managed = (lifecycle or argument.default_value) == "true"
    nodes = [each for each in description if isinstance(each, Node)]
    conditions = [each.condition for each in nodes if each.condition is not None]
    assert {each.argument.name for each in conditions} == {argument.name} == {"lifecycle"}
    return [each for each in nodes if each.condition is None or each.condition.wanted == is_managed]


def read(nodes: Sequence[Node], folder: Path) -> dict[str, dict[str, Any]]:
    """Return the options of each node by its name."""
    told: list[str] = []
    found = {}
    for node in nodes:
        line = as_options(node.command_line(folder), told.append)
        with Context(jacaros) as context:
            _, command, rest = jacaros.resolve_command(context, line)
            assert command is not None
            found[node.name] = command.make_context(str(command.name), rest).params
    assert told == []
    return found


def test_the_launch_file_starts_a_world_and_the_agents(description: Description, tmp_path: Path) -> None:
    options = read(started(description), tmp_path)
    world, agents = options["world"], options["patrol"]
    assert (world["ros"], world["node_name"], world["publish_clock"]) == ("ros2", "world", True)
    assert (agents["ros"], agents["node_name"], agents["lifecycle"]) == ("ros2", "patrol", False)
    assert read_parameters((), agents["params_file"], "patrol") == {"use_sim_time": True}
    assert Path(world["world"]).is_file()
    assert agents["file"].is_file()


def test_the_launch_file_starts_managed_agents_when_asked(description: Description, tmp_path: Path) -> None:
    world, agents = started(description, "true")
    assert world.name == "world"
    options = read([agents], tmp_path)["patrol"]
    assert (options["lifecycle"], options["node_name"]) == (True, "patrol")
    assert options["file"] == read([started(description)[1]], tmp_path)["patrol"]["file"]
