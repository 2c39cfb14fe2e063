"""Options of commands that join a ROS graph: its address, and the names used in it."""

from collections.abc import Callable, Sequence
from typing import Any

import click

from jacaros.robots.ros.middleware import ROS_KINDS
from jacaros.runtime.cli.options import PATH, F, option, with_options
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
    settings: dict[str, Any] = {"required": True} if required else {"default": "memory"}
    return option("--ros", help, RosKind(kinds), envvar="JACAROS_ROS", **settings)


noise_option = option(
    "--noise FACTOR",
    "Factor for the noise of the embedded world's odometry and lasers: 0 (exact), 1 (that of the world file, or that of "
    "slipping wheels if it has none) or up to 100 (default: as in the world file; 0 if no world is named).",
    click.FloatRange(0.0, 100.0),
)


def world_option(help: str) -> Callable[[F], F]:
    """Return the option ``--world``."""
    return option("--world FILE", help, envvar="JACAROS_WORLD")


faults_option = option("--faults FILE", "Fault file: what fails in the embedded world, and when.", PATH)
_ADDRESS = (
    option("--domain-id N", "Domain of the ROS 2 graph (default: ROS_DOMAIN_ID).", int),
    option("--master URI", "Master of the ROS 1 graph (default: ROS_MASTER_URI)."),
    option(
        "--bridge URL",
        "Address of a rosbridge server, such as ws://robot.lab.example:9090 (default: ROSBRIDGE_URI).",
    ),
)
_NAMESPACE = option("--namespace NAME", "Prefix of relative ROS names.", default="", show_default=False)
_NAMES = (
    option("--node-name NAME", "Name of the ROS node (default: the name of the agent system)."),
    option("--remap FROM:=TO...", "Use the name TO for the topic, service or action FROM. Repeatable."),
)
graph_options = with_options(*_ADDRESS, _NAMESPACE, *_NAMES)
"""The options for the address of a graph, the name of our node, and remappings."""
address_options = with_options(*_ADDRESS, _NAMESPACE)
"""The options for the address of a graph and the namespace of our node."""
world_options = with_options(*_ADDRESS, *_NAMES)
"""The same options as `graph_options` without the namespace: world files give each robot its own."""
parameter_options = with_options(
    option(
        "--param NAME:=VALUE...", "Set a parameter declared by a mapping file or an artifact. Repeatable."
    ),
    option("--params-file FILE...", "ROS 2 parameter file for this node. Repeatable.", PATH),
)
"""The options that set parameters of our node."""
orphans_option = option(
    "--orphans",
    "What to do with action goals that an earlier run of this node left behind, for example because it was killed: "
    "cancel them (default), or keep them.",
    click.Choice(["cancel", "keep"]),
    default="cancel",
    show_default=False,
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
