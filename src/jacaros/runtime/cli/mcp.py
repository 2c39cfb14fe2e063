"""``jacaros mcp FILE``."""

from collections.abc import Iterable
from importlib.util import find_spec

import click

from jacaros.agents.language.offers import OBSERVER, OPERATOR, USER
from jacaros.runtime.cli import run
from jacaros.runtime.cli.options import option, variables
from jacaros.runtime.cli.usage import examples, usage_error
from jacaros.runtime.mas.system import System
from jacaros.serving.stdio import claim


def check_installed() -> None:
    """Check that the SDK is installed.

    Raises:
        UsageError: it is not.
    """
    if find_spec("mcp") is None:
        raise usage_error("MCP needs the Python package mcp", 'pip install "jacaros[mcp]"')


@click.command(
    "mcp",
    context_settings={"ignore_unknown_options": True},
    epilog=examples(
        "jacaros mcp robot.asl --world house",
        "jacaros mcp robot.asl --mapping robot.yaml --ros ros2 --guard --role user --role nurse",
    ),
)
@option(
    "--role ROLE...",
    f"Role of the client: {OBSERVER}, {USER} (default), {OPERATOR}, or a role of your offers. Repeatable.",
    name="roles",
)
@option(
    "--wait S",
    "Seconds after which the tool of a goal returns although the goal continues (default: no limit).",
    click.FloatRange(min=0),
    name="patience",
)
@click.argument("options", nargs=-1, type=click.UNPROCESSED, metavar="FILE [OPTIONS OF jacaros run]...")
def command(roles: Iterable[str], patience: float | None, options: tuple[str, ...]) -> int:
    """Run FILE, and serve what its agents offer to a language model: MCP on the standard input and output.

    Your MCP client starts this command. The output of agents goes to the standard error output. The run ends when the
    client closes the standard input, and all goals that continue without it have ended.
    """  # fmt: skip
    check_installed()
    context = run.command.make_context("jacaros mcp", list(options), obj=variables())
    from jacaros.serving.mcp.stdio import StdioDoor  # here: it imports much

    def open_door(mas: System) -> None:
        StdioDoor(mas, wire, frozenset(roles or (USER,)), patience)

    context.params["open_door"] = open_door
    wire = claim()
    with context:
        code: int = run.command.invoke(context)
    return code
