"""Options set by environment variables: they are defaults of a terminal, so a project's own world overrides them.

From strong to weak: the command line, the project file, the environment.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from jacaros.mas.options import RunOptions
from jacaros.mas.ros_graph import NO_WORLD


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


def note(option: str, variable: str) -> str:
    """Return the line below an error that may be about the value of a variable."""
    return f"note: {option} was set by the environment variable {variable}; to ignore it, unset {variable}"


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
