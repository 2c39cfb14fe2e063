"""``jacaros run FILE``, and ``jacaros demo``."""

import asyncio
import os
import shlex
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TextIO

import click

from jacaros.agents.mind.mind import Mind
from jacaros.runtime.cli.fleet_options import (
    RunCommand,
    as_member,
    fleet_options,
    given_arguments,
    join_of,
    note_on_nodes,
)
from jacaros.runtime.cli.graph_options import (
    faults_option,
    graph_options,
    noise_option,
    orphans_option,
    parameter_options,
    read_remaps,
    ros_option,
    world_option,
)
from jacaros.runtime.cli.options import (
    PATH,
    ground_truth_option,
    option,
    settled,
    variables,
    view_options,
)
from jacaros.runtime.cli.outputs import OUTPUT_GONE, RECORD_LIMIT, RequestedOutputs, has_display, write_output
from jacaros.runtime.cli.serving import RequestedService, serve_options
from jacaros.runtime.cli.usage import examples, listed, not_found, usage_error
from jacaros.runtime.files.texts import is_file
from jacaros.runtime.input import LineInput
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.console import StandardConsole
from jacaros.runtime.mas.deployment import Deployment
from jacaros.runtime.mas.launch import launch, load_deployment
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System
from jacaros.runtime.output import CLOSING, PATIENCE

FAST_PATIENCE = 1.0
"""Seconds that a run on the virtual clock waits for a slow reader of its output; its agents miss nothing meanwhile."""
HOW_TO_END = "press Ctrl+C to end the run, or start it with --until-idle"
SUFFIXES = (".asl", ".mas2j", ".jcm", ".py")
"""Suffixes of files that can be run."""


@click.command(
    "run",
    cls=RunCommand,
    epilog=examples(
        "jacaros run hello.asl",
        "jacaros run robot.asl --world house --view",
        "jacaros run house.jcm --clock fast --seed 1 --until-idle",
        "jacaros run robot.asl --mapping robot.yaml --ros ros2 --guard",
        "jacaros run house.jcm --record run.jsonl",
        "jacaros run robot.asl --world house --serve 8000",
        "jacaros run house.jcm --all-nodes",
    ),
)
@click.argument("file", type=PATH)
@option(
    "--clock",
    "Clock to run on: real (default), fast (virtual time; with --ros memory only) or ros (follow /clock).",
    click.Choice(["real", "fast", "ros"]),
    envvar="JACAROS_CLOCK",
)
@option("--seed", "Seed for random numbers. With --clock fast, the whole run is reproducible.", int)
@ros_option("ROS graph to join: memory (in-process), or a real one.")
@world_option("World file, or the name of a shipped world; `none` for a graph without robots.")
@noise_option
@faults_option
@option(
    "--mapping FILE...",
    "Mapping file of a robot; a program without a project file focuses its artifacts. Repeatable.",
    name="mappings",
)
@option("--until-idle", "Exit once all agents are idle.")
@option(
    "--fail-on-lost-goal",
    "Exit with code 1 if a goal failed that no plan handled, or an exception ended an agent in Python.",
)
@option("--for S", "Exit after S seconds of the run's clock.", float, name="seconds")
@option(
    "--guard",
    "Start a separate process that stops the robot if this one dies, freezes or is stuck (real graphs only), or use "
    "a running `jacaros guard` for this node; also publish a heartbeat for a guard on the robot's computer.",
)
@graph_options
@orphans_option
@option(
    "--offer",
    "Offer in the ROS graph what the agents offer: goals as actions, beliefs as topics, questions as services (default: if "
    "a mapping file has `offers`).",
)
@option(
    "--lifecycle",
    "Make the node a managed one (ROS 2): the agents wait for the transitions `configure` and `activate`.",
)
@fleet_options
@parameter_options
@option(
    "--rosout/--no-rosout",
    "Also publish the output of agents, and warnings, on /rosout (default: on real graphs).",
    default=None,
)
@option(
    "--record FILE",
    "Record the run to FILE: JSON lines, compressed if it ends in .gz.",
    PATH,
)
@option(
    "--record-limit MB",
    "Size limit of the recording, in megabytes; the older half is in FILE.1.",
    click.IntRange(1),
    default=RECORD_LIMIT,
)
@option("--replay FILE.html", "Write the run as a page that needs no server.", PATH)
@ground_truth_option
@option(
    "--restrict",
    "Forbid agents to take plans from others (tellHow), to use files (.include, .save_agent, .list_files, "
    ".create_agent with a program) and to create Python objects (cartago.*): such a step fails.",
    name="restricted",
)
@option(
    "--explain EVENT...",
    "Log how EVENT is handled each time, such as '+alarm(_)' or '!go(dock)'. Repeatable.",
    name="explained",
)
@view_options
@serve_options
@option("--quiet", "Print only warnings and errors.")
def command(
    file: Path,
    clock: str | None,
    remap: tuple[str, ...],
    param: tuple[str, ...],
    params_file: tuple[Path, ...],
    quiet: bool,
    offer: bool,
    lifecycle: bool,
    explained: tuple[str, ...],
    node: str | None,
    all_nodes: bool,
    open_door: Callable[[System], None] | None = None,
    streams: tuple[TextIO, TextIO] | None = None,
    **given: Any,
) -> int:
    """Run FILE: an agent program (.asl, or .py for an agent in Python) or a project (.mas2j, .jcm).

    The output of agents goes to the standard output as `[agent] text`, everything else to the standard error output.
    A line on the standard input answers the oldest open question of an agent to a person, see the artifact Operator.
    """
    check_file(file)
    outputs = RequestedOutputs.taken_from(given)
    outputs.check()
    service = RequestedService.taken_from(given)
    service.check()
    if all_nodes and service.serve is not None:
        raise usage_error("--serve serves one node", "name it: --node NAME instead of --all-nodes")
    if explained:
        from jacaros.look.why.patterns import QuestionPattern  # here: few runs are explained

        for each in explained:
            QuestionPattern(each)  # refuses what is not an event, a goal or a belief
    options = RunOptions(
        remap=read_remaps(remap) if remap else {},
        explain=bool(explained),
        show_world=outputs.ground_truth is not None,
        **given,
    )
    project = load_deployment(file)
    options, notes = settled(options, file.name, project.world)
    if len(project.nodes) > 1 and node is None and not all_nodes:
        notes.append(note_on_nodes(project.nodes))
    project, options = as_member(file, project, options, node, all_nodes)
    if param or params_file:
        parameters = _parameters(project, param, params_file, options)
        simulated = parameters.pop("use_sim_time", False)
        if not isinstance(simulated, bool):
            raise usage_error(
                f"invalid parameter use_sim_time: expected true or false, found `{simulated!r}`"
            )
        if simulated and (clock is None or "--clock" in variables()) and options.real_graph:
            clock = "ros"
        options = replace(options, parameters=parameters)
    options = replace(options, fast=clock == "fast", ros_clock=clock == "ros")
    if lifecycle and options.ros not in ("memory", "ros2"):
        raise usage_error("--lifecycle needs a ROS 2 graph", "add --ros ros2")
    if all_nodes:
        options.check()
        return _run_nodes(project, outputs, options.fleet_keys)
    own = service.own_console()
    stream, errors = streams or 2 * (None if own is None else own.stream,)
    patience = FAST_PATIENCE if options.fast else PATIENCE
    console = StandardConsole("warning" if quiet else "info", stream, errors, patience)
    for each in notes:
        console.log(each)
    code = 1
    try:

        def open_doors(mas: System) -> None:
            service.begin(mas, console.log, own)
            _open_to_ros(mas, offer=offer, lifecycle=lifecycle)
            if open_door is not None:
                open_door(mas)

        code = _launch(project, options, console, outputs, explained, open_doors)
        return code
    finally:
        _close(console, code)


