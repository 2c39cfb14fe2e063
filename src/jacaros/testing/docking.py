"""A robot's stays in docks, for checkers."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from jacaros.sim.ground_truth import GroundTruth
from jacaros.testing.judging import Verdict
from jacaros.testing.paths import Placed, distance


class Stay(NamedTuple):
    """From docking to leaving the dock; ``end`` is None when the run ended in the dock."""

    begin: float
    end: float | None
    charged: bool
    level: float
    """Percent at the beginning."""


def stays(truth: GroundTruth, robot: str | None = None) -> list[Stay]:
    """The stays in which the battery got current; brief halts with a full battery do not count.

    A robot that turns in the dock docks and undocks again: that is one stay.
    """
    robot = robot or truth.robots[0]
    found: list[Stay] = []
    for stay in _dockings(truth, robot):
        if found and _stayed_between(truth, robot, found[-1], stay):
            before = found[-1]
            found[-1] = before._replace(end=stay.end, charged=before.charged or stay.charged)
        else:
            found.append(stay)
    return found


def _dockings(truth: GroundTruth, robot: str) -> Iterator[Stay]:
    """From each ``docked`` to the next ``undocked``, where the battery was charged meanwhile."""
    begin, level, charged = 0.0, None, False
    for event in truth.events_of("docked", "charging", "charged", "undocked", robot=robot):
        match event.kind:
            case "docked":
                begin, level, charged = event.time, None, False
            case "charging":
                level = float(event.data["level"])
            case "charged":
                charged = True
            case _:
                if level is not None:
                    yield Stay(begin, event.time, charged, level)
                level = None
    if level is not None:
        yield Stay(begin, None, charged, level)


def _stayed_between(truth: GroundTruth, robot: str, one: Stay, other: Stay) -> bool:
    assert one.end is not None
    between = [sample for sample in truth.path(robot) if one.end <= sample.time <= other.begin]
    return all(_in_dock(sample, truth.world) for sample in between)


def judge_recharging(verdict: Verdict, truth: GroundTruth, low: float = 20.0) -> list[Stay]:
    """Expect a robot that charges in docks only, when the battery is low, until it is full, and is never empty.

    Args:
        verdict: takes the complaints and figures.
        truth: what happened.
        low: percent from which on the robot may go to the dock.

    Returns:
        The stays in the dock.
    """
    found = stays(truth)
    verdict.measure("recharges", len(found))
    verdict.measure("least percent", min(sample.battery for sample in truth.path()))
    verdict.expect(not truth.events_of("battery_empty"), "the battery was empty")
    for event in truth.events_of("charging"):
        verdict.expect(_in_dock(event, truth.world), f"it charged outside of a dock at {event.time:.1f} s")
    for stay in found:
        verdict.expect(stay.charged, f"it left the dock of {stay.begin:.1f} s before the battery was full")
        verdict.expect(
            stay.level <= low, f"it docked at {stay.begin:.1f} s with {stay.level:.0f} %, which is not low"
        )
    return found


def _in_dock(place: Placed, world: dict[str, Any]) -> bool:
    return any(distance(place, *dock["pose"][:2]) <= dock["radius"] for dock in world.get("docks", []))
