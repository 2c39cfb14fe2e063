"""The four settings of the workshop's problems: agents solve them, and the checker finds errors."""

import importlib.util
import shutil
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest
from examples_lab import falsified, world_with

from jacaros.artifacts import Session
from jacaros.robots.world import GroundTruth
from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, Verdict, run_project

FOLDER = Path(__file__).parents[2] / "experiment" / "workshop"
WORLD, FAILURES = FOLDER / "building.yaml", FOLDER / "failures.yaml"
TEA = "  - {name: tea, x: -3.7, y: 0.6, color: green}\n"
JAMMED = "faults:\n  jammed: {{kind: stuck_door, door: cold_closet, at: 0{}}}\n"
LONGEST = 1500.0
"""Seconds of the virtual clock; the longest run takes 260."""


@cache
def checker() -> ModuleType:
    spec = importlib.util.spec_from_file_location("check_workshop", FOLDER / "check.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(
    setting: str,
    seed: int = 0,
    faults: Path | None = None,
    world: Path | None = None,
    folder: Path = FOLDER,
) -> RunResult:
    project = folder / setting / f"{setting.partition('_')[2]}.jcm"
    result = run_project(project, seed=seed, faults=faults, world=world, seconds=LONGEST)
    assert result.errors == []
    assert result.seconds < LONGEST
    return result


def check(setting: str, truth: GroundTruth) -> Verdict:
    verdict: Verdict = checker().check(truth, checker().GOALS[setting])
    return verdict


def solve(setting: str, seed: int = 0, faults: Path | None = None, world: Path | None = None) -> RunResult:
    result = run(setting, seed, faults, world)
    assert result.exit_code == 0
    assert check(setting, result.ground_truth).complaints == []
    return result


# The settings.


def test_a_thing_is_fetched() -> None:
    assert solve("1_fetch").lines == ["[robot] the tea is in its place: counter"]


@pytest.mark.slow
def test_waste_is_carried_into_a_closed_closet_in_a_closed_room() -> None:
    assert check("2_waste", waste()).complaints == []
    assert doors_opened(waste()) == ["waste_room", "waste_closet"]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_things_are_searched_for_though_actions_fail(seed: int) -> None:
    solve("3_search", seed, FAILURES)


@pytest.mark.slow
def test_things_are_found_in_the_other_closets(tmp_path: Path) -> None:
    swapped = world_with(tmp_path, WORLD, "milk, x: -3.5,", "milk, x: -2,")
    swapped = world_with(tmp_path, swapped, "flour, x: -2,", "flour, x: -3.5,")
    assert doors_opened(solve("3_search", world=swapped).ground_truth) == ["cold_closet", "dry_closet"]


@pytest.mark.slow
def test_the_robot_recharges_when_the_battery_does_not_last() -> None:
    assert "charging_room" in doors_opened(solve("4_battery", 0, FAILURES).ground_truth)


@cache
def waste() -> GroundTruth:
    truth: GroundTruth = run("2_waste").ground_truth
    return truth


def doors_opened(truth: GroundTruth) -> list[str]:
    return [event.data["door"] for event in truth.events_of("door_opened")]


# What cannot be done, or not as thought.


@pytest.mark.slow
def test_a_thing_is_looked_for_where_it_is_not_believed_to_be(tmp_path: Path) -> None:
    moved = world_with(tmp_path, WORLD, TEA, "")
    moved = world_with(tmp_path, moved, "{name: flour,", "{name: tea,")
    result = solve("1_fetch", world=moved)
    assert result.of("robot") == ["no tea at the shelf", "the tea is in its place: counter"]


@pytest.mark.slow
def test_a_thing_that_is_nowhere_is_reported(tmp_path: Path) -> None:
    result = run("1_fetch", world=world_with(tmp_path, WORLD, TEA, ""))
    missed, asked = result.of("robot")
    assert missed == "no tea at the shelf"
    assert asked.startswith("question 1: I am stuck: the tea is nowhere. I believe: ")
    assert result.exit_code == 1
    assert check("1_fetch", result.ground_truth).complaints == ["the tea is not in the counter"]


@pytest.mark.slow
def test_a_door_that_stays_closed_is_reported(tmp_path: Path) -> None:
    faults = tmp_path / "faults.yaml"
    faults.write_text(JAMMED.format(""), encoding="utf-8")
    result = run("3_search", faults=faults)
    (line,) = result.of("robot")
    assert line.startswith("question 1: I am stuck: ")
    assert "the door 'cold_closet' is stuck" in line
    assert result.exit_code == 1


@pytest.mark.slow
def test_a_door_that_a_person_has_mended_is_gone_through(tmp_path: Path) -> None:
    def person_comes(mas: System) -> None:
        person = Session(mas.environment, "person")
        mas.clock.call_later(150.0, lambda: person.begin("answer", 1, "retry", artifact="operator"))

    project, faults = FOLDER / "3_search" / "search.jcm", JAMMED.format(", for: 140")
    result = run_project(project, faults=faults, seconds=LONGEST, when_started=person_comes)
    assert result.of("robot")[0].startswith("question 1: I am stuck: ")
    assert check("3_search", result.ground_truth).complaints == []
    assert result.exit_code == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("setting", "old", "new", "complaint"),
    [
        ("3_search", "attempts(15).", "attempts(1).", "the flour is not in the counter"),
        ("4_battery", "low_at(40).", "low_at(0).", "0 recharges, not 1"),
    ],
)
def test_the_failures_are_such_that_care_is_needed(
    tmp_path: Path, setting: str, old: str, new: str, complaint: str
) -> None:
    careless = tmp_path / "workshop"
    shutil.copytree(FOLDER, careless)
    world_with(careless, careless / "carrier.asl", old, new)
    result = run(setting, faults=FAILURES, folder=careless)
    assert complaint in check(setting, result.ground_truth).complaints


# The checker on runs that went otherwise.


@pytest.mark.slow
def test_the_checker_sees_what_is_not_in_its_place() -> None:
    last = waste().events_of("placed")[-1]
    elsewhere = falsified(waste(), event=lambda e: e._replace(data={**e.data, "x": 0.0}) if e is last else e)
    assert check("2_waste", elsewhere).complaints == ["the box is not in the waste_closet"]
    carried = falsified(waste(), event=lambda e: None if e is last else e)
    assert check("2_waste", carried).complaints == ["the box is not in the waste_closet"]


@pytest.mark.slow
def test_the_checker_sees_an_open_closet_and_doors_that_move_by_themselves() -> None:
    left_open = falsified(waste(), event=lambda e: e if e.kind != "door_closed" else None)
    assert check("2_waste", left_open).complaints == ["the door of the waste_closet is open"]
    apart = falsified(waste(), event=lambda e: e._replace(x=3.0) if e.kind == "door_closed" else e)
    (complaint,) = check("2_waste", apart).complaints
    assert complaint.startswith("the door of the waste_closet moved with the robot 5.")


@pytest.mark.slow
def test_the_checker_sees_what_goes_through_a_closed_door() -> None:
    closed = falsified(waste(), event=lambda e: None if e.data.get("door") == "waste_closet" else e)
    assert check("2_waste", closed).complaints == [
        "the can was placed through the closed door of the waste_closet",
        "the box was placed through the closed door of the waste_closet",
    ]
