"""``jacaros run FILE``."""

import asyncio
import sys
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import click

from jacaros.bdi.mind import Mind
from jacaros.cli.graph_options import (
    faults_option,
    graph_options,
    orphan_policy,
    orphans_option,
    parameter_options,
    read_remaps,
    ros_option,
)
from jacaros.cli.outputs import OUTPUT_GONE, RECORD_LIMIT, Outputs
from jacaros.cli.view_options import ViewCommand, view_options
from jacaros.errors import UsageError
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.console import StandardConsole
from jacaros.mas.deployment import Deployment
from jacaros.mas.launch import launch
from jacaros.mas.loading import load_deployment
from jacaros.mas.options import RunOptions
from jacaros.mas.system import System
from jacaros.output import CLOSING, PATIENCE
from jacaros.text_files import is_file

FAST_PATIENCE = 1.0
"""Seconds that a run on the virtual clock waits for a reader; its agents miss nothing meanwhile."""
HOW_TO_END = "press Ctrl+C to end the run, or start it with --until-idle"
MOST_NAMES = 8
"""Agents that wait, in the note that a run has nothing left to do."""
SUFFIXES = (".asl", ".mas2j", ".jcm", ".py")
"""Of files that can be run."""


@click.command("run", cls=ViewCommand, short_help="Run an agent program or a project.")
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--clock",
    type=click.Choice(["real", "fast", "ros"]),
    envvar="JACAROS_CLOCK",
    show_envvar=True,
    help="Clock to run on: real (default), fast (virtual time; with --ros memory only) or ros (follow /clock).",
)
@click.option(
    "--seed", type=int, help="Seed for random numbers. With --clock fast, the whole run is reproducible."
)
@ros_option("ROS graph to use (default: memory, in-process).")
@click.option(
    "--world",
    metavar="FILE",
    envvar="JACAROS_WORLD",
    show_envvar=True,
    help="World file, or the name of a world that comes with jacaros; `none`: a graph without a robot.",
)
@faults_option
@click.option(
    "--mapping",
    "mappings",
    metavar="FILE",
    multiple=True,
    help="Mapping file of a robot; a lone program focuses its artifacts. Repeatable.",
)
@click.option("--until-idle", is_flag=True, help="Exit once all agents are idle.")
@click.option(
    "--fail-on-lost-goal",
    is_flag=True,
    help="Exit with code 1 instead of 0 if a goal failed and no plan took over, or an exception ended an agent in Python.",
)
@click.option("--for", "seconds", type=float, metavar="S", help="Exit after S seconds of the run's clock.")
@click.option(
    "--guard",
    is_flag=True,
    help="Have a process of its own stop the robot if this one dies, freezes or is stuck (real graphs only). Uses the "
    "`jacaros guard` of this node, or starts one.",
)
@graph_options
@orphans_option
@parameter_options
@click.option(
    "--rosout/--no-rosout",
    default=None,
    help="Write output of agents, and warnings, to /rosout, too (default: on real graphs).",
)
@click.option(
    "--diagnostics/--no-diagnostics",
    default=None,
    help="Publish the state of agents and connection on /diagnostics (default: on real graphs).",
)
@click.option(
    "--record",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Record the run as JSON lines; FILE.gz is compressed, and FILE.mcap is for Foxglove (extra mcap).",
)
@click.option(
    "--record-limit",
    type=click.IntRange(1),
    default=RECORD_LIMIT,
    metavar="MB",
    show_default=True,
    help="Limit of the recording, in megabytes; FILE.1 has its older half.",
)
@click.option(
    "--replay",
    type=click.Path(path_type=Path),
    metavar="FILE.html",
    help="Write the page of the run to FILE.html, which needs no server.",
)
@click.option(
    "--ground-truth",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the ground truth of the world to FILE (JSON lines).",
)
@click.option(
    "--restrict",
    "restricted",
    is_flag=True,
    help="Forbid agents to take plans from others (tellHow), to use files (.include, .save_agent, .list_files, "
    ".create_agent with a program) and to make Python objects (cartago.*): the step fails.",
)
@click.option(
    "--explain",
    "explained",
    metavar="EVENT",
    multiple=True,
    help="Explain on the standard error output how EVENT is handled each time, such as '+alarm(_)' or '!go(dock)'. "
    "Repeatable.",
)
@view_options
@click.option("--quiet", is_flag=True, help="Print only warnings and errors.")
def command(
    file: Path,
    clock: str | None,
    remap: tuple[str, ...],
    orphans: str,
    param: tuple[str, ...],
    params_file: tuple[Path, ...],
    record: Path | None,
    record_limit: int,
    replay: Path | None,
    ground_truth: Path | None,
    view: str | None,
    view_port: int,
    view_address: str,
    view_token: str | None,
    quiet: bool,
    explained: tuple[str, ...],
    **given: Any,
) -> int:
    """Run FILE: an agent program (.asl, or .py for an agent in Python) or a project (.mas2j, .jcm).

    Output of agents goes to the standard output as `[agent] text`, everything else to the standard error output.

    Compiled plans are kept in $XDG_CACHE_HOME/jacaros (default: ~/.cache/jacaros), so that the next start is faster. Set
    JACAROS_CACHE to another folder, or to 0 to keep nothing. You can remove the folder at any time.
    """  # fmt: skip
    check_file(file)
    outputs = Outputs(
        record,
        replay,
        ground_truth,
        view or "",
        view_address,
        view_port,
        view_token,
        record_limit * 1_000_000,
    )
    outputs.check()
    _check_events(explained)
    options = RunOptions(
        remap=read_remaps(remap) if remap else {},
        orphans=orphan_policy(orphans),
        explain=bool(explained),
        show_world=outputs.ground_truth is not None,
        **given,
    )
    project: Path | Deployment = file
    if param or params_file:
        project = load_deployment(file)
        parameters = _parameters(project, param, params_file, options)
        simulated = parameters.pop("use_sim_time", False)
        if not isinstance(simulated, bool):
            raise UsageError(f"the parameter use_sim_time is true or false, not {simulated!r}")
        if simulated and clock is None and options.real_graph:
            clock = "ros"
        options = replace(options, parameters=parameters)
    options = replace(options, fast=clock == "fast", ros_clock=clock == "ros")
    console = StandardConsole(
        "warning" if quiet else "info", patience=FAST_PATIENCE if options.fast else PATIENCE
    )
    code = 1
    try:
        code = _launch(project, options, console, outputs, explained)
        return code
    finally:
        _close(console, code)


