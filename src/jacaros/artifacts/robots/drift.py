"""Advice for robots that drive by odometry although a localisation finds them elsewhere."""

import math
from collections.abc import Callable
from weakref import WeakSet

from jacaros.artifacts.robots.odometry import Odometer
from jacaros.plane.pose import Pose, normalised
from jacaros.ros.backend import Backend
from jacaros.ros.message import to_seconds
from jacaros.ros.node import Sample

LOCALISED = "geometry_msgs/msg/PoseWithCovarianceStamped"
TOLERANCE = (0.05, math.radians(3.0))
"""Metres and radians that odometry may drift: the accuracy of a navigation goal."""
LEAP = (0.5, math.radians(30.0))
"""A larger change between two poses is a new estimate, as after a pose from rviz, and not a drift."""
OUTDATED, AHEAD = 1.0, 0.1
"""Seconds over which the motion is extrapolated: from the newest odometry back to a pose, and forward to one. Over a slow
network odometry does not yet show that the robot turns, and a pose that is further ahead would look like a drift."""

_advised: WeakSet[Backend] = WeakSet()


class Drift:
    """Compare odometry with localised poses (``amcl_pose``), and log once per run that they drift apart.

    Args:
        ros: the graph.
        odometer: odometry of the robot in its own frame.
        driving: whether a motion relies on that odometry now.
        log: takes the advice.
    """

    def __init__(
        self, ros: Backend, odometer: Odometer, driving: Callable[[], bool], log: Callable[[str], None]
    ) -> None:
        self._ros, self._odometer, self._driving, self._log = ros, odometer, driving, log
        self._first: Pose | None = None
        self._last: Pose | None = None

    def take(self, sample: Sample) -> None:
        """Handle a localised pose; the callback of the subscription."""
        at = self._odometry_at(to_seconds(sample.message.header.stamp))
        if at is None or self._ros in _advised:
            return
        correction = Pose.of(sample.message.pose.pose).then(at.inverse())
        if (
            self._first is None
            or self._last is None
            or _exceeds(self._apart(self._last, correction, at), LEAP)
        ):
            self._first = correction
        self._last = correction
        metres, angle = self._apart(self._first, correction, at)
        if _exceeds((metres, angle), TOLERANCE) and self._driving():
            _advised.add(self._ros)
            self._log(
                f"note: odometry and localisation have drifted {metres:.2f} m and {math.degrees(angle):.1f} degrees "
                "apart; the option `frame(map)` corrects it"
            )

    def _odometry_at(self, stamp: float) -> Pose | None:
        """Return the pose in odometry at *stamp*, extrapolated from the newest: localisation is late by its computation."""
        odometer = self._odometer
        newest = odometer.newest
        if newest is None or not odometer.trusted:
            return None
        late = to_seconds(newest.sample.message.header.stamp) - stamp
        if not -AHEAD <= late <= OUTDATED:
            return None
        ahead = newest.pose.yaw - 0.5 * late * newest.velocity.angular
        metres = late * newest.velocity.linear
        return Pose(
            newest.pose.x - metres * math.cos(ahead),
            newest.pose.y - metres * math.sin(ahead),
            newest.pose.yaw - late * newest.velocity.angular,
        )

    @staticmethod
    def _apart(one: Pose, other: Pose, at: Pose) -> tuple[float, float]:
        """Return how far two corrections put the robot apart: metres and radians."""
        a, b = one.then(at), other.then(at)
        return math.dist(a[:2], b[:2]), abs(normalised(a.yaw - b.yaw))


def _exceeds(apart: tuple[float, float], limits: tuple[float, float]) -> bool:
    return any(value > limit for value, limit in zip(apart, limits, strict=True))
