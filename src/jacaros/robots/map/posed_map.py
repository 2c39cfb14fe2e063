"""A map with the robot's pose on it: the pose itself, doubt about it, and the search for the robot's place."""

import math

from jacaros.artifacts.env.artifact import Out, internal_operation, operation
from jacaros.robots.kit.ros_artifact import FIRST_MESSAGE
from jacaros.robots.map.doubt import PROBABLE
from jacaros.robots.map.mapper import Mapper
from jacaros.robots.map.place_search import MOST_PLACES, PlaceSearch
from jacaros.robots.map.routes import open_ground
from jacaros.robots.map.slam_data import ArtSlamData
from jacaros.robots.plane.pose import Pose
from jacaros.runtime.trace import Cause

LOOK = 0.1
"""Seconds between two looks at whether a scan was compared."""


class PosedMap(ArtSlamData):
    """The part of `jacaros.robots.map.robot_map.ArtMap` that knows, doubts and finds the robot's pose.

    Attributes:
        mapper: the pose and the scans; a subclass makes it.
    """

    mapper: Mapper
    _shown: tuple[int, bool] | None = None

    @operation(name="getPose")
    def get_pose(self, x: Out, y: Out, yaw: Out) -> None:
        """Give the robot's pose on the map (metres and degrees); fails with ``no_odometry`` and ``lost``, as `getLeg`."""
        pose = self.known_pose()
        for out, value in zip((x, y, yaw), (pose.x, pose.y, math.degrees(pose.yaw)), strict=True):
            out.set(value)

    def known_pose(self) -> Pose:
        """Return the pose, for operations: they fail with ``lost`` or ``no_odometry`` if it is unknown."""
        if self.mapper.doubt.lost:
            self.fail("the robot does not know its place on the map", "lost")
        pose = self.mapper.localisation.pose
        if pose is None:
            self.fail("no odometry has arrived", "no_odometry")
        return pose

    @operation(name="getOpenGround")
    def get_open_ground(self, degrees: Out, metres: Out) -> None:
        """Give the longest straight drive that the newest scan shows to be free, up to ``leg(M)`` metres: how far to turn,
        and how far to drive. It needs no place on the map. Fails with ``no_scan``."""
        scan = self.mapper.newest_scan()
        if scan is None:
            self.fail("no scan has arrived", "no_scan")
        turn, ahead = open_ground(scan.echoes, self.radius, self.option("leg", 1.0))
        degrees.set(math.degrees(turn))
        metres.set(ahead)

    # ---- doubt about the pose

    def _doubt(self) -> tuple[int, bool]:
        return round(self.mapper.doubt.quality), self.mapper.doubt.lost

    def heed_doubt(self, cause: Cause | None) -> None:
        """Show what the newest scan has changed, and search with it if the robot is searching."""
        if self.mapper.search_is_due():
            self.start(self.search_on, cause=cause)
        if self.mapper.matching and self._doubt() != self._shown:
            self.start(self.show_doubt, cause=cause)

    @internal_operation
    def show_doubt(self) -> None:
        """Show `localised` and `lost`."""
        self._shown = quality, lost = self._doubt()
        self._show_values("localised", (quality,))
        self.show_elements("lost", [()] if lost else [], 0)

    @internal_operation
    async def search_on(self) -> None:
        """Continue the search for the robot's place with the newest scan; other messages are handled meanwhile."""
        if self.mapper.search_is_due():
            for _ in self.mapper.search_steps():
                await self.sleep(0.0)
            self.show_doubt()

    @operation
    async def relocalise(self) -> None:
        """Search the whole map for the robot's place, where the next scan matches, and set the pose.

        Until then the robot is `lost`. Fails with ``ambiguous(Places)`` if several places match about equally, with
        ``no_match`` if none does, with ``no_scan(5)`` after 5 s without a scan, and with ``no_matching`` without
        ``pose_from(scans)``. After the first three the pose stays, and the search continues with later scans: turn and
        drive until `lost` is gone.
        """
        if not self.mapper.matching:
            self.fail("only a map with pose_from(scans) can search", "no_matching")
        search = self.mapper.begin_search()
        self.show_doubt()
        await self._compared(search)
        if not search.scans:
            self.fail(f"no scan within {FIRST_MESSAGE:g} s", "no_scan", FIRST_MESSAGE)
        if self.mapper.search is search:
            places = len(search.places)
            if places or search.too_many:
                more = places or MOST_PLACES
                self.fail(f"the scan matches at {places or 'too many'} places of the map", "ambiguous", more)
            self.fail("the scan matches nowhere on the map", "no_match")

    @operation
    async def set_pose(self, x: float, y: float, yaw: float) -> None:
        """Set the robot's pose on the map (metres and degrees), accurate to 50 cm and 15 degrees: the next scan corrects
        it. Fails with ``no_odometry`` while nothing is known of the robot's motion."""
        pose, localisation = Pose(x, y, math.radians(yaw)), self.mapper.localisation
        odometry = localisation.odometry_at(0.0)
        if odometry is None:
            self.fail("no odometry has arrived", "no_odometry")
        self.mapper.end_search(pose.then(odometry.inverse()))
        if self.mapper.matching:
            search = self.mapper.begin_search(PROBABLE, pose)
            self.show_doubt()
            await self._compared(search)
            if self.mapper.search is search:
                self.mapper.end_search(localisation.correction)

    async def _compared(self, search: PlaceSearch) -> None:
        """Wait until a search has compared a scan, for at most `FIRST_MESSAGE` seconds."""
        for _ in range(round(FIRST_MESSAGE / LOOK)):
            if search.scans or self.mapper.search is not search:
                return
            await self.sleep(LOOK)

    @property
    def driven(self) -> float:
        """Metres driven so far, according to odometry."""
        return self.mapper.localisation.driven
