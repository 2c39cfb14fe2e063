"""Faults as plain data, read from fault files (`jacaros.robots.world.files.faults`)."""

import math
import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Final, NamedTuple

from jacaros.robots.plane.pose import ORIGIN, Pose
from jacaros.robots.world.data.world import PersonDescription
from jacaros.runtime.files.entries import FieldSpec, choice, number, section, whole


class FaultKind(NamedTuple):
    """A kind of faults.

    Attributes:
        keys: its keys in a fault file, beside ``at``, ``after``, ``for`` and ``robot``.
        robot: whether it concerns a robot.
        lasts: whether it has a duration.
    """

    keys: tuple[str, ...]
    robot: bool = False
    lasts: bool = True


MESSAGES: Final[Mapping[str, FaultKind]] = {
    "dead": FaultKind(("topic",), True),
    "frozen": FaultKind(("topic",), True),
    "nan": FaultKind(("topic",), True),
    "lost": FaultKind(("topic", "share"), True),
    "delayed": FaultKind(("topic", "seconds", "jitter"), True),
    "duplicated": FaultKind(("topic", "copies"), True),
}
"""Kinds that affect the messages of a topic."""

KINDS: Final[Mapping[str, FaultKind]] = {
    "wheel_slip": FaultKind(("share",), True),
    "blocked_wheel": FaultKind(("wheel",), True),
    "kidnapped_robot": FaultKind(("to", "by"), True, lasts=False),
    "lost_localisation": FaultKind(("to",), True, lasts=False),
    "battery_drop": FaultKind(("to",), True, lasts=False),
    "dead_dock": FaultKind(("dock",)),
    "dirty_contact": FaultKind(("dock", "share", "period")),
    "wrong_dock": FaultKind(("to",)),
    "closed_door": FaultKind(("door",)),
    "stuck_door": FaultKind(("door", "share")),
    "person": FaultKind(("path", "radius", "speed", "loop", "careless")),
    "person_in_the_way": FaultKind(("gap", "radius"), True),
    "missed_grasp": FaultKind(("share",), True),
    **MESSAGES,
    "aborted_action": FaultKind(("action", "share"), True),
}


def _seconds(help: str, key: str = "") -> FieldSpec:
    return number(0.0, math.inf, "s", help, key)


@dataclass(frozen=True, slots=True)
class Progress:
    """Progress of a robot after which a fault begins: one of the three entries.

    Attributes:
        metres: distance truly driven since the start of the world.
        battery: level in percent, at or below.
        tasks: number of announced tasks.
        robot: name of the robot that makes it, "" for the first.
    """

    metres: Annotated[float | None, number(0.0, math.inf, "m", "driven since the start")] = None
    battery: Annotated[float | None, number(0.0, 100.0, "%", "level, at or below this")] = None
    tasks: Annotated[int | None, whole(1, "tasks announced since the start")] = None
    robot: str = ""

    def __bool__(self) -> bool:
        return (self.metres, self.battery, self.tasks) != (None, None, None)

    def reached(self, metres: float, battery: float, tasks: int) -> bool:
        """Return whether a robot has got that far."""
        if self.metres is not None:
            return metres >= self.metres
        if self.battery is not None:
            return battery <= self.battery
        return self.tasks is not None and tasks >= self.tasks


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault.

    Attributes:
        name: name in the ground truth and in its service.
        kind: one of `KINDS`.
        at: start in seconds of the world; None without it.
        after: progress that starts it. Without both, it starts only on request.
        lasts: duration in seconds; None: until `Faults.end`.
        robot: name of the affected robot, "" for none.
        topic, action: absolute names.
        door, dock: names.
        share: mean loss of slipping wheels or of a contact, or of messages, goals, grasps or requests; 0 to 1.
        period: seconds after which a dirty contact can change.
        gap: metres between a robot and the person in its way.
        wheel: ``left``, ``right`` or ``both``.
        pose: new pose of a kidnapped robot, pose that a lost robot believes in, or pose of a wrong dock.
        by: metres by which a kidnapped robot is carried, in a drawn direction; None: to ``pose``.
        level: remaining charge of the battery, in percent.
        person: person who appears.
        seconds, jitter: delay of messages, and maximum of its random part, in seconds.
        copies: number of deliveries of each message.
    """

    name: str
    kind: str
    at: Annotated[float | None, _seconds("beginning; without it, only on request")] = None
    after: Annotated[Progress, section("progress of the robot that begins it, instead of `at`")] = Progress()
    lasts: Annotated[float | None, _seconds("duration; without it, until you end it", "for")] = None
    robot: str = ""
    topic: Annotated[str, FieldSpec("text", "absolute, or below the robot's namespace")] = ""
    action: Annotated[str, FieldSpec("text", "absolute, or below the robot's namespace")] = ""
    door: Annotated[str, FieldSpec("text", "name of a door")] = ""
    dock: Annotated[str, FieldSpec("text", "name of a dock")] = ""
    share: Annotated[float, number(0.0, 1.0, help="mean loss")] = 1.0
    period: Annotated[float, number(0.1, math.inf, "s", "after which a dirty contact can change")] = 1.0
    gap: Annotated[float, number(0.05, 5.0, "m", "between the robot and the person in its way")] = 0.5
    wheel: Annotated[str, choice("both", "left", "right", help="blocked wheel")] = "both"
    pose: Pose = ORIGIN
    by: Annotated[
        float | None, number(0.0, 100.0, "m", "distance of a kidnapped robot from where it was")
    ] = None
    level: float = 0.0
    person: PersonDescription | None = None
    seconds: Annotated[float, _seconds("delay")] = 0.5
    jitter: Annotated[float, _seconds("largest random extra delay")] = 0.0
    copies: Annotated[int, whole(2, "deliveries of each message")] = 2

    def draw(self, seed: int, purpose: str) -> Callable[[], float]:
        """Return random numbers from 0 to 1 for a world with that seed: the same ones in each run."""
        return random.Random(f"{seed}/{self.name}/{purpose}").random

    def connects(self, seed: int, time: float) -> bool:
        """Return whether a dirty contact conducts at *time* (seconds of the world)."""
        return self.draw(seed, f"contact {time // self.period:.0f}")() >= self.share

    def chance(self, seed: int) -> Callable[[], bool]:
        """Return a function that decides each time whether the fault happens, with the probability ``share``."""
        draw = self.draw(seed, self.kind)
        return lambda: draw() < self.share
