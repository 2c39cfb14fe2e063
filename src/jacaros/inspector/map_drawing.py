"""A map of the graph (``nav_msgs/msg/OccupancyGrid``) as a drawing of a world: walls to outline, boxes to fill."""

import math
from typing import Any

from jacaros.files.maps import meanings
from jacaros.plane.pose import Point, Pose
from jacaros.plane.shapes import Rectangle, Segment
from jacaros.sim.data.world import WorldDescription
from jacaros.sim.files.map import OccupancyMap


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
