"""What a fault is, as plain data; a fault file (`jacaros.sim.faults.file`) is read into these."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from jacaros.sim.description import PersonDescription, Pose

WHEELS: Final = ("wheel_slip", "blocked_wheel")
"""Kinds that concern the wheels of a robot."""
MESSAGES: Final = ("dead", "frozen", "nan", "lost", "delayed", "duplicated")
"""Kinds that concern the messages of a topic."""
AT_ONCE: Final = ("kidnapped_robot", "battery_drop")
"""Kinds that happen in one moment, and have no end."""

KEYS: Final[Mapping[str, tuple[str, ...]]] = {
    "wheel_slip": ("share",),
    "blocked_wheel": ("wheel",),
    "kidnapped_robot": ("to",),
    "battery_drop": ("to",),
    "dead_dock": ("dock",),
    "closed_door": ("door",),
    "person": ("path", "radius", "speed", "loop", "careless"),
    "dead": ("topic",),
    "frozen": ("topic",),
    "nan": ("topic",),
    "lost": ("topic", "share"),
    "delayed": ("topic", "seconds", "jitter"),
    "duplicated": ("topic", "copies"),
}
"""What each kind of fault is told; ``at`` and ``for`` belong to all, ``robot`` to those of wheels and at once."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault.

    Attributes:
        name: how it is called, in the ground truth and by its service.
        kind: one of `KEYS`.
        at: seconds of the world at which it begins; None: only when it is asked for.
        lasts: seconds until it ends; None: until it is ended.
        robot: name of the robot that it happens to, "" for none.
        topic: absolute name.
        share: of the way that slipping wheels lose on average, or of the messages that are lost.
        wheel: ``left``, ``right`` or ``both``.
        pose: where a kidnapped robot is put.
        level: percent that are left in the battery.
        place: name of the door or the dock.
        person: who comes.
        seconds, jitter: by which messages are late, and by up to so many more at random.
        copies: how often each message comes.
    """

    name: str
    kind: str
    at: float | None = None
    lasts: float | None = None
    robot: str = ""
    topic: str = ""
    share: float = 1.0
    wheel: str = "both"
    pose: Pose = field(default=Pose(0.0, 0.0, 0.0))
    level: float = 0.0
    place: str = ""
    person: PersonDescription | None = None
    seconds: float = 0.0
    jitter: float = 0.0
    copies: int = 2
