"""Options of the view of a run: a page in the browser, or the terminal."""

from collections.abc import Callable
from typing import Any

import click

from jacaros.cli.outputs import LOOPBACK
from jacaros.cli.variables import VariableOption

_PLACE = (
    click.option(
        "--view-port",
        type=click.IntRange(0, 65535),
        default=0,
        metavar="PORT",
        help="Port of the page (default: a free one).",
    ),
    click.option(
        "--view-address",
        default=LOOPBACK,
        metavar="ADDRESS",
        show_default=True,
        help="Address of this machine to serve the page at. Any other than the default lets other machines see and command "
        "the run, and needs a token.",
    ),
    click.option(
        "--view-token",
        cls=VariableOption,
        metavar="TOKEN",
        envvar="JACAROS_VIEW_TOKEN",
        show_envvar=True,
        help="Token in the address of the page, at least 16 characters (default: random).",
    ),
)


def place_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options that say where to serve a page."""
    for option in reversed(_PLACE):
        command = option(command)
    return command


def view_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options ``--view`` and `place_options`; the command's class must be `ViewCommand`."""
    command = place_options(command)
    return click.option(
        "--view",
        type=click.Choice(["page", "terminal"]),
        metavar="[=terminal]",
        help="Show the run on a page in the browser (`--view`) or in the terminal (`--view=terminal`).",
    )(command)


class ViewCommand(click.Command):
    """A command whose option ``--view`` takes a value only after ``=``: the next argument may be the file to run."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        return super().parse_args(ctx, ["--view=page" if each == "--view" else each for each in args])
