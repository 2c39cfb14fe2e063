"""Options of commands that join a ROS graph: which one, and under which names."""

import asyncio
import sys
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from jacaros.errors import UsageError
from jacaros.ros.middleware import ROS_KINDS

if TYPE_CHECKING:
    from jacaros.ros.orphans import OrphanPolicy

F = TypeVar("F", bound=Callable[..., Any])


class RosKind(click.Choice[str]):
    """Takes a kind of graph, or a class for one's own as ``MODULE:NAME``."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Give the name of a class as it is written."""
        return value if ":" in value else super().convert(value, param, ctx)


def ros_option(
    told: str, kinds: Sequence[str] = ROS_KINDS, required: bool = False, but_with: str = ""
) -> Callable[[F], F]:
    """The option that says which kind of graph; *told* is its help, and it is ``memory`` unless it is required.

    With the flag *but_with* it is not.
    """

    def needed(context: click.Context, option: click.Parameter, value: str | None) -> str | None:
        if value is None and required and not context.params.get(but_with):
            raise click.MissingParameter(ctx=context, param=option)
        return value

    return click.option(
        "--ros",
        type=RosKind(kinds),
        default=None if required else "memory",
        callback=needed,
        envvar="JACAROS_ROS",
        show_default=not required,
        show_envvar=True,
        help=told,
    )


faults_option = click.option(
    "--faults",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="File with faults of the world and their times.",
)

_ADDRESS = (
    click.option(
        "--domain-id",
        type=int,
        metavar="N",
        help="Domain of the ROS 2 graph, instead of ROS_DOMAIN_ID.",
    ),
    click.option(
        "--master",
        metavar="URI",
        help="Master of the ROS 1 graph, instead of ROS_MASTER_URI.",
    ),
    click.option(
        "--bridge",
        metavar="URL",
        help="Address of a rosbridge server, such as ws://robot.lab.example:9090, instead of ROSBRIDGE_URI.",
    ),
)
_NAMESPACE = click.option("--namespace", default="", metavar="NAME", help="Prefix of relative ROS names.")
_NAMES = (
    click.option(
        "--node-name", metavar="NAME", help="Name of the ROS node (default: the name of the system)."
    ),
    click.option(
        "--remap",
        multiple=True,
        metavar="FROM:=TO",
        help="Use the topic or service TO instead of FROM. Repeatable.",
    ),
)

_PARAMETERS = (
    click.option(
        "--param",
        multiple=True,
        metavar="NAME:=VALUE",
        help="Value of a parameter that a mapping file or an artifact declares. Repeatable.",
    ),
    click.option(
        "--params-file",
        multiple=True,
        type=click.Path(path_type=Path),
        metavar="FILE",
        help="ROS 2 parameter file with parameters of this node. Repeatable.",
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


def orphans_option(command: F) -> F:
    """Give a command the option that says what becomes of goals of an earlier run."""
    option = click.option(
        "--orphans",
        type=click.Choice(["cancel", "keep", "ask"]),
        default="cancel",
        help="Action goals of an earlier run of this node, for example of one that was killed: cancel them "
        "(default), keep them, or ask on the terminal.",
    )
    return _with(command, (option,))


def orphan_policy(written: str) -> "OrphanPolicy":
    """Return what `--orphans` means; without a terminal, `ask` keeps goals and says so."""
    if written == "cancel":
        return "cancel"
    if written == "keep" or not (sys.stdin.isatty() and sys.stderr.isatty()):
        return "keep"
    one_by_one = asyncio.Lock()

    async def ask(question: str) -> bool:
        async with one_by_one:
            return await _ask(question)

    return ask


async def _ask(question: str) -> bool:
    """Ask on the terminal, in a thread that does not keep the process from ending."""
    loop = asyncio.get_running_loop()
    answer: asyncio.Future[str] = loop.create_future()

    def settle(text: str) -> None:
        if not answer.done():
            answer.set_result(text)

    def read() -> None:
        print(f"{question} [Y/n] ", end="", file=sys.stderr, flush=True)
        text = sys.stdin.readline()
        with suppress(RuntimeError):  # the run has ended meanwhile
            loop.call_soon_threadsafe(settle, text)

    threading.Thread(target=read, name="orphans", daemon=True).start()
    # At the end of the input there is nobody to ask: an empty answer without a line feed keeps the goal.
    return (await answer).strip().lower() in ("y", "yes") or answer.result() == "\n"


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
