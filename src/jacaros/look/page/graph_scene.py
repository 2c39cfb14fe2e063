"""The world as visible in a real graph: its map, the estimated poses of robots, and their batteries."""

import asyncio
import contextlib
import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from jacaros.look.page.scene import UNKNOWN, RobotView
from jacaros.robots.artifacts.battery import Charge
from jacaros.robots.artifacts.odometry import not_finite
from jacaros.robots.plane.pose import Point, Pose
from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.ros.backend import Backend, GraphContents
from jacaros.robots.ros.errors import RosError, TransformUnavailable
from jacaros.robots.ros.message import constant
from jacaros.robots.ros.node import Capability, Sample, Subscription
from jacaros.robots.ros.protocols.transform import Transform
from jacaros.robots.ros.qos import QoS
from jacaros.robots.world.data.world import WorldDescription
from jacaros.robots.world.files.map import OccupancyMap
from jacaros.runtime.clock import Clock
from jacaros.runtime.files.maps import meanings

LOOK_PERIOD = 3.0
"""Seconds between two searches for new robots and maps."""
MAP_PERIOD = 5.0
"""Minimum seconds between two drawings of a changing map."""
MAP = "map"
_ODOMETRY, _BATTERY, _GRID = (
    "nav_msgs/msg/Odometry",
    "sensor_msgs/msg/BatteryState",
    "nav_msgs/msg/OccupancyGrid",
)
_RECORDED = {"scan": "sensor_msgs/msg/LaserScan", "plan": "nav_msgs/msg/Path"}
"""Topics of a robot whose messages are recorded in the history on arrival."""
_LATCHED = QoS(durability="transient_local", depth=1)
_NEWEST = QoS(reliability="best_effort", depth=1)
"""Matches reliable and best-effort publishers."""
_FLOOR = 3.0


