"""Where a robot believes to be on the map: its odometry, put right now and then."""

import math

from jacaros.sim.navigation.placement import Placement
from jacaros.sim.robot import Robot

PERIOD = 0.5
"""Seconds between two corrections of the odometry."""
_SAME = 1e-6


class Localisation:
    """The transform from map to odometry, as a robot with a good laser finds it.

    Twice a second it takes away all errors that odometry has piled up; between two corrections the robot
    trusts its wheels.  (Matching scans with the map is not what this world is for, so the correction is taken from the
    true pose.)

    Attributes:
        map_to_odom: where the odometry frame stands on the map.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._next = -math.inf
        self.map_to_odom = Placement(0.0, 0.0)

    def update(self, time: float) -> None:
        """Correct the transform if that is due at *time* (seconds of the world)."""
        if time < self._next:
            return
        self._next = time + PERIOD
        robot = self._robot
        found = Placement.at(robot.x, robot.y, robot.yaw).then(self._odometry().inverse())
        known = self.map_to_odom
        # Rounding alone must not make a robot with faultless odometry hop.
        if max(abs(a - b) for a, b in zip(found, known, strict=True)) > _SAME:
            self.map_to_odom = found

    def pose(self) -> Placement:
        """The robot's pose on the map, as it believes."""
        return self.map_to_odom.then(self._odometry())

    def _odometry(self) -> Placement:
        odometry = self._robot.odometry
        return Placement.at(odometry.x, odometry.y, odometry.yaw)
