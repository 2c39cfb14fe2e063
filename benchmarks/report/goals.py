"""The goals of speed, each with what was measured."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from report.wording import figure

START_GOAL = 0.35 / 0.02
"""A start may take 0.35 s on a machine where an empty Python takes 0.02 s."""


LATENCY_GOAL, ROS1_LATENCY_GOAL = 1.25, 1.5
"""Time of a message through an agent, divided by its time through a bare echo of the client library, at most."""


@dataclass(frozen=True)
class Goal:
    """A goal.

    Attributes:
        text: what is wanted.
        measured: what came out.
        met: whether that will do; None when it could not be measured.
    """

    text: str
    measured: str
    met: bool | None


def goals_of(report: dict[str, Any]) -> Iterator[Goal]:
    """All goals, judged."""
    programs = [row for row in report["programs"] if "note" not in row]
    yield from _calls(programs)
    yield _tables(programs)
    yield from _peer(programs, "agentspeak", "python-agentspeak")
    yield _memory(report["memory"])
    yield _start(report["start"])
    yield from _peer(programs, "jason", "Jason, warm")
    yield from _robot(report.get("robot", {}))
    yield from latency_goals(report.get("latency", {}).get("figures", []))


def _calls(programs: list[dict[str, Any]]) -> Iterator[Goal]:
    names = {25: "a cycle of sub-goals", 50: "any other step", 150: "a message"}
    for goal, what in names.items():
        rows = [row for row in programs if row["goal"] == goal]
        if not rows:
            continue
        worst = max(rows, key=lambda row: float(row["calls"]))
        over = [row["name"] for row in rows if row["calls"] > goal]
        measured = f"{figure(worst['calls'])} ({worst['name']})" if len(rows) > 1 else figure(worst["calls"])
        if over:
            measured += f"; over it: {', '.join(over)}"
        yield Goal(f"{what} ≤ {goal} empty calls", measured, not over)


def _tables(programs: list[dict[str, Any]]) -> Goal:
    costs = {row["name"]: row["calls"] for row in programs if row["name"].startswith("look-ups in")}
    text = "a look-up in 20,000 facts ≤ 2 × one in 200"
    if len(costs) < 2:
        return Goal(text, "not measured", None)
    few, many = costs["look-ups in 200 facts"], costs["look-ups in 20,000 facts"]
    return Goal(text, f"{many / few:.2f} ×", many <= 2 * few)


def _peer(programs: list[dict[str, Any]], engine: str, name: str) -> Iterator[Goal]:
    peers = [(row["name"], row["peers"][engine]) for row in programs if engine in row["peers"]]
    for goal in sorted({peer["goal"] for _, peer in peers if peer["goal"] is not None}, reverse=True):
        ratios = {name: peer["ratio"] for name, peer in peers if peer["goal"] == goal and "ratio" in peer}
        subjects = ", ".join(name for name, peer in peers if peer["goal"] == goal and "lacks" not in peer)
        text = f"≥ {goal:g} × {name}: {subjects}"
        if not ratios:
            yield Goal(text, "not measured", None)
            continue
        least = min(ratios, key=lambda each: float(ratios[each]))
        under = [each for each, ratio in ratios.items() if ratio < goal]
        measured = f"{figure(ratios[least])} × ({least})"
        if len(under) > 1:
            measured += f"; under it: {', '.join(under)}"
        yield Goal(text, measured, not under)


def latency_goals(figures: list[dict[str, Any]]) -> Iterator[Goal]:
    """The goals of latency, for each graph that was measured."""
    medians = {(each["graph"], each["way"]): each["median"] for each in figures}
    for graph in dict.fromkeys(each["graph"] for each in figures):
        agent, bare = medians.get((graph, "agent")), medians.get((graph, "bare"))
        goal = ROS1_LATENCY_GOAL if graph == "ros1" else LATENCY_GOAL
        text = f"from a message to the command ≤ {goal} × a bare echo on {graph}"
        if agent is None or bare is None:
            yield Goal(text, "not measured", None)
        else:
            yield Goal(text, f"{agent / bare:.2f} ×", agent <= goal * bare)


def _memory(memory: dict[str, Any]) -> Goal:
    ratio = memory["recursion"] / memory["empty"]
    return Goal(
        f"memory of {memory['cycles']:,} cycles of tail recursion ≤ 1.2 × an empty program's",
        f"{ratio:.2f} × ({memory['recursion']:.1f} of {memory['empty']:.1f} MB)",
        ratio <= 1.2,
    )


def _start(start: dict[str, Any]) -> Goal:
    hello, python = start["jacaros"]["processor"], start["python"]["processor"]
    return Goal(
        "`jacaros run hello.asl` ≤ 0.35 s of processor time where an empty Python takes 0.02 s",
        f"{hello:.3f} s where it takes {python:.3f} s",
        hello <= START_GOAL * python,
    )


def _robot(robot: dict[str, Any]) -> Iterator[Goal]:
    scan, burst = robot.get("scan"), robot.get("burst")
    if scan is not None:
        text = f"a scan of {scan['beams']} beams at {scan['hertz']:g} Hz, of which five ranges are used, < 5 % of a core"
        yield Goal(text, f"{100 * scan['share']:.1f} %", scan["share"] < 0.05)
    if burst is not None:
        urgent, percepts = burst["urgent"], burst["percepts"]
        yield Goal(
            f"an urgent plan does not wait for a burst of {percepts:,} percepts",
            f"its first step is cycle {urgent['cycles']:,}, with {urgent['low']:,} of them before it "
            f"(without urgency {burst['plain']['low']:,})",
            urgent["low"] < percepts / 100,
        )
    for name, text, unit, key in (
        ("operations", "an operation, there and back, ≤ {goal:g} µs", "µs", "round_trip"),
        ("observers", "≥ {goal:,} updates a second of a property with ten observers", "a second", "rate"),
    ):
        found = robot.get(name)
        if found is not None:
            goal, value = found["goal"], found[key]
            met = value <= goal if name == "operations" else value >= goal
            yield Goal(text.format(goal=goal), f"{figure(value)} {unit}", met)
