"""``jacaros ros list|show|map|check``: inspect a live ROS graph."""

import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from jacaros.robots.ros.middleware import MIDDLEWARES
from jacaros.runtime.cli.graph_options import address_options, ros_option, world_option
from jacaros.runtime.cli.options import PATH, option, settled, with_options
from jacaros.runtime.cli.usage import examples, usage_error
from jacaros.runtime.mas.options import RunOptions

if TYPE_CHECKING:
    from jacaros.robots.mapping.file import MappingFile
    from jacaros.runtime.cli.graph.joining import Joined

T = TypeVar("T")

_asking = with_options(
    ros_option("ROS graph to inspect: that of the embedded world (memory), or a real one."),
    world_option("World file, or the name of a shipped world; with --ros memory only."),
    address_options,
    option(
        "--timeout S",
        "Seconds to wait for nodes, replies and messages.",
        click.FloatRange(min=0.0, min_open=True),
        default=5.0,
    ),
)
"""Adds the options that select the graph."""


@click.group("ros", short_help="Inspect a live ROS graph, and write mapping files for it.")
def command() -> None:
    """Inspect a live ROS graph, and write and check mapping files for it.

    Without --ros, the commands inspect the graph of the embedded world.
    """  # fmt: skip


@command.command(
    "list",
    short_help="List topics, actions, services and nodes.",
    epilog=examples("jacaros ros list --world house", "jacaros ros list --ros ros2 --rates"),
)
@_asking
@option("--rates", "Listen for 2 seconds and print the rate of each topic, in Hz.")
@option("--json", "Print JSON.", name="as_json")
def list_command(rates: bool, as_json: bool, **graph: Any) -> None:
    """List the topics, actions, services and nodes of the graph with their types.

    Prints tables on a terminal, otherwise one line for each entry.
    """  # fmt: skip
    from jacaros.runtime.cli.graph import joining, listing

    async def look(joined: "Joined") -> None:
        counted = await joining.rates(joined, joined.contents.topics.values()) if rates else {}
        if as_json:
            click.echo(listing.as_json(joined.contents, counted))
        elif sys.stdout.isatty():
            listing.show_tables(joined.contents, counted)
        else:
            for line in listing.as_lines(joined.contents, counted):
                click.echo(line)
        for note in listing.notes(joined.contents):
            click.echo(note, err=True)

    _in_graph(look, **graph)


@command.command(
    "show",
    short_help="Show a topic, action, service, node or type.",
    epilog=examples(
        "jacaros ros show /odom --world house", "jacaros ros show nav2_msgs/action/NavigateToPose --ros ros2"
    ),
)
@click.argument("name")
@_asking
@option("--json", "Print JSON.", name="as_json")
def show_command(name: str, as_json: bool, **graph: Any) -> None:
    """Show NAME: a topic, service, action or node of the graph, or a type such as nav_msgs/msg/Odometry.

    Prints the fields with types, bounds, units and constants, the publishers and subscriptions with their quality of
    service, the next message, and the entry for a mapping file.
    """  # fmt: skip
    from jacaros.runtime.cli.graph import showing
    from jacaros.runtime.cli.graph.listing import find

    async def look(joined: "Joined") -> None:
        things = find(joined, name)
        data = await showing.described_all(joined, things)
        if as_json:
            click.echo(showing.as_json(data))
            return
        for number, each in enumerate(data):
            if number:
                click.echo()
            for line in showing.as_text(each):
                click.echo(line)

    _in_graph(look, **graph)


@command.command(
    "map",
    short_help="Write a first mapping file.",
    epilog=examples(
        "jacaros ros map --ros ros2 -o robot.yaml", "jacaros ros map /odom /cmd_vel --ros ros2 -o robot.yaml"
    ),
)
@click.argument("names", nargs=-1, metavar="[TOPIC|SERVICE|ACTION]...")
@option("-o --output FILE", "File to write (default: standard output).", PATH)
@option("--force", "Overwrite an existing file.")
@_asking
def map_command(names: tuple[str, ...], output: Path | None, force: bool, **graph: Any) -> None:
    """Write a mapping file for the named topics, services and actions; without names, for the usual ones of a robot.

    The usual ones are odometry, laser scan, battery, bumpers, map, velocity, the actions to drive and dock, and services
    without arguments. The file works as written; its comments show how agents use it.
    """  # fmt: skip
    from jacaros.runtime.cli.graph import first_mapping, joining
    from jacaros.runtime.cli.graph.joining import NothingThere
    from jacaros.runtime.cli.graph.listing import find_mappable
    from jacaros.runtime.cli.graph.standard_topics import left_out, usual_things

    if output is not None and output.exists() and not force:
        raise usage_error(f"file exists: `{output}`", "--force overwrites it")
    file = output if output is not None else Path("robot.yaml")

    async def look(joined: "Joined") -> str:
        if names:
            things = [thing for name in names for thing in find_mappable(joined, name)]
            frames: dict[str, str] = {}
            left = []
        else:
            things = usual_things(joined.contents)
            left = left_out(joined.contents, things)
            frames = await joining.frames(joined)
            if not things:
                raise NothingThere(
                    "the graph has no odometry, scan, cmd_vel, battery or action to drive\n"
                    "  = help: name topics, services or actions that `jacaros ros list` shows"
                )
        return first_mapping.mapping_for(joined, things, frames, file.name, _written(**graph), left)

    text = _in_graph(look, **graph)
    if output is None:
        click.echo(text, nl=False)
        return
    output.write_text(text, encoding="utf-8", newline="\n")
    click.echo(f"wrote {output}; see `jacaros describe {output}`")


