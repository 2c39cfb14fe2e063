"""Where a robot believes it is, and how sure it is: localisation by scans, with the doubts of AMCL."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from jacaros.robots.plane.pose import Placement, Point, distance
from jacaros.robots.plane.trigonometry import PI, sine_cosine
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.physics.ranging import Laser
from jacaros.robots.world.physics.robot import Robot, WheelOdometry
from jacaros.robots.world.physics.world import World

PERIOD = 0.5
"""Seconds between two corrections of the odometry."""
SURE = 0.2
"""Errors in metres and radians that are always corrected, whatever the accuracy claimed by a received pose."""
FOUND = (0.0025, 0.001)
"""Variances of a pose corrected by scans: of x and y (m²), and of the heading (rad²)."""
UPDATE_DISTANCE = 0.25
"""Metres of odometry after which scans make a pose surer (``update_min_d`` of Nav2's AMCL)."""
UPDATE_ANGLE = 0.2
"""Radians of odometry after which they do (``update_min_a``)."""
_SAME = 1e-6
_BEAMS = 24
_ON_WALL, _ON_DOCK = 0.15, 0.3
_MATCH = 0.9
"""Share of the echoes that must lie on walls of the map for a scan to match."""
_WORSE = 0.25
"""Sum of the shares by which a possible pose may match worse than the best one in a search."""
_APART, _HEADINGS = 0.25, 12
_MOST_POSES = 30_000
"""Poses of the lattice; its metres are doubled until a large map has at most these."""
_ONE_PLACE = 0.1
"""Variance in m² and rad² up to which possible poses count as one."""
_SEVERAL, _SURE_ENOUGH = 0.5, 0.3
"""Variances of the estimate in m²: the least while several places are possible, and that at which a search ends."""
_ANY_HEADING = PI * PI / 3.0


class OdometryMoves:
    """Whether a robot has moved enough, by its odometry, for another update; the first update is always due."""

    def __init__(self, odometry: WheelOdometry) -> None:
        self._odometry = odometry
        self._last = (math.inf, math.inf, 0.0)

    def begin(self) -> None:
        """Measure from here."""
        self._last = (self._odometry.x, self._odometry.y, self._odometry.yaw)

    def enough(self) -> bool:
        """Return whether the robot has moved by `UPDATE_DISTANCE` or turned by `UPDATE_ANGLE`."""
        odometry, (x, y, yaw) = self._odometry, self._last
        turned = abs(math.remainder(odometry.yaw - yaw, math.tau))
        return turned >= UPDATE_ANGLE or distance((x, y), (odometry.x, odometry.y)) >= UPDATE_DISTANCE


class ScanMatch:
    """How well a robot's scan matches the map at a pose: AMCL's likelihood field, with a handful of beams.

    Args:
        world: the world.
        robot: robot with the laser.
        grid: creates the map; called at the first scan.
    """

    def __init__(self, world: World, robot: Robot, grid: Callable[[], Grid]) -> None:
        self._world, self._robot, self._grid = world, robot, grid
        settings = replace(robot.description.laser, beams_per_turn=_BEAMS, noise=0.0)
        self._laser = Laser(settings, "")
        self._beams = [
            sine_cosine(self._laser.angle_min + number * self._laser.angle_increment)
            for number in range(_BEAMS)
        ]
        self._echoes: list[Point] = []
        self._dock: Point | None = None

    def scan(self) -> bool:
        """Take a scan, for the calls that follow; return whether it says anything: it has an echo, or a dock in view."""
        robot, world = self._robot, self._world
        self._laser.segments = world.segments
        ranges = self._laser.scan(robot.x, robot.y, robot.yaw, world.others(robot))
        self._echoes = [
            (reach * cosine, reach * sine)
            for reach, (sine, cosine) in zip(ranges, self._beams, strict=False)
            if math.isfinite(reach) and robot.description.laser.enabled
        ]
        dock = world.visible_dock(robot)
        self._dock = None if dock is None else robot.placement.local(dock.pose.x, dock.pose.y)
        return bool(self._echoes or dock)

    def share(self, place: Placement, least: float = 0.0) -> float:
        """Return the share of the echoes that lie on walls of the map; 1 without echoes.

        Returns 0 for a pose in a wall, for one where the map lacks the dock that the robot sees, and for a share below
        *least*.
        """
        grid = self._grid()
        here = grid.cell(place.x, place.y)
        if here is None or grid.clearance[here] < 0.5 * self._robot.description.radius:
            return 0.0
        if self._dock is not None and not self._on_a_dock(place.point(*self._dock)):
            return 0.0
        count, missed = len(self._echoes), 0
        allowed, near = (1.0 - least) * count + 1e-9, max(_ON_WALL, grid.resolution)
        # As `Grid.cell`, in line: a search does this 100,000 times.
        per_metre, width, height, clearance = 1.0 / grid.resolution, grid.width, grid.height, grid.clearance
        beside = near * per_metre  # a wall may be the edge of the map
        left, down, cosine, sine = place.x - grid.x_min, place.y - grid.y_min, place.cosine, place.sine
        for x, y in self._echoes:
            column = int((left + cosine * x - sine * y) * per_metre + 1.0)
            row = int((down + sine * x + cosine * y) * per_metre + 1.0)
            on_map = -beside < column < width + beside and -beside < row < height + beside
            column, row = min(max(column, 1), width - 2), min(max(row, 1), height - 2)
            if not on_map or clearance[row * width + column] > near:
                missed += 1
                if missed > allowed:
                    return 0.0
        return 1.0 - missed / count if count else 1.0

    def _on_a_dock(self, point: Point) -> bool:
        docks = self._world.description.docks
        return any(distance(point, (dock.pose.x, dock.pose.y)) <= _ON_DOCK for dock in docks)

    def matching(self, poses: Iterable[tuple[float, Placement]]) -> list[tuple[float, Placement]]:
        """Return the poses whose scans match about as well as those of the best, which comes first.

        Args:
            poses: poses with the sums of how much worse than the best one their shares have been.
        """
        best, found = 0.0, []
        for worse, place in poses:
            share = self.share(place, best + worse - _WORSE)
            if share > 0.0:
                best = max(best, share)
                found.append((worse, share, place))
        summed = [(worse + best - share, place) for worse, share, place in found]
        return sorted((each for each in summed if each[0] <= _WORSE), key=lambda pair: pair[0])

    def everywhere(self) -> Iterable[tuple[float, Placement]]:
        """Return poses all over the map: a lattice through the true pose, which so is one of them."""
        grid, robot, apart = self._grid(), self._robot, _APART
        while _HEADINGS * grid.width * grid.height * (grid.resolution / apart) ** 2 > _MOST_POSES:
            apart *= 2.0
        reach = math.ceil(max(grid.width, grid.height) * grid.resolution / apart)
        headings = [sine_cosine(robot.yaw + 2.0 * PI * n / _HEADINGS) for n in range(_HEADINGS)]
        steps = sorted(range(-reach, reach + 1), key=abs)
        for row in steps:
            for column in steps:
                x, y = robot.x + column * apart, robot.y + row * apart
                if grid.cell(x, y) is not None:
                    yield from ((0.0, Placement(x, y, cosine, sine)) for sine, cosine in headings)

    def spread(self) -> tuple[float, float]:
        """Return the variances of a pose that can be anywhere on the map."""
        grid = self._grid()
        return (grid.width**2 + grid.height**2) * grid.resolution**2 / 24.0, _ANY_HEADING


class SimulatedLocalisation:
    """The transform from map to odometry, as estimated by a robot with a good laser, and how sure it is.

    Twice a second it removes the accumulated error of odometry; between corrections the robot trusts its wheels.
    (Corrections use the true pose.) As with AMCL, a wrong pose makes the robot lost: it then uses odometry alone, until it
    receives a pose or relocalises.

    The variances grow with slip, with bumps, and with scans that do not match the map at the estimated pose. While scans
    match, they halve whenever the robot has moved, down to `FOUND`. A robot that was carried to a place that looks the same
    does not notice.

    Args:
        world: the world.
        robot: the robot.
        grid: creates the map; called when the robot is lost.

    Attributes:
        map_to_odom: pose of the odometry frame on the map.
        variances: variances of the estimate: of x and y (m²), and of the heading (rad²).
        lost: whether the true pose is too far from the estimate for scans to correct.
    """

    def __init__(self, world: World, robot: Robot, grid: Callable[[], Grid]) -> None:
        self._robot, self._match = robot, ScanMatch(world, robot, grid)
        self._next = -math.inf
        self.map_to_odom = Placement(0.0, 0.0)
        self.variances = FOUND
        self.lost = False
        self._put_downs, self._shaken = robot.put_downs, robot.shaken
        self._moves = OdometryMoves(robot.odometry)
        self._moves.begin()
        self._searching = False
        self._possible: Sequence[tuple[float, Placement]] = ()
        """Poses of odometry on the map that the search considers, as `ScanMatch.matching` does; none before a scan."""

    @property
    def settled(self) -> bool:
        """Whether nothing has happened that an update could notice, other than motion."""
        robot = self._robot
        undisturbed = robot.put_downs == self._put_downs and robot.shaken == self._shaken
        return undisturbed and self.variances is FOUND and not self.lost

    def update(self, time: float) -> None:
        """Correct the transform if a correction is due at *time* (seconds of the world)."""
        robot = self._robot
        if robot.put_downs != self._put_downs:
            self._put_downs = robot.put_downs
            self.lost = True  # nothing tells the robot that it was moved
        if time < self._next:
            return
        self._next = time + PERIOD
        if not self.settled:
            self._doubt()
            shaken, self._shaken = robot.shaken - self._shaken, robot.shaken
            if shaken:
                self.variances = (self.variances[0] + shaken**2, self.variances[1] + shaken**2)
        if self.lost:
            return
        found = robot.placement.then(robot.odometry.placement.inverse())
        known = self.map_to_odom
        # Rounding errors must not move a robot with exact odometry.
        if max(abs(a - b) for a, b in zip(found, known, strict=True)) > _SAME:
            self.map_to_odom = found

    def _doubt(self) -> None:
        """Update the variances."""
        moved = self._moves.enough()
        if moved:
            self._moves.begin()
        if self.lost:
            if not self._match.scan():
                return
            if not self._searching:
                self.lost = not self._corrects(self.pose(), SURE, SURE)
                share = self._match.share(self.pose())
                if share < _MATCH:
                    self._grow(2.0 + 14.0 * (1.0 - share / _MATCH))
                    return
        if moved:
            least = self._narrow() if self._searching else FOUND
            halved = max(least[0], 0.5 * self.variances[0]), max(least[1], 0.5 * self.variances[1])
            self.variances = FOUND if halved == FOUND else halved
            if self._searching and max(least) <= _ONE_PLACE and halved[0] <= _SURE_ENOUGH:
                self._searching, (_, self.map_to_odom) = False, self._possible[0]
                self.lost = not self._corrects(self.pose(), SURE, SURE)

    def _grow(self, factor: float) -> None:
        """Multiply the standard deviations, up to those of a pose anywhere on the map."""
        both = zip(self.variances, FOUND, self._match.spread(), strict=True)
        xy, heading = (max(now, min(factor**2 * max(now, least), most)) for now, least, most in both)
        self.variances = xy, heading

    def _narrow(self) -> tuple[float, float]:
        """Drop the possible poses that the scan contradicts; return the variances of the others, at least `FOUND`."""
        odometry = self._robot.odometry.placement
        found = self._match.matching((worse, each.then(odometry)) for worse, each in self._possible)
        found = found or self._match.matching(self._match.everywhere())
        back = odometry.inverse()
        self._possible = [(worse, place.then(back)) for worse, place in found]
        xy, heading = _variances([place for _, place in found]) if found else self._match.spread()
        if max(xy, heading) > _ONE_PLACE:
            xy = max(xy, _SEVERAL)
        return max(FOUND[0], xy), max(FOUND[1], heading)

    def _corrects(self, place: Placement, radius: float, turn: float) -> bool:
        """Return whether the true pose is within *radius* metres and *turn* radians of a pose."""
        truth = self._robot.placement
        apart = distance((place.x, place.y), (truth.x, truth.y))
        alike = place.cosine * truth.cosine + place.sine * truth.sine
        return apart <= radius and alike >= sine_cosine(min(PI, turn))[1]

    def believe(self, place: Placement, radius: float, turn: float, time: float) -> None:
        """Set the robot's pose, accurate to *radius* metres and *turn* radians, at *time* (see `update`).

        If the true pose is within that accuracy (at least `SURE`), the next correction finds it.
        """
        self.lost = not self._corrects(place, max(SURE, radius), max(SURE, turn))
        self._searching, self._put_downs = False, self._robot.put_downs
        self.map_to_odom = place.then(self._robot.odometry.placement.inverse())
        self.variances = ((0.5 * radius) ** 2, (0.5 * turn) ** 2)
        self._next = time + PERIOD
        self._moves.begin()

    def relocalise(self) -> None:
        """Spread the estimate over the whole map; the robot finds its place while it turns and drives.

        The transform stays as it is until one place is left. Without a laser, or without walls in reach, it finds none.
        """
        self._put_downs, self._possible = self._robot.put_downs, ()
        self.lost = self._searching = True
        self.variances = self._match.spread()
        self._moves.begin()

    def pose(self) -> Placement:
        """Return the estimated pose on the map."""
        return self.map_to_odom.then(self._robot.odometry.placement)

    def belief(self, time: float) -> Placement:
        """Return the estimate at *time* (seconds of the world) without updating it, for observers."""
        due = time >= self._next and not self.lost and self._robot.put_downs == self._put_downs
        return self._robot.placement if due else self.pose()


def _variances(places: Sequence[Placement]) -> tuple[float, float]:
    """Return the variances of poses: of x and y (m²), and of the heading (rad²)."""
    count = len(places)
    x, y, cosine, sine = (sum(values) / count for values in zip(*places, strict=True))
    apart = sum((place.x - x) ** 2 + (place.y - y) ** 2 for place in places) / (2.0 * count)
    # 1 - length of the mean direction is half the variance of small angles.
    return apart, min(_ANY_HEADING, 2.0 * (1.0 - math.sqrt(cosine * cosine + sine * sine)))
