"""Batteries of a world that runs by itself: who started it hears when a robot will not drive any more."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from jacaros.sim.description import BatterySettings, WorldDescription

LOW = 20
"""Percent at which it is told, each time that a battery gets so low."""


def with_full_batteries(world: WorldDescription) -> WorldDescription:
    """Give the same world with batteries that stay full."""
    full = BatterySettings(level=100.0, drain_per_second=0.0, drain_per_metre=0.0, drain_per_radian=0.0)
    return replace(world, robots=tuple(replace(robot, battery=full) for robot in world.robots))


def told(tell: Callable[[str], None]) -> Callable[[dict[str, Any]], None]:
    """Give a listener of `GroundTruth.listen` that tells *tell* of batteries that have become low, or are empty."""
    low: set[str] = set()

    def listen(record: dict[str, Any]) -> None:
        if record.get("event") == "battery_empty":
            tell(
                f"the battery of {record['robot']} is empty: it does not drive any more. Start the world again; with "
                "--full-battery it stays full"
            )
        elif record.get("event") == "battery":
            robot, level = record["robot"], record["data"]["level"]
            if level > LOW:
                low.discard(robot)
            elif robot not in low:
                low.add(robot)
                tell(f"the battery of {robot} is at {level} %")

    return listen