@command.command(
    "check",
    short_help="Check a mapping file against the graph, or what the base does when commands cease.",
    epilog=examples(
        "jacaros ros check robot.yaml --ros ros2",
        "jacaros ros check --base-timeout --ros ros2 --namespace robot_1",
    ),
)
@click.argument("file", type=PATH, required=False)
@_asking
@option(
    "--base-timeout",
    "Drive the robot at 0.05 m/s for a second, send no more commands, and report when its base stops; at the end, "
    "stop the robot.",
)
@option("--yes", "Drive without asking whether the way is free.")
def check_command(file: Path | None, base_timeout: bool, yes: bool, **graph: Any) -> int:
    """Check that the topics, servers, frames and parameters in the mapping FILE exist in the graph, with the same types.

    Each problem is reported with its line, what was found, and a suggested fix. The exit code is 1 if there is one. A
    warning names other nodes that publish velocities to the same robot.

    With --base-timeout, FILE can be omitted; it names the topics if the robot's are not `cmd_vel` and `odom`. The exit
    code is 1 if the base keeps driving when commands cease.
    """  # fmt: skip
    if file is None and not base_timeout:
        raise usage_error("missing argument: `FILE`", "name a mapping file, or add --base-timeout")
    if base_timeout and not yes and not _may_drive(graph["ros"]):
        return 1
    from jacaros.robots.mapping.file import find_mapping, load_mapping

    mapping = None if file is None else load_mapping(find_mapping(str(file)) or file)

    async def look(joined: "Joined") -> int:
        problems = 0 if mapping is None else await _check_mapping(joined, mapping, str(file))
        drives = not base_timeout or await _check_base(joined, mapping, graph["namespace"])
        return 0 if not problems and drives else 1

    return _in_graph(look, **graph)


async def _check_mapping(joined: "Joined", mapping: "MappingFile", name: str) -> int:
    """Print the problems of a mapping file, and return their number."""
    from jacaros.runtime.cli.graph import joining
    from jacaros.runtime.cli.graph.verifying import problems_of, warnings_of
    from jacaros.runtime.files.yaml import shown

    parts = mapping.artifacts.values()
    frames = await joining.frames(joined) if any(part.frames for part in parts) else {}
    problems = [each for part in parts for each in await problems_of(joined, part, frames)]
    warnings = list(dict.fromkeys(each for part in parts for each in warnings_of(joined, part)))
    lines = mapping.text.splitlines()
    for problem in problems:
        click.echo(shown(mapping.file, lines, problem))
    for warning in warnings:
        click.echo(shown(mapping.file, lines, warning, "warning: "))
    count = f"{len(problems)} problem{'s' if len(problems) != 1 else ''}"
    click.echo(f"{count} with this graph" if problems else f"{name} matches this graph", err=bool(problems))
    return len(problems)


def _may_drive(ros: str) -> bool:
    """Ask whether a real robot may drive."""
    from jacaros.runtime.cli.graph.base_timeout import QUESTION

    if ros == "memory":
        return True
    if not sys.stdin.isatty():
        raise usage_error("--base-timeout drives the robot", "check that the way is free, and add --yes")
    return click.confirm(QUESTION, err=True)


async def _check_base(joined: "Joined", mapping: "MappingFile | None", namespace: str) -> bool:
    """Drive, print what the base did, and return whether it stops by itself."""
    from jacaros.runtime.cli.graph.base_timeout import Drive, find_base, verdict
    from jacaros.runtime.cli.graph.verifying import nodes_of, topics_of

    parts = mapping.artifacts.values() if mapping is not None else ()
    named = {name for part in parts for name in topics_of(joined, part)}
    command, odometry = find_base(joined, named, namespace)
    click.echo(f"driving with `{command.name}`, watching `{odometry.name}`")
    if command.publishers:
        click.echo(f"warning: {nodes_of(command.publishers)} may command `{command.name}`, too", err=True)
    ceased = await Drive(joined, command, odometry).run()
    click.echo(verdict(ceased))
    return ceased.seconds is not None


def _in_graph(
    look: Callable[[Any], Awaitable[T]],
    timeout: float,
    **graph: Any,
) -> T:
    """Join the graph that the options select, and run *look* in it."""
    from jacaros.runtime.cli.graph.joining import clock_for, joined
    from jacaros.runtime.clock import run

    options, notes = settled(RunOptions(**graph))
    for note in notes:
        click.echo(note, err=True)
    clock = clock_for(options)

    async def main() -> T:
        async with joined(options, clock, timeout) as there:
            return await look(there)

    return run(main, clock)


def _written(ros: str, world: str | None, **rest: Any) -> str:
    """Return the options as on the command line, for commands in comments."""
    parts = [f"--ros {ros}"] if ros != "memory" else []
    parts += [f"--world {world}"] if world is not None else []
    for kind in MIDDLEWARES.values():
        if rest.get(kind.option) is not None:
            parts.append(f"{kind.flag} {rest[kind.option]}")
    return "".join(f" {part}" for part in parts)