def _run_nodes(project: Deployment, outputs: RequestedOutputs, keys: Path | None) -> int:
    from jacaros.runtime.cli.nodes import Nodes, arguments_of_nodes  # here: few runs start other processes

    names = [each.name for each in project.nodes]
    return Nodes(names, arguments_of_nodes(given_arguments(), outputs, keys)).run()


def _parameters(
    project: Deployment, written: Sequence[str], files: Sequence[Path], options: RunOptions
) -> dict[str, Any]:
    from jacaros.runtime.cli.ros_arguments import read_parameters  # here: few runs have parameters
    from jacaros.runtime.mas.ros_graph import node_name

    name = f"{options.namespace}/{options.node_name or node_name(project.name)}"
    return read_parameters(written, files, name, "/" if options.ros == "ros1" else ".")


def _launch(
    project: Deployment,
    options: RunOptions,
    console: StandardConsole,
    outputs: RequestedOutputs,
    explained: Sequence[str] = (),
    open_doors: Callable[[System], None] = lambda _: None,
) -> int:
    def begin(mas: System) -> None:
        if sys.stdin is not None:  # otherwise the descriptor 0 may be another file
            mas.input = LineInput()
        open_doors(mas)
        if explained:
            from jacaros.look.why.why import Announcer  # here: few runs are explained

            history = mas.keep_history()
            history.listen(Announcer(history.all, explained, mas.console.log).hear)
        if options.fast:
            # As in `| head`: no reader wants the rest, and no robot depends on the agents.
            loop = asyncio.get_running_loop()
            end = partial(mas.stop_system, 0.0, OUTPUT_GONE)
            console.when_gone(lambda: loop.call_soon_threadsafe(end))
        if not options.until_idle and options.seconds is None:
            report_idleness(mas)

    join = join_of(options, console.log)
    if not outputs.any:
        with console.with_prints():
            return launch(project, options, console, begin, join=join)
    # Imported here: numpy, rich and the simulator are needed only for views and recordings.
    from jacaros.runtime.cli.watching import Watching

    def begin_watched(mas: System) -> None:
        begin(mas)
        watching.begin(mas)

    with Watching(console, outputs) as watching, console.with_prints():
        code = launch(project, options, watching, begin_watched, join=join)
    return code or int(watching.incomplete)


