"""The artifacts of this case, written from its spec.md."""

import math
from dataclasses import dataclass
from enum import Enum, auto
from itertools import pairwise

from jacaros.artifacts import Artifact, Out, operation


@dataclass(frozen=True)
class Pose:
    """Where something is."""

    x: float
    y: float
    frame: str = "map"


class Speed(Enum):
    """How fast."""

    SLOW = auto()
    FAST = auto()


class Navigator(Artifact):
    """Knows where to go."""

    @operation
    def drive(self, to: Pose, speed: Speed) -> None:
        if self.has_property("goal"):
            self.update_property("goal", to, speed)
        else:
            self.define_property("goal", to, speed)

    @operation
    def path(self, poses: list[Pose], length: Out) -> None:
        length.set(sum(math.dist((a.x, a.y), (b.x, b.y)) for a, b in pairwise(poses)))

    @operation
    def mean(self, numbers: list[float], mean: Out) -> None:
        mean.set(sum(numbers) / len(numbers))
