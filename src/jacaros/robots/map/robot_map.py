"""``ArtMap``: the map of the thesis, filled by a robot's sensors."""

import math
from functools import partial
from typing import ClassVar

from jacaros.artifacts.env.artifact import Out, internal_operation, operation
from jacaros.robots.artifacts.odometry import Odometer, Odometry
from jacaros.robots.kit.options import number, one_of, positive, text
from jacaros.robots.kit.reading import Reading, Stamps
from jacaros.robots.map.cells import Cell, LabelledCells, OccupancyCells
from jacaros.robots.map.map_files import OccupancyGrid
from jacaros.robots.map.mapper import Mapper, ScanOptions
from jacaros.robots.map.posed_map import PosedMap
from jacaros.robots.map.routes import Leg, around, frontier, nearest, next_leg
from jacaros.robots.plane.pose import ORIGIN, Pose
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.qos import LATCHED, SENSOR_DATA
from jacaros.robots.streams import ReadingPolicy

AMCL_POSE = "geometry_msgs/msg/PoseWithCovarianceStamped"

SHORTEST_FRONTIER = 0.4
"""Minimum length of a frontier, in metres; a shorter one is a gap between two beams."""


def names(value: object) -> tuple[str, ...]:
    """Read a list of names."""
    if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
        raise ValueError("a list of names")
    return tuple(str(each) for each in value)


def mount(value: object) -> Pose:
    """Read a list of x, y (metres) and an angle (degrees)."""
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError("a list of x, y (metres) and degrees")
    x, y, degrees = map(number, value)
    return Pose(x, y, math.radians(degrees))


