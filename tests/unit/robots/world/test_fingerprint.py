"""The fingerprint of a world: equal on every Python, and different for another seed."""

import pytest

from jacaros.robots.world import World
from jacaros.robots.world.physics.fingerprint import fingerprint
from jacaros.runtime.cli.main import call

WORLD = """
name: two rooms
size: [6, 4]
border: walls
seed: 3
walls:
  - segment: [[0, -2], [0, -0.5]]
  - segment: [[0, 0.5], [0, 2]]
  - box: {from: [1, 1], to: [1.5, 2]}
robots:
  - {name: a, namespace: a, pose: {x: -1, y: 0}, odometry: {noise_per_metre: 0.02, noise_degrees_per_turn: 2}}
  - {name: b, namespace: b, pose: {x: 2, y: 0, yaw_degrees: 180}, laser: {noise: 0.02}}
  - {name: c, namespace: c, pose: {x: -2, y: 1}}
  - {name: d, namespace: d, pose: {x: -2, y: -1}}
"""
EXPECTED = "98cacf317fa5810d1b04d55c9b45ad583edaf9d48168b8da8bb5d5998c7cb3df"


def test_it_is_the_same_on_every_machine() -> None:
    assert fingerprint(World.load(WORLD), 10.0) == EXPECTED


def test_another_seed_gives_another_one() -> None:
    assert fingerprint(World.load(WORLD, 4), 10.0) != EXPECTED


def test_the_command_prints_it(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["sim", "patrol", "--hash", "--for", "2"]) == 0
    assert capsys.readouterr().out.strip() == fingerprint(World.load("patrol"), 2.0)
