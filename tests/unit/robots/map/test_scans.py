"""Laser scans as points."""

import math
from types import SimpleNamespace

import pytest

from jacaros.robots.map.mapper import ScanOptions, moved, read_scan
from jacaros.robots.plane.pose import ORIGIN, Pose


def message(ranges: list[float], increment: float = math.pi / 2.0) -> SimpleNamespace:
    return SimpleNamespace(
        ranges=ranges, angle_min=0.0, angle_increment=increment, range_min=0.1, range_max=8.0
    )


def options(mount: Pose = ORIGIN, longest: float = 4.0) -> ScanOptions:
    return ScanOptions(longest, mount, 0.1)


def test_echoes_are_points_and_beams_clear_the_ground_up_to_them() -> None:
    scan = read_scan(message([1.0, 2.0]), options())
    assert scan.echoes == [pytest.approx((1.0, 0.0)), pytest.approx((0.0, 2.0))]
    assert scan.clear == [pytest.approx((0.9, 0.0)), pytest.approx((0.0, 1.9))]


def test_no_echo_clears_the_ground_and_nonsense_says_nothing() -> None:
    assert read_scan(message([math.nan, -math.inf, 0.0, -1.0]), options()) == ((0.0, 0.0), [], [])
    scan = read_scan(message([math.inf, 9.0, 6.0]), options())
    assert scan.echoes == []
    assert [round(math.hypot(*point), 6) for point in scan.clear] == [4.0, 4.0, 4.0]


def test_a_beam_that_grazes_a_wall_does_not_clear_the_cells_beside_it() -> None:
    """The wall is half a metre beside the robot: y = 0.5."""
    degree = math.radians(1.0)
    ranges = [0.5 / math.sin(max(1, number) * degree) for number in range(90)]
    scan = read_scan(message(ranges, degree), options(longest=20.0))
    echoes = {round(x, 3): y for x, y in scan.echoes}
    assert all(abs(y - 0.5) < 1e-6 for x, y in scan.echoes if x < 20.0)
    assert len(echoes) > 80
    for x, y in scan.clear:
        if math.hypot(x, y) < 6.0:
            assert y < 0.5 - 0.08


def test_beams_of_one_direction_do_no_harm() -> None:
    assert len(read_scan(message([1.0, 1.0], 0.0), options()).clear) == 2


def test_the_laser_may_be_anywhere_on_the_robot_and_the_robot_on_the_map() -> None:
    scan = read_scan(message([1.0]), options(Pose(0.2, 0.1, math.pi / 2.0)))
    assert scan.origin == (0.2, 0.1)
    assert scan.echoes == [pytest.approx((0.2, 1.1))]
    on_map = moved(scan, Pose(5.0, 5.0, math.pi))
    assert on_map.origin == pytest.approx((4.8, 4.9))
    assert on_map.echoes == [pytest.approx((4.8, 3.9))]
