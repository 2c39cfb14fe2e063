"""How the cost of a look-up, an event or a message grows with the size of its surroundings."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from mind.engines import AGENTSPEAK, OURS
from mind.rounds import Figures, Runner
from mind.workloads import Workload, single


@dataclass(frozen=True)
class Curve:
    """A workload at several sizes of its surroundings.

    Attributes:
        name: of the picture.
        title: what is shown.
        per: what one unit is.
        among: what there are more and more of.
        points: how many of them.
        peer_points: those that python-agentspeak is measured at.
        at: the workload among so many.
        peer_n: how much of it python-agentspeak does there.
    """

    name: str
    title: str
    per: str
    among: str
    points: tuple[int, ...]
    peer_points: tuple[int, ...]
    at: Callable[[int], Workload]
    peer_n: Callable[[int], int]


def lookups(size: int) -> Workload:
    """Look-ups among *size* beliefs."""
    return single(f"look-ups in {size:,} facts", "lookups_again", 100_000, lambda n, k: n, k=size)


def waiting(size: int) -> Workload:
    """Belief events, while *size* intentions wait."""
    return single(f"events, {size:,} intentions wait", "events_among", 20_000, lambda n, k: n, k=size)


def taking_turns(size: int) -> Workload:
    """Sub-goals of *size* intentions that take turns, 100,000 in all."""
    n = 100_000 // size
    return single(
        f"sub-goals of {size:,} intentions", "intentions", n, lambda n, k: k * n + 7 * k + 8, k=size
    )


def messages(size: int) -> Workload:
    """Messages between a hub and *size* other agents, in turn."""
    agents = (("spoke", "spoke", size), ("hub", "hub", 1))
    return Workload(f"messages, {size:,} agents", agents, 20_000, lambda n, k: n, k=size)


def stamps(size: int) -> Workload:
    """Beliefs that get *size* annotations in turn, 20,000 in all."""
    return single(f"beliefs with {size:,} annotations", "stamps", 20_000 // size, lambda n, k: n * k, k=size)


def growing(size: int) -> Workload:
    """Lists in a belief that grow to *size* elements, 20,000 in all."""
    return single(f"lists of {size:,} elements", "growing", 20_000 // size, lambda n, k: n * k, k=size)


def forks(size: int) -> Workload:
    """Loops that fork *size* times, 20,000 forks in all."""
    return single(f"loops of {size:,} forks", "forks", 20_000 // size, lambda n, k: n * k, k=size)


def conditions(size: int) -> Workload:
    """Conditions that come true while *size* others are awaited."""
    return single(f"waits beside {size:,} others", "waits", 5_000, lambda n, k: n, k=size)


TO_10_000 = (1, 10, 100, 1_000, 10_000)
CURVES = (
    Curve(
        "lookups", "A look-up by its first argument", "look-up", "beliefs", (100, 1_000, 10_000, 100_000, 1_000_000),
        (100, 1_000, 10_000), lookups, lambda size: 500_000 // size,
    ),
    Curve(
        "waiting", "A belief event, while other intentions wait", "event", "waiting intentions", TO_10_000,
        (1, 10, 100), waiting, lambda size: 100_000 // (10 * (10 + size)),
    ),
    Curve(
        "turns", "A sub-goal, while other intentions take turns", "sub-goal", "intentions", TO_10_000,
        (1, 10, 100, 1_000), taking_turns, lambda size: 20_000 // size,
    ),
    Curve(
        "messages", "A message to one of many agents", "message", "agents", TO_10_000,
        (1, 10, 100), messages, lambda size: 2_000,
    ),
    Curve(
        "annotations", "An annotation added to a belief", "annotation", "annotations", (1, 10, 100, 1_000),
        (), stamps, lambda size: 0,
    ),
    Curve(
        "conditions", "A wait for a condition, while others are awaited", "wait", "awaited conditions", TO_10_000,
        (), conditions, lambda size: 0,
    ),
    Curve(
        "growing", "An element added to a list in a belief", "element", "elements", TO_10_000,
        (), growing, lambda size: 0,
    ),
    Curve("forks", "A fork in a loop", "fork", "rounds of the loop", TO_10_000, (), forks, lambda size: 0),
)  # fmt: skip


def measure(
    curves: Sequence[Curve], engines: Sequence[str], rounds: int, run: Runner, tell: Callable[[str], None]
) -> list[dict[str, Any]]:
    """Measure every curve; the points of one are measured in turn, round after round."""
    found = []
    for curve in curves:
        points: dict[tuple[str, int], Figures] = {}
        for number in range(1, rounds + 1):
            for size in curve.points:
                tell(f"scaling, round {number} of {rounds}: {curve.at(size).name}")
                for engine, n in _turns(curve, size, engines):
                    figures = points.setdefault((engine, size), Figures())
                    if not figures.notes:
                        result = run(engine, curve.at(size), n)
                        if "note" in result:
                            figures.notes[engine] = result
                        else:
                            figures.runs.setdefault((engine, n), []).append(result)
        found.append(_as_data(curve, points, engines))
    return found


def _turns(curve: Curve, size: int, engines: Sequence[str]) -> list[tuple[str, int]]:
    turns = [(OURS, curve.at(size).n)]
    if AGENTSPEAK in engines and size in curve.peer_points:
        turns.append((AGENTSPEAK, curve.peer_n(size)))
    return turns


def _as_data(curve: Curve, points: dict[tuple[str, int], Figures], engines: Sequence[str]) -> dict[str, Any]:
    lines: dict[str, list[dict[str, Any]]] = {}
    for (engine, size), figures in points.items():
        for (_, n), runs in figures.runs.items():
            units = curve.at(size).units_of(n, size)
            middle = sorted(runs, key=lambda each: each["calls"])[len(runs) // 2]
            lines.setdefault(engine, []).append(
                {
                    "size": size,
                    "calls": middle["calls"] / units,
                    "nanoseconds": middle["seconds"] / units * 1e9,
                    "megabytes": middle["megabytes"],
                }
            )
    notes = [
        f"{figures.notes[engine]['note']} at {size}"
        for (engine, size), figures in points.items()
        if figures.notes
    ]
    return {
        "name": curve.name, "title": curve.title, "per": curve.per, "among": curve.among,
        "lines": lines, "notes": notes,
    }  # fmt: skip
