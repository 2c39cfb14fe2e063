"""``jacaros fleet list|ping|stop``: look at the members of a fleet, and stop them."""

import asyncio
import json
from collections.abc import Awaitable, Callable, Iterable, Sequence
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, TypeVar

import click

from jacaros.runtime.cli.options import PATH, option, with_options
from jacaros.runtime.cli.usage import examples, listed, usage_error
from jacaros.runtime.clock import WallClock, run
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import suggestion

if TYPE_CHECKING:
    from jacaros.fleet.operator import Operator, Seen

T = TypeVar("T")

_LOOK = 1.2
"""Seconds for finding the members, which then have half a second to answer."""
_PERIOD = 1.0
"""Seconds between an answer and the next ping."""
_ANSWER = 1.0
"""Seconds within which a ping is answered."""
_END = 10.0
"""Seconds within which a member ends."""

_reaching = with_options(
    option("--router ADDRESS...", "Address of a router of the fleet. Repeatable.", name="routers"),
    option(
        "--keys DIR",
        "Folder of keys: those of `operator`, or of a member (default: those in ~/.config/jacaros/fleets/FLEET).",
        PATH,
    ),
)
"""Adds the options that say how to reach the fleet."""


@click.command(
    "list",
    short_help="List the members of a fleet.",
    epilog=examples("jacaros fleet list lab", "jacaros fleet list lab --json"),
)
@click.argument("fleet")
@_reaching
@option("--json", "Print JSON.", name="as_json")
def list_command(fleet: str, routers: tuple[str, ...], keys: Path | None, as_json: bool) -> None:
    """List the members of FLEET: their agents, workspaces and pages, delays and clocks.

    The delay is that of a message there and back. The clock is how far the member's clock is ahead of this computer's.
    """  # fmt: skip

    async def look(operator: "Operator") -> list["Seen"]:
        return [seen for _, seen in sorted(operator.members.items())]

    members = _visit(look, fleet, routers, keys)
    if as_json:
        click.echo(json.dumps([_data(each) for each in members], indent=2))
    elif not members:
        click.echo(f"fleet {fleet} has no members")
    else:
        header = ("member", "delay", "clock", "agents", "workspaces", "page")
        _show([header, *map(_row, members)])


def _data(seen: "Seen") -> dict[str, object]:
    found: dict[str, object] = {"member": seen.id.name, "problem": _problem(seen)}
    if seen.picture is not None:
        found |= {
            "agents": seen.picture.agents,
            "workspaces": [path for path, _ in seen.picture.workspaces],
            "page": seen.picture.page,
            "delay_seconds": seen.delay,
            "clock_ahead_seconds": seen.channel.clocks.offset if seen.delay is not None else None,
        }
    return found


def _problem(seen: "Seen") -> str:
    return seen.problem or ("does not answer" if seen.picture is None else "")


def _row(seen: "Seen") -> tuple[str, ...]:
    picture = seen.picture
    if picture is None:
        return seen.id.name, _problem(seen)
    return (
        seen.id.name,
        "" if seen.delay is None else f"{seen.delay * 1000:.1f} ms",
        "" if seen.delay is None else _ahead(seen.channel.clocks.offset),
        listed(picture.agents),
        listed(path for path, _ in picture.workspaces),
        picture.page,
    )


def _ahead(seconds: float) -> str:
    """Return the offset of a clock as text."""
    return f"{seconds * 1000:+.1f} ms" if abs(seconds) < 1 else f"{seconds:+.2f} s"


def _show(rows: Sequence[Sequence[str]]) -> None:
    whole = [row for row in rows if len(row) == len(rows[0])]
    widths = [max(map(len, column)) for column in zip(*whole, strict=True)]
    widths[0] = max(len(row[0]) for row in rows)
    for row in rows:
        click.echo("  ".join(text.ljust(width) for text, width in zip(row, widths, strict=False)).rstrip())


