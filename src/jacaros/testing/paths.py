"""Evaluate runs by their ground truth: checkers of scenarios, and the geometry of true paths.

A checker is a function from a ground truth to a `Verdict`; it ignores what agents believe and print. As a program::

    def check(truth: GroundTruth) -> Verdict:
        verdict = Verdict()
        verdict.measure("metres driven", truth.odometer())
        verdict.expect(truth.odometer() > 1.0, "the robot did not drive")
        return verdict

    if __name__ == "__main__":
        sys.exit(judge(check, sys.argv[1:]))

Lengths are in metres and angles in radians.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from jacaros.robots.plane.pose import Pose, normalised
from jacaros.robots.plane.shapes import Segment
from jacaros.robots.world.data.ground_truth import GroundTruth, PathSample, RobotEvent
from jacaros.runtime.errors import JacarosError


@dataclass(slots=True)
class Verdict:
    """The result of a checker.

    Attributes:
        complaints: failed expectations; empty if the run passes.
        measured: measured values by name.
    """

    complaints: list[str] = field(default_factory=list)
    measured: dict[str, float] = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """Whether no expectation failed."""
        return not self.complaints

    def expect(self, condition: bool, complaint: str) -> None:
        """Add a complaint unless the condition holds."""
        if not condition:
            self.complaints.append(complaint)

    def measure(self, what: str, value: float) -> float:
        """Record a value and return it."""
        self.measured[what] = value
        return value

    def at_most(self, what: str, value: float, limit: float) -> None:
        """Record a value; add a complaint if it exceeds *limit*."""
        self.measure(what, value)
        self.expect(value <= limit, f"{what}: {value:.4g}, more than {limit:g}")

    def lines(self) -> list[str]:
        """Return the verdict as text."""
        figures = [f"{what}: {value:.4g}" for what, value in self.measured.items()]
        if self.passed:
            return [*figures, "passed"]
        return [*figures, *(f"FAILED: {complaint}" for complaint in self.complaints)]


def judge(check: Callable[[GroundTruth], Verdict], arguments: Sequence[str]) -> int:
    """Run a checker as a main program on the ground truth file that is the only argument.

    Returns:
        The exit code: 0 passed; 1 failed, or the file is not a ground truth file; 2 wrong usage.
    """
    if len(arguments) != 1:
        print(
            "usage: check.py GROUND_TRUTH_FILE    (written by jacaros run --ground-truth GROUND_TRUTH_FILE)"
        )
        return 2
    try:
        verdict = check(GroundTruth.read(arguments[0]))
    except (OSError, ValueError, JacarosError) as error:
        print(f"error: cannot read the ground truth `{arguments[0]}`: {error}")
        return 1
    print("\n".join(verdict.lines()))
    return 0 if verdict.passed else 1


Placed = PathSample | RobotEvent | Pose
"""What has a position, `x` and `y` in metres, and a heading `yaw` in radians."""


class Turn(NamedTuple):
    """A turn on the spot: mean position (m), signed angle (rad), start and end (s)."""

    x: float
    y: float
    angle: float
    begin: float
    end: float


def distance(one: Placed, x: float, y: float) -> float:
    """Return the distance from a pose to a point, in metres."""
    return math.hypot(one.x - x, one.y - y)


def angle_between(one: float, other: float) -> float:
    """Return the absolute difference of two headings, from 0 to pi, in radians."""
    return abs(normalised(one - other))


def seen_from(origin: Placed, point: Placed) -> tuple[float, float]:
    """Return the position of a point relative to a pose: metres ahead, metres to the left."""
    return Pose(origin.x, origin.y, origin.yaw).local(point.x, point.y)


def to_segment(one: Placed, a: tuple[float, float], b: tuple[float, float]) -> float:
    """Return the distance from a pose to the segment from *a* to *b*, in metres."""
    return Segment(*a, *b).distance(one.x, one.y)


def turns(path: Sequence[PathSample], least: float = math.radians(20.0)) -> list[Turn]:
    """Return the turns on the spot by *least* radians or more; small corrections on the way do not count."""
    found = [_turn(stretch) for stretch in _turning_stretches(path)]
    return [turn for turn in found if abs(turn.angle) >= least]


def _turning_stretches(path: Sequence[PathSample]) -> Iterable[list[PathSample]]:
    """Yield sequences of samples in which the robot turned and hardly moved."""
    stretch: list[PathSample] = []
    for before, after in itertools.pairwise(path):
        turned = angle_between(after.yaw, before.yaw)
        moved = after.odometer - before.odometer
        if turned > math.radians(0.2) and moved < 0.02:
            stretch = stretch or [before]
            stretch.append(after)
        elif stretch:
            yield stretch
            stretch = []
    if stretch:
        yield stretch


def _turn(stretch: Sequence[PathSample]) -> Turn:
    angle = math.fsum(normalised(b.yaw - a.yaw) for a, b in itertools.pairwise(stretch))
    count = len(stretch)
    return Turn(
        math.fsum(sample.x for sample in stretch) / count,
        math.fsum(sample.y for sample in stretch) / count,
        angle,
        stretch[0].time,
        stretch[-1].time,
    )


class Stay(NamedTuple):
    """A stay in the dock, from docking to leaving; ``end`` is None if the run ended in the dock."""

    begin: float
    end: float | None
    charged: bool
    level: float
    """Battery level in percent at the start."""


def stays(truth: GroundTruth, robot: str | None = None) -> list[Stay]:
    """Return the stays that charged the battery; brief stops with a full battery do not count.

    A robot that turns in the dock undocks and docks again; this counts as one stay.
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
    """Yield the stays from each ``docked`` to the next ``undocked`` event in which the battery was charged."""
    begin, level, charged = 0.0, None, False
    for event in truth.events_of("docked", "charging", "charged", "undocked", robot=robot):
        match event.kind:
            case "docked":
                begin, level, charged = event.time, None, False
            case "charging":
                # A contact that comes and goes begins charging more than once.
                level = float(event.data["level"]) if level is None else level
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
    """Expect that a robot charges only in docks, only when its battery is low, until it is full, and never runs empty.

    Args:
        low: battery level in percent below which the robot may dock.

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
            stay.level <= low,
            f"it docked at {stay.begin:.1f} s with {stay.level:.0f} %, which is not low",
        )
    return found


def _in_dock(place: Placed, world: dict[str, Any]) -> bool:
    return any(distance(place, *dock["pose"][:2]) <= dock["radius"] for dock in world.get("docks", []))
