"""Records of robots: laser scans that our node receives, planned paths, and estimated poses."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from jacaros.runtime.clock import Clock

if TYPE_CHECKING:
    from jacaros.sim.node import SimNode

MOST_RAYS = 90
SCAN_PERIOD = 0.1
"""Seconds between two recorded scans of one topic."""
OFF = (0.05, math.radians(5.0))
"""Difference in metres and radians from the true pose up to which an estimate counts as equal."""
_SCAN = "LaserScan"
_PATH = "Path"

Tell = Callable[[str, Mapping[str, Any]], None]

Truths = Callable[[], Mapping[str, tuple[float, float, float]]]
"""Returns the true pose of each robot: x, y, yaw."""


class RobotRecords:
    """Makes the records ``laser``, ``path`` and ``believed``.

    Args:
        clock: clock of the run.
        tell: takes the kind of a record and its data.
        robot_at: returns a robot's name for a topic prefix, such as ``/robot_0``.
        find_robots: returns the node of the embedded world, or None.
        truths: returns their true poses.
    """

    def __init__(
        self,
        clock: Clock,
        tell: Tell,
        robot_at: Callable[[str], str],
        find_robots: "Callable[[], SimNode | None]" = lambda: None,
        truths: Truths = dict,
    ) -> None:
        self._clock, self._tell, self._robot_at = clock, tell, robot_at
        self._find_robots, self._truths = find_robots, truths
        self._scanned: dict[str, float] = {}
        self._paths: dict[str, Sequence[tuple[float, float]]] = {}
        self._astray: set[str] = set()

    def listener_of(self, message: Any) -> Callable[[str, Any], None] | None:
        """Return what records messages such as this one (scans and paths), or None."""
        kind = type(message).__name__
        if kind.endswith(_SCAN):
            return self._scan
        return self._planned if kind.endswith(_PATH) and hasattr(message, "poses") else None

    def _planned(self, topic: str, path: Any) -> None:
        points = [(pose.pose.position.x, pose.pose.position.y) for pose in path.poses]
        self._path(self._robot_at(topic.rpartition("/")[0]), points)

    def _scan(self, topic: str, scan: Any) -> None:
        now = self._clock.elapsed
        # Slightly less, because scans at 10 Hz do not arrive at exact intervals.
        if now - self._scanned.get(topic, -SCAN_PERIOD) < 0.9 * SCAN_PERIOD:
            return
        self._scanned[topic] = now
        robot = self._robot_at(topic.rpartition("/")[0])
        self._tell("laser", {"robot": robot, **thinned(scan)})

    def look(self) -> None:
        """Record paths and estimated poses that have changed. Call it a few times a second."""
        robots = self._find_robots()
        if robots is None:
            return
        for robot, path in robots.paths().items():
            if path is not self._paths.get(robot, ()) and (path or self._paths.get(robot)):
                self._path(robot, path)
        truths = self._truths()
        for robot, (x, y, yaw) in robots.beliefs().items():
            true_x, true_y, true_yaw = truths[robot]
            turned = math.remainder(yaw - true_yaw, math.tau)
            self._belief(
                robot, x, y, yaw, math.hypot(x - true_x, y - true_y) > OFF[0] or abs(turned) > OFF[1]
            )

    def _path(self, robot: str, path: Sequence[tuple[float, float]]) -> None:
        self._paths[robot] = path
        self._tell("path", {"robot": robot, "points": [(round(x, 3), round(y, 3)) for x, y in path]})

    def _belief(self, robot: str, x: float, y: float, yaw: float, astray: bool) -> None:
        if astray:
            self._astray.add(robot)
            data = {"robot": robot, "x": round(x, 3), "y": round(y, 3), "yaw": round(yaw, 3)}
            self._tell("believed", data)
        elif robot in self._astray:
            self._astray.discard(robot)
            self._tell("believed", {"robot": robot, "x": None, "y": None, "yaw": None})


def thinned(scan: Any) -> dict[str, Any]:
    """Return a scan with at most `MOST_RAYS` rays: of adjacent rays the shortest, in whole centimetres."""
    ranges = scan.ranges
    share = max(1, math.ceil(len(ranges) / MOST_RAYS))
    least, most = scan.range_min, scan.range_max
    rays = []
    for start in range(0, len(ranges), share):
        # NaN fails both comparisons, infinity the second.
        seen = [metres for metres in ranges[start : start + share] if least <= metres <= most]
        rays.append(round(100.0 * float(min(seen))) if seen else 0)
    middle = 0.5 * (share - 1) * scan.angle_increment
    return {
        "from": round(float(scan.angle_min + middle), 5),
        "step": round(float(scan.angle_increment * share), 6),
        "ranges": rays,
    }