@click.command(
    "ping",
    short_help="Measure the delay to a member.",
    epilog=examples("jacaros fleet ping lab robot1", "jacaros fleet ping lab robot1 --count 5"),
)
@click.argument("fleet")
@click.argument("member")
@option("--count N", "Stop after N requests (default: when you press Ctrl+C).", click.IntRange(min=1))
@_reaching
def ping_command(
    fleet: str, member: str, count: int | None, routers: tuple[str, ...], keys: Path | None
) -> int:
    """Send a request to MEMBER of FLEET every second, and print how long the answer takes.

    It goes through the member's event loop, so a busy member answers late. Exits with status 1 without any answer.
    """  # fmt: skip
    times: list[float | None] = []

    async def ping(operator: "Operator") -> None:
        _found(operator, fleet, [member])
        try:
            while count is None or len(times) < count:
                await asyncio.sleep(_PERIOD if times else 0.0)
                seen = operator.members.get(member)
                times.append(None if seen is None else await operator.ping(seen, _ANSWER))
                took = times[-1]
                how = "no answer" if took is None else f"{took * 1000:.2f} ms"
                click.echo(f"{member}: {len(times)}: {how}")
        finally:
            click.echo(_summary(member, times))

    _visit(ping, fleet, routers, keys)
    return int(not any(each is not None for each in times))


def _summary(member: str, times: Sequence[float | None]) -> str:
    answered = sorted(each * 1000 for each in times if each is not None)
    text = f"{member}: {len(times)} sent, {len(answered)} answered"
    if answered:
        text += f"; min/median/max {answered[0]:.2f}/{median(answered):.2f}/{answered[-1]:.2f} ms"
    return text


@click.command(
    "stop",
    short_help="Stop members of a fleet.",
    epilog=examples("jacaros fleet stop lab robot1", "jacaros fleet stop lab --all"),
)
@click.argument("fleet")
@click.argument("members", nargs=-1, metavar="[MEMBER]...")
@option("--all", "Stop all members.", name="every")
@_reaching
def stop_command(
    fleet: str, members: tuple[str, ...], every: bool, routers: tuple[str, ...], keys: Path | None
) -> int:
    """Stop MEMBERs of FLEET, as `.stopMAS` does: their robots stop, and they exit with status 0.

    In a fleet with keys, you need those of `operator`, or of a member to which --fleet-allow of `jacaros run` gives the
    right `stop`.
    """  # fmt: skip

    async def stop(operator: "Operator") -> int:
        found = _found(operator, fleet, members if not every else operator.members)
        if not found:
            raise usage_error(
                "name the members to stop", f"--all stops {', '.join(sorted(operator.members))}"
            )
        problems = await asyncio.gather(*(operator.stop(each, _END) for each in found))
        for each, problem in zip(found, problems, strict=True):
            click.echo(f"{each.id.name}: {problem or 'stopped'}", err=bool(problem))
        return int(any(problems))

    return _visit(stop, fleet, routers, keys)


def _found(operator: "Operator", fleet: str, names: Iterable[str]) -> list["Seen"]:
    """Return members by name.

    Raises:
        UsageError: one does not exist.
    """
    known = operator.members
    if not known:
        raise usage_error(f"fleet {fleet} has no members", f"jacaros run FILE --fleet {fleet}")
    for name in names:
        if name not in known:
            help = suggestion(name, known, f"its members are {listed(sorted(known))}")
            raise usage_error(f"unknown member of fleet {fleet}: `{name}`", help)
    return [known[name] for name in names]


def _visit(
    visit: Callable[["Operator"], Awaitable[T]], fleet: str, routers: tuple[str, ...], keys: Path | None
) -> T:
    """Visit a fleet, when all members that answer are known."""
    from jacaros.fleet.keys import NO_EXTRA
    from jacaros.fleet.names import OPERATOR
    from jacaros.fleet.network import Network

    try:
        from jacaros.fleet.on_zenoh import ZenohCarrier
        from jacaros.fleet.operator import Operator
    except ImportError:
        raise UsageError(NO_EXTRA) from None
    keys = keys or _own_keys(fleet)
    name = OPERATOR if keys is None else keys.name
    network = Network(fleet, name, keys, routers)

    async def main() -> T:
        async with Operator(ZenohCarrier(network, warn), name, clock) as operator:
            await operator.look(_LOOK)
            return await visit(operator)

    def warn(line: str) -> None:
        click.echo(line, err=True)

    clock = WallClock()
    return run(main, clock)


def _own_keys(fleet: str) -> Path | None:
    """Return the keys on this computer: those of the operator, or else of a member; None: none."""
    from jacaros.fleet.keys import CERTIFICATE, fleet_folder
    from jacaros.fleet.names import AUTHORITY, OPERATOR, ROUTER

    folders = sorted(each.parent for each in fleet_folder(fleet).glob(f"*/{CERTIFICATE}"))
    of_members = [each for each in folders if each.name not in (AUTHORITY, ROUTER)]
    return next((each for each in of_members if each.name == OPERATOR), next(iter(of_members), None))