class SeenRobot:
    """A robot whose odometry is in the graph.

    Attributes:
        name: name of the robot.
        odometry, battery: newest messages; None before the first ones.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.odometry: Any = None
        self.battery: Any = None
        self._charge = Charge()
        self._share: float | None = None

    def hear_odometry(self, sample: Sample) -> bool:
        """Keep the newest message unless it contains NaN or infinity; return whether it was kept."""
        if not_finite(sample.message) is not None:
            return False
        self.odometry = sample.message
        return True

    def hear_battery(self, sample: Sample) -> None:
        """Keep the newest message."""
        self.battery = sample.message
        self._share = self._charge.share(float(self.battery.percentage))

    def pose(self, backend: Backend) -> Transform:
        """Return the pose: odometry, corrected by localisation if there is one."""
        message = self.odometry
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        pose = Transform((place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w))
        if Capability.TRANSFORMS in backend.capabilities:
            with contextlib.suppress(TransformUnavailable):
                corrected = backend.tf_lookup(MAP, message.header.frame_id.strip("/")).after(pose)
                if all(map(math.isfinite, (*corrected.translation, corrected.yaw))):
                    return corrected
        return pose

    def view(self, backend: Backend) -> RobotView:
        """Return the robot as shown."""
        pose = self.pose(backend)
        x, y, _ = pose.translation
        return RobotView(
            self.name, x=x, y=y, yaw=pose.yaw, battery=self._percent(), charging=self._charging()
        )

    def _percent(self) -> float:
        return UNKNOWN if self._share is None else min(100.0, 100.0 * self._share)

    def _charging(self) -> bool:
        message = self.battery
        return message is not None and message.power_supply_status == constant(
            message, "POWER_SUPPLY_STATUS_CHARGING"
        )


class GraphScene:
    """Observes a real graph: ``map``, and for each ``odom`` a robot with its ``scan`` and its ``plan``, in any namespace.

    Args:
        backend: our node; already started.
        clock: sets the rate of observation.
        name: name of the drawing.
    """

    def __init__(self, backend: Backend, clock: Clock, name: str = "") -> None:
        self._backend, self._clock, self._name = backend, clock, name
        self._robots: dict[str, SeenRobot] = {}
        self._shown: list[SeenRobot] = []
        self._subscriptions: dict[str, Subscription] = {}
        self._map: Any = None
        self._drawn: Any = None
        self._drawn_at = -math.inf
        self._drawing: dict[str, Any] | None = None
        self._task = asyncio.get_running_loop().create_task(self._keep_looking())

    def drawing(self) -> Mapping[str, Any] | None:
        """The map, redrawn from time to time while it changes, and the robots."""
        now = self._clock.now()
        if self._map is not self._drawn and abs(now - self._drawn_at) >= MAP_PERIOD:
            self._drawn, self._drawn_at = self._map, now
            self._drawing = map_drawing(self._map, self._name)
        if self._drawing is None and self._shown:
            self._drawing = self._floor()
        if self._drawing is not None and len(self._drawing["robots"]) < len(self._shown):
            self._drawing = {**self._drawing, "robots": [{"name": robot.name} for robot in self._shown]}
        return self._drawing

    def _floor(self) -> dict[str, Any]:
        """Return the world without a map: an open floor around the first robot."""
        x, y, _ = self._shown[0].pose(self._backend).translation
        bounds = Rectangle(x - _FLOOR, y - _FLOOR, x + _FLOOR, y + _FLOOR)
        return WorldDescription(self._name, bounds, robots=()).drawing()

    def robots(self) -> list[RobotView]:
        """Return the robots at their estimated poses."""
        return [robot.view(self._backend) for robot in self._shown]

    def follow(self, moved: Callable[[], None]) -> bool:
        """Return False: messages arrive at any rate, so there is nothing to follow."""
        return False

    def close(self) -> None:
        """Withdraw the subscriptions."""
        self._task.cancel()
        for subscription in self._subscriptions.values():
            subscription.close()

    async def _keep_looking(self) -> None:
        if Capability.TRANSFORMS in self._backend.capabilities:
            self._backend.tf_listen()
        while True:
            with contextlib.suppress(RosError):  # the graph may be temporarily unreachable
                self._join(await self._backend.contents())
            await self._clock.sleep(LOOK_PERIOD)

    def _join(self, contents: GraphContents) -> None:
        topics = contents.topics
        found = [name for name, info in sorted(topics.items()) if info.publishers]
        maps = [name for name in found if _GRID in topics[name].types and name.endswith("/map")]
        if maps and not any(name in self._subscriptions for name in maps):
            self._listen(min(maps, key=len), _GRID, self._hear_map, _LATCHED)
        for name in found:
            if _ODOMETRY in topics[name].types and name.endswith("/odom"):
                namespace = name.removesuffix("/odom")
                robot = self._robots.setdefault(namespace, SeenRobot(namespace.strip("/") or "robot"))
                self._listen(name, _ODOMETRY, partial(self._hear_odometry, robot), _NEWEST)
                battery = f"{namespace}/battery_state"
                if battery in topics and _BATTERY in topics[battery].types:
                    self._listen(battery, _BATTERY, robot.hear_battery, _NEWEST)
                for word, type_name in _RECORDED.items():
                    if f"{namespace}/{word}" in found and type_name in topics[f"{namespace}/{word}"].types:
                        self._listen(f"{namespace}/{word}", type_name, lambda _: None, _NEWEST)

    def _listen(self, topic: str, type_name: str, hear: Any, qos: QoS) -> None:
        if topic not in self._subscriptions:
            with contextlib.suppress(RosError):
                self._subscriptions[topic] = self._backend.subscription(topic, type_name, hear, qos)

    def _hear_odometry(self, robot: SeenRobot, sample: Sample) -> None:
        is_new = robot.odometry is None
        if robot.hear_odometry(sample) and is_new:
            self._shown.append(robot)

    def _hear_map(self, sample: Sample) -> None:
        if can_be_drawn(sample.message):
            self._map = sample.message


# ---- the map


def can_be_drawn(message: Any) -> bool:
    """Return whether a map is valid: the number of cells matches, and size and origin are finite."""
    info = message.info
    numbers = (info.resolution, *Pose.of(info.origin))
    return info.width * info.height == len(message.data) > 0 < info.resolution and all(
        map(math.isfinite, numbers)
    )


def map_drawing(message: Any, name: str = "") -> dict[str, Any]:
    """Draw a map: outlines of occupied areas as ``walls``, and occupied areas as ``boxes``.

    ``bounds`` are those of the known cells (SLAM publishes large empty margins). A map that is rotated in its frame has
    only outlines, because boxes are axis-aligned.
    """
    info = message.info
    cells = OccupancyMap(1.0, 0.0, 0.0, info.width, info.height, meanings(message.data))
    size = float(info.resolution)
    origin = Pose.of(info.origin)

    def point(column: float, row: float) -> Point:
        x, y = origin.point(column * size, row * size)
        return round(x, 4), round(y, 4)

    walls = [Segment(*point(a, b), *point(c, d)) for a, b, c, d in cells.walls()]
    boxes = []
    if abs(origin.yaw) < 1e-6:
        boxes = [Rectangle(*point(a, b), *point(c, d)) for a, b, c, d in cells.boxes()]
    left, bottom, right, top = cells.known_part()
    corners = [point(x, y) for x in (left, right) for y in (bottom, top)]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    bounds = Rectangle(min(xs), min(ys), max(xs), max(ys))
    return WorldDescription(name, bounds, tuple(walls), tuple(boxes), robots=()).drawing()
