"""A small colour and depth camera that faces ahead.

======================================= ================================= ==========================
topic (below the namespace)             type                              rate
======================================= ================================= ==========================
``/camera/image_raw``                   ``sensor_msgs/msg/Image``         5 Hz, ``rgb8``, 80 x 60
``/camera/depth/image_raw``             the same                          5 Hz, ``32FC1``, metres
``/camera/camera_info``                 ``sensor_msgs/msg/CameraInfo``    with each image
======================================= ================================= ==========================

Nothing is rendered without subscribers.
"""

from collections.abc import Iterator
from typing import Any, Final

from jacaros.ros.node import Publisher
from jacaros.sim.description import Segment
from jacaros.sim.navigation.frames import CAMERA
from jacaros.sim.robot.on_graph import RobotOnGraph
from jacaros.sim.robot.sensors.laser_plain import Circle
from jacaros.sim.robot.sensors.rendering import FOCAL_LENGTH, HEIGHT, WIDTH, Look, colours, columns, depths

_TICKS_PER_IMAGE = 4
_WALL: Final = Look(2.5, (216, 211, 200))
_DOOR: Final = Look(2.0, (150, 95, 45))
_BOX: Final = Look(0.75, (158, 128, 88))
_DOCK: Final = Look(0.12, (242, 193, 78))
_ROBOT: Final = Look(0.35, (60, 120, 165))
_PERSON: Final = Look(1.75, (200, 80, 70))
_OBJECT: Final = Look(0.12, (90, 160, 90))
_DOCK_RADIUS = 0.1


class CameraSensor:
    """The camera of one robot."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at, self._world = at, at.time.world
        self._image = at.publisher("/camera/image_raw", "sensor_msgs/msg/Image")
        self._depth = at.publisher("/camera/depth/image_raw", "sensor_msgs/msg/Image")
        self._info = at.publisher("/camera/camera_info", "sensor_msgs/msg/CameraInfo")
        self._segments: tuple[Segment, ...] = ()
        self._walls: list[tuple[Segment, Look]] = []

    def publish(self, ticks: int) -> None:
        """Publish if due."""
        if ticks % _TICKS_PER_IMAGE:
            return
        wants_colours, wants_depths = self._image.subscription_count, self._depth.subscription_count
        if wants_colours or wants_depths:
            robot = self._at.robot
            seen = columns(self._looking_at(), self._discs(), robot.x, robot.y, robot.yaw)
            if wants_colours:
                self._send(self._image, "rgb8", 3, colours(seen))
            if wants_depths:
                self._send(self._depth, "32FC1", 4, depths(seen))
        if self._info.subscription_count:
            self._send_info()

    def _looking_at(self) -> list[tuple[Segment, Look]]:
        """Return the walls with their looks; recomputed when a door has moved."""
        world = self._world
        if self._segments is not world.segments:
            looks = {door.segment: _DOOR for door in world.description.doors}
            looks |= {edge: _BOX for box in world.description.boxes for edge in box.edges()}
            for each in world.description.furniture:
                looks |= dict.fromkeys(each.area.edges(), _coloured(_BOX, each.color))
            self._segments = world.segments
            self._walls = [(segment, looks.get(segment, _WALL)) for segment in world.segments]
        return self._walls

    def _discs(self) -> Iterator[tuple[Circle, Look]]:
        world = self._world
        for dock in world.description.docks:
            yield (dock.pose.x, dock.pose.y, _DOCK_RADIUS), _DOCK
        for robot in world.robots.values():
            if robot is not self._at.robot:
                yield (robot.x, robot.y, robot.description.radius), _ROBOT
        for person in world.people.values():
            yield (
                (person.x, person.y, person.description.radius),
                _coloured(_PERSON, person.description.color),
            )
        for each in world.objects.by_name.values():
            yield (*each.place, each.description.radius), _coloured(_OBJECT, each.description.color)

    def _send(self, publisher: Publisher, encoding: str, octets: int, data: bytes) -> None:
        message = publisher.message(
            width=WIDTH, height=HEIGHT, encoding=encoding, step=octets * WIDTH, data=data
        )
        self._at.fill_header(message.header, CAMERA)
        publisher.publish(message)

    def _send_info(self) -> None:
        message = self._info.message(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob")
        self._at.fill_header(message.header, CAMERA)
        intrinsic, projection, rotation = (_matrix(message, name) for name in "kpr")
        for matrix, row in ((intrinsic, 3), (projection, 4)):
            matrix[0] = matrix[row + 1] = FOCAL_LENGTH
            matrix[2], matrix[row + 2], matrix[2 * row + 2] = 0.5 * WIDTH, 0.5 * HEIGHT, 1.0
        rotation[0] = rotation[4] = rotation[8] = 1.0
        self._info.publish(message)


def _matrix(message: Any, name: str) -> Any:
    """Return a matrix of a ``CameraInfo``, whose name is in capitals on ROS 1."""
    return getattr(message, name) if hasattr(message, name) else getattr(message, name.upper())


def _coloured(look: Look, colour: str) -> Look:
    """Return the same look in a colour ``#rrggbb``; "" for no change."""
    if not colour:
        return look
    return Look(look.height, (int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)))
