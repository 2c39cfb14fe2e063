"""Parcels: a Python agent plans the routes, AgentSpeak agents drive them."""

from itertools import pairwise, permutations
from math import dist

import pytest
from examples_lab import checker, falsified, passed, run_of, spoilt, truth_of

from jacaros.robots.world import GroundTruth, RobotEvent
from jacaros.runtime.files.python_modules import ProjectModules
from jacaros.testing import run_project

PROJECT = "08_parcels/parcels.jcm"
check = checker("08_parcels").check


def test_all_parcels_arrive_on_short_ways() -> None:
    passed(check(truth_of(PROJECT)))


def test_the_output_of_the_agents() -> None:
    result = run_of(PROJECT)
    assert result.of("dispatcher")[0] == "8.0 m: hallway, bathroom, kitchen, living_room, hallway"
    assert result.of("robot")[0] == "parcel 3 goes to the kitchen"
    assert "battery full" in result.of("robot")
    assert result.lines[-1] == "[customer] all 14 parcels have arrived"


def test_the_way_is_the_shortest_of_all() -> None:
    (module,) = ProjectModules(checker("08_parcels").__file__.rpartition("/")[0]).load("dispatcher")
    parcels = [("kitchen", "hallway"), ("hallway", "kitchen"), ("bathroom", "living_room")]
    found, way = module.shortest_way(module.Situation("hallway", frozenset(parcels), frozenset({"bathroom"})))
    stops = [("bathroom",), *parcels]
    lengths = []
    for order in permutations([(n, end) for n, stop in enumerate(stops) for end in range(len(stop))]):
        if all(order.index((n, 0)) < order.index((n, 1)) for n, stop in enumerate(stops) if len(stop) == 2):
            rooms = ["hallway", *(stops[n][end] for n, end in order)]
            lengths.append(sum(dist(module.PLACES[a], module.PLACES[b]) for a, b in pairwise(rooms)))
    assert found == pytest.approx(min(lengths))
    assert len(way) == 5


# The checker on runs that went otherwise.


def tasks(truth: GroundTruth) -> list[RobotEvent]:
    return truth.events_of("task")


def test_the_checker_sees_a_parcel_in_the_wrong_room_and_one_left_behind() -> None:
    truth = truth_of(PROJECT)
    wrong = tasks(truth)[2]
    moved = falsified(
        truth, event=lambda e: e._replace(data={**e.data, "room": "hallway"}) if e is wrong else e
    )
    assert check(moved).complaints == ["parcel 3 was unloaded in ['hallway'], not in the kitchen"]
    gone = falsified(truth, event=lambda e: None if e is wrong else e)
    assert check(gone).complaints == ["parcel 3 was unloaded in [], not in the kitchen"]


def test_the_checker_sees_that_no_robot_recharged() -> None:
    false = falsified(truth_of(PROJECT), event=lambda e: e if e.kind != "charging" else None)
    assert "0 recharges, not 1" in check(false).complaints


@pytest.mark.slow
def test_the_checker_sees_long_ways(tmp_path) -> None:
    """A dispatcher that carries one parcel after the other."""
    old = "sorted(situation.wanted()):"
    new = "sorted(situation.aboard or situation.wanted())[:1]:"
    project = spoilt(tmp_path, PROJECT, old, new, "dispatcher.py")
    result = run_project(project, seed=0, seconds=1000)
    assert any("metres driven" in complaint for complaint in check(result.ground_truth).complaints)
