"""The IMU and the sonar of a robot: what they measure, and that they cost nothing without subscribers."""

import math
import random

import pytest
from sensor_lab import heard

from jacaros.robots.plane.pose import Placement
from jacaros.robots.plane.shapes import Circle, Segment
from jacaros.robots.world.physics.ranging import FIELD, echo


def test_the_imu_measures_rotation_and_centripetal_acceleration() -> None:
    world, messages = heard("/imu", "sensor_msgs/msg/Imu", 2.0, 0.3, 0.5)
    assert len(messages) == pytest.approx(40, abs=1)
    last = messages[-1]
    assert last.header.frame_id == "base_link"
    assert last.angular_velocity.z == pytest.approx(0.5)
    assert last.linear_acceleration.y == pytest.approx(0.15)
    assert last.linear_acceleration.z == pytest.approx(9.81, abs=0.01)
    assert 2 * math.atan2(last.orientation.z, last.orientation.w) == pytest.approx(
        world.robot().yaw, abs=0.03
    )


def test_the_imu_measures_acceleration() -> None:
    _, messages = heard("/imu", "sensor_msgs/msg/Imu", 1.0, 0.4)
    ahead = [message.linear_acceleration.x for message in messages]
    assert ahead[0] == 0.0, "there is no message before the first"
    assert ahead[2:7] == pytest.approx([0.8] * 5, abs=0.33), "the limit of the robot"
    assert ahead[-1] == 0.0


def test_the_sonar_measures_the_wall_ahead_but_not_beyond_its_range() -> None:
    text = "walls: [{segment: [[2.8, -3], [2.8, 3]]}]\nrobots: [{name: robot}]\n"
    world, messages = heard("/sonar", "sensor_msgs/msg/Range", 4.0, 0.3, world=text)
    assert len(messages) == pytest.approx(40, abs=1)
    assert (messages[0].radiation_type, messages[0].field_of_view) == (0, pytest.approx(FIELD))
    assert messages[0].range == pytest.approx(2.8, abs=0.01)
    assert messages[-1].range == pytest.approx(2.8 - world.robot().x, abs=0.04)
    _, silent = heard("/sonar", "sensor_msgs/msg/Range", 0.5, 0.0, world="empty")
    assert {message.range for message in silent} == {math.inf}


def test_the_sonar_detects_another_robot() -> None:
    text = "robots:\n  - {name: a}\n  - {name: b, namespace: b, pose: {x: 1.5}}\n"
    _, messages = heard("/sonar", "sensor_msgs/msg/Range", 0.5, 0.0, world=text)
    assert messages[0].range == pytest.approx(1.5 - 0.17)


def by_many_rays(segments: list[Segment], circles: list[Circle]) -> float:
    """Return the nearest hit of many rays of the cone, from the origin along x."""
    nearest = math.inf
    for number in range(2001):
        angle = FIELD * (number / 2000 - 0.5)
        c, s = math.cos(angle), math.sin(angle)
        for ax, ay, bx, by in segments:
            dx, dy = bx - ax, by - ay
            across = c * dy - s * dx
            if across:
                distance, place = (ax * dy - ay * dx) / across, (ax * s - ay * c) / across
                if distance >= 0 and 0 <= place <= 1:
                    nearest = min(nearest, distance)
        for x, y, radius in circles:
            along, beside = x * c + y * s, x * s - y * c
            if abs(beside) <= radius and along > 0:
                nearest = min(nearest, along - math.sqrt(radius**2 - beside**2))
    return nearest


def test_the_echo_is_that_of_the_nearest_point_in_the_cone() -> None:
    draw = random.Random(4)
    heard_something = 0
    for _ in range(40):
        segments = [Segment(*(draw.uniform(-3, 3) for _ in range(4))) for _ in range(2)]
        circles = [(draw.uniform(0.5, 3), draw.uniform(-2, 2), 0.3)]
        found, expected = echo(segments, circles, Placement(0.0, 0.0)), by_many_rays(segments, circles)
        heard_something += found < math.inf
        assert found == pytest.approx(expected, abs=0.01)
    assert heard_something > 10
