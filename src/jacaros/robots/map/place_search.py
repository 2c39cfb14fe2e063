"""The search of a lost robot for its place on the map."""

from collections.abc import Generator, Iterator, Sequence

from jacaros.robots.map.cells import OccupancyCells
from jacaros.robots.map.doubt import ENOUGH, NEAR, on_obstacles
from jacaros.robots.map.scan_matching import Surfaces, match
from jacaros.robots.plane.pose import Point, Pose, distance, normalised
from jacaros.robots.plane.pose_search import Fit, PoseSearch, disc

BEAMS = 40
"""Approximate number of echoes that are looked for on the whole map."""

LEAST = 0.75
"""Share of them, and later of all echoes, that must lie on obstacles."""

WORSE = 0.2
"""Sum of the shares, of several scans, by which a possible place may match worse than the best one."""

MOST_FITS, MOST_PLACES = 20_000, 200
"""Numbers of poses and of places above which a scan does not say enough."""

ONE_PLACE = (0.3, 0.3)
"""Metres and radians within which poses are one place."""

ABOUT = (0.75, 0.4)
"""Metres and radians within which the pose that a person gives is corrected."""

MOVED = (0.25, 0.2)
"""Metres or radians of odometry after which another scan counts."""


def _alike(a: Pose, b: Pose, within: tuple[float, float]) -> bool:
    """Return whether two poses are *within* metres and radians of each other."""
    return distance((a.x, a.y), (b.x, b.y)) <= within[0] and abs(normalised(a.yaw - b.yaw)) <= within[1]


class PlaceSearch:
    """The places at which the robot can be: those where its scans match the map, fewer with each scan.

    Args:
        cells: the map.
        surfaces: the same as lines.
        longest: metres at which beams are cut off.
        about: the pose that a person gives; None: anywhere.

    Attributes:
        busy: whether `steps` are under way.
        scans: number of scans compared.
        places: for each possible place, how much worse than the best it has matched, in sum, and the pose of the odometry
            frame on the map. The best comes first.
        too_many: whether the last scan matched at so many places that none was kept.
    """

    def __init__(
        self, cells: OccupancyCells, surfaces: Surfaces, longest: float, about: Pose | None = None
    ) -> None:
        self._cells, self._surfaces, self._longest, self._about = cells, surfaces, longest, about
        self._tight = disc(max(0.1 / cells.size, 1.0))
        self._last: Pose | None = None
        self.busy, self.scans, self.too_many = False, 0, False
        self.places: list[tuple[float, Pose]] = []

    def is_due(self, odometry: Pose) -> bool:
        """Return whether the next scan counts: the robot has moved since the last one."""
        return not self.busy and (self._last is None or not _alike(self._last, odometry, MOVED))

    def steps(self, echoes: Sequence[Point], odometry: Pose) -> Iterator[None]:
        """Compare a scan with the map at the possible places, or everywhere if none is known; each step takes a few
        milliseconds.

        Args:
            echoes: the scan, in the frame of the robot.
            odometry: the robot's pose according to odometry.
        """
        self.busy, self._last, self.too_many = True, odometry, False
        seeds = [(worse, place.then(odometry)) for worse, place in self.places]
        if not seeds and len(echoes) >= ENOUGH:
            seeds = yield from self._everywhere(echoes)
        matched: list[tuple[float, float, Pose]] = []
        for worse, seed in seeds:
            pose = match(self._surfaces, echoes, seed) or seed
            share = on_obstacles(self._cells, pose.points(echoes), self._tight)[0] / len(echoes)
            if share >= LEAST:
                matched.append((worse, share, pose))
            yield
        self._keep(matched, odometry.inverse())
        self.busy, self.scans = False, self.scans + 1

    def _everywhere(self, echoes: Sequence[Point]) -> Generator[None, None, list[tuple[float, Pose]]]:
        """Return the best pose of each place on the map where a scan fits roughly."""
        cells, odds = self._cells, self._cells.odds.items()
        walls, floor = (
            [cell for cell, each in odds if each > 0.0],
            [cell for cell, each in odds if each < 0.0],
        )
        search = PoseSearch(walls, floor, cells.size, max(NEAR, cells.size), self._longest)
        found: list[Fit] = []
        for fits in search.poses(echoes[:: max(1, len(echoes) // BEAMS)], LEAST):
            found += (fit for fit in fits if self._about is None or _alike(self._about, fit.pose, ABOUT))
            yield
        seeds: list[Pose] = []
        if len(found) <= MOST_FITS:
            for fit in sorted(found, reverse=True):
                if not any(_alike(fit.pose, seed, ONE_PLACE) for seed in seeds):
                    seeds.append(fit.pose)
        self.too_many = len(found) > MOST_FITS or len(seeds) > MOST_PLACES
        return [] if self.too_many else [(0.0, seed) for seed in seeds]

    def _keep(self, matched: Sequence[tuple[float, float, Pose]], back: Pose) -> None:
        """Keep the places that match about as well as the best, each once; *back*: the odometry frame seen by the
        robot."""
        best = max((share for _, share, _ in matched), default=0.0)
        kept: list[tuple[float, Pose]] = []
        for worse, pose in sorted((worse + best - share, pose) for worse, share, pose in matched):
            if worse <= WORSE and not any(_alike(pose, other, ONE_PLACE) for _, other in kept):
                kept.append((worse, pose))
        self.places = [(worse, pose.then(back)) for worse, pose in kept]
