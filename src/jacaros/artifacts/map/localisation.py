"""The pose of a robot on the map: its odometry, and a correction."""

import math
from collections import deque

from jacaros.plane.pose import ORIGIN, Pose, normalised

REMEMBERED = 40
"""Number of odometry poses that are stored: two seconds at 20 Hz, for sensors that arrive late."""


class Localisation:
    """The pose of a robot on the map.

    Attributes:
        correction: pose of the odometry frame on the map; the origin until something corrects it.
        pose: the newest pose on the map; None before the first odometry.
        driven: metres driven, according to odometry.
    """

    def __init__(self) -> None:
        self.correction = ORIGIN
        self.pose: Pose | None = None
        self.driven = 0.0
        self._odometry: deque[tuple[float, Pose]] = deque(maxlen=REMEMBERED)

    def take_odometry(self, stamp: float, pose: Pose) -> None:
        """Take a pose from odometry; *stamp* in seconds."""
        if self._odometry:
            last, before = self._odometry[-1]
            self.driven += math.dist(before[:2], pose[:2])
            if stamp < last:  # the sender's clock was set back
                self._odometry.clear()
        self._odometry.append((stamp, pose))
        self.pose = self.correction.then(pose)

    def pose_at(self, stamp: float) -> Pose | None:
        """Return the pose on the map at *stamp* (0.0: now), the nearest known one; None before the first odometry."""
        found = self._odometry_at(stamp)
        return None if found is None else self.correction.then(found)

    def correct(self, stamp: float, pose: Pose) -> None:
        """Correct the pose: the robot was at *pose* on the map at *stamp*. No effect before the first odometry."""
        found = self._odometry_at(stamp)
        if found is not None:
            self.correction = pose.then(found.inverse())
            self.pose = self.correction.then(self._odometry[-1][1])

    def _odometry_at(self, stamp: float) -> Pose | None:
        if not self._odometry:
            return None
        later_stamp, later = self._odometry[-1]
        if stamp == 0.0 or stamp >= later_stamp:
            return later
        for before_stamp, before in reversed(self._odometry):
            if before_stamp <= stamp:
                return _between(before, later, (stamp - before_stamp) / (later_stamp - before_stamp))
            later_stamp, later = before_stamp, before
        return later


def _between(a: Pose, b: Pose, share: float) -> Pose:
    """Interpolate linearly between *a* (share 0) and *b* (share 1)."""
    turn = normalised(b.yaw - a.yaw)
    return Pose(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.yaw + share * turn)
