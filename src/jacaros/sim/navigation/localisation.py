"""The estimated pose of a robot on the map: its odometry, corrected at intervals."""

import math

from jacaros.plane.pose import Placement, distance
from jacaros.plane.trigonometry import PI, sine_cosine
from jacaros.sim.robot.robot import Robot

PERIOD = 0.5
"""Seconds between two corrections of the odometry."""
SURE = 0.2
"""Errors in metres and radians that are always corrected, whatever the accuracy claimed by a received pose."""
FOUND = (0.0025, 0.001)
"""Variances of a pose corrected by scans: of x and y (m²), and of the heading (rad²)."""
_SAME = 1e-6


class Localisation:
    """The transform from map to odometry, as estimated by a robot with a good laser.

    Twice a second it removes the accumulated error of odometry; between corrections the robot trusts its wheels. (Scan
    matching is out of scope, so corrections use the true pose.) As with AMCL, a wrong initial pose makes the robot lost: it
    then uses odometry alone.

    Attributes:
        map_to_odom: pose of the odometry frame on the map.
        variances: variances of the estimate: `FOUND`, or those of the received pose.
        lost: whether the last received pose was too wrong for scans to correct.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._next = -math.inf
        self.map_to_odom = Placement(0.0, 0.0)
        self.variances = FOUND
        self.lost = False
        self._put_downs = robot.put_downs

    def update(self, time: float) -> None:
        """Correct the transform if a correction is due at *time* (seconds of the world)."""
        if self._robot.put_downs != self._put_downs:
            self._put_downs = self._robot.put_downs
            self.lost = True  # nothing tells the robot that it was moved
        if time < self._next or self.lost:
            return
        self._next = time + PERIOD
        self.variances = FOUND
        found = self._robot.placement.then(self._robot.odometry.placement.inverse())
        known = self.map_to_odom
        # Rounding errors must not move a robot with exact odometry.
        if max(abs(a - b) for a, b in zip(found, known, strict=True)) > _SAME:
            self.map_to_odom = found

    def believe(self, place: Placement, radius: float, turn: float, time: float) -> None:
        """Set the robot's pose, accurate to *radius* metres and *turn* radians, at *time* (see `update`).

        If the true pose is within that accuracy (at least `SURE`), the next correction finds it.
        """
        truth = self._robot.placement
        apart = distance((place.x, place.y), (truth.x, truth.y))
        alike = place.cosine * truth.cosine + place.sine * truth.sine
        _, least_alike = sine_cosine(min(PI, max(SURE, turn)))
        self.lost = apart > max(SURE, radius) or alike < least_alike
        self.map_to_odom = place.then(self._robot.odometry.placement.inverse())
        self.variances = ((0.5 * radius) ** 2, (0.5 * turn) ** 2)
        self._next = time + PERIOD

    def pose(self) -> Placement:
        """Return the estimated pose on the map."""
        return self.map_to_odom.then(self._robot.odometry.placement)

    def belief(self, time: float) -> Placement:
        """Return the estimate at *time* (seconds of the world) without updating it, for observers."""
        due = time >= self._next and not self.lost and self._robot.put_downs == self._put_downs
        return self._robot.placement if due else self.pose()
