"""The figures of a report as Markdown, part by part."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from report.goals import goals_of
from report.wording import figure, milliseconds

ENGINES = {
    "jacaros": "JaCaROS",
    "agentspeak": "python-agentspeak",
    "jason": "Jason",
    "python": "an empty Python",
}
MET = {True: "met", False: "**missed**", None: "not known"}


def parts_of(report: dict[str, Any]) -> dict[str, str]:
    """The text of each part of the page."""
    return {
        "machine": machine(report["machine"], report["rounds"]),
        "goals": goals(report),
        "programs": programs(report["programs"]),
        "scaling": scaling(report["scaling"]),
        "processes": processes(report),
        "robot": robot(report["robot"]),
        "latency": latency(report["latency"]),
        "patrol": str(report["patrol"]),
    }


def machine(found: dict[str, Any], rounds: int) -> str:
    """Where and when."""
    return (
        f"Measured on {found['date']}: {found['processor']}, {found['cores']} cores, {found['gigabytes']} GB; "
        f"{found['system']}; {found['python']}. Load before it began: {found['load']}. An empty call of three arguments "
        f"took {found['call']:.0f} ns. Medians of {rounds} round{'' if rounds == 1 else 's'}."
    )


def goals(report: dict[str, Any]) -> str:
    """What is wanted, and what came out."""
    return _table(
        ("goal", "measured", ""), ((goal.text, goal.measured, MET[goal.met]) for goal in goals_of(report))
    )


def programs(rows: Sequence[dict[str, Any]]) -> str:
    """Every program, with each engine that was there."""
    engines = list(dict.fromkeys(engine for row in rows for engine in row["peers"]))
    heads = ["program", "time", "in empty calls", "goal", "memory"]
    for engine in engines:
        heads += [f"{ENGINES[engine]} takes", "goal", "its memory"]
    return _table(heads, (_program(row, engines) for row in rows), numbers_from=1)


def _program(row: dict[str, Any], engines: Sequence[str]) -> list[str]:
    if "note" in row:
        cells = [row["name"], row["note"], "", "", ""]
    else:
        goal = row["goal"]
        cells = [
            row["name"],
            f"{figure(row['nanoseconds'])} ns per {row['unit']}",
            figure(row["calls"]),
            "" if goal is None else f"≤ {goal:g} {MET[row['calls'] <= goal]}",
            f"{row['megabytes']:.0f} MB",
        ]
    for engine in engines:
        cells += _peer(row["peers"].get(engine, {"note": "not measured"}))
    return cells


def _peer(peer: dict[str, Any]) -> list[str]:
    """How many times as long it took, its goal, its memory; a dash where it lacks what the program needs."""
    if "lacks" in peer:
        return ["–", "", ""]
    goal = peer.get("goal")
    if "ratio" in peer:
        judged = "" if goal is None else f"≥ {goal:g} {MET[peer['ratio'] >= goal]}"
        return [f"{figure(peer['ratio'])} ×", judged, f"{peer['megabytes']:.0f} MB"]
    least = peer.get("least_ratio")
    if least is None:
        return [peer["note"], "", ""]
    judged = "" if goal is None else f"≥ {goal:g} {MET[True if least >= goal else None]}"
    return [f"{peer['note']}: > {figure(least)} ×", judged, ""]


def scaling(curves: Sequence[dict[str, Any]]) -> str:
    """The curves as a table: what a unit costs, in empty calls."""
    return "\n\n".join(_curve(curve) for curve in curves)


def _curve(curve: dict[str, Any]) -> str:
    ours = curve["lines"].get("jacaros", [])
    if not ours:
        return f"{curve['title']}: not measured."
    sizes = [point["size"] for point in ours]
    rows = []
    for engine, points in curve["lines"].items():
        costs = {point["size"]: figure(point["calls"]) for point in points}
        rows.append([ENGINES[engine], *(costs.get(size, "") for size in sizes)])
    rows.append(["JaCaROS, memory in MB", *(f"{point['megabytes']:.0f}" for point in ours)])
    growth = max(point["calls"] for point in ours) / min(point["calls"] for point in ours)
    heads = [f"{curve['among']}:", *(f"{size:,}" for size in sizes)]
    notes = "".join(f" {note}." for note in curve["notes"])
    return (
        f"{curve['title']}, in empty calls. The dearest {curve['per']} costs {growth:.1f} times the cheapest.{notes}\n\n"
        + _table(heads, rows, numbers_from=1)
    )


def processes(report: dict[str, Any]) -> str:
    """Start, memory, loading."""
    start = report["start"]
    rows = [
        [
            ENGINES[name],
            milliseconds(each["processor"]),
            milliseconds(each["wall"]),
            f"{each['megabytes']:.0f} MB",
        ]
        for name, each in start.items()
    ]
    memory, loading, imports = report["memory"], report["loading"], report["imports"]
    packages = ", ".join(f"{name} {value:.0f} ms" for name, value in imports["milliseconds"].items())
    return "\n\n".join(
        (
            _table(
                ("a program that says hello", "processor time", "wall time", "memory"), rows, numbers_from=1
            ),
            (
                f"It imports {imports['modules']} modules (measured by Python's `-X importtime`, which slows them down: "
                f"{packages}). A plan takes {milliseconds(loading['parse'])} to be read, and "
                f"{milliseconds(loading['compile'])} more when its first event comes."
            ),
            (
                f"{memory['cycles']:,} cycles of tail recursion need {memory['recursion']:.1f} MB, a program that ends "
                f"at once {memory['empty']:.1f} MB."
            ),
        )
    )


def robot(found: dict[str, Any]) -> str:
    """What a robot asks of its agent, on the graph inside the process."""
    latency_, rate, scan, burst = found["latency"], found["rate"], found["scan"], found["burst"]
    operations, observers = found["operations"], found["observers"]
    rows = [
        [
            "from a message to the command that it leads to",
            f"{latency_['agent']['median']:.0f} µs, 95 % within {latency_['agent']['p95']:.0f} µs",
            f"{latency_['bare']['median']:.0f} µs, 95 % within {latency_['bare']['p95']:.0f} µs",
        ],
        ["messages answered, a second", figure(rate["agent"]), figure(rate["bare"])],
        [
            f"a scan of {scan['beams']} beams, of which five ranges are used",
            f"{scan['scan']:.0f} µs: {100 * scan['share']:.1f} % of a core at {scan['hertz']:g} Hz",
            "",
        ],
        *(
            [
                f"a safety plan{'' if way == 'plain' else ', urgent,'} behind {burst['percepts']:,} percepts: first step",
                f"{burst[way]['time'] / 1000:.1f} ms, {burst[way]['low']:,} events before it",
                "",
            ]
            for way in ("plain", "urgent")
        ),
        ["an operation, from agent to artifact and back", f"{operations['round_trip']:.1f} µs", ""],
        [
            f"updates of a property with {observers['observers']} observers, a second",
            figure(observers["rate"]),
            "",
        ],
    ]
    if "reaction_rate" in observers:
        rows.append(["the same, and each observer runs a plan", figure(observers["reaction_rate"]), ""])
    return _table(("what", "an agent", "a bare callback"), rows)


def latency(found: dict[str, Any]) -> str:
    """From a message to the command that it leads to, on real graphs."""
    bare = {each["graph"]: each["median"] for each in found["figures"] if each["way"] == "bare"}
    rows = [
        [
            each["graph"],
            {"agent": "through an agent", "bare": "a bare echo"}[each["way"]],
            *(milliseconds(each[key]) for key in ("median", "most", "nearly_all")),
            f"{each['median'] / bare[each['graph']]:.2f} ×" if each["graph"] in bare else "",
            figure(each["rate"]) if each.get("rate") else "",
        ]
        for each in found["figures"]
    ]
    heads = ("graph", "way", "median", "90 %", "99 %", "of a bare echo", "flat out, a second")
    table = [_table(heads, rows, numbers_from=2)] if rows else []
    return "\n\n".join([*table, *found["notes"]])


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]], numbers_from: int | None = None) -> str:
    return "\n".join(_lines(heads, rows, numbers_from))


def _lines(heads: Sequence[str], rows: Iterable[Sequence[str]], numbers_from: int | None) -> Iterator[str]:
    numbers = len(heads) if numbers_from is None else numbers_from
    yield f"| {' | '.join(heads)} |"
    yield f"|{'|'.join('---' if place < numbers else '---:' for place in range(len(heads)))}|"
    for row in rows:
        yield f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |"
