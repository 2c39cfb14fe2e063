"""How many seconds of the world one second of the processor simulates: robots that drive about, and ten scans a second.

    world_speed.py [--seconds S] [--peer PYTHON]

A scan has 360 beams.  PYTHON is an interpreter that has ir-sim, a simulator with like robots (``pip install ir-sim``); both
take turns.  Its robots are moved ten times a second, ours fifty times.
"""

import argparse
import json
import random
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

TURNS = 3
SCANS = 0.1
"""Seconds between scans."""
WORLDS = {1: "flat", 20: "warehouse"}


def main() -> None:
    """Measure, and print the medians."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--peer")
    parser.add_argument("--as-peer", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.as_peer:
        print(peer_speed(json.loads(arguments.as_peer), arguments.seconds))
        return
    for robots, world in WORLDS.items():
        ours, theirs = [], []
        for _ in range(TURNS):
            ours.append(speed(world, arguments.seconds))
            if arguments.peer:
                theirs.append(asked(arguments.peer, world, arguments.seconds / 10.0))
        told = (
            f"{robots:>2} robots ({world}): {median(ours):.0f} simulated seconds in a second of the processor"
        )
        print(told + (f", ir-sim {median(theirs):.1f}" if theirs else ""), flush=True)


def median(figures: list[float]) -> float:
    """The middle one."""
    return sorted(figures)[len(figures) // 2]


def speed(name: str, seconds: float) -> float:
    """Simulated seconds in a second of the processor."""
    from jacaros.robots.world import World
    from jacaros.robots.world.physics.world import STEP

    world = World.load(name)
    rates = random.Random(1)
    began = time.process_time()
    for step in range(round(seconds / STEP)):
        if step % round(SCANS / STEP) == 0:
            for robot in world.robots.values():
                robot.command(-0.1 if robot.touching else 0.3, rates.uniform(-0.5, 0.5))
                world.scan(robot.name)
        world.step()
    return seconds / (time.process_time() - began)


def asked(python: str, name: str, seconds: float) -> float:
    """The same of ir-sim, in a process of its own."""
    from jacaros.robots.world import World

    command = [
        python,
        __file__,
        "--seconds",
        str(seconds),
        "--as-peer",
        json.dumps(as_peers_world(World.load(name))),
    ]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[-1])


def as_peers_world(world: Any) -> dict[str, Any]:
    """The world in ir-sim's terms."""
    left, bottom, right, top = world.description.bounds
    lidar = {"name": "lidar2d", "range_min": 0, "range_max": 10, "angle_range": 6.2832, "number": 360}
    return {
        "world": {"height": top - bottom, "width": right - left, "offset": [left, bottom], "step_time": 0.1},
        "robot": [
            {
                "kinematics": {"name": "diff"},
                "shape": {"name": "circle", "radius": robot.description.radius},
                "state": list(robot.pose),
                "goal": [0, 0, 0],
                "sensors": [lidar],
            }
            for robot in world.robots.values()
        ],
        "obstacle": [
            {"shape": {"name": "linestring", "vertices": [[ax, ay], [bx, by]]}}
            for ax, ay, bx, by in world.segments
        ],
    }


def peer_speed(world: dict[str, Any], seconds: float) -> float:
    """Simulated seconds in a second of the processor, of ir-sim."""
    import tempfile

    import irsim
    import numpy

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "world.yaml"
        path.write_text(json.dumps(world), encoding="utf-8")
        peer = irsim.make(str(path), display=False, log_level="ERROR")
        commands = [numpy.array([[0.3], [0.2]]) for _ in world["robot"]]
        began = time.process_time()
        for _ in range(round(seconds * 10)):
            peer.step(commands)
        took = time.process_time() - began
        peer.end()
    return seconds / took


if __name__ == "__main__":
    sys.exit(main())
