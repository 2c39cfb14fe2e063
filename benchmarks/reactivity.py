"""How soon a bumper plan stops the wheels while the same agent is busy, with and without ``[urgency(..)]``.

    reactivity.py [--quick] [--bridge URL] [--json FILE] [GRAPH ...]

Graphs are ``memory``, ``ros1``, ``ros2-jazzy``, ``ros2-kilted`` and ``rosbridge``; all of them unless given.  A graph
that is not available on this machine is named as missing.  ``rosbridge`` needs the address of a running server.

The agent (``latency/bumper.asl``) has 1,000 intentions that never rest, and reacts to laser scans of 720 beams at 40 Hz.
The robot (``latency/bumps.py``) publishes a numbered bumper message and takes the time until the zero velocity with the
same number arrives: through artifact, signal, event, plan and operation.  Two loads are measured:

* ``intentions``: the intentions and the scans.
* ``and percepts``: the same, and the bumper message is published when 10,000 percepts, each with a plan, wait in the agent.

Agents with and without urgency take turns, so that both meet the same load from other processes: three turns of 200 bumps
each, or 40 where percepts wait.  ``--quick``: one turn of 50 and 15, and on ``memory`` alone unless graphs are given.  Each
turn has its own processes.  On ``memory``, robot and agent share one process, and another process begins the bumps; on
other graphs the robot is a separate process.

The JSON file holds ``machine`` (see ``machine.py``), ``figures`` and ``notes`` about what was not measured.  A figure has
``graph``, ``load``, ``urgent``, ``bumps``, ``lost``, and ``p50``, ``p99`` and ``most`` in seconds.

Some four minutes on each graph; ``--quick``: one minute.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import graphs
import latency
from machine import machine

HERE = Path(__file__).resolve().parent
LABEL = "@bump[urgency(10)]\n"
"""The label of the bumper plan."""

LOADS = {"intentions": "steady", "and percepts": "burst"}
"""The loads, and what ``bumps.py`` calls them."""

COUNTS = {"steady": (200, 50), "burst": (40, 15)}
"""Bumps of a turn, and of a quick one."""

TURNS = (3, 1)
"""Turns of each agent, and quick."""

GRAPHS = ("memory", *graphs.ENVIRONMENTS, "rosbridge")
PATIENCE = 600.0
"""Seconds after which a measurement is given up."""


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description="How soon a bumper plan stops the wheels of a busy robot.")
    parser.add_argument(
        "--quick", action="store_true", help="fewer bumps, and on memory alone unless graphs are given"
    )
    parser.add_argument("--bridge", metavar="URL", help="address of a rosbridge server")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures to this file")
    parser.add_argument("graphs", nargs="*", metavar="GRAPH", help=f"what to measure: {', '.join(GRAPHS)}")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.graphs if name not in GRAPHS]
    if unknown:
        parser.error(f"unknown graph {unknown[0]}; known graphs: {', '.join(GRAPHS)}")
    chosen = arguments.graphs or (["memory"] if arguments.quick else GRAPHS)
    found = measured(chosen, arguments.quick, arguments.bridge, lambda text: print(text, file=sys.stderr))
    print(table(found["figures"]))
    for note in found["notes"]:
        print(f"\n{note}")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")


def measured(
    kinds: Sequence[str], quick: bool, bridge: str | None, progress: Callable[[str], None]
) -> dict[str, Any]:
    """Measure on the graphs of *kinds*."""
    figures, notes = [], []
    where = machine()
    for kind in kinds:
        why = unavailable(kind, bridge)
        if why is not None:
            notes.append(why)
            continue
        for load in LOADS:
            progress(f"{kind}: {load}")
            try:
                figures += compared(kind, load, quick, bridge)
            except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as error:
                notes.append(f"{kind}: {load}: not measured; {error}")
    return {"machine": where, "figures": figures, "notes": notes}


def compared(kind: str, load: str, quick: bool, bridge: str | None) -> list[dict[str, Any]]:
    """The figures of an agent with urgency and of one without, which take turns."""
    name = LOADS[load]
    times: dict[bool, list[float]] = {True: [], False: []}
    lost = {True: 0, False: 0}
    for _ in range(TURNS[quick]):
        for urgent in times:
            reactions = once(kind, name, urgent, COUNTS[name][quick], bridge)
            times[urgent] += reactions["times"]
            lost[urgent] += reactions["lost"]
    return [
        {"graph": kind, "load": load, "urgent": urgent, **summary(times[urgent], lost[urgent])}
        for urgent in times
    ]


def unavailable(kind: str, bridge: str | None) -> str | None:
    """A note why a graph cannot be measured; None if it can."""
    if kind == "rosbridge" and bridge is None:
        return "rosbridge: not measured; give the address of a running server with `--bridge`."
    if kind in graphs.ENVIRONMENTS and not graphs.python_of(kind).exists():
        return graphs.missing(kind)
    return None


def once(kind: str, load: str, urgent: bool, count: int, bridge: str | None) -> dict[str, Any]:
    """The reaction times of one turn, and how many bumps were lost."""
    robot = HERE / "latency" / "bumps.py"
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        program = written(scratch, urgent)
        if kind == "memory":
            return outcome([sys.executable, robot, kind, load, str(count), program])
        ros = kind.partition("-")[0]
        python = graphs.python_of(kind) if kind in graphs.ENVIRONMENTS else Path(sys.executable)
        address = [bridge] if bridge is not None and ros == "rosbridge" else []
        to_bridge = ["--bridge", *address] if address else []
        agent = [python, "-m", "jacaros", "run", program, "--ros", ros, "--quiet", *to_bridge]
        with latency.graph(ros, scratch) as environment, latency.running(agent, environment):
            return outcome([python, robot, ros, load, str(count), *address], environment)


def written(folder: Path, urgent: bool) -> Path:
    """Write the agent's program and its artifacts to a folder; the bumper plan has no urgency unless *urgent*."""
    program = (HERE / "latency" / "bumper.asl").read_text(encoding="utf-8")
    assert LABEL in program
    file = folder / "bumper.asl"
    file.write_text(program if urgent else program.replace(LABEL, ""), encoding="utf-8")
    (folder / "artifacts.py").write_bytes((HERE / "latency" / "artifacts.py").read_bytes())
    return file


def outcome(command: "Sequence[str | Path]", environment: dict[str, str] | None = None) -> dict[str, Any]:
    """What a process prints as JSON in its last line."""
    done = subprocess.run(
        command, env=environment, check=True, timeout=PATIENCE, stdout=subprocess.PIPE, text=True
    )
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def summary(times: Sequence[float], lost: int) -> dict[str, float | int | None]:
    """Return percentiles of reaction times; None without any."""
    times = sorted(times)

    def at(share: float) -> float | None:
        return times[min(int(share * len(times)), len(times) - 1)] if times else None

    return {"bumps": len(times), "lost": lost, "p50": at(0.5), "p99": at(0.99), "most": at(1.0)}


def table(figures: Sequence[dict[str, Any]]) -> str:
    """The figures as a table in Markdown, in milliseconds."""
    lines = [
        "| graph | load | urgency | median | 99 % | maximum | bumps |",
        "|---|---|---|---:|---:|---:|---:|",
    ]
    for each in figures:
        times = (f"{1000 * each[key]:.1f} ms" if each["bumps"] else "–" for key in ("p50", "p99", "most"))
        bumps = f"{each['bumps']}" + (f", {each['lost']} lost" if each["lost"] else "")
        urgency = "with" if each["urgent"] else "without"
        lines.append(f"| {each['graph']} | {each['load']} | {urgency} | {' | '.join(times)} | {bumps} |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
