"""Agents in different processes of this machine: how fast they are, and what a larger fleet costs.

    fleet.py [--json FILE] [--processes N ...] [--rounds N] [--members N ...] [--before FOLDER] [NAME ...]

Names are ``messages``, ``operations``, ``updates``, ``growth`` and ``inside``; all but the last unless given.

The first three measure JaCaROS, Zenoh alone (its Python package, over the same kind of link), and ROS 2 alone (rclpy with
Fast DDS, if ``tools/install_ros2.sh`` was run), by turns in one run. Processes work in pairs, all pairs at the same time.

* ``messages``: there and back, between two agents; publications; topics.
* ``operations``: an operation of an artifact in the other process; a query; a call of a service.
* ``updates``: of an observable property, each with a plan that runs; publications; topics. One way, as fast as possible.

``growth`` starts up to 32 systems with ten agents each, and measures memory, the time until each knows all agents, and the
traffic of each, idle and while each agent sends a message a second. 50 systems need more than two cores.

``inside`` measures messages inside one process with the code in FOLDER, a clone of an earlier version, and with this one,
by turns.

The JSON file holds one object; a key for each name, with a row for each number of processes. Times are in microseconds.
"""

import argparse
import contextlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

from machine import machine
from members import running
from members.running import Process

ROOT = Path(__file__).resolve().parent.parent
AMOUNTS = {"messages": 250, "operations": 250, "updates": 1.0}
"""Messages, operations, or seconds, of each turn."""
GROWTH, INSIDE = "growth", "inside"
KNOWN = (*AMOUNTS, GROWTH, INSIDE)
SIZES = (2, 4, 8, 16, 32)
AGENTS = 10
"""Of each system, as in members/crowd.py."""
WINDOW = 4.0
"""Seconds in which traffic is counted."""

Row = dict[str, Any]


def main() -> None:
    """Measure, print, write."""
    arguments = _arguments()
    figures: dict[str, Any] = {"machine": machine()}
    names = arguments.names or [*AMOUNTS, GROWTH]
    compared = [name for name in names if name in AMOUNTS]
    for row in compare(compared, arguments.processes, arguments.rounds) if compared else ():
        figures.setdefault(row["what"], []).append(row)
    if GROWTH in names:
        figures[GROWTH] = grow(arguments.members)
    if INSIDE in names:
        figures[INSIDE] = inside(arguments.before, arguments.rounds)
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")


