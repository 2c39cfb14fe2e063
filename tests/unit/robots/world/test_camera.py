"""The camera of a robot: its images, checked against the positions of objects."""

import math
from array import array
from typing import Any

import pytest
from sensor_lab import heard

from jacaros.robots.world.physics.rendering import CAMERA_HEIGHT, FOCAL_LENGTH, HEIGHT, WIDTH

IMAGE = "sensor_msgs/msg/Image"
ROOM = """\
bounds: {from: [-1, -3], to: [4, 3]}
border: walls
walls:
  - box: {from: [2, 0.5], to: [2.5, 1], color: red}
doors:
  - {name: cupboard, segment: [[3, -1], [3, -0.5]]}
docks:
  - {name: dock, x: 1.5, y: 0}
robots:
  - {name: robot}
"""


def colour(image: Any, column: int, row: int) -> tuple[int, ...]:
    place = row * image.step + 3 * column
    return tuple(int(part) for part in image.data[place : place + 3])


def depth(image: Any, column: int, row: int) -> float:
    return array("f", bytes(image.data))[row * WIDTH + column]


def column_of(x: float, y: float) -> int:
    """Return the column in which a robot at the origin sees a point."""
    return round(WIDTH / 2 - FOCAL_LENGTH * y / x - 0.5)


def test_images_are_published_at_5_hz_with_subscribers() -> None:
    _, images = heard("/camera/image_raw", IMAGE, 2.0, 0.0, world=ROOM)
    assert len(images) == pytest.approx(10, abs=1)
    image = images[0]
    assert (image.width, image.height, image.encoding, image.step) == (WIDTH, HEIGHT, "rgb8", 3 * WIDTH)
    assert len(image.data) == 3 * WIDTH * HEIGHT
    assert image.header.frame_id == "camera_optical_frame"


def test_furniture_has_its_colour_and_hides_only_the_lower_part_of_the_wall() -> None:
    _, images = heard("/camera/image_raw", IMAGE, 0.3, 0.0, world=ROOM)
    column = column_of(2.0, 0.75)
    red, green, blue = colour(images[0], column, HEIGHT // 2)
    assert red > 100
    assert max(green, blue) < red / 2
    top = HEIGHT / 2 - FOCAL_LENGTH * (0.75 - CAMERA_HEIGHT) / 2.0
    assert colour(images[0], column, math.floor(top) - 1)[1] > 100, "the wall above it"


def test_the_depth_image_has_metres_ahead() -> None:
    _, images = heard("/camera/depth/image_raw", IMAGE, 0.3, 0.0, world=ROOM)
    image = images[0]
    assert image.encoding == "32FC1"
    assert depth(image, column_of(4.0, 0.4), 0) == pytest.approx(4.0), "the wall"
    assert depth(image, column_of(2.0, 0.75), HEIGHT // 2) == pytest.approx(2.0), (
        "the box, not the wall behind"
    )
    assert depth(image, column_of(3.0, -0.75), HEIGHT // 2) == pytest.approx(3.0), "the closed door"
    assert depth(image, WIDTH // 2, HEIGHT // 2 + 12) == pytest.approx(1.4, abs=0.01), "the dock"
    floor = FOCAL_LENGTH * CAMERA_HEIGHT / (HEIGHT / 2 - 0.5)
    assert depth(image, 0, HEIGHT - 1) == pytest.approx(floor)


def test_the_depth_of_empty_space_is_infinite() -> None:
    _, images = heard("/camera/depth/image_raw", IMAGE, 0.3, 0.0, world="robots: [{name: robot}]\n")
    assert depth(images[0], 40, 0) == math.inf
    assert depth(images[0], 40, HEIGHT - 1) < 1.0


def test_the_centre_of_the_depth_image_equals_the_laser_range() -> None:
    text = ROOM.replace("{name: robot}", "{name: robot, pose: {yaw_degrees: 70}}")
    world, images = heard("/camera/depth/image_raw", IMAGE, 0.3, 0.0, world=text)
    for column, beam in ((WIDTH // 2, 180), (0, 210), (WIDTH - 1, 150)):
        slope = (column + 0.5 - WIDTH / 2) / FOCAL_LENGTH
        seen = depth(images[0], column, HEIGHT // 2) * math.sqrt(1.0 + slope * slope)
        assert seen == pytest.approx(world.scan("robot")[beam], rel=0.02)


def test_another_robot_and_a_person_are_seen() -> None:
    text = """\
robots:
  - {name: robot}
  - {name: other, namespace: other, pose: {x: 1.5, y: 0}}
people:
  - {name: anna, path: [[2, 1]]}
"""
    _, images = heard("/camera/depth/image_raw", IMAGE, 0.3, 0.0, world=text)
    assert depth(images[0], WIDTH // 2, HEIGHT // 2 + 2) == pytest.approx(1.5 - 0.17, abs=0.01)
    assert depth(images[0], column_of(2.0, 1.0), 10) < 2.0, "a person is taller than the camera"


def test_an_open_door_is_invisible() -> None:
    text = ROOM.replace("[3, -0.5]]", "[3, -0.5]], open: true")
    _, images = heard("/camera/depth/image_raw", IMAGE, 0.3, 0.0, world=text)
    assert depth(images[0], column_of(3.0, -0.75), HEIGHT // 2) == pytest.approx(4.0)


def test_the_camera_info_has_the_focal_length() -> None:
    _, infos = heard("/camera/camera_info", "sensor_msgs/msg/CameraInfo", 0.3, 0.0, world=ROOM)
    assert list(infos[0].k) == pytest.approx([FOCAL_LENGTH, 0, 40, 0, FOCAL_LENGTH, 30, 0, 0, 1])
    assert list(infos[0].p) == pytest.approx([FOCAL_LENGTH, 0, 40, 0, 0, FOCAL_LENGTH, 30, 0, 0, 0, 1, 0])
    assert pytest.approx(WIDTH / 2 / math.tan(math.radians(30))) == FOCAL_LENGTH