class ArtMap(PosedMap):
    """A map built from a robot's laser scans or from ``/map``, with the robot on it.

    The centre of cell X, Y is X and Y times the size of a cell from the origin. Whether a cell is free or an obstacle
    is decided by most of the scans (log odds, Moravec and Elfes 1985); labels of agents take precedence. Scans are
    added at the robot's pose: odometry, corrected by matching the scan with earlier ones. The origin of the map is
    that of odometry.

    Options:
        source(scan) or source(map): the source of cells, ``/scan`` (default) or ``/map``.
        pose_from(scans), pose_from(odometry) or pose_from(amcl): the robot's pose is odometry corrected by scans
            (default with ``source(scan)``), odometry alone, or odometry corrected by ``/amcl_pose`` (default with
            ``source(map)``).
        cell_size(S): side of a cell in metres (0.1); with ``source(map)`` at least that of the map.
        max_range(R): metres (4) at which beams are cut off.
        laser([X, Y, D]): pose of the laser on the robot, metres and degrees; default: in its centre, facing ahead.
        radius(R): clearance of the robot, in metres (0.25): routes keep the centres of cells farther than this from
            those of obstacles. A robot with a radius of 0.17 m keeps a few centimetres away from them.
        leg(M): maximum length of a leg of `getLeg`, in metres (1).
        robots(Names): show other robots on the same map by their ``/NAME/amcl_pose``.
        scan_topic(T), odometry_topic(T), map_topic(T), amcl_topic(T): other topics.

    Properties:
        localised(Quality): with ``pose_from(scans)``: how sure the robot is of its pose, in percent; 100 if nine of ten
            echoes lie on obstacles of the map, 0 if half of them do.
        lost: the quality has fallen below 50, and not risen above 70 since. Scans then change neither the map nor the
            pose.
    """

    known_options: ClassVar = {
        "source": one_of("scan", "map"),
        "pose_from": one_of("scans", "odometry", "amcl"),
        "max_range": positive,
        "laser": mount,
        "leg": positive,
        "robots": names,
        "scan_topic": text,
        "odometry_topic": text,
        "map_topic": text,
        "amcl_topic": text,
    }
    usual_size: ClassVar[float] = 0.1
    usual_radius: ClassVar[float] = 0.25

    def open(self) -> None:
        """Begin with an empty map, and subscribe to the sensors."""
        super().open()
        self._done: set[Cell] = set()
        self._showing = False
        self._first = Reading(ReadingPolicy(on_demand=True), self.clock)
        source = self.option("source", "scan")
        pose_from = self.option("pose_from", "amcl" if source == "map" else "scans")
        options = ScanOptions(self.option("max_range", 4.0), self.option("laser", ORIGIN), self.size)
        self.mapper = Mapper(self._seen, options, pose_from == "scans")
        self._listen_for_cells(source)
        self._listen_for_poses(pose_from)

    def new_cells(self, obstacle: str) -> LabelledCells:
        """Return an empty grid."""
        self._seen = OccupancyCells(obstacle, self.size)
        return self._seen

    def _listen_for_cells(self, source: str) -> None:
        if source == "map":
            topic = self.option("map_topic", "map")
            self.subscription(topic, "nav_msgs/msg/OccupancyGrid", self._take_map, LATCHED)
            return
        topic = self.option("scan_topic", "scan")
        self._header = Stamps(self.faults_of(topic), self.clock)
        self.subscription(topic, "sensor_msgs/msg/LaserScan", self._take_scan, SENSOR_DATA)

    def _listen_for_poses(self, pose_from: str) -> None:
        Odometer(self, self.option("odometry_topic", "odom"), self._take_odometry)
        if pose_from == "amcl":
            self.subscription(self.option("amcl_topic", "amcl_pose"), AMCL_POSE, self._take_pose, LATCHED)
        others: tuple[str, ...] = self.option("robots", ())
        for name in others:
            take = partial(self._take_other, name)
            self.kept(self.ros.subscription(f"/{name}/amcl_pose", AMCL_POSE, take, LATCHED))

    # ---- sensor messages

    def _take_odometry(self, odometry: Odometry) -> None:
        stamp = to_seconds(odometry.sample.message.header.stamp) or odometry.sample.stamp
        self.mapper.localisation.take_odometry(stamp, odometry.pose)
        self._locate(odometry.sample)

    def _take_scan(self, sample: Sample) -> None:
        message = sample.message
        stamp = to_seconds(message.header.stamp)
        if not self._header.accept(stamp, sample.stamp, message.header.frame_id):
            return
        if self.mapper.take_scan(stamp or sample.stamp, message):
            self._first.take((True,))
            self._locate(sample)
        self.heed_doubt(sample.cause)

    def _take_pose(self, sample: Sample) -> None:
        message = sample.message
        self.mapper.localisation.correct(to_seconds(message.header.stamp), Pose.of(message.pose.pose))
        self._locate(sample)

    def _take_map(self, sample: Sample) -> None:
        grid = OccupancyGrid.of(sample.message)
        self._seen.resize(max(self.size, grid.resolution))
        self.size = self._seen.size
        self._seen.load(grid.labels(self.size))
        self._first.take((True,))
        self.start(self.show_surroundings, cause=sample.cause)

    def _take_other(self, name: str, sample: Sample) -> None:
        pose = Pose.of(sample.message.pose.pose)
        self.start(self.update_object, name, *self._seen.cell_at(pose.x, pose.y), cause=sample.cause)

    def _locate(self, sample: Sample) -> None:
        """Update the robot's position; if it has entered another cell, update the properties."""
        pose = self.mapper.localisation.pose
        if pose is None:
            return
        self.heading = math.degrees(pose.yaw)
        if not self._showing and self._seen.cell_at(pose.x, pose.y) != self.here:
            self._showing = True
            self.start(self.show_surroundings, cause=sample.cause)

    @internal_operation
    def show_surroundings(self) -> None:
        """Show the robot's cell."""
        self._showing = False
        pose = self.mapper.localisation.pose
        if pose is not None:
            self.stand(self._seen.cell_at(pose.x, pose.y), math.degrees(pose.yaw), 0.0)

    # ---- destinations

    @operation(name="getLeg")
    def get_leg(self, degrees: Out, metres: Out) -> None:
        """Give the next straight leg of the newest route: how far to turn (positive to the left), and how far to
        drive.

        A leg ends where the route bends, or after ``leg(M)`` metres. At the end of the route both are 0. Fails with
        ``no_route`` before the first route, with ``no_odometry`` while the robot's pose is unknown, and with ``lost``.
        """
        pose = self.known_pose()
        if not self.way:
            self.fail("no route: call getRoute first", "no_route")
        longest = self.option("leg", 1.0)
        found = next_leg(self.way, self.enterable(), pose, Leg(self.size, longest))
        degrees.set(math.degrees(found[0]))
        metres.set(found[1])

    @operation(name="getFrontier")
    async def get_frontier(self, x: Out, y: Out) -> None:
        """Give the nearest reachable cell from which unknown ground can be seen.

        If the robot is at a frontier that is still there, the ground behind it cannot be seen, and the frontier is
        left out from then on. Fails with ``explored`` if no frontier is left, and with ``no_scan(5)`` (``no_map(5)``
        with ``source(map)``) if nothing is known after 5 s.
        """
        await self.newest(self._first, "no_map" if self.option("source", "scan") == "map" else "no_scan")
        free, known = self.cells.passable(), self.cells.known()
        enterable = self.enterable()
        reach = math.ceil(self.radius / self.size) + 1
        edge = frontier(free, known, math.ceil(SHORTEST_FRONTIER / self.size)) - self._done
        self._done |= edge & around({self.here}, free, reach)
        found = nearest(self.here, enterable, around(edge - self._done, free, reach) & enterable)
        if found is None:
            self.fail("no reachable cell borders unknown ground", "explored")
        x.set(found[0])
        y.set(found[1])

    def begin_with_map(self) -> None:
        """Match scans with the present map."""
        self._done.clear()
        self.mapper.begin_with(self.cells.blocked())