def _parameters(
    project: Deployment, written: Sequence[str], files: Sequence[Path], options: RunOptions
) -> dict[str, Any]:
    from jacaros.cli.ros_arguments import read_parameters  # here: few runs are given any
    from jacaros.mas.ros_graph import node_name

    name = f"{options.namespace}/{options.node_name or node_name(project.name)}"
    return read_parameters(written, files, name, "/" if options.ros == "ros1" else ".")


def _launch(
    file: Path | Deployment,
    options: RunOptions,
    console: StandardConsole,
    outputs: Outputs,
    explained: Sequence[str] = (),
) -> int:
    def begin(mas: System) -> None:
        if explained:
            _announce(mas, explained)
        if options.fast:
            # As in `| head`: nobody wants the rest, and no robot depends on the agents.
            loop = asyncio.get_running_loop()
            end = partial(mas.stop_system, 0.0, OUTPUT_GONE)
            console.when_gone(lambda: loop.call_soon_threadsafe(end))
        if not options.until_idle and options.seconds is None:
            report_idleness(mas)

    if not outputs.any:
        with console.with_prints():
            return launch(file, options, console, begin)
    # Imported here: numpy, rich and the simulator are for those who want to see something.
    from jacaros.cli.watching import Watching

    def begin_watched(mas: System) -> None:
        begin(mas)
        watching.begin(mas)

    with Watching(console, outputs) as watching, console.with_prints():
        return launch(file, options, watching, begin_watched)


def _check_events(events: Sequence[str]) -> None:
    """Refuse what `--explain` cannot explain, before the run.

    Raises:
        UsageError: one of them is not an event, a goal or a belief.
    """
    if events:
        from jacaros.mas.history.patterns import Pattern  # here: few runs are explained

        for each in events:
            Pattern(each)


def _announce(mas: System, events: Sequence[str]) -> None:
    from jacaros.mas.history.announcing import Announcer  # here: few runs are explained

    Announcer(mas.keep_history(), events, mas.console.log).begin()


def report_idleness(mas: System) -> None:
    """Log once that the run has nothing left to do, if nothing from outside can change that."""
    if mas.options.real_graph:
        return  # any message may

    def idle() -> None:
        stop()
        if not _can_be_woken(mas):
            mas.console.log(f"note: nothing left to do: {_what_waits(mas)}; {HOW_TO_END}")

    stop = mas.idleness.watch(idle)


def _can_be_woken(mas: System) -> bool:
    """Whether something else than the agents may give them something to do: the ROS graph, artifacts, the project's Python
    code."""
    from jacaros.env.standard_artifacts import DEFAULT_TYPES  # here: only for runs that get idle

    if mas.ros.joined is not None or any(type(host) is not AgentHost for host in mas.directory):
        return True
    workspaces = mas.environment.workspaces() if mas.environment is not None else ()
    return any(
        each.type_name not in DEFAULT_TYPES for workspace in workspaces for each in workspace.artifacts()
    )


def _what_waits(mas: System) -> str:
    waiting = [host.name for host in mas.directory if isinstance(host.mind, Mind) and host.mind.alive]
    if not waiting:
        return "no agent has a goal or an event"
    names = ", ".join(waiting[:MOST_NAMES]) + (", ..." if len(waiting) > MOST_NAMES else "")
    return f"the goals of {names} wait, and no agent can wake them"


def _close(console: StandardConsole, code: int) -> None:
    if code > 128:
        console.close(limit=CLOSING)  # a signal is not to be waited for
    elif sys.stderr is not None and sys.stderr.isatty():
        console.close(patience=None)  # `| less`: you may read for as long as you like
    else:
        console.close()


def check_file(file: Path) -> None:
    """Refuse a project file that is not there.

    Raises:
        UsageError: with the names of similar files beside it.
    """
    if is_file(file):
        if file.suffix in (".yaml", ".yml"):
            raise UsageError(
                f"{file} is no program; a mapping file goes with one, jacaros run agent.asl --mapping {file}, and so "
                "does a world: --world"
            )
        return
    if file.is_dir():
        raise UsageError(f"{file} is a folder; give a .asl, .py, .mas2j or .jcm file in it")
    beside = [each.name for each in file.parent.glob("*.*") if each.suffix in SUFFIXES]
    import difflib  # here: only for a file that is not there

    near = [f"{file.name}{suffix}" for suffix in SUFFIXES if f"{file.name}{suffix}" in beside]
    near = near or difflib.get_close_matches(file.name, beside, n=2)
    help = f"; did you mean {' or '.join(str(file.parent / name) for name in near)}?" if near else ""
    raise UsageError(f"file not found: {file}{help}")
