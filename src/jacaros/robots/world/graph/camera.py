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

from collections.abc import Iterator, Mapping
from typing import Any, Final

from jacaros.robots.plane.shapes import Circle, Segment
from jacaros.robots.world.graph.frames import CAMERA
from jacaros.robots.world.graph.on_graph import RobotOnGraph
from jacaros.robots.world.graph.publishing import Tick, sensor
from jacaros.robots.world.physics.rendering import (
    FOCAL_LENGTH,
    HEIGHT,
    WIDTH,
    Hit,
    Look,
    colours,
    columns,
    depths,
)

_WALL: Final = Look(2.5, (216, 211, 200))
_DOOR: Final = Look(2.0, (150, 95, 45))
_BOX: Final = Look(0.75, (158, 128, 88))
_DOCK: Final = Look(0.12, (242, 193, 78))
_ROBOT: Final = Look(0.35, (60, 120, 165))
_PERSON: Final = Look(1.75, (200, 80, 70))
_OBJECT: Final = Look(0.12, (90, 160, 90))
_DOCK_RADIUS = 0.1


_IMAGE = "sensor_msgs/msg/Image"


def camera(at: RobotOnGraph) -> Tick:
    """Make the topics of the camera of one robot."""
    view = _View(at)
    described = (
        sensor("/camera/image_raw", _IMAGE, every=4, fields=view.colours, frame=CAMERA),
        sensor("/camera/depth/image_raw", _IMAGE, every=4, fields=view.depths, frame=CAMERA),
        sensor("/camera/camera_info", "sensor_msgs/msg/CameraInfo", _calibration, 4, frame=CAMERA),
    )
    topics = [topic(at) for topic in described]

    def publish(ticks: int) -> None:
        for topic in topics:
            topic(ticks)

    return publish


class _View:
    """What the camera of one robot sees, computed once for both images."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at, self._world = at, at.time.world
        self._segments: tuple[Segment, ...] = ()
        self._walls: list[tuple[Segment, Look]] = []
        self._seen: list[list[Hit]] = []
        self._time = -1.0

    def colours(self, at: RobotOnGraph) -> Mapping[str, Any]:
        return {"encoding": "rgb8", "step": 3 * WIDTH, "data": colours(self._look()), **_SIZE}

    def depths(self, at: RobotOnGraph) -> Mapping[str, Any]:
        return {"encoding": "32FC1", "step": 4 * WIDTH, "data": depths(self._look()), **_SIZE}

    def _look(self) -> list[list[Hit]]:
        if self._time != self._world.time:
            self._time = self._world.time
            self._seen = columns(self._looking_at(), self._discs(), self._at.robot.placement)
        return self._seen

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
        for dock in world.docks:
            yield (dock.pose.x, dock.pose.y, _DOCK_RADIUS), _DOCK
        for robot in world.robots.values():
            if robot is not self._at.robot:
                yield robot.circle, _ROBOT
        for person in world.people.values():
            yield person.circle, _coloured(_PERSON, person.description.color)
        for each in world.objects.by_name.values():
            yield (*each.place, each.description.radius), _coloured(_OBJECT, each.description.color)


_SIZE = {"width": WIDTH, "height": HEIGHT}


def _calibration(at: RobotOnGraph, message: Any) -> None:
    message.width, message.height, message.distortion_model = WIDTH, HEIGHT, "plumb_bob"
    intrinsic, projection, rotation = (_matrix(message, name) for name in "kpr")
    for matrix, row in ((intrinsic, 3), (projection, 4)):
        matrix[0] = matrix[row + 1] = FOCAL_LENGTH
        matrix[2], matrix[row + 2], matrix[2 * row + 2] = 0.5 * WIDTH, 0.5 * HEIGHT, 1.0
    rotation[0] = rotation[4] = rotation[8] = 1.0


def _matrix(message: Any, name: str) -> Any:
    """Return a matrix of a ``CameraInfo``, whose name is in capitals on ROS 1."""
    return getattr(message, name) if hasattr(message, name) else getattr(message, name.upper())


def _coloured(look: Look, colour: str) -> Look:
    """Return the same look in a colour ``#rrggbb``; "" for no change."""
    if not colour:
        return look
    return Look(look.height, (int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)))
