"""Poses and directions: the frames of REP 105, and the angles of a quaternion."""

import math
import random
from types import SimpleNamespace

import pytest

from jacaros.robots.plane.pose import ORIGIN, Placement, Pose, normalised, pitch_of, roll_of, wrap, yaw_of
from jacaros.robots.plane.trigonometry import PI, TWO_PI


@pytest.mark.parametrize(
    ("angle", "same"),
    [(0, 0), (math.pi, math.pi), (-math.pi, math.pi), (7, 7 - math.tau), (-7, math.tau - 7)],
)
def test_directions_are_normalised(angle: float, same: float) -> None:
    assert normalised(angle) == pytest.approx(same)


def test_a_direction_in_degrees_is_at_most_half_a_turn() -> None:
    assert [normalised(angle, 360.0) for angle in (-180.0, 180.0, 270.0, 725.0)] == [180.0, 180.0, -90.0, 5.0]


def test_the_worlds_directions_exclude_half_a_turn() -> None:
    assert wrap(PI) == wrap(-PI) == -PI
    draw = random.Random(3)
    for _ in range(1000):
        angle = draw.uniform(-3.0 * PI, 3.0 * PI)
        assert wrap(angle) == angle - TWO_PI * math.floor((angle + PI) / TWO_PI)


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5, 3.1])
def test_the_heading_is_read_from_a_quaternion(heading: float) -> None:
    assert yaw_of(0, 0, math.sin(heading / 2), math.cos(heading / 2)) == pytest.approx(heading)


def test_the_angles_of_a_quaternion_are_about_its_axes() -> None:
    sine, cosine = math.sin(0.2), math.cos(0.2)
    assert roll_of(sine, 0, 0, cosine) == pytest.approx(0.4)
    assert pitch_of(0, sine, 0, cosine) == pytest.approx(0.4)
    assert roll_of(0, sine, 0, cosine) == pitch_of(sine, 0, 0, cosine) == 0.0
    assert pitch_of(0, 0.7072, 0, 0.7072) == pytest.approx(math.pi / 2), "rounded up"


def test_a_message_is_read_as_a_pose() -> None:
    turn = SimpleNamespace(x=0.0, y=0.0, z=math.sin(0.5), w=math.cos(0.5))
    message = SimpleNamespace(position=SimpleNamespace(x=1, y=2, z=3), orientation=turn)
    assert Pose.of(message) == pytest.approx((1.0, 2.0, 1.0))


def test_poses_can_be_composed_and_separated() -> None:
    pose = Pose(1.0, -2.0, 2.5)
    back = pose.then(pose.inverse())
    assert (back.x, back.y, back.yaw) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    ahead = pose.point(2.0, 1.0)
    assert pose.local(*ahead) == pytest.approx((2.0, 1.0))
    assert pose.then(Pose(2.0, 1.0, 1.0)) == pytest.approx((*ahead, 3.5 - math.tau))
    assert ORIGIN.then(pose) == pytest.approx(pose)


def test_placements_compose_as_angles_do() -> None:
    draw = random.Random(5)
    for _ in range(200):
        x, y, yaw = draw.uniform(-5, 5), draw.uniform(-5, 5), draw.uniform(-PI, PI)
        place = Placement.at(x, y, yaw)
        assert place.then(place.inverse()) == pytest.approx((0.0, 0.0, 1.0, 0.0), abs=1e-12)
        z, w = place.quaternion()
        assert Placement.from_quaternion(x, y, (0.0, 0.0, z, w)) == pytest.approx(place, abs=1e-9)
        px, py = draw.uniform(-5, 5), draw.uniform(-5, 5)
        turned = complex(px, py) * complex(math.cos(yaw), math.sin(yaw)) + complex(x, y)
        assert place.point(px, py) == pytest.approx((turned.real, turned.imag))
        assert place.local(*place.point(px, py)) == pytest.approx((px, py))
