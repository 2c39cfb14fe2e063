"""The laser range finder in plain Python: exact, and the reference for the numpy version.

The sweep intersects a wall only with the beams between the bearings of its two ends. The bearings come from the C
library's arctangent, which only *selects* candidates (one more beam on each side makes its last bit irrelevant); the
ranges themselves are computed with ``+ - * /`` and square roots.
"""

import math
from collections.abc import Iterable

from jacaros.plane.trigonometry import PI, TWO_PI, sine_cosine
from jacaros.sim.description import LaserSettings, Segment

Circle = tuple[float, float, float]
"""A round obstacle: centre and radius, in metres."""


class Beams:
    """The directions of one laser: beam 0 points backwards (-pi), the others follow counter-clockwise.

    Attributes:
        count: beams of a full turn.
        first, last: the field of view is the beams from ``first`` to ``last`` (excluded).
        angle_min, angle_increment: bearing of the first beam in the field of view, and step, in radians.
    """

    def __init__(self, settings: LaserSettings) -> None:
        self.count = settings.beams_per_turn
        self.angle_increment = TWO_PI / self.count
        if settings.field >= TWO_PI:
            self.first, self.last = 0, self.count
        else:
            half = math.floor(settings.field / 2.0 / self.angle_increment + 1e-9)
            ahead = self.count // 2
            self.first, self.last = max(0, ahead - half), min(self.count, ahead + half + 1)
        self.angle_min = -PI + self.first * self.angle_increment
        pairs = [sine_cosine(-PI + index * TWO_PI / self.count) for index in range(self.count)]
        self.cosines = [cosine for _, cosine in pairs]
        self.sines = [sine for sine, _ in pairs]

    @property
    def angle_max(self) -> float:
        """Bearing of the last beam in the field of view, in radians."""
        return -PI + (self.last - 1) * self.angle_increment


def sweep_walls(segments: Iterable[Segment], x: float, y: float, yaw: float, beams: Beams) -> list[float]:
    """Return distances (metres) of a full turn of beams to the nearest wall, ``inf`` for none."""
    sine, cosine = sine_cosine(yaw)
    xs = [cosine * c - sine * s for c, s in zip(beams.cosines, beams.sines, strict=True)]
    ys = [sine * c + cosine * s for c, s in zip(beams.cosines, beams.sines, strict=True)]
    count, scale = beams.count, beams.count / TWO_PI
    ranges = [math.inf] * count
    for segment_ax, segment_ay, segment_bx, segment_by in segments:
        ax, ay, bx, by = segment_ax - x, segment_ay - y, segment_bx - x, segment_by - y
        dx, dy = bx - ax, by - ay
        area = ax * by - ay * bx
        of_a, of_b = math.atan2(ay, ax), math.atan2(by, bx)
        start, end = (of_a, of_b) if area > 0.0 else (of_b, of_a)
        first = math.floor((start - yaw + PI) * scale) - 1
        candidates = math.ceil(((end - start) % TWO_PI) * scale) + 3
        for number in range(first, first + candidates):
            beam = number % count
            c, s = xs[beam], ys[beam]
            across = c * dy - s * dx
            if across == 0.0:
                continue
            distance = area / across
            place = (ax * s - ay * c) / across
            if distance >= 0.0 and 0.0 <= place <= 1.0 and distance < ranges[beam]:
                ranges[beam] = distance
    return ranges


def sweep_circles(
    ranges: list[float], circles: Iterable[Circle], x: float, y: float, yaw: float, beams: Beams
) -> None:
    """Shorten *ranges* where a beam meets one of *circles* first."""
    sine, cosine = sine_cosine(yaw)
    count, scale = beams.count, beams.count / TWO_PI
    for circle_x, circle_y, radius in circles:
        ex, ey = circle_x - x, circle_y - y
        apart2, radius2 = ex * ex + ey * ey, radius * radius
        if apart2 <= radius2:
            continue
        half = math.asin(radius / math.sqrt(apart2))
        first = math.floor((math.atan2(ey, ex) - half - yaw + PI) * scale) - 1
        for number in range(first, first + math.ceil(2.0 * half * scale) + 3):
            beam = number % count
            c = cosine * beams.cosines[beam] - sine * beams.sines[beam]
            s = sine * beams.cosines[beam] + cosine * beams.sines[beam]
            along, across = ex * c + ey * s, ex * s - ey * c
            root = radius2 - across * across
            if root >= 0.0 and along > 0.0:
                distance = along - math.sqrt(root)
                if distance < ranges[beam]:
                    ranges[beam] = distance
