"""Scan matching: a pose by what is seen, where odometry is off."""

import math
import random

import pytest

from jacaros.robots.map.scan_matching import Surfaces, match
from jacaros.robots.plane.pose import Point, Pose


def room(noise: float = 0.01) -> list[Point]:
    """Points of the four walls of a room of 4 x 3 m, and of a box in it."""
    chance = random.Random(1)
    walls = [((0, 0), (4, 0)), ((4, 0), (4, 3)), ((4, 3), (0, 3)), ((0, 3), (0, 0)), ((1, 1), (1, 1.5))]
    found: list[Point] = []
    for (ax, ay), (bx, by) in walls:
        for step in range(60):
            share = step / 60
            x, y = ax + share * (bx - ax), ay + share * (by - ay)
            found.append((x + chance.uniform(-noise, noise), y + chance.uniform(-noise, noise)))
    return found


def seen_from(pose: Pose, points: list[Point]) -> list[Point]:
    back = pose.inverse()
    return [back.point(*point) for point in points]


def known_room() -> Surfaces:
    surfaces = Surfaces()
    surfaces.add(room())
    return surfaces


@pytest.mark.parametrize("off", [(0.1, 0.0, 0.0), (-0.08, 0.1, 0.05), (0.0, 0.0, -0.09), (0.05, -0.05, 0.08)])
def test_the_pose_is_found_from_a_guess_that_is_off(off: tuple[float, float, float]) -> None:
    truth = Pose(2.5, 1.2, 0.7)
    guess = Pose(truth.x + off[0], truth.y + off[1], truth.yaw + off[2])
    found = match(known_room(), seen_from(truth, room(0.01)), guess)
    assert found is not None
    assert math.dist(found[:2], truth[:2]) < 0.012
    assert abs(found.yaw - truth.yaw) < math.radians(0.4)


def test_along_a_corridor_odometry_is_believed() -> None:
    surfaces = Surfaces()
    walls = [(0.05 * step, y) for step in range(200) for y in (0.0, 1.0)]
    surfaces.add(walls)
    near = [point for point in walls if 3.0 < point[0] < 6.0]
    found = match(surfaces, seen_from(Pose(4.5, 0.5, 0.0), near), Pose(4.8, 0.55, 0.03))
    assert found is not None
    assert found.x == pytest.approx(4.8, abs=0.02)
    assert found.y == pytest.approx(0.5, abs=0.01)
    assert found.yaw == pytest.approx(0.0, abs=0.005)


def test_without_anything_known_nothing_is_found() -> None:
    points = seen_from(Pose(2.5, 1.2, 0.7), room())
    assert match(Surfaces(), points, Pose(2.5, 1.2, 0.7)) is None
    assert match(known_room(), points[:5], Pose(2.5, 1.2, 0.7)) is None
    far = Pose(40.0, 40.0, 0.0)
    assert match(known_room(), points, far) is None


def test_some_points_of_something_new_do_not_move_the_pose() -> None:
    truth = Pose(2.5, 1.2, 0.0)
    new = [(0.05 * step, 0.2) for step in range(12)]
    found = match(known_room(), seen_from(truth, room() + new), truth)
    assert found is not None
    assert math.dist(found[:2], truth[:2]) < 0.015
