"""Scan matching: correct the pose of a robot by comparing a laser scan with earlier ones.

A scan is moved until its points lie on the lines of earlier scans (iterated closest point with point-to-line
distances: Chen and Medioni 1991).  Odometry gives the initial pose, and is weighted so that it decides the directions
that the lines leave open, such as along a corridor.
"""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from jacaros.robots.map.cells import Cell
from jacaros.robots.plane.pose import Point, Pose, normalised

BUCKET = 0.1
"""Side, in metres, of the squares in which observed points are averaged."""

MOST = 30
"""Maximum number of points that a square averages; further points change nothing, so that the map does not drift with
the robot."""

FAR = 0.3
"""Metres from its line beyond which a point is ignored."""

DOUBTFUL = 0.04
"""Metres from its line at which a point counts half."""

STRAIGHT = 0.15
"""Maximum spread of the points of a line across it, as a fraction of the spread along it (variances)."""

ROUNDS = 12
FEW = 12
"""Minimum number of points on lines for a match."""

TRUST = (4.0, 4.0, 10.0)
"""Weights of odometry for x, y and heading, in points."""


class WallLine(NamedTuple):
    """A piece of a wall: a point on it, and its normal."""

    x: float
    y: float
    across_x: float
    across_y: float


class Surfaces:
    """Positions of echoes, averaged, as pieces of lines."""

    def __init__(self) -> None:
        self._sums: dict[Cell, tuple[int, float, float]] = {}
        self._lines: dict[Cell, WallLine | None] = {}

    def __bool__(self) -> bool:
        return bool(self._sums)

    def add(self, echoes: Iterable[Point]) -> None:
        """Add the echoes of a scan, in map coordinates."""
        self._lines.clear()
        sums = self._sums
        for x, y in echoes:
            key = (math.floor(x / BUCKET), math.floor(y / BUCKET))
            count, sum_x, sum_y = sums.get(key, (0, 0.0, 0.0))
            if count < MOST:
                sums[key] = (count + 1, sum_x + x, sum_y + y)

    def line_near(self, x: float, y: float) -> WallLine | None:
        """Return the line through the points observed near a point, None if no points exist or they are not on a
        line."""
        key = (math.floor(x / BUCKET), math.floor(y / BUCKET))
        if key not in self._lines:
            self._lines[key] = self._fit(key)
        return self._lines[key]

    def _fit(self, key: Cell) -> WallLine | None:
        """Fit a line to the averages of the surrounding squares, weighted by distance."""
        column, row = key
        weight = sum_x = sum_y = 0.0
        found: list[tuple[float, float, float]] = []
        for i in range(column - 2, column + 3):
            for j in range(row - 2, row + 3):
                entry = self._sums.get((i, j))
                if entry is not None:
                    count, x, y = entry
                    part = count / (1.0 + (i - column) ** 2 + (j - row) ** 2)
                    found.append((part, x / count, y / count))
                    weight += part
                    sum_x += part * x / count
                    sum_y += part * y / count
        if len(found) < 3:
            return None
        x, y = sum_x / weight, sum_y / weight
        xx = sum(part * (a - x) ** 2 for part, a, _ in found) / weight
        yy = sum(part * (b - y) ** 2 for part, _, b in found) / weight
        xy = sum(part * (a - x) * (b - y) for part, a, b in found) / weight
        spread = math.hypot(0.5 * (xx - yy), xy)
        if 0.5 * (xx + yy) - spread > STRAIGHT * (0.5 * (xx + yy) + spread):
            return None
        along = 0.5 * math.atan2(2.0 * xy, xx - yy)
        return WallLine(x, y, -math.sin(along), math.cos(along))


def match(surfaces: Surfaces, points: Sequence[Point], guess: Pose) -> Pose | None:
    """Find the pose at which the points of a scan fit earlier ones best.

    Args:
        surfaces: what earlier scans observed.
        points: echoes, in the frame of the robot; a hundred are enough.
        guess: the pose according to odometry; it must be within about `FAR` and a few degrees of the true one.

    Returns:
        The pose, or None if too few points lie on lines.
    """
    pose = guess
    for _ in range(ROUNDS):
        normal = _Normal(pose, guess)
        sine, cosine = math.sin(pose.yaw), math.cos(pose.yaw)
        used = 0
        for px, py in points:
            rx, ry = cosine * px - sine * py, sine * px + cosine * py
            x, y = pose.x + rx, pose.y + ry
            line = surfaces.line_near(x, y)
            if line is None:
                continue
            off = line.across_x * (x - line.x) + line.across_y * (y - line.y)
            if abs(off) < FAR:
                used += 1
                normal.add(line.across_x, line.across_y, rx * line.across_y - ry * line.across_x, off)
        if used < FEW:
            return None
        dx, dy, turn = normal.solved()
        pose = Pose(pose.x + dx, pose.y + dy, normalised(pose.yaw + turn))
        if abs(dx) + abs(dy) < 1e-4 and abs(turn) < 1e-4:
            break
    return pose


class _Normal:
    """The normal equations of one iteration: least squares for a small motion of the pose."""

    def __init__(self, pose: Pose, guess: Pose) -> None:
        tx, ty, tt = TRUST
        turned = normalised(guess.yaw - pose.yaw)
        self._a = [[tx, 0.0, 0.0], [0.0, ty, 0.0], [0.0, 0.0, tt]]
        self._b = [tx * (guess.x - pose.x), ty * (guess.y - pose.y), tt * turned]

    def add(self, jx: float, jy: float, jt: float, off: float) -> None:
        """Add a point that is *off* its line, and the effect of a motion along x and y and of a turn."""
        weight = 1.0 / (1.0 + (off / DOUBTFUL) ** 2)
        wx, wy, wt = weight * jx, weight * jy, weight * jt
        a, b = self._a, self._b
        a[0][0] += wx * jx
        a[0][1] += wx * jy
        a[0][2] += wx * jt
        a[1][1] += wy * jy
        a[1][2] += wy * jt
        a[2][2] += wt * jt
        b[0] -= wx * off
        b[1] -= wy * off
        b[2] -= wt * off

    def solved(self) -> tuple[float, float, float]:
        """Return the motion; the matrix is positive definite because odometry counts in every direction."""
        (a, b, c), (_, d, e), (_, _, f) = self._a
        p, q, r = self._b
        m00, m01, m02 = d * f - e * e, c * e - b * f, b * e - c * d
        m11, m12, m22 = a * f - c * c, b * c - a * e, a * d - b * b
        determinant = a * m00 + b * m01 + c * m02
        return (
            (m00 * p + m01 * q + m02 * r) / determinant,
            (m01 * p + m11 * q + m12 * r) / determinant,
            (m02 * p + m12 * q + m22 * r) / determinant,
        )
