"""Options that several commands share, and those that environment variables set.

Options of the environment are defaults of a terminal, so a project's own world overrides them. From strong to weak: the
command line, the project file, the environment.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import click
from click.core import ParameterSource

from jacaros.agents.language.offers import OBSERVER, OPERATOR, USER
from jacaros.runtime.cli.outputs import LOOPBACK
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import NO_WORLD

F = TypeVar("F", bound=Callable[..., Any])

PATH = click.Path(path_type=Path)


class VariableOption(click.Option):
    """An option with an environment variable, of which messages about its value remind.

    ``Context.obj``, which all commands of a call share, maps the options that the environment has set to their variables.
    """

    def consume_value(self, ctx: click.Context, opts: Any) -> tuple[Any, ParameterSource]:
        """Return the value of the option, and note whether the environment has set it."""
        value, source = super().consume_value(ctx, opts)
        if source is ParameterSource.ENVIRONMENT:
            variables(ctx)[self.opts[0]] = str(self.envvar)
        return value, source


def variables(context: click.Context | None = None) -> dict[str, str]:
    """Return the variables that have set options of this call, by option, such as ``--world``."""
    found: dict[str, str] = (context or click.get_current_context()).ensure_object(dict)
    return found


def option(
    declared: str, help: str, type: Any = None, name: str | None = None, **settings: Any
) -> Callable[[F], F]:
    """Return an option, declared as help texts show it.

    Its default is shown, and it may have an environment variable (`VariableOption`).

    Args:
        declared: ``--strict`` is a flag, ``--record FILE`` has a value, and ``--mapping FILE...`` can be repeated.
        help: its line in help texts.
        type: type of the value; None for a text, or that of the default.
        name: name of the parameter; None for that of the option.
        settings: for `click.option`.
    """
    *flags, last = declared.split()
    metavar = None if last.startswith("-") else last.removesuffix("...")
    flags += [last] if metavar is None else []
    if metavar is None and type is None and "/" not in last:
        settings["is_flag"] = True
    elif last.endswith("..."):
        settings["multiple"] = True
    if "envvar" in settings:
        settings |= {"cls": VariableOption, "show_envvar": True}
    if "default" in settings:
        settings.setdefault("show_default", True)
    names = flags if name is None else [*flags, name]
    return click.option(*names, help=help, type=type, metavar=metavar, **settings)


imports_option = option(
    "--import",
    "Run the Python files of the project to find all their declarations (default: read them only).",
    name="imports",
)
ground_truth_option = option(
    "--ground-truth FILE", "Write the ground truth of the world to FILE (JSON lines).", PATH
)


def with_options(*options: Callable[[F], F]) -> Callable[[F], F]:
    """Return a decorator that adds the options to a command, in this order."""

    def add(command: F) -> F:
        for option in reversed(options):
            command = option(command)
        return command

    return add


def settled(
    options: RunOptions, project: str = "", world: str | Path | None = None
) -> tuple[RunOptions, list[str]]:
    """Return the options without those of the environment that the command line or the project overrides.

    A world that either of them names is simulated in this process, whatever graph the environment names; and a world of
    the environment is never simulated in a real graph.

    Args:
        options: the options of the command.
        project: the name of the project's file.
        world: the world that the project names; None for none.

    Returns:
        The options, and a note for each that is ignored.
    """
    by_variable, notes = variables(), list[str]()

    def ignored(name: str, because: str, instead: Any) -> RunOptions:
        value = getattr(options, name)
        variable = by_variable.pop(f"--{name}")
        notes.append(f"note: {because}; {variable}={value} is ignored (to use it: --{name} {value})")
        return replace(options, **{name: instead})

    if "--world" in by_variable and world not in (None, options.world):
        options = ignored("world", f"{project} names the world `{world}`", None)
    own = options.world if "--world" not in by_variable else None
    if "--ros" in by_variable and options.real_graph and (own or world) not in (None, NO_WORLD):
        who = "--world names" if own is not None else f"{project} names"
        options = ignored("ros", f"{who} the world `{own or world}`, which runs in this process", "memory")
    if "--world" in by_variable and options.real_graph:
        options = ignored("world", f"the run joins a real graph (--ros {options.ros})", None)
    return options, notes


# The view of a run: a page in the browser, or the terminal.


place_options = with_options(
    option(
        "--view-port PORT",
        "Port of the page (default: a free one).",
        click.IntRange(0, 65535),
        default=0,
        show_default=False,
    ),
    option(
        "--view-address ADDRESS",
        "Address of this machine to serve the page at. Any other than the default lets other machines see and command "
        "the run, and needs a token.",
        default=LOOPBACK,
    ),
    option(
        "--view-token TOKEN",
        "Token in the address of the page, at least 16 characters (default: random).",
        envvar="JACAROS_VIEW_TOKEN",
    ),
)
"""Add the options that say where to serve a page."""

view_options = with_options(
    option(
        "--view [=terminal]",
        "Show the run on a page in the browser (`--view`) or in the terminal (`--view=terminal`).",
        click.Choice(["page", "terminal"]),
    ),
    place_options,
    option(
        "--view-role ROLE",
        "What the page may do: an `observer` only looks; a `user` also gives goals that agents offer, and answers their "
        "questions; an `operator` may do everything.",
        click.Choice([OBSERVER, USER, OPERATOR]),
        default=OPERATOR,
    ),
    option(
        "--view-in-frame",
        "Let other pages show the page in a frame, as editors do in a tab. No browser is opened.",
    ),
)
"""Add the options of a run's page, and `place_options`; the command's class must be `ViewCommand`."""


class ViewCommand(click.Command):
    """A command whose option ``--view`` takes a value only after ``=``: the next argument may be the file to run."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        return super().parse_args(ctx, ["--view=page" if each == "--view" else each for each in args])
