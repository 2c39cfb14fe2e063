"""The room in front of a robot, by its laser: the option ``stop_for`` of artifacts that drive."""

import math
from collections.abc import Sequence

from jacaros.robots.artifacts.drive_model import Limits, Velocity
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.plane.pose import clamp
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.qos import SENSOR_DATA

RADIUS = 0.18
"""Metres from the laser to the edge of a TurtleBot."""

MARGIN = 0.05
"""Metres that stay free in front of the robot."""

BESIDE = 0.01
"""The same at each side: a robot that stands next to something may leave."""

REACTION = 0.3
"""Seconds until a robot brakes: the age of a scan, and the way of a command."""

CREEPING = 0.01
"""Speed in m/s below which a robot stands."""

BLIND = 1.0
"""Age in seconds at which a scan no longer shows what is in the way."""


class Lookout:
    """Slow a robot down before what its laser sees, and stop it there.

    Args:
        artifact: subscribes to the scans.
        topic: of ``sensor_msgs/msg/LaserScan``.
        radius: metres from the laser to the edge of the robot.
        limits: of the robot; it brakes with its acceleration.
    """

    def __init__(self, artifact: RosArtifact, topic: str, radius: float, limits: Limits) -> None:
        self._radius, self._braking, self._clock = radius, limits.acceleration, artifact.clock
        self._echoes: Sequence[tuple[float, float]] = ()
        self._seen = -math.inf
        artifact.subscription(topic, "sensor_msgs/msg/LaserScan", self._take, SENSOR_DATA)

    def _take(self, sample: Sample) -> None:
        scan = sample.message
        start, step, least = scan.angle_min, scan.angle_increment, scan.range_min
        found = []
        for number, reach in enumerate(scan.ranges):
            if least <= reach <= scan.range_max:  # neither NaN nor infinite
                angle = start + number * step
                found.append((reach * math.cos(angle), reach * math.sin(angle)))
        self._echoes, self._seen = found, self._clock.elapsed

    @property
    def sees(self) -> bool:
        """Whether the newest scan is fresh enough to drive by."""
        return self._clock.elapsed - self._seen <= BLIND

    def room(self, towards: float) -> float:
        """Return the free metres in front of the robot (*towards* > 0) or behind it; 0 without a fresh scan."""
        if not self.sees:
            return 0.0
        radius, lane = self._radius, self._radius + BESIDE
        sign = math.copysign(1.0, towards)
        ways = (
            sign * x - math.sqrt(max(0.0, radius * radius - y * y))
            for x, y in self._echoes
            if sign * x > 0.0 and abs(y) < lane
        )
        return max(0.0, min(ways, default=math.inf))

    def limit(self, wanted: Velocity) -> Velocity:
        """Return the command, slowed down so that the robot can still stop; it stands where no room is left."""
        if not wanted.linear:
            return wanted
        left = max(0.0, self.room(wanted.linear) - MARGIN)
        # v * REACTION + v * v / (2 * braking) = left
        late = self._braking * REACTION
        most = math.sqrt(late * late + 2.0 * self._braking * left) - late
        if abs(wanted.linear) <= most:
            return wanted
        return wanted._replace(linear=clamp(wanted.linear, most)) if most >= CREEPING else Velocity()
