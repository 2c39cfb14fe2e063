"""The laser range finder.

The sweep of the laser intersects a wall only with the beams between the bearings of its two ends. The bearings come from
the C library's arctangent, which only *selects* candidates (one more beam on each side makes its last bit irrelevant); the
ranges themselves are computed with ``+ - * /`` and square roots, and are equal on every machine.
"""

import math
import random
from collections.abc import Iterable, Sequence

from jacaros.robots.plane.shapes import Circle, Segment
from jacaros.robots.plane.trigonometry import PI, TWO_PI, sine_cosine
from jacaros.robots.world.data.robot import LaserSettings


class Laser:
    """One robot's laser: beam 0 of a full turn points backwards (-pi), the others follow counter-clockwise.

    Attributes:
        settings: settings from the world file.
        segments: all walls.
        angle_min, angle_max, angle_increment: bearings of the first and the last beam in the field of view, and the step
            between two beams, in radians.
    """

    def __init__(self, settings: LaserSettings, seed: str, segments: Sequence[Segment] = ()) -> None:
        self.settings, self.segments = settings, segments
        self._count = settings.beams_per_turn
        self.angle_increment = TWO_PI / self._count
        self._first, self._last = 0, self._count
        if settings.field < TWO_PI:
            half = math.floor(settings.field / 2.0 / self.angle_increment + 1e-9)
            ahead = self._count // 2
            self._first, self._last = max(0, ahead - half), min(self._count, ahead + half + 1)
        self.angle_min = -PI + self._first * self.angle_increment
        self.angle_max = -PI + (self._last - 1) * self.angle_increment
        # As sines and cosines.
        self._beams = [sine_cosine(-PI + index * TWO_PI / self._count) for index in range(self._count)]
        self._draw = random.Random(seed).random

    def scan(self, x: float, y: float, yaw: float, others: Iterable[Circle] = ()) -> list[float]:
        """Return ranges (metres) of the field of view, counter-clockwise; ``inf`` for no echo in range."""
        noise, reach = self.settings.noise, self.settings.range_max
        sine, cosine = sine_cosine(yaw)
        xs = [cosine * c - sine * s for s, c in self._beams]
        ys = [sine * c + cosine * s for s, c in self._beams]
        ranges = [math.inf] * self._count
        self._meet_walls(ranges, x, y, yaw, xs, ys)
        self._meet_circles(ranges, others, x, y, yaw, xs, ys)
        swept = ranges[self._first : self._last]
        if noise:
            swept = [value + (self._draw() * 2.0 - 1.0) * noise for value in swept]
        return [value if value <= reach else math.inf for value in swept]

    def _meet_walls(
        self, ranges: list[float], x: float, y: float, yaw: float, xs: list[float], ys: list[float]
    ) -> None:
        """Shorten *ranges* where a beam meets a wall; *xs* and *ys* are the beams' directions."""
        count, scale, far = self._count, self._count / TWO_PI, self.settings.range_max + self.settings.noise
        for segment_ax, segment_ay, segment_bx, segment_by in self.segments:
            ax, ay, bx, by = segment_ax - x, segment_ay - y, segment_bx - x, segment_by - y
            if (ax > far and bx > far) or (ax < -far and bx < -far):
                continue
            if (ay > far and by > far) or (ay < -far and by < -far):
                continue
            dx, dy = bx - ax, by - ay
            area = ax * by - ay * bx
            of_a, of_b = math.atan2(ay, ax), math.atan2(by, bx)
            start, end = (of_a, of_b) if area > 0.0 else (of_b, of_a)
            first = math.floor((start - yaw + PI) * scale) - 1
            last = first + math.ceil(((end - start) % TWO_PI) * scale) + 3
            for number in range(first, last):
                beam = number % count
                c, s = xs[beam], ys[beam]
                across = c * dy - s * dx
                if not across:
                    continue
                distance = area / across
                if 0.0 <= distance < ranges[beam] and 0.0 <= (ax * s - ay * c) / across <= 1.0:
                    ranges[beam] = distance

    def _meet_circles(
        self,
        ranges: list[float],
        circles: Iterable[Circle],
        x: float,
        y: float,
        yaw: float,
        xs: list[float],
        ys: list[float],
    ) -> None:
        """Shorten *ranges* where a beam meets a circle first."""
        count, scale, far = self._count, self._count / TWO_PI, self.settings.range_max + self.settings.noise
        for circle_x, circle_y, radius in circles:
            ex, ey = circle_x - x, circle_y - y
            apart2, radius2 = ex * ex + ey * ey, radius * radius
            if not radius2 < apart2 < (far + radius) * (far + radius):
                continue
            half = math.asin(radius / math.sqrt(apart2))
            first = math.floor((math.atan2(ey, ex) - half - yaw + PI) * scale) - 1
            for number in range(first, first + math.ceil(2.0 * half * scale) + 3):
                beam = number % count
                along, across = ex * xs[beam] + ey * ys[beam], ex * ys[beam] - ey * xs[beam]
                root = radius2 - across * across
                if root >= 0.0 and along > 0.0 and (distance := along - math.sqrt(root)) < ranges[beam]:
                    ranges[beam] = distance
