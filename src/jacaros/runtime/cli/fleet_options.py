"""Options of a run in a fleet: which part of a project this process runs, and which member of which fleet it is."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import click

from jacaros.runtime.cli.options import PATH, ViewCommand, option, with_options
from jacaros.runtime.cli.usage import listed, usage_error
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.mas.deployment import Deployment, NodeSpec
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import Join

fleet_options = with_options(
    option("--node NAME", "Run only this node of the project, as a member of a fleet (see --fleet)."),
    option("--all-nodes", "Run every node of the project, each in its own process on this computer."),
    option(
        "--fleet NAME",
        "Fleet to join: systems that exchange messages and share workspaces (default with --node and --all-nodes: the "
        "name of the project).",
    ),
    option("--member NAME", "Name of this system in the fleet (default: that of the node or the file)."),
    option(
        "--fleet-keys DIR",
        "Folder with the keys of this member; with --all-nodes, a folder with one for each node. Without keys, a fleet is "
        "limited to this computer.",
        PATH,
    ),
    option(
        "--router ADDRESS...",
        "Router of the fleet, such as lab.example:7447, for networks without multicast. Repeatable.",
        name="fleet_routers",
    ),
    option(
        "--fleet-allow MEMBER=RIGHTS...",
        "What a member (`*`: any other) may do here: send, see, operate, tell_how, stop (default: the first three). "
        "Repeatable.",
        name="fleet_allow",
    ),
    option(
        "--fleet-lease S",
        "Seconds without a sign of life after which another member is lost (default: 2).",
        click.FloatRange(0.5),
        default=2.0,
    ),
)
"""Add the options of a fleet; the command's class must be `RunCommand`."""
_ARGUMENTS = f"{__name__}.arguments"


class RunCommand(ViewCommand):
    """A command that keeps its arguments, for the processes of nodes."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        ctx.meta[_ARGUMENTS] = tuple(args)
        return super().parse_args(ctx, args)


def given_arguments() -> Sequence[str]:
    """Return the arguments of the running `RunCommand`."""
    arguments: Sequence[str] = click.get_current_context().meta[_ARGUMENTS]
    return arguments


def as_member(
    file: Path, project: Deployment, options: RunOptions, node: str | None, all_nodes: bool
) -> tuple[Deployment, RunOptions]:
    """Return the part of a project that runs at *node*, and the options with the defaults of a fleet.

    Raises:
        UsageError: the project has no such node, or the options exclude each other.
    """
    if node is None and not all_nodes:
        member = file.stem if options.fleet is not None else None
        return project, replace(options, member=options.member or member)
    if node is not None and all_nodes:
        raise usage_error("--node excludes --all-nodes", f"jacaros run {file} --node {node}")
    if options.member is not None:
        raise usage_error("--member excludes --node and --all-nodes", "a node is the member of its name")
    options = replace(options, fleet=options.fleet or project.name, member=node)
    names = [each.name for each in project.nodes]
    if not names:
        raise usage_error(f"`{file}` declares no nodes", "add a section to the project: `node lab`")
    from jacaros.fleet.names import check_name  # here: few runs are in a fleet

    for name in names:
        check_name("member", name)
    if node is None:
        return project, options
    if node not in names:
        known = f"nodes of `{file}`: {listed(names)}"
        raise usage_error(f"unknown node `{node}`", suggestion(node, names, known))
    from jacaros.runtime.mas.project.nodes import at_node  # here: most projects have no nodes

    return at_node(project, node), options


def join_of(options: RunOptions, log: Callable[[str], None]) -> Join | None:
    """Return the function that joins a run to its fleet. None: it is in no fleet.

    Raises:
        UsageError: names, keys or rights are invalid.
    """
    if options.fleet is None or options.member is None:
        return None
    options.check()
    from jacaros.fleet.joining import joining  # here: few runs are in a fleet
    from jacaros.fleet.keys import find_keys
    from jacaros.fleet.network import Network
    from jacaros.fleet.on_zenoh import ZenohCarrier
    from jacaros.fleet.rights import read_rights

    keys = options.fleet_keys or find_keys(options.fleet, options.member)
    network = Network(
        options.fleet, options.member, keys, tuple(options.fleet_routers), lease=options.fleet_lease
    )
    reach = "on this computer alone" if keys is None else f"with the keys in {keys}"
    log(f"[fleet] {network.member} in the fleet {network.fleet}, {reach}")
    carrier = ZenohCarrier(network, lambda line: log(f"[fleet] {line}"))
    return joining(carrier, network.member, read_rights(options.fleet_allow), network.lease)


def note_on_nodes(nodes: Sequence[NodeSpec]) -> str:
    """Return the note for a run that ignores the nodes of its project."""
    names = [f"`{each.name}`" for each in nodes]
    return (
        f"note: the nodes {listed(names)} run in one process; --all-nodes runs each in its own, and --node "
        f"{nodes[0].name} runs one of them"
    )
