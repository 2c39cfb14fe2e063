"""Judging a run by what truly happened: the frame of a scenario's checker, and the geometry of true paths.

A checker is a function from a ground truth to a `Verdict`; it takes what an agent believes or prints for
nothing.  As a program it is::

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
from typing import Any, NamedTuple, Protocol

from jacaros.errors import JacarosError
from jacaros.sim.ground_truth import GroundTruth, Sample


@dataclass(slots=True)
class Verdict:
    """What a checker found.

    Attributes:
        complaints: what is not as it should be; empty when the run passes.
        measured: figures for people, by what they are.
    """

    complaints: list[str] = field(default_factory=list)
    measured: dict[str, float] = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """True when there is nothing to complain about."""
        return not self.complaints

    def expect(self, condition: bool, complaint: str) -> None:
        """Complain unless the condition holds."""
        if not condition:
            self.complaints.append(complaint)

    def measure(self, what: str, value: float) -> float:
        """Take note of a figure, and give it back."""
        self.measured[what] = value
        return value

    def at_most(self, what: str, value: float, limit: float) -> None:
        """Take note of a figure, and complain when it is greater than *limit*."""
        self.measure(what, value)
        self.expect(value <= limit, f"{what}: {value:.4g}, more than {limit:g}")

    def lines(self) -> list[str]:
        """The verdict for people."""
        figures = [f"{what}: {value:.4g}" for what, value in self.measured.items()]
        if self.passed:
            return [*figures, "passed"]
        return [*figures, *(f"FAILED: {complaint}" for complaint in self.complaints)]


def judge(check: Callable[[GroundTruth], Verdict], arguments: Sequence[str]) -> int:
    """The main program of a checker: judge the ground truth file that is the only argument.

    Returns:
        The exit code: 0 passed, 1 failed or no ground truth file, 2 wrong usage.
    """
    if len(arguments) != 1:
        print(
            "usage: check.py GROUND_TRUTH_FILE    (written by jacaros run --ground-truth GROUND_TRUTH_FILE)"
        )
        return 2
    try:
        verdict = check(GroundTruth.read(arguments[0]))
    except (OSError, ValueError, JacarosError) as error:
        print(f"{arguments[0]} cannot be judged: {error}")
        return 1
    print("\n".join(verdict.lines()))
    return 0 if verdict.passed else 1


class Placed(Protocol):
    """Anything with a pose: a sample, an event, a pose."""

    @property
    def x(self) -> float:
        """Metres."""

    @property
    def y(self) -> float:
        """Metres."""

    @property
    def yaw(self) -> float:
        """Radians."""


class Turn(NamedTuple):
    """The robot turned on the spot: where (the mean), by how much (signed), and when it began and ended."""

    x: float
    y: float
    angle: float
    begin: float
    end: float


def distance(one: Placed, x: float, y: float) -> float:
    """From a pose to a point."""
    return math.hypot(one.x - x, one.y - y)


def angle_between(one: float, other: float) -> float:
    """The smaller angle between two headings, not negative."""
    return abs(math.remainder(one - other, math.tau))


def seen_from(origin: Placed, point: Placed) -> tuple[float, float]:
    """How far ahead of a pose, and how far to its left, another one lies."""
    dx, dy = point.x - origin.x, point.y - origin.y
    cosine, sine = math.cos(origin.yaw), math.sin(origin.yaw)
    return dx * cosine + dy * sine, dy * cosine - dx * sine


def to_segment(one: Placed, a: tuple[float, float], b: tuple[float, float]) -> float:
    """From a pose to the nearest point between *a* and *b*."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    share = ((one.x - a[0]) * dx + (one.y - a[1]) * dy) / (dx * dx + dy * dy)
    share = min(1.0, max(0.0, share))
    return distance(one, a[0] + share * dx, a[1] + share * dy)


def turns(path: Sequence[Sample], least: float = math.radians(20.0)) -> list[Turn]:
    """Where the robot turned on the spot by *least* or more; wobbling on the way is no turn."""
    found = [_turn(stretch) for stretch in _turning_stretches(path)]
    return [turn for turn in found if abs(turn.angle) >= least]


def _turning_stretches(path: Sequence[Sample]) -> Iterable[list[Sample]]:
    """Runs of samples between which the robot turned and hardly moved."""
    stretch: list[Sample] = []
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


def _turn(stretch: Sequence[Sample]) -> Turn:
    angle = math.fsum(math.remainder(b.yaw - a.yaw, math.tau) for a, b in itertools.pairwise(stretch))
    count = len(stretch)
    return Turn(
        math.fsum(sample.x for sample in stretch) / count,
        math.fsum(sample.y for sample in stretch) / count,
        angle,
        stretch[0].time,
        stretch[-1].time,
    )


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
