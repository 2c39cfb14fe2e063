"""The laser range finder on numpy: the operations of `jacaros.sim.robot.sensors.laser_plain.sweep_walls` in the same order.

Its ranges equal those of the plain version to the last bit, even with numpy's processor-specific code disabled, because
they are computed with ``+ - * /`` and a minimum only.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy

from jacaros.plane.trigonometry import PI, TWO_PI, sine_cosine
from jacaros.sim.description import Segment
from jacaros.sim.robot.sensors.laser_plain import Beams, Circle


class WallArrays:
    """The walls of a world and the beams of one laser as arrays, created once."""

    def __init__(self, segments: Sequence[Segment], beams: Beams) -> None:
        table: Any = numpy.array(segments, dtype=numpy.float64).reshape(-1, 4)
        self._ax, self._ay, self._bx, self._by = (numpy.ascontiguousarray(table[:, i]) for i in range(4))
        self._cosines, self._sines = numpy.array(beams.cosines), numpy.array(beams.sines)
        self._beams = beams

    def sweep(self, x: float, y: float, yaw: float, circles: Sequence[Circle] = ()) -> list[float]:
        """Return the distances of a whole turn of beams: those of `sweep_walls` and `sweep_circles` in `laser_plain`."""
        count, scale = self._beams.count, self._beams.count / TWO_PI
        sine, cosine = sine_cosine(yaw)
        xs = cosine * self._cosines - sine * self._sines
        ys = sine * self._cosines + cosine * self._sines
        ax, ay, bx, by = self._ax - x, self._ay - y, self._bx - x, self._by - y
        dx, dy = bx - ax, by - ay
        area = ax * by - ay * bx
        of_a, of_b = numpy.arctan2(ay, ax), numpy.arctan2(by, bx)
        start, end = numpy.where(area > 0.0, of_a, of_b), numpy.where(area > 0.0, of_b, of_a)
        first = numpy.floor((start - yaw + PI) * scale).astype(numpy.int64) - 1
        candidates = numpy.ceil(((end - start) % TWO_PI) * scale).astype(numpy.int64) + 3
        wall, number = _expand(first, candidates)
        beam = number % count
        c, s = xs[beam], ys[beam]
        across = c * dy[wall] - s * dx[wall]
        with numpy.errstate(divide="ignore", invalid="ignore", over="ignore"):
            distance = area[wall] / across
            place = (ax[wall] * s - ay[wall] * c) / across
        hit = (across != 0.0) & (distance >= 0.0) & (place >= 0.0) & (place <= 1.0)
        ranges = numpy.full(count, math.inf)
        numpy.minimum.at(ranges, beam[hit], distance[hit])
        if circles:
            self._sweep_circles(ranges, circles, x, y, yaw, xs, ys)
        result: list[float] = ranges.tolist()
        return result

    def _sweep_circles(
        self, ranges: Any, circles: Sequence[Circle], x: float, y: float, yaw: float, xs: Any, ys: Any
    ) -> None:
        """Shorten *ranges* where a beam meets a circle first; *xs* and *ys* are the beams' directions."""
        count, scale = self._beams.count, self._beams.count / TWO_PI
        table = numpy.array(circles, dtype=numpy.float64)
        ex, ey, radius = table[:, 0] - x, table[:, 1] - y, table[:, 2]
        apart2, radius2 = ex * ex + ey * ey, radius * radius
        outside = apart2 > radius2
        ex, ey, radius2, apart2, radius = (each[outside] for each in (ex, ey, radius2, apart2, radius))
        half = numpy.arcsin(radius / numpy.sqrt(apart2))
        first = numpy.floor((numpy.arctan2(ey, ex) - half - yaw + PI) * scale).astype(numpy.int64) - 1
        circle, number = _expand(first, numpy.ceil(2.0 * half * scale).astype(numpy.int64) + 3)
        beam = number % count
        c, s = xs[beam], ys[beam]
        along, across = ex[circle] * c + ey[circle] * s, ex[circle] * s - ey[circle] * c
        root = radius2[circle] - across * across
        hit = (root >= 0.0) & (along > 0.0)
        numpy.minimum.at(ranges, beam[hit], along[hit] - numpy.sqrt(root[hit]))


def _expand(first: Any, candidates: Any) -> tuple[Any, Any]:
    """Return a flat list of (wall or circle, beam number) pairs from the first beam and the count of each."""
    wall = numpy.repeat(numpy.arange(len(first)), candidates)
    begin = numpy.cumsum(candidates) - candidates
    number = numpy.arange(len(wall)) - begin[wall] + first[wall]
    return wall, number
