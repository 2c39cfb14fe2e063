"""Geometry of true paths."""

import math

import pytest

from jacaros.robots.plane.pose import Pose
from jacaros.robots.world import PathSample, World
from jacaros.testing.paths import angle_between, distance, seen_from, to_segment, turns


def test_distances_and_angles() -> None:
    assert distance(Pose(1, 1, 0), 4, 5) == 5
    assert angle_between(math.radians(179), math.radians(-179)) == pytest.approx(math.radians(2))
    assert angle_between(0, 4 * math.pi) == pytest.approx(0)


def test_a_point_is_seen_from_a_pose() -> None:
    ahead, left = seen_from(Pose(1, 1, math.pi / 2), Pose(0, 3, 0))
    assert (ahead, left) == pytest.approx((2, 1))


@pytest.mark.parametrize(("x", "y", "far"), [(1, 1, 1), (-3, 4, 5), (5, 4, 5), (2, 0, 0)])
def test_the_nearest_point_of_a_segment(x: float, y: float, far: float) -> None:
    assert to_segment(Pose(x, y, 0), (0, 0), (2, 0)) == pytest.approx(far)


def path_of(*commands: tuple[float, float, float]) -> list[PathSample]:
    """Return the path of a robot with a speed and turn rate for several seconds each."""
    world = World.load("empty")
    for speed, turn_rate, seconds in commands:
        for _ in range(round(seconds / 0.1)):
            world.command("turtlebot", speed, turn_rate)
            world.run(0.1)
    return [*world.ground_truth.path(), world.ground_truth.latest()]


def test_turns_on_the_spot_are_found_with_place_and_angle() -> None:
    found = turns(
        path_of((0.5, 0, 2), (0, 0, 1), (0, 1, 1.5), (0, 0, 1), (0.5, 0, 2), (0, 0, 1), (0, -1, 2), (0, 0, 1))
    )
    assert len(found) == 2
    assert found[0].x == pytest.approx(1.0, abs=0.05)
    assert found[0].angle == pytest.approx(1.5, abs=0.1)
    assert found[1].angle == pytest.approx(-2.0, abs=0.1)
    assert math.dist((found[0].x, found[0].y), (found[1].x, found[1].y)) == pytest.approx(1.0, abs=0.05)
    assert found[0].end - found[0].begin == pytest.approx(2.0, abs=0.3)


def test_a_curve_does_not_count_as_a_turn_on_the_spot() -> None:
    assert turns(path_of((0.5, 1, 3), (0, 0, 1))) == []


def test_a_small_turn_is_left_out() -> None:
    path = path_of((0, 1, 0.2), (0, 0, 1))
    assert turns(path) == []
    assert len(turns(path, least=math.radians(5))) == 1


def test_a_turn_at_the_end_of_the_path_counts() -> None:
    assert len(turns(path_of((0, 1, 1.5)))) == 1
