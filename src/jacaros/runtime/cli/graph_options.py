"""Options of commands that join a ROS graph: its address, and the names used in it."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click

from jacaros.robots.ros.middleware import ROS_KINDS
from jacaros.runtime.cli.options import F, VariableOption, with_options
from jacaros.runtime.cli.usage import usage_error


class RosKind(click.Choice[str]):
    """Accepts a kind of graph, or the class of a custom backend as ``MODULE:NAME``."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the name of a class unchanged."""
        return value if ":" in value else super().convert(value, param, ctx)


def ros_option(help: str, kinds: Sequence[str] = ROS_KINDS, required: bool = False) -> Callable[[F], F]:
    """Return the option ``--ros``.

    Args:
        help: help text of the option.
        kinds: kinds of graph that the command accepts.
        required: there is no default; otherwise the default is ``memory``.
    """
    settings: dict[str, Any] = {"required": True} if required else {"default": "memory", "show_default": True}
    return click.option(
        "--ros",
        cls=VariableOption,
        type=RosKind(kinds),
        envvar="JACAROS_ROS",
        show_envvar=True,
        help=help,
        **settings,
    )


class NoiseFactor(click.FloatRange):
    """Accepts ``off`` (0), ``on`` (1), or a factor."""

    name = "factor"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the factor."""
        try:
            return super().convert({"off": 0.0, "on": 1.0}.get(value, value), param, ctx)  # pyright: ignore[reportArgumentType]
        except click.BadParameter:
            raise usage_error(
                f"invalid value of --noise: expected off, on or a factor up to 100, found `{value}`",
                "--noise 0.5",
            ) from None


noise_option = click.option(
    "--noise",
    type=NoiseFactor(0.0, 100.0),
    metavar="FACTOR",
    help="Factor for the noise of the embedded world's odometry and lasers: off (0), on (1, that of the world file, or "
    "that of slipping wheels if it has none) or a number (default: as in the world file; off if no world is named).",
)


def world_option(help: str) -> Callable[[F], F]:
    """Return the option ``--world``."""
    return click.option(
        "--world", cls=VariableOption, metavar="FILE", envvar="JACAROS_WORLD", show_envvar=True, help=help
    )


faults_option = click.option(
    "--faults",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Fault file: what fails in the embedded world, and when.",
)

_ADDRESS = (
    click.option(
        "--domain-id",
        type=int,
        metavar="N",
        help="Domain of the ROS 2 graph (default: ROS_DOMAIN_ID).",
    ),
    click.option(
        "--master",
        metavar="URI",
        help="Master of the ROS 1 graph (default: ROS_MASTER_URI).",
    ),
    click.option(
        "--bridge",
        metavar="URL",
        help="Address of a rosbridge server, such as ws://robot.lab.example:9090 (default: ROSBRIDGE_URI).",
    ),
)
_NAMESPACE = click.option("--namespace", default="", metavar="NAME", help="Prefix of relative ROS names.")
_NAMES = (
    click.option(
        "--node-name", metavar="NAME", help="Name of the ROS node (default: the name of the agent system)."
    ),
    click.option(
        "--remap",
        multiple=True,
        metavar="FROM:=TO",
        help="Use the name TO for the topic, service or action FROM. Repeatable.",
    ),
)

_PARAMETERS = (
    click.option(
        "--param",
        multiple=True,
        metavar="NAME:=VALUE",
        help="Set a parameter declared by a mapping file or an artifact. Repeatable.",
    ),
    click.option(
        "--params-file",
        multiple=True,
        type=click.Path(path_type=Path),
        metavar="FILE",
        help="ROS 2 parameter file for this node. Repeatable.",
    ),
)


graph_options = with_options(*_ADDRESS, _NAMESPACE, *_NAMES)
"""The options for the address of a graph, the name of our node, and remappings."""
address_options = with_options(*_ADDRESS, _NAMESPACE)
"""The options for the address of a graph and the namespace of our node."""
world_options = with_options(*_ADDRESS, *_NAMES)
"""The same options as `graph_options` without the namespace: world files give each robot its own."""
parameter_options = with_options(*_PARAMETERS)
"""The options that set parameters of our node."""
orphans_option = click.option(
    "--orphans",
    type=click.Choice(["cancel", "keep"]),
    default="cancel",
    help="What to do with action goals that an earlier run of this node left behind, for example because it was "
    "killed: cancel them (default), or keep them.",
)


def read_remaps(written: tuple[str, ...]) -> dict[str, str]:
    """Read remappings ``FROM:=TO``, in the notation of ROS's own tools.

    Raises:
        UsageError: a remapping is malformed, or a name has two replacements.
    """
    remap: dict[str, str] = {}
    for each in written:
        old, sign, new = each.partition(":=")
        if not sign or not old or not new:
            raise usage_error(
                f"invalid value of --remap: expected FROM:=TO, found `{each}`", "--remap odom:=/robot_1/odom"
            )
        if remap.get(old, new) != new:
            raise usage_error(f"--remap gives `{old}` two new names: `{remap[old]}` and `{new}`")
        remap[old] = new
    return remap
