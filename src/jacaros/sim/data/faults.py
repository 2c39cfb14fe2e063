"""Faults as plain data, read from fault files (`jacaros.sim.files.faults`)."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Final

from jacaros.files.entries import Entry, choice, number, whole
from jacaros.plane.pose import ORIGIN, Pose
from jacaros.sim.data.world import PersonDescription

WHEELS: Final = ("wheel_slip", "blocked_wheel")
"""Kinds that affect the wheels of a robot."""
MESSAGES: Final = ("dead", "frozen", "nan", "lost", "delayed", "duplicated")
"""Kinds that affect the messages of a topic."""
ACTIONS: Final = ("aborted_action",)
"""Kinds that affect the goals of an action."""
AT_ONCE: Final = ("kidnapped_robot", "battery_drop")
"""Kinds without duration."""

KEYS: Final[Mapping[str, tuple[str, ...]]] = {
    "wheel_slip": ("share",),
    "blocked_wheel": ("wheel",),
    "kidnapped_robot": ("to",),
    "battery_drop": ("to",),
    "dead_dock": ("dock",),
    "closed_door": ("door",),
    "stuck_door": ("door", "share"),
    "person": ("path", "radius", "speed", "loop", "careless"),
    "dead": ("topic",),
    "frozen": ("topic",),
    "nan": ("topic",),
    "lost": ("topic", "share"),
    "delayed": ("topic", "seconds", "jitter"),
    "duplicated": ("topic", "copies"),
    "aborted_action": ("action", "share"),
}
"""Further keys by kind; all kinds have ``at`` and ``for``, and kinds of wheels or without duration also ``robot``."""


def _seconds(help: str, key: str = "") -> Entry:
    return number(0.0, math.inf, "s", help, key)


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault.

    Attributes:
        name: name in the ground truth and in its service.
        kind: one of `KEYS`.
        at: start in seconds of the world; None: only on request.
        lasts: duration in seconds; None: until `Faults.end`.
        robot: name of the affected robot, "" for none.
        topic, action: absolute names.
        share: mean loss of slipping wheels, or of messages, goals or requests; 0 to 1.
        wheel: ``left``, ``right`` or ``both``.
        pose: new pose of a kidnapped robot.
        level: remaining charge of the battery, in percent.
        place: name of the door or the dock.
        person: person who appears.
        seconds, jitter: delay of messages, and maximum of its random part, in seconds.
        copies: number of deliveries of each message.
    """

    name: str
    kind: str
    at: Annotated[float | None, _seconds("beginning; without it, only on request")] = None
    lasts: Annotated[float | None, _seconds("duration; without it, until you end it", "for")] = None
    robot: str = ""
    topic: str = ""
    action: str = ""
    share: Annotated[float, number(0.0, 1.0, help="mean loss")] = 1.0
    wheel: Annotated[str, choice("both", "left", "right", help="blocked wheel")] = "both"
    pose: Pose = ORIGIN
    level: float = 0.0
    place: str = ""
    person: PersonDescription | None = None
    seconds: Annotated[float, _seconds("delay")] = 0.5
    jitter: Annotated[float, _seconds("largest random extra delay")] = 0.0
    copies: Annotated[int, whole(2, "deliveries of each message")] = 2
