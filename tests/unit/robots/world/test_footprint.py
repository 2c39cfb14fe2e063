"""Rectangular robots: they touch walls with edges and corners."""

import math

import pytest

from jacaros.look.page.picture import picture_svg
from jacaros.look.records.recording import Recording
from jacaros.robots.plane.contact import WallIndex, push_out_rectangle
from jacaros.robots.plane.pose import Pose
from jacaros.robots.plane.shapes import Segment
from jacaros.robots.world import World
from jacaros.robots.world.data.world import WorldError
from jacaros.robots.world.files.world import read_world

WALL = Segment(1.0, -2.0, 1.0, 2.0)


def world(pose: str = "{x: 0, y: 0}", footprint: str = "[0.6, 0.3]", more: str = "") -> str:
    return f"""
size: [4, 4]
border: walls
robots:
  - {{name: cart, pose: {pose}, footprint: {footprint} {more}}}
"""


def pushed(pose: Pose, *segments: Segment) -> tuple[float, float, tuple[float, float] | None]:
    return push_out_rectangle(pose, 0.3, 0.15, WallIndex(segments, 0.34).near(pose.x, pose.y))


@pytest.mark.parametrize(
    ("yaw", "half"), [(0.0, 0.3), (math.pi / 2, 0.15), (math.pi / 4, (0.3 + 0.15) / math.sqrt(2))]
)
def test_a_footprint_keeps_edges_and_corners_out_of_walls(yaw: float, half: float) -> None:
    x, y, towards = pushed(Pose(0.9, 0.0, yaw), WALL)
    assert (x, y) == pytest.approx((1.0 - half, 0.0))
    assert towards == pytest.approx((1.0, 0.0))


def test_only_the_footprint_touches_not_its_circle() -> None:
    beside = Segment(-1.0, 0.2, 1.0, 0.2)
    assert pushed(Pose(0.0, 0.0, 0.0), beside) == (0.0, 0.0, None)
    post = Segment(0.31, 0.2, 0.4, 0.3)
    assert pushed(Pose(0.0, 0.0, 0.0), post) == (0.0, 0.0, None)


def test_the_end_of_a_wall_pushes_by_the_shortest_way() -> None:
    x, y, towards = pushed(Pose(0.0, 0.0, 0.0), Segment(0.25, 0.0, 2.0, 0.0))
    assert (x, y) == pytest.approx((-0.05, 0.0))
    assert towards == (1.0, 0.0)


def test_it_drives_against_a_wall_and_turns_off_it() -> None:
    run = World.load(world())
    for _ in range(100):
        run.command("cart", 0.3, 0.0)
        run.run(0.1)
    robot = run.robot()
    assert robot.x == pytest.approx(1.7, abs=0.002)
    assert robot.contacts == {"wall": "front"}
    for _ in range(60):
        run.command("cart", 0.0, 0.5)
        run.run(0.1)
        reach = 0.3 * abs(math.cos(robot.yaw)) + 0.15 * abs(math.sin(robot.yaw))
        assert robot.x + reach < 2.003


def test_a_place_beside_a_wall_is_checked_by_its_edges() -> None:
    read_world(world("{x: 0, y: 1.8}"))
    with pytest.raises(WorldError, match=r"in a wall, with a footprint of 0\.6 x 0\.3 m"):
        read_world(world("{x: 0, y: 1.8, yaw_degrees: 90}"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (world(more=", radius: 0.2"), "'radius' and 'footprint' are alternatives"),
        (world(footprint="[0.6, 0]"), "a footprint is from 0.04 to 4 m long and wide"),
    ],
)
def test_an_invalid_footprint_is_reported(text: str, message: str) -> None:
    with pytest.raises(WorldError, match=message):
        read_world(text)


def test_it_is_drawn_as_a_rectangle() -> None:
    description = read_world(world())
    assert description.robots[0].radius == pytest.approx(math.hypot(0.3, 0.15))
    svg = picture_svg(Recording(world=description.drawing()), 400)
    assert '<rect class="robot"' in svg
    assert '<circle class="robot"' not in svg
