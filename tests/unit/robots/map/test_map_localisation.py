"""Where a robot is on the map: odometry, and its correction."""

import math

import pytest

from jacaros.robots.map.mapper import Localisation
from jacaros.robots.plane.pose import Pose


def test_a_sensor_that_is_late_gets_the_pose_of_its_time() -> None:
    where = Localisation()
    assert where.pose_at(1.0) is None
    for number in range(60):
        where.take_odometry(10.0 + number, Pose(0.1 * number, 0.0, 0.0))
    assert where.pose_at(68.5) == pytest.approx((5.85, 0.0, 0.0))
    assert where.pose_at(0.0) == where.pose_at(99.0) == where.pose == pytest.approx((5.9, 0.0, 0.0))
    assert where.pose_at(11.0) == pytest.approx((2.0, 0.0, 0.0))  # the oldest that is remembered
    assert where.driven == pytest.approx(5.9)


def test_a_correction_holds_for_the_poses_that_follow() -> None:
    where = Localisation()
    where.correct(1.0, Pose(9.0, 9.0, 0.0))
    where.take_odometry(1.0, Pose(1.0, 0.0, 0.0))
    where.take_odometry(2.0, Pose(2.0, 0.0, 0.0))
    assert where.pose == pytest.approx((2.0, 0.0, 0.0))
    where.correct(1.0, Pose(5.0, 5.0, math.pi / 2.0))
    assert where.pose == pytest.approx((5.0, 6.0, math.pi / 2.0))
    where.take_odometry(3.0, Pose(3.0, 0.0, 0.0))
    assert where.pose == pytest.approx((5.0, 7.0, math.pi / 2.0))


def test_a_clock_that_was_set_back_starts_again() -> None:
    where = Localisation()
    where.take_odometry(100.0, Pose(0.0, 0.0, 0.0))
    where.take_odometry(5.0, Pose(1.0, 0.0, 0.0))
    assert where.pose_at(4.0) == pytest.approx((1.0, 0.0, 0.0))
