"""Rendering of camera images of a flat world with heights and colours: one ray per column, no textures, no shadows.

The camera is a pinhole, level and facing ahead. Columns are counted from the left, rows from the top. A ray continues
behind what it meets, because a low object hides only the lower part of a high one.
"""

import math
import sys
from array import array
from collections.abc import Iterable
from operator import itemgetter
from typing import Final, NamedTuple

from jacaros.robots.plane.pose import Placement
from jacaros.robots.plane.shapes import Circle, Segment
from jacaros.robots.plane.trigonometry import radians, sine_cosine

WIDTH, HEIGHT = 80, 60
"""Columns and rows of an image."""
CAMERA_HEIGHT = 0.3
"""Height of the camera above the floor, in metres."""
_FIELD = radians(60.0)
_SINE, _COSINE = sine_cosine(0.5 * _FIELD)
FOCAL_LENGTH: Final = 0.5 * WIDTH * _COSINE / _SINE
"""Focal length in pixels, for a field of view of 60 degrees."""
_NEAR = 0.02
_DIMMING = 0.15
"""Loss of brightness per metre."""

Colour = tuple[int, int, int]
_SKY: Colour = (196, 208, 218)
_FLOOR: Colour = (150, 146, 138)
_SLOPES = tuple((0.5 * WIDTH - column - 0.5) / FOCAL_LENGTH for column in range(WIDTH))
"""Metres to the left per metre ahead, for each column."""
_FLOOR_DEPTHS = tuple(
    FOCAL_LENGTH * CAMERA_HEIGHT / (row + 0.5 - 0.5 * HEIGHT) if 2 * row >= HEIGHT else math.inf
    for row in range(HEIGHT)
)


class Look(NamedTuple):
    """The look of an object: its height in metres, and its colour as red, green and blue, 0 to 255."""

    height: float
    colour: Colour


Hit = tuple[float, Look]
"""A hit of a ray: distance ahead (metres, along the view, not along the ray), and look."""


def columns(
    walls: Iterable[tuple[Segment, Look]], discs: Iterable[tuple[Circle, Look]], robot: Placement
) -> list[list[Hit]]:
    """Return the hits of the ray of each column, farthest first."""
    hits: list[list[Hit]] = [[] for _ in range(WIDTH)]
    for (ax, ay, bx, by), look in walls:
        _meet_wall(hits, look, *robot.local(ax, ay), *robot.local(bx, by))
    for (x, y, radius), look in discs:
        _meet_disc(hits, look, *robot.local(x, y), radius)
    for met in hits:
        met.sort(key=itemgetter(0), reverse=True)
    return hits


def _meet_wall(hits: list[list[Hit]], look: Look, a: float, a_left: float, b: float, b_left: float) -> None:
    """Add the hits of a wall between two points, each metres ahead and to the left."""
    if a < _NEAR and b < _NEAR:
        return
    ahead, left = b - a, b_left - a_left
    if a < _NEAR:
        a, a_left = _NEAR, a_left + (_NEAR - a) / ahead * left
    elif b < _NEAR:
        b, b_left = _NEAR, a_left + (_NEAR - a) / ahead * left
    ahead, left = b - a, b_left - a_left
    first, last = sorted((_column(a, a_left), _column(b, b_left)))
    for column in range(max(0, math.ceil(first)), min(WIDTH - 1, math.floor(last)) + 1):
        slope = _SLOPES[column]
        across = left - slope * ahead
        if across != 0.0:
            hits[column].append((a + (slope * a - a_left) / across * ahead, look))


def _column(ahead: float, left: float) -> float:
    return 0.5 * WIDTH - 0.5 - FOCAL_LENGTH * left / ahead


def _meet_disc(hits: list[list[Hit]], look: Look, ahead: float, left: float, radius: float) -> None:
    """Add the hits of an upright cylinder; a camera inside it does not see it."""
    if ahead + radius < _NEAR:
        return
    rest = ahead * ahead + left * left - radius * radius
    for column, slope in enumerate(_SLOPES):
        square, along = 1.0 + slope * slope, ahead + slope * left
        root = along * along - square * rest
        if root >= 0.0:
            depth = (along - math.sqrt(root)) / square
            if depth >= _NEAR:
                hits[column].append((depth, look))


def _rows(hit: Hit) -> tuple[int, int]:
    """Return the first row that an object fills in its column, and the first row below it."""
    depth, look = hit
    top = 0.5 * HEIGHT - FOCAL_LENGTH * (look.height - CAMERA_HEIGHT) / depth
    bottom = 0.5 * HEIGHT + FOCAL_LENGTH * CAMERA_HEIGHT / depth
    return max(0, min(HEIGHT, math.ceil(top - 0.5))), max(0, min(HEIGHT, math.ceil(bottom - 0.5)))


def colours(seen: list[list[Hit]]) -> bytes:
    """Return the image as ``rgb8``, row by row."""
    image = bytearray(_BACKGROUND)
    stride = 3 * WIDTH
    for column, hits in enumerate(seen):
        for hit in hits:
            first, last = _rows(hit)
            for part, value in enumerate(_shaded(hit[1].colour, hit[0])):
                place = 3 * column + part
                image[first * stride + place : last * stride + place : stride] = bytes((value,)) * (
                    last - first
                )
    return bytes(image)


def depths(seen: list[list[Hit]]) -> bytes:
    """Return the depth image as ``32FC1`` (little-endian): metres ahead, ``inf`` for nothing."""
    image = array("f", (depth for depth in _FLOOR_DEPTHS for _ in range(WIDTH)))
    for column, hits in enumerate(seen):
        for hit in hits:
            first, last = _rows(hit)
            image[first * WIDTH + column : last * WIDTH + column : WIDTH] = array("f", (hit[0],)) * (
                last - first
            )
    if sys.byteorder == "big":
        image.byteswap()
    return image.tobytes()


def _shaded(colour: Colour, depth: float) -> Colour:
    light = 1.0 / (1.0 + _DIMMING * depth)
    red, green, blue = colour
    return int(red * light), int(green * light), int(blue * light)


_BACKGROUND = b"".join(
    bytes(_SKY if depth == math.inf else _shaded(_FLOOR, depth)) * WIDTH for depth in _FLOOR_DEPTHS
)
