"""What a robot knows: its estimated pose on the map, and the robots, people and doors that its laser sees."""

import math
from collections.abc import Iterable

from jacaros.robots.plane.pose import Placement, Point, distance
from jacaros.robots.plane.shapes import Circle, Segment
from jacaros.robots.plane.trigonometry import PI, sine_cosine
from jacaros.robots.world.data.world import Door
from jacaros.robots.world.physics.robot import Robot
from jacaros.robots.world.physics.world import World

PERIOD = 0.5
"""Seconds between two corrections of the odometry."""
SURE = 0.2
"""Errors in metres and radians that are always corrected, whatever the accuracy claimed by a received pose."""
FOUND = (0.0025, 0.001)
"""Variances of a pose corrected by scans: of x and y (m²), and of the heading (rad²)."""
_SAME = 1e-6


class SimulatedLocalisation:
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


RANGE = 3.0
"""Distance in metres up to which other robots and doors are considered."""
_LEAF = -0.03
"""Radius of the circles that stand for a closed door: navigation treats it as a wall, not as a robot."""
_BETWEEN = 0.1
"""Maximum distance in metres between the centres of those circles."""


class LaserPerception:
    """What a robot perceives, on the map at its estimated pose. A robot without a laser perceives nothing.

    Args:
        world: the world.
        robot: robot with the laser.
    """

    def __init__(self, world: World, robot: Robot) -> None:
        self._world, self._robot = world, robot
        laser = robot.description.laser
        self._reach = min(RANGE, laser.range_max) if laser.enabled else 0.0
        self._closed: set[str] = set()

    def robots(self, believed: Placement) -> list[Circle]:
        """Return the robots, people and obstacles that no wall hides."""
        world = self._world
        if self._reach <= 0.0 or not (len(world.robots) > 1 or world.people or world.obstacles):
            return []
        true, seen = self._robot.placement, []
        for x, y, radius in self._world.others(self._robot):
            if self._sees(x, y, self._world.segments):
                seen.append((*believed.point(*true.local(x, y)), radius))
        return seen

    def closed_doors(self, believed: Placement) -> dict[str, list[Circle]]:
        """Return the doors that were closed when last seen, each as a row of circles."""
        doors = self._world.description.doors
        if not doors:
            return {}
        for door in doors:
            others = [wall for wall in self._world.segments if wall is not door.segment]
            if any(self._sees(*point, others) for point in _points(door)[1:-1]):
                (self._closed.discard if self._world.doors[door.name] else self._closed.add)(door.name)
        true = self._robot.placement
        return {
            door.name: [(*believed.point(*true.local(*point)), _LEAF) for point in _points(door)]
            for door in doors
            if door.name in self._closed
        }

    def covers(self, place: Point, believed: Placement) -> bool:
        """Return whether the robot sees a place on its map, or what occupies it."""
        return self._sees(*self._robot.placement.point(*believed.local(*place)), self._world.segments)

    def forget(self) -> None:
        """Forget the doors that were closed."""
        self._closed.clear()

    def _sees(self, x: float, y: float, walls: Iterable[Segment]) -> bool:
        dx, dy = x - self._robot.x, y - self._robot.y
        near = dx * dx + dy * dy <= self._reach * self._reach
        return near and not Segment(self._robot.x, self._robot.y, x, y).crosses(*walls)


def _points(door: Door) -> list[Point]:
    ax, ay, bx, by = door.segment
    pieces = max(2, math.ceil(distance((ax, ay), (bx, by)) / _BETWEEN))
    return [(ax + (bx - ax) * n / pieces, ay + (by - ay) * n / pieces) for n in range(pieces + 1)]