def _open_to_ros(mas: System, offer: bool, lifecycle: bool) -> None:
    """Offer in the ROS graph what the agents offer, and serve the lifecycle of the node, where wanted."""
    if not offer and mas.has_environment and (mas.options.mappings or mas.deployment.workspaces):
        from jacaros.runtime.mas.mappings import files_with_offers  # here: most runs have no mappings

        offer = bool(files_with_offers(mas.deployment, mas.options.mappings))
    if not (offer or lifecycle):
        return
    from jacaros.serving.ros.opening import open_door  # here: few runs are open to the graph

    if lifecycle:
        from jacaros.serving.ros.lifecycle import Lifecycle

        Lifecycle(mas, partial(open_door, mas) if offer else None)
    else:
        open_door(mas)


def report_idleness(mas: System) -> None:
    """Log once that the run has nothing left to do, if nothing from outside can change that."""
    if mas.options.real_graph or mas.options.fleet is not None or mas.service is not None:
        return  # any message or request may wake an agent

    def idle() -> None:
        stop()
        if not _can_be_woken(mas):
            mas.console.log(f"note: nothing left to do: {_what_waits(mas)}; {HOW_TO_END}")

    stop = mas.idleness.watch(idle)


def _can_be_woken(mas: System) -> bool:
    """Return whether the ROS graph, an artifact or Python code of the project may wake an agent."""
    from jacaros.artifacts.env.environment import DEFAULT_TYPES  # here: only for idle runs

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
    return f"the goals of {listed(waiting)} wait, and no agent can wake them"


def _close(console: StandardConsole, code: int) -> None:
    if code > 128:
        console.close(limit=CLOSING)  # after a signal, the process must end immediately
    elif sys.stderr is not None and sys.stderr.isatty():
        console.close(patience=None)  # `| less`: the user may read for as long as they like
    else:
        console.close()


def check_file(file: Path) -> None:
    """Check that a file can be run.

    Raises:
        UsageError: the file does not exist (the error suggests similar names), or is of another kind.
    """
    if is_file(file):
        if file.suffix in (".yaml", ".yml"):
            raise usage_error(
                f"`{file}` is not a program or a project",
                f"for a mapping file: jacaros run agent.asl --mapping {file}; for a world file: --world {file}",
            )
        return
    if os.path.isdir(file):
        raise usage_error(f"`{file}` is a folder", "name a .asl, .py, .mas2j or .jcm file in it")
    raise not_found(file, SUFFIXES)


PROGRAM = Path(__file__).with_name("patrol.asl")
ROBOT = ("--world", "patrol", "--mapping", "nav2.yaml", "--mapping", "turtlebot4.yaml")
"""Options of the run: the world of the program, and the mappings of its robot."""


@click.command(
    "demo",
    context_settings={"ignore_unknown_options": True},
    epilog=examples("jacaros demo", "jacaros demo --view=terminal", "jacaros demo --save"),
)
@option("--save", "Write the program to patrol.asl in this folder, and do not run it.")
@click.argument("options", nargs=-1, type=click.UNPROCESSED, metavar="[OPTIONS OF jacaros run]...")
def demo(save: bool, options: tuple[str, ...]) -> int:
    """Run a robot on patrol in the embedded world, and show it on a page in the browser.

    Without a display, the terminal shows it. Press Ctrl+C to stop. Options of `jacaros run` work here, too, such as
    `--view=terminal`, `--clock fast` or `--record run.jsonl`.
    """  # fmt: skip
    if save:
        _save(Path(PROGRAM.name))
        return 0
    chosen = any(each == "--view" or each.startswith("--view=") for each in options)
    view = () if chosen else ("--view" if has_display() else "--view=terminal",)
    arguments = [str(PROGRAM), *ROBOT, *view, *options]
    code: int = command.main(arguments, "jacaros demo", standalone_mode=False, obj=variables())
    return code


def _save(file: Path) -> None:
    if os.path.exists(file):
        raise usage_error(f"file exists: `{file}`", "rename it, or change to another folder")
    write_output(file, PROGRAM.read_bytes(), "change to another folder")
    click.echo(f"wrote {file}; run it with\n  jacaros run {file} {shlex.join(ROBOT)} --view")
