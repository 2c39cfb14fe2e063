"""A map of the graph (``nav_msgs/msg/OccupancyGrid``) as the drawing of a world: walls to outline, boxes to fill."""

import math
from typing import Any

from jacaros.sim.description import Rectangle, Segment, WorldDescription

SOLID = 50
"""Percent of certainty above which a cell counts as occupied."""


def can_be_drawn(message: Any) -> bool:
    """Whether a map is one: it has as many cells as it says, of some size, somewhere."""
    info = message.info
    place, turn = info.origin.position, info.origin.orientation
    numbers = (info.resolution, place.x, place.y, turn.z, turn.w)
    return info.width * info.height == len(message.data) > 0 < info.resolution and all(
        map(math.isfinite, numbers)
    )


def map_drawing(message: Any, name: str = "") -> dict[str, Any]:
    """Draw a map: outlines of what is occupied as ``walls``, and what is occupied as ``boxes``.

    ``bounds`` are those of the cells about which anything is known (SLAM publishes large empty margins); a map that is
    turned in its frame has outlines alone, for boxes are upright.
    """
    # numpy takes a third of a second to import, and only runs that are watched on a real graph need it here.
    import numpy as np

    info = message.info
    cells = np.asarray(message.data, dtype=np.int16).reshape(info.height, info.width)
    known = np.argwhere(cells >= 0)
    size = float(info.resolution)
    place, turn = info.origin.position, info.origin.orientation
    yaw = 2.0 * math.atan2(turn.z, turn.w)
    cosine, sine = math.cos(yaw), math.sin(yaw)

    def point(column: float, row: float) -> tuple[float, float]:
        x, y = column * size, row * size
        return round(place.x + cosine * x - sine * y, 4), round(place.y + sine * x + cosine * y, 4)

    solid = np.zeros((info.height + 2, info.width + 2), dtype=bool)
    solid[1:-1, 1:-1] = cells > SOLID
    walls = [Segment(*point(*a), *point(*b)) for a, b in _outlines(solid)]
    boxes = []
    if abs(yaw) < 1e-6:
        boxes = [Rectangle(*point(box[0], box[1]), *point(box[2], box[3])) for box in _boxes(solid)]
    (bottom, left), (top, right) = (known.min(0), known.max(0) + 1) if len(known) else ((0, 0), cells.shape)
    corners = [point(float(x), float(y)) for x in (left, right) for y in (bottom, top)]
    xs, ys = [x for x, _ in corners], [y for _, y in corners]
    bounds = Rectangle(min(xs), min(ys), max(xs), max(ys))
    return WorldDescription(name, bounds, tuple(walls), tuple(boxes), robots=()).drawing()


def _outlines(solid: Any) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """The edges between solid and free cells, in pieces as long as can be; in cells, without the ring around *solid*."""
    import numpy as np

    pieces = []
    for line, begin, end in _runs(np.diff(solid.astype(np.int8), axis=0)):
        pieces.append(((begin - 1, line), (end - 1, line)))
    for line, begin, end in _runs(np.diff(solid.astype(np.int8), axis=1).T):
        pieces.append(((line, begin - 1), (line, end - 1)))
    return pieces


def _runs(rows: Any) -> list[tuple[int, int, int]]:
    """Stretches of equal numbers, other than 0, in *rows*: the row, where it begins, and behind its end."""
    import numpy as np

    found: list[tuple[int, int, int]] = []
    padded = np.pad(rows, ((0, 0), (1, 1)))
    for row, column in np.argwhere(padded[:, 1:] != padded[:, :-1]).tolist():
        if found and found[-1][0] == row and found[-1][2] < 0:
            found[-1] = (row, found[-1][1], column)
        if padded[row, column + 1]:
            found.append((row, column, -1))
    return found


def _boxes(solid: Any) -> list[tuple[int, int, int, int]]:
    """Upright rectangles that fill the solid cells: stretches of a row, joined with equal ones above."""
    import numpy as np

    growing: dict[tuple[int, int], int] = {}
    boxes: list[tuple[int, int, int, int]] = []
    stretches: dict[int, set[tuple[int, int]]] = {}
    for row, begin, end in _runs(solid.astype(np.int8)):
        stretches.setdefault(row, set()).add((begin - 1, end - 1))
    for row in range(solid.shape[0]):
        here = stretches.get(row, set())
        for stretch in [old for old in growing if old not in here]:
            boxes.append((stretch[0], growing.pop(stretch), stretch[1], row - 1))
        for stretch in here:
            growing.setdefault(stretch, row - 1)
    return sorted(boxes)
