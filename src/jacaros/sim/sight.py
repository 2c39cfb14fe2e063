"""What hides what, and the echo of a sonar, which comes from the nearest point in its cone."""

import math
from collections.abc import Iterable

from jacaros.plane.trigonometry import radians, sine_cosine
from jacaros.sim.description import Segment
from jacaros.sim.robot.sensors.laser import Circle

FIELD = radians(30.0)
"""Width of the cone, in radians."""
RANGE_MIN, RANGE_MAX = 0.02, 4.0
"""Maximum range in metres; there is no echo from farther away."""
_EDGE_SINE, _EDGE_COSINE = sine_cosine(0.5 * FIELD)


def hidden(walls: Iterable[Segment], ax: float, ay: float, bx: float, by: float) -> bool:
    """Return whether a wall crosses the straight line between two points."""
    dx, dy = bx - ax, by - ay
    for cx, cy, ex, ey in walls:
        of_c, of_e = dx * (cy - ay) - dy * (cx - ax), dx * (ey - ay) - dy * (ex - ax)
        if (of_c > 0.0) == (of_e > 0.0):
            continue
        wx, wy = ex - cx, ey - cy
        if (wx * (ay - cy) - wy * (ax - cx) > 0.0) != (wx * (by - cy) - wy * (bx - cx) > 0.0):
            return True
    return False


def echo(segments: Iterable[Segment], circles: Iterable[Circle], x: float, y: float, yaw: float) -> float:
    """Return the distance in metres from a sonar to the nearest point in its cone, ``inf`` for none."""
    sine, cosine = sine_cosine(yaw)
    nearest = math.inf
    for ax, ay, bx, by in segments:
        ax, ay, bx, by = ax - x, ay - y, bx - x, by - y
        found = _of_segment(
            cosine * ax + sine * ay, cosine * ay - sine * ax, cosine * bx + sine * by, cosine * by - sine * bx
        )
        nearest = found if found < nearest else nearest
    for circle_x, circle_y, radius in circles:
        cx, cy = circle_x - x, circle_y - y
        found = _of_circle(cosine * cx + sine * cy, abs(cosine * cy - sine * cx), radius)
        nearest = found if found < nearest else nearest
    return nearest


def _of_segment(ax: float, ay: float, bx: float, by: float) -> float:
    """Return the distance to the nearest point of a segment within the cone (ahead is x)."""
    first, last = 0.0, 1.0
    for side in (1.0, -1.0):
        # Metres inside this edge of the cone, at both ends.
        at_a = _EDGE_SINE * ax + side * _EDGE_COSINE * ay
        at_b = _EDGE_SINE * bx + side * _EDGE_COSINE * by
        if at_a < 0.0 and at_b < 0.0:
            return math.inf
        if at_a < 0.0:
            first = max(first, at_a / (at_a - at_b))
        elif at_b < 0.0:
            last = min(last, at_a / (at_a - at_b))
    if first > last:
        return math.inf
    dx, dy = bx - ax, by - ay
    place = min(max(-(ax * dx + ay * dy) / (dx * dx + dy * dy), first), last)
    px, py = ax + place * dx, ay + place * dy
    return math.sqrt(px * px + py * py)


def _of_circle(cx: float, cy: float, radius: float) -> float:
    """Return the distance to the nearest point of a disc within the cone; *cy* is not negative, by symmetry."""
    if _EDGE_SINE * cx - _EDGE_COSINE * cy >= 0.0:  # the centre is in the cone
        return max(0.0, math.sqrt(cx * cx + cy * cy) - radius)
    along, across = _EDGE_COSINE * cx + _EDGE_SINE * cy, _EDGE_COSINE * cy - _EDGE_SINE * cx
    root = radius * radius - across * across
    return along - math.sqrt(root) if root >= 0.0 and along > 0.0 else math.inf