def compare(names: Sequence[str], sizes: Sequence[int], rounds: int) -> list[Row]:
    """Measure some figures by all ways, by turns, for each number of processes."""
    rows = []
    if "ros2" not in running.commands():
        print("ros2: not here (tools/install_ros2.sh installs it)", file=sys.stderr)
    for size in sizes:
        with contextlib.ExitStack() as stack:
            ways = {
                way: running.asking_halves(command, size // 2, stack)
                for way, command in running.commands().items()
            }
            for name in names:
                found = _in_turn(ways, name, rounds)
                rows += [_row(name, size, way, turns) for way, turns in found.items()]
                for row in rows[-len(ways) :]:
                    print(_compared(row), flush=True)
    return rows


def _in_turn(ways: dict[str, list[Process]], name: str, rounds: int) -> dict[str, list[list[list[float]]]]:
    """Return for each way, turn and pair its times."""
    amount = AMOUNTS[name]
    for processes in ways.values():
        running.ordered(processes, name, amount / 4)  # the first times do not count
    found: dict[str, list[list[list[float]]]] = {way: [] for way in ways}
    for _ in range(rounds):
        for way, processes in ways.items():
            found[way].append(running.ordered(processes, name, amount))
    return found


def _row(name: str, processes: int, way: str, turns: list[list[list[float]]]) -> Row:
    times = sorted(each for turn in turns for pair in turn for each in pair)
    return {
        "what": name,
        "processes": processes,
        "way": way,
        "median": median(times),
        "p99": times[int(0.99 * len(times))],
        "count": len(times),
        "rate": median(sum(_rate(pair) for pair in turn) for turn in turns),
    }


def _rate(times: Sequence[float]) -> float:
    return 1e6 * len(times) / sum(times)


def _compared(row: Row) -> str:
    times = "" if row["what"] == "updates" else f"  50 % {row['median']:6.0f} us  99 % {row['p99']:6.0f} us"
    return (
        f"{row['what']:10} {row['processes']} processes  {row['way']:6}{times}  {row['rate']:8.0f} a second"
    )


def grow(sizes: Sequence[int]) -> list[Row]:
    """Let a fleet grow, and measure at each size."""
    rows = []
    command = [sys.executable, str(running.HERE / "crowd.py"), f"crowd{time.time_ns() % 10**6}"]
    with contextlib.ExitStack() as stack:
        systems: list[Process] = []
        for size in sizes:
            new = running.begun([[*command, f"m{number}"] for number in range(len(systems), size)], stack)
            systems += new
            rows.append(_measured(systems, new))
            print(_grown(rows[-1]), flush=True)
    return rows


def _measured(systems: list[Process], new: list[Process]) -> Row:
    size = len(systems)
    seconds = _joined(systems, new)
    idle, busy = (running.ordered(systems, what, WINDOW) for what in ("idle", "busy"))
    memory = running.ordered(systems, "memory", 0)

    def _middle(rows: list[list[float]], place: int) -> float:
        return median(row[place] for row in rows)

    return {
        "systems": size,
        "joined": len(new),
        "all_know_all": seconds,
        "idle_sent": _middle(idle, 0),
        "idle_datagrams": _middle(idle, 1),
        "idle_core": _middle(idle, 2),
        "busy_sent": _middle(busy, 0),
        "busy_datagrams": _middle(busy, 1),
        "busy_core": _middle(busy, 2),
        "resident": _middle(memory, 0),
        "proportional": _middle(memory, 1),
        "own": _middle(memory, 2),
    }


def _middle(rows: list[list[float]], place: int) -> float:
    return median(row[place] for row in rows)


def _joined(systems: list[Process], new: list[Process]) -> float:
    """Let new systems join together. Return the seconds until all systems know all agents."""
    began = time.perf_counter()
    for each in systems:
        each.order("join" if each in new else "know", AGENTS * len(systems))
    for each in systems:
        each.answer()
    return time.perf_counter() - began


def inside(before: Path, rounds: int) -> Row:
    """Measure messages inside one process, with the code before and with this one."""
    found: dict[str, list[float]] = {"before": [], "now": []}
    for _ in range(rounds):
        for name, root in (("before", before), ("now", ROOT)):
            command = [sys.executable, str(running.HERE / "inside.py"), "3000", "5"]
            environment = {**os.environ, "PYTHONPATH": str(root / "src")}
            done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
            found[name] += json.loads(done.stdout)
    ratios = [now / then for then, now in zip(found["before"], found["now"], strict=True)]
    row = {name: min(times) for name, times in found.items()} | {"ratio": median(ratios)}
    print(
        f"inside     before {row['before']:.1f} us  now {row['now']:.1f} us  (best of {rounds}); median of the ratios "
        f"{row['ratio']:.2f}"
    )
    return row


def _grown(row: Row) -> str:
    return (
        f"{row['systems']:3} systems: {row['joined']} more joined in {row['all_know_all']:.1f} s; sent by each, idle "
        f"{row['idle_sent']:.0f} bytes a second ({row['idle_core']:.1%} of a core), busy {row['busy_sent']:.0f} "
        f"({row['busy_core']:.1%}); {row['own']:.0f} MB of its own each"
    )


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Agents in different processes.")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    parser.add_argument("--processes", type=int, nargs="+", default=[2, 4, 8], metavar="N")
    parser.add_argument("--rounds", type=int, default=6, help="turns of each way")
    parser.add_argument(
        "--members", type=int, nargs="+", default=SIZES, metavar="N", help="sizes of the fleet"
    )
    parser.add_argument(
        "--before", type=Path, metavar="FOLDER", help="clone of an earlier version, for inside"
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(KNOWN))
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in KNOWN]
    if unknown:
        parser.error(f"unknown benchmark {unknown[0]}; expected {', '.join(KNOWN)}")
    if INSIDE in arguments.names and arguments.before is None:
        parser.error("inside needs --before FOLDER")
    return arguments


if __name__ == "__main__":
    main()
