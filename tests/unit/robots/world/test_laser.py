"""The laser sweep: exact against brute force."""

import math
import random
from collections.abc import Sequence

import pytest

from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.plane.trigonometry import PI, TWO_PI, sine_cosine
from jacaros.robots.world.data.robot import LaserSettings
from jacaros.robots.world.physics.ranging import Laser


def random_walls(draw: random.Random, count: int) -> list[Segment]:
    place = draw.uniform
    walls = [Segment(place(-7, 7), place(-5, 5), place(-7, 7), place(-5, 5)) for _ in range(count)]
    return [*walls, *Rectangle(-7.0, -5.0, 7.0, 5.0).edges()]


def brute_force(segments: Sequence[Segment], x: float, y: float, yaw: float, beams: int) -> list[float]:
    """Every beam with every wall."""
    sine, cosine = sine_cosine(yaw)
    ranges = []
    for beam in range(beams):
        beam_s, beam_c = sine_cosine(-PI + beam * TWO_PI / beams)
        c, s = cosine * beam_c - sine * beam_s, sine * beam_c + cosine * beam_s
        nearest = math.inf
        for wall in segments:
            ax, ay, bx, by = wall.ax - x, wall.ay - y, wall.bx - x, wall.by - y
            across = c * (by - ay) - s * (bx - ax)
            if across != 0.0:
                distance, place = (ax * by - ay * bx) / across, (ax * s - ay * c) / across
                if distance >= 0.0 and 0.0 <= place <= 1.0:
                    nearest = min(nearest, distance)
        ranges.append(nearest)
    return ranges


@pytest.mark.parametrize("seed", range(6))
def test_the_sweep_equals_brute_force_to_the_last_bit(seed: int) -> None:
    draw = random.Random(seed)
    walls = random_walls(draw, 40)
    laser = Laser(LaserSettings(beams_per_turn=draw.choice([90, 181, 360]), range_max=50.0), "seed", walls)
    for _ in range(10):
        pose = draw.uniform(-6.9, 6.9), draw.uniform(-4.9, 4.9), draw.uniform(-PI, PI)
        assert laser.scan(*pose) == brute_force(walls, *pose, laser.settings.beams_per_turn)


def test_walls_out_of_range_are_skipped_and_no_others() -> None:
    walls = random_walls(random.Random(3), 40)
    far, near = Laser(LaserSettings(), "s", walls), Laser(LaserSettings(range_max=2.0), "s", walls)
    for step in range(20):
        pose = (-3.0 + 0.3 * step, -1.0, 0.05 * step)
        assert near.scan(*pose) == [value if value <= 2.0 else math.inf for value in far.scan(*pose)]


def test_the_field_of_view_is_centred_on_the_heading() -> None:
    laser = Laser(LaserSettings(beams_per_turn=360, field=PI), "seed", [Segment(2.0, -1.0, 2.0, 1.0)])
    assert laser.angle_min == pytest.approx(-PI / 2)
    assert laser.angle_max == pytest.approx(PI / 2)
    ranges = laser.scan(0.0, 0.0, 0.0)
    assert len(ranges) == 181
    assert ranges[90] == pytest.approx(2.0)


def test_another_robot_is_seen_as_a_disc() -> None:
    laser = Laser(LaserSettings(beams_per_turn=360), "seed", [])
    ranges = laser.scan(0.0, 0.0, 0.0, [(3.0, 0.0, 0.5)])
    assert ranges[180] == pytest.approx(2.5)
    seen = [beam for beam, distance in enumerate(ranges) if distance < math.inf]
    half = math.degrees(math.asin(0.5 / 3.0))
    assert seen == [beam for beam in range(360) if abs(beam - 180) <= half]


def test_noise_is_bounded_and_repeats_with_the_seed() -> None:
    settings = LaserSettings(noise=0.02)
    walls = [Segment(2.0, -9.0, 2.0, 9.0)]
    first, again, other = (Laser(settings, seed, walls).scan(0.0, 0.0, 0.0) for seed in ("1", "1", "2"))
    exact = Laser(LaserSettings(), "1", walls).scan(0.0, 0.0, 0.0)
    assert first == again
    assert first != other
    for noisy, true in zip(first, exact, strict=True):
        assert noisy == true == math.inf or abs(noisy - true) <= 0.02
