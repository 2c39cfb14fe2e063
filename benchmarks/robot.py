"""What a robot demands of its agent: latency, rate, load, and order in a burst.

    robot.py [--json FILE] [NAME ...]

Names are ``latency``, ``rate``, ``scan``, ``burst``, ``operations`` and ``observers``; all of them unless given.  Each is
measured in a process of its own, on the graph inside the process (``memory``), and printed as lines for people.  All
times are of the processor but those of ``latency``, which are what a robot would wait.

The JSON file holds one object; a key for each name that was measured, with these keys (times in microseconds, ``call`` is
the cost of an empty Python call with three arguments in the same run):

* ``latency``: ``messages``; ``agent`` and ``bare``, each with ``median``, ``p95``; ``call``.  From the publishing of an
  odometry message to the command it leads to: through artifact, belief, plan and operation, and through a bare callback.
* ``rate``: ``agent`` and ``bare``, answered messages a second, five on their way at a time; ``lost``; ``call``.
* ``scan``: ``beams``, ``hertz``, ``seconds`` (simulated), ``scan`` (what one costs), ``share`` (of a core, 0.01 is one per
  cent), ``goal`` (0.05), ``call``.
* ``burst``: ``percepts``; ``plain`` and ``urgent``, each with ``cycles`` and ``time`` until the first step of the plan for
  the bumper that is noticed last, ``low`` (events handled before it) and ``all`` (time until everything is handled);
  ``call``.
* ``operations``: ``round_trip`` from agent to artifact and back, ``goal`` (20), ``call``.
* ``observers``: ``observers`` (10), ``update`` (what one update costs with all of them), ``rate`` (updates a second),
  ``calls`` (an update in empty calls), all three where no plan is applicable to the event; ``reaction``,
  ``reaction_rate`` and ``reaction_calls`` where one is run; ``goal`` (10000, a second), ``call``.

Half a minute: ``robot.py operations observers``.
"""

import argparse
import json
import statistics
import subprocess
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent / "robot"


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description="What a robot asks of its agent.")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"what to measure: {', '.join(LINES)}")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.names if name not in LINES]
    if unknown:
        parser.error(f"unknown benchmark {unknown[0]}; expected {', '.join(LINES)}")
    figures = {}
    for name in arguments.names or LINES:
        figures[name] = measured(name)
        for line in LINES[name](figures[name]):
            print(f"{name:11} {line}", flush=True)
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")


ROUNDS = {"operations": 3, "observers": 3}
"""How often a program is run whose figures are of process time, which moves with what else the machine does."""


def measured(name: str) -> dict[str, Any]:
    """The figures of one of the programs, medians where it is run several times."""
    rounds = [once(name) for _ in range(ROUNDS.get(name, 1))]
    if len(rounds) == 1:
        return rounds[0]
    return {key: statistics.median(each[key] for each in rounds) for key in rounds[0]}


def once(name: str) -> dict[str, Any]:
    """The figures of one run."""
    ended = subprocess.run(
        [sys.executable, HERE / f"{name}.py"], stdout=subprocess.PIPE, text=True, check=True
    )
    figures: dict[str, Any] = json.loads(ended.stdout.splitlines()[-1])
    return figures


def _latency(figures: dict[str, Any]) -> list[str]:
    return [
        f"{way:6} median {figures[way]['median']:6.0f} us   95 % {figures[way]['p95']:6.0f} us"
        f"   ({figures['messages']} messages)"
        for way in ("agent", "bare")
    ]


def _rate(figures: dict[str, Any]) -> list[str]:
    lost = f"   ({figures['lost']} lost)" if figures["lost"] else ""
    return [f"{way:6} {figures[way]:8.0f} messages a second{lost}" for way in ("agent", "bare")]


def _scan(figures: dict[str, Any]) -> list[str]:
    share, goal = 100 * figures["share"], 100 * figures["goal"]
    scans = f"{figures['beams']} beams at {figures['hertz']} Hz: {figures['scan']:.0f} us each"
    return [f"{scans}, {share:.2f} % of a core (goal: less than {goal:.0f} %)"]


def _burst(figures: dict[str, Any]) -> list[str]:
    return [_way(way, figures[way]) for way in ("plain", "urgent")]


def _way(way: str, found: dict[str, Any]) -> str:
    first = f"first step of the safety plan after {found['cycles']:6} cycles, {found['time'] / 1000:7.1f} ms"
    return f"{way:6} {first}, {found['low']} other events; everything after {found['all'] / 1000:.0f} ms"


def _operations(figures: dict[str, Any]) -> list[str]:
    trip = figures["round_trip"]
    calls = trip / figures["call"]
    return [f"agent, artifact, agent: {trip:.1f} us = {calls:.0f} calls (goal: {figures['goal']} us)"]


def _observers(figures: dict[str, Any]) -> list[str]:
    updates = f"updates a second to {figures['observers']} observers"
    update = f"{figures['update']:.1f} us = {figures['calls']:.0f} calls each"
    reaction = f"{figures['reaction']:.1f} us = {figures['reaction_calls']:.0f} calls each"
    return [
        f"{figures['rate']:.0f} {updates}, {update} (goal: {figures['goal']})",
        f"{figures['reaction_rate']:.0f} {updates} that react, {reaction}",
    ]


LINES = {
    "latency": _latency,
    "rate": _rate,
    "scan": _scan,
    "burst": _burst,
    "operations": _operations,
    "observers": _observers,
}
"""By name, what writes the figures for people."""


if __name__ == "__main__":
    main()
