"""The laser sweep: exact against brute force, and bit-identical with and without numpy."""

import math
import os
import random
import subprocess
import sys
from collections.abc import Sequence

import pytest

from jacaros.plane.trigonometry import PI, sine_cosine
from jacaros.sim.description import LaserSettings, Rectangle, Segment
from jacaros.sim.robot.sensors.laser import Laser
from jacaros.sim.robot.sensors.laser_numpy import WallArrays
from jacaros.sim.robot.sensors.laser_plain import Beams, sweep_circles, sweep_walls


def random_walls(draw: random.Random, count: int) -> list[Segment]:
    place = draw.uniform
    walls = [Segment(place(-7, 7), place(-5, 5), place(-7, 7), place(-5, 5)) for _ in range(count)]
    return [*walls, *Rectangle(-7.0, -5.0, 7.0, 5.0).edges()]


def brute_force(segments: Sequence[Segment], x: float, y: float, yaw: float, beams: Beams) -> list[float]:
    """Every beam with every wall."""
    sine, cosine = sine_cosine(yaw)
    ranges = []
    for beam_c, beam_s in zip(beams.cosines, beams.sines, strict=True):
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
def test_the_sweep_equals_brute_force_and_numpy_to_the_last_bit(seed: int) -> None:
    draw = random.Random(seed)
    walls = random_walls(draw, 40)
    beams = Beams(LaserSettings(beams_per_turn=draw.choice([90, 181, 360])))
    arrays = WallArrays(walls, beams)
    for _ in range(10):
        x, y, yaw = draw.uniform(-6.9, 6.9), draw.uniform(-4.9, 4.9), draw.uniform(-PI, PI)
        plain = sweep_walls(walls, x, y, yaw, beams)
        assert plain == brute_force(walls, x, y, yaw, beams)
        assert plain == arrays.sweep(x, y, yaw)


def test_numpy_without_its_processor_paths_gives_the_same_bits() -> None:
    program = (
        "import hashlib, random\n"
        "from jacaros.sim.description import LaserSettings, Segment\n"
        "from jacaros.sim.robot.sensors.laser_plain import Beams\n"
        "from jacaros.sim.robot.sensors.laser_numpy import WallArrays\n"
        "place = random.Random(3).uniform\n"
        "walls = [Segment(*(place(-5, 5) for _ in range(4))) for _ in range(60)]\n"
        "arrays = WallArrays(walls, Beams(LaserSettings()))\n"
        "scans = [arrays.sweep(place(-4, 4), place(-4, 4), place(-3, 3)) for _ in range(20)]\n"
        "print(hashlib.sha256(repr(scans).encode()).hexdigest())\n"
    )
    paths = " ".join(switchable_processor_paths())
    hashes = {
        subprocess.run(
            [sys.executable, "-c", program],
            env={**os.environ, "NPY_DISABLE_CPU_FEATURES": disabled},
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for disabled in ("", paths)
    }
    assert len(hashes) == 1


def switchable_processor_paths() -> list[str]:
    """The processor features that this numpy dispatches on and this processor has."""
    from numpy._core import _multiarray_umath as numpy_core

    features = numpy_core.__cpu_features__
    return [name for name in numpy_core.__cpu_dispatch__ if features.get(name)]


def test_the_middle_beam_hits_a_wall_ahead() -> None:
    laser = Laser(LaserSettings(beams_per_turn=360), [Segment(2.0, -1.0, 2.0, 1.0)], "seed")
    ranges = laser.scan(0.0, 0.0, 0.0)
    assert ranges[180] == pytest.approx(2.0)
    assert ranges[180 + 20] == pytest.approx(2.0 / math.cos(math.radians(20)))
    assert ranges[90] == math.inf
    assert ranges[0] == math.inf


def test_the_field_of_view_is_centred_on_the_heading() -> None:
    beams = Beams(LaserSettings(beams_per_turn=360, field=PI))
    assert beams.last - beams.first == 181
    assert beams.angle_min == pytest.approx(-PI / 2)
    assert beams.angle_max == pytest.approx(PI / 2)
    laser = Laser(LaserSettings(beams_per_turn=360, field=PI), [Segment(2.0, -1.0, 2.0, 1.0)], "seed")
    assert laser.scan(0.0, 0.0, 0.0)[90] == pytest.approx(2.0)


def test_another_robot_is_seen_as_a_disc() -> None:
    beams = Beams(LaserSettings(beams_per_turn=360))
    ranges = [math.inf] * 360
    sweep_circles(ranges, [(3.0, 0.0, 0.5)], 0.0, 0.0, 0.0, beams)
    assert ranges[180] == pytest.approx(2.5)
    seen = [beam for beam, distance in enumerate(ranges) if distance < math.inf]
    half = math.degrees(math.asin(0.5 / 3.0))
    assert seen == [beam for beam in range(360) if abs(beam - 180) <= half]


def test_noise_is_bounded_and_repeats_with_the_seed() -> None:
    settings = LaserSettings(noise=0.02)
    walls = [Segment(2.0, -9.0, 2.0, 9.0)]
    first, again, other = (Laser(settings, walls, seed).scan(0.0, 0.0, 0.0) for seed in ("1", "1", "2"))
    exact = Laser(LaserSettings(), walls, "1").scan(0.0, 0.0, 0.0)
    assert first == again
    assert first != other
    for noisy, true in zip(first, exact, strict=True):
        assert noisy == true == math.inf or abs(noisy - true) <= 0.02


def test_nothing_is_detected_out_of_range() -> None:
    laser = Laser(LaserSettings(range_max=1.5), [Segment(2.0, -1.0, 2.0, 1.0)], "seed")
    assert set(laser.scan(0.0, 0.0, 0.0)) == {math.inf}


def test_two_lasers_with_and_without_numpy_agree_in_a_world_with_robots() -> None:
    walls = random_walls(random.Random(9), 30)
    others = [(1.0, 1.0, 0.17), (-2.0, 0.5, 0.17)]
    plain = Laser(LaserSettings(noise=0.01), walls, "s", with_numpy=False)
    fast = Laser(LaserSettings(noise=0.01), walls, "s", with_numpy=True)
    for step in range(20):
        pose = (-3.0 + 0.1 * step, -1.0, 0.05 * step)
        assert plain.scan(*pose, others) == fast.scan(*pose, others)


def test_without_numpy_a_laser_in_a_large_world_sees_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    walls = [(float(x), -9.0, float(x), 9.0) for x in range(2, 12)]
    with_numpy = Laser(LaserSettings(), walls, "s").scan(0.0, 0.0, 0.3)
    monkeypatch.setitem(sys.modules, "jacaros.sim.robot.sensors.laser_numpy", None)
    laser = Laser(LaserSettings(), walls, "s")
    assert [laser.scan(0.0, 0.0, 0.3), laser.scan(0.0, 0.0, 0.3)] == [with_numpy] * 2
