"""Stays in docks, from the ground truth."""

from jacaros.robots.world import GroundTruth, World
from jacaros.testing import Verdict
from jacaros.testing.paths import judge_recharging, stays

WORLD = """
name: hall
docks: [{name: dock, x: 0.5, y: 0}]
robots:
  - name: r
    battery: {level: 15, drain_per_second: 0.5, charge_per_second: 20}
"""


def drive(world: World, speed: float, turn_rate: float, seconds: float) -> None:
    for _ in range(round(seconds / 0.1)):
        world.command("r", speed, turn_rate)
        world.run(0.1)


def visit(world: World, rest: float) -> GroundTruth:
    """Drive half a metre to the dock, rest there, and drive back."""
    drive(world, 0.25, 0, 2)
    drive(world, 0, 0, rest)
    drive(world, -0.25, 0, 2)
    drive(world, 0, 0, 1)
    return world.ground_truth


def test_a_stay_charges_from_low_to_full() -> None:
    truth = visit(World.load(WORLD), 8)
    (stay,) = stays(truth)
    assert 13 < stay.level < 15
    assert stay.charged
    assert stay.end is not None
    assert 7.5 < stay.end - stay.begin < 9
    verdict = Verdict()
    assert judge_recharging(verdict, truth) == [stay]
    assert verdict.complaints == []


def test_turning_in_the_dock_does_not_make_two_stays_of_one() -> None:
    world = World.load(WORLD)
    drive(world, 0.25, 0, 2)
    drive(world, 0, 0, 6)
    drive(world, 0, 1, 1)
    drive(world, 0, 0, 1)
    (stay,) = stays(world.ground_truth)
    assert stay.end is None


def test_a_stay_with_a_dirty_contact_has_the_level_at_its_begin() -> None:
    faults = "faults:\n  f: {kind: dirty_contact, dock: dock, at: 0}\n"
    (stay,) = stays(visit(World.load(WORLD, faults=faults), 20))
    assert stay.level < 15
    assert stay.charged


def test_leaving_too_early_is_a_complaint() -> None:
    verdict = Verdict()
    judge_recharging(verdict, visit(World.load(WORLD), 2))
    assert len(verdict.complaints) == 1
    assert "before the battery was full" in verdict.complaints[0]


def test_docking_without_need_is_a_complaint() -> None:
    verdict = Verdict()
    judge_recharging(verdict, visit(World.load(WORLD), 8), low=10)
    assert len(verdict.complaints) == 1
    assert "which is not low" in verdict.complaints[0]


def test_an_empty_battery_is_a_complaint() -> None:
    world = World.load(WORLD)
    world.run(40)
    verdict = Verdict()
    assert judge_recharging(verdict, world.ground_truth) == []
    assert verdict.complaints == ["the battery was empty"]
