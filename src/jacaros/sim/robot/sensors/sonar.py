"""The sonar of a robot, whose echo comes from the nearest point in its cone."""

import math
from collections.abc import Iterable

from jacaros.plane.trigonometry import radians, sine_cosine
from jacaros.ros.message import constant
from jacaros.sim.description import Segment
from jacaros.sim.robot.on_graph import RobotOnGraph
from jacaros.sim.robot.sensors.laser import Circle

FIELD = radians(30.0)
"""Width of the cone, in radians."""
RANGE_MIN, RANGE_MAX = 0.02, 4.0
"""Maximum range in metres; there is no echo from farther away."""
_TICKS_PER_ECHO = 2
_EDGE_SINE, _EDGE_COSINE = sine_cosine(0.5 * FIELD)


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


class SonarSensor:
    """``/sonar``: metres to the nearest thing in a cone of 30 degrees ahead, 10 Hz with subscribers."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._publisher = at.publisher("/sonar", "sensor_msgs/msg/Range")

    def publish(self, ticks: int) -> None:
        """Publish if due."""
        if ticks % _TICKS_PER_ECHO or not self._publisher.subscription_count:
            return
        world, robot = self._at.time.world, self._at.robot
        found = echo(world.segments, world.others(robot), robot.x, robot.y, robot.yaw)
        message = self._publisher.message()
        self._at.fill_header(message.header, "base_link")
        message.radiation_type = constant(message, "ULTRASOUND")
        message.field_of_view, message.min_range, message.max_range = FIELD, RANGE_MIN, RANGE_MAX
        message.range = found if found <= RANGE_MAX else math.inf  # REP 117: no echo
        self._publisher.publish(message)
