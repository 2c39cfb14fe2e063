"""Options of commands that join a ROS graph: which one, and under which names."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from jacaros.errors import UsageError

F = TypeVar("F", bound=Callable[..., Any])

_ADDRESS = (
    click.option(
        "--domain-id",
        type=int,
        metavar="N",
        help="Domain of the ROS 2 graph, in place of the environment's ROS_DOMAIN_ID.",
    ),
    click.option(
        "--master",
        metavar="URI",
        help="Master of the ROS 1 graph, in place of the environment's ROS_MASTER_URI.",
    ),
    click.option(
        "--bridge",
        metavar="URL",
        help="Address of a rosbridge server, such as ws://robot.lab.example:9090, in place of ROSBRIDGE_URI.",
    ),
)
_NAMESPACE = click.option("--namespace", default="", metavar="NAME", help="Put before relative ROS names.")
_NAMES = (
    click.option("--node-name", metavar="NAME", help="Name of our node, in place of the system's name."),
    click.option(
        "--remap",
        multiple=True,
        metavar="FROM:=TO",
        help="Use the topic or service TO wherever FROM is asked for; may be given more often.",
    ),
)

_PARAMETERS = (
    click.option(
        "--param",
        multiple=True,
        metavar="NAME:=VALUE",
        help="Value of a parameter that a mapping file or an artifact declares; may be given more often.",
    ),
    click.option(
        "--params-file",
        multiple=True,
        type=click.Path(path_type=Path),
        metavar="FILE",
        help="File of ROS 2 with the parameters of nodes, ours among them; may be given more often.",
    ),
)


def graph_options(command: F) -> F:
    """Give a command the options that name a graph, our node in it, and other names for topics."""
    return _with(command, (*_ADDRESS, _NAMESPACE, *_NAMES))


def address_options(command: F) -> F:
    """Give a command the options that name a graph and the namespace of a node in it."""
    return _with(command, (*_ADDRESS, _NAMESPACE))


def world_options(command: F) -> F:
    """The same without a namespace: a world file says those of its robots."""
    return _with(command, (*_ADDRESS, *_NAMES))


def parameter_options(command: F) -> F:
    """Give a command the options that give parameters to our node."""
    return _with(command, _PARAMETERS)


def _with(command: F, options: tuple[Callable[[F], F], ...]) -> F:
    for option in reversed(options):
        command = option(command)
    return command


def read_remaps(written: tuple[str, ...]) -> dict[str, str]:
    """Read ``FROM:=TO`` pairs, as ROS's own tools write them.

    Raises:
        UsageError: one is written in another way, or a name has two replacements.
    """
    remap: dict[str, str] = {}
    for each in written:
        old, sign, new = each.partition(":=")
        if not sign or not old or not new:
            raise UsageError(
                f"--remap is written FROM:=TO, such as --remap odom:=/robot_1/odom, not {each!r}"
            )
        if remap.get(old, new) != new:
            raise UsageError(f"--remap gives {old!r} two other names: {remap[old]!r} and {new!r}")
        remap[old] = new
    return remap
