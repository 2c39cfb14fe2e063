"""Scenario 5: a house to clean."""

from pathlib import Path

import pytest
from examples_lab import (
    EXAMPLES,
    LONGEST,
    checker,
    doing_at,
    falsified,
    passed,
    run,
    run_of,
    spoilt,
    truth_of,
    world_with,
)

import jacaros.robots.world
from jacaros.robots.world import GroundTruth, RobotEvent
from jacaros.testing import run_project

PROJECT = "05_house_cleaning/house_cleaning.jcm"
HOUSE = Path(jacaros.robots.world.__file__).parent / "worlds" / "house.yaml"
check = checker("05_house_cleaning").check


def test_every_task_is_done_in_its_room_and_in_order_and_the_house_is_clean() -> None:
    passed(check(truth_of(PROJECT)))
    assert truth_of(PROJECT).dirt == {
        ("living_room", "dust"): 0.0,
        ("kitchen", "stains"): 0.0,
        ("bathroom", "limescale"): 0.0,
        ("bathroom", "stains"): 0.0,
    }


def test_the_agent_prints_the_tasks() -> None:
    lines = run_of(PROJECT).lines
    assert lines[:5] == [
        "[robot] living Room: vacuum the Carpet",
        "[robot] kitchen: mop the Floor",
        "[robot] bathroom: scrub the Tub",
        "[robot] bathroom: mop the Floor",
        "[robot] hallway: round 1 is done",
    ]
    assert lines[-1] == "[robot] The house is clean: 4 rounds, the battery charged 1 times."


LEVELS = [
    pytest.param(23.5, "driving", id="on the way to the living room"),
    pytest.param(25.5, "standing", id="vacuuming the carpet"),
    pytest.param(26.75, "turning", id="swinging in the living room"),
    pytest.param(29, "driving", id="on the way to the kitchen"),
    pytest.param(32.1, "standing", id="mopping the kitchen"),
    pytest.param(38.1, "standing", id="between scrubbing the tub and mopping the floor"),
    pytest.param(39.25, "standing", id="mopping the bathroom"),
    pytest.param(39.8, "turning", id="leaving the bathroom"),
    pytest.param(42, "driving", id="on the way to the hallway"),
]
"""Percent at the beginning, and what the robot is doing when its agent sees that the battery is low."""


@pytest.mark.slow
@pytest.mark.parametrize(("level", "doing"), LEVELS)
def test_the_battery_may_get_low_anywhere(level: float, doing: str, tmp_path: Path) -> None:
    world = world_with(tmp_path, HOUSE, "level: 100", f"level: {level}")
    assert doing_at("battery low", PROJECT, "rounds(1)", world) == doing
    result = run(PROJECT, "rounds(1)", world)
    assert check(result.ground_truth, rounds=1).complaints == []


@pytest.mark.slow
def test_the_bathroom_floor_is_mopped_after_the_recharge_when_the_tub_was_scrubbed_before(tmp_path: Path):
    world = world_with(tmp_path, HOUSE, "level: 100", "level: 38.1")
    truth = run(PROJECT, "rounds(1)", world).ground_truth
    story = [event.data.get("task", event.kind) for event in truth.events_of("task", "charging")]
    assert story[2:4] == ["scrub tub bathroom", "charging"]
    assert story[-1] == "mop floor bathroom"


@pytest.mark.slow
def test_the_program_alone_runs_in_the_world_of_the_command_line() -> None:
    alone = run("05_house_cleaning/robot.asl", "rounds(1)", HOUSE)
    assert check(alone.ground_truth, rounds=1, recharges=0).passed


OVER_NAV2 = EXAMPLES.parent / "experiment/agents/house_cleaning/house_cleaning.jcm"


def aborted(seconds: float) -> str:
    """A fault file: navigation aborts its goals for that time."""
    return f"faults:\n  f: {{kind: aborted_action, action: /navigate_to_pose, at: 3, for: {seconds}}}\n"


@pytest.mark.slow
def test_over_nav2_it_comes_back_to_a_room_that_was_out_of_reach() -> None:
    result = run_project(OVER_NAV2, faults=aborted(60), seconds=LONGEST)
    help, *arrivals = result.lines
    assert help.startswith("[robot] I need help, or come back later: place 1 is out of reach")
    assert arrivals[:4] == ["[robot] room 2", "[robot] room 3", "[robot] hallway", "[robot] room 1"]
    tasks_done = [event.data["task"] for event in tasks(result.ground_truth)]
    assert tasks_done.count("vacuum carpet living_room") == 4
    assert result.exit_code == 0


@pytest.mark.slow
def test_over_nav2_a_room_that_is_left_out_makes_the_exit_status_1(tmp_path: Path) -> None:
    world = world_with(
        tmp_path, HOUSE, "{from: [2.75, 1.6], to: [3.2, 3.2]", "{from: [1.5, 1.5], to: [3.2, 3.2]"
    )
    result = run_project(OVER_NAV2, world=world, seconds=LONGEST)
    assert result.lines[-1] == "[robot] I need help: place 2 was left out"
    assert len(tasks(result.ground_truth)) == 12, "the other rooms are clean"
    assert result.exit_code == 1


# The checker on runs that went otherwise.


@pytest.mark.slow
def test_the_checker_sees_a_robot_that_does_not_go_back_into_the_room(tmp_path: Path) -> None:
    project = spoilt(tmp_path, PROJECT, "     !return.\n", "     .print(lost).\n")
    world = world_with(tmp_path, HOUSE, "level: 100", "level: 37.9")
    result = run_project(project, world=world, seconds=68)
    complaints = check(result.ground_truth, rounds=1).complaints
    assert complaints == [
        "the robot did 'mop floor bathroom' in the kitchen",
        "the robot did 'mop floor bathroom' 1.4 m from the corner of the bathroom",
        "11.5 g of the limescale in the bathroom are left, not 10.5",
        "36.0 g of the stains in the bathroom are left, not 27.0",
    ]


def cleaned(event: RobotEvent, room: str, dirt: str) -> bool:
    return event.kind == "cleaned" and (event.data["room"], event.data["dirt"]) == (room, dirt)


@pytest.mark.slow
def test_nothing_is_cleaned_between_leaving_for_the_dock_and_the_return(tmp_path: Path) -> None:
    world = world_with(tmp_path, HOUSE, "level: 100", "level: 32.1")  # leaves while it mops the kitchen
    truth = run(PROJECT, "rounds(1)", world).ground_truth
    (stopped, started) = [
        event.time for event in truth.events_of("tool_stopped", "tool_started") if event.data["tool"] == "mop"
    ][1:3]
    mopped = [event for event in truth.events if cleaned(event, "kitchen", "stains")]
    assert started - stopped > 20.0
    assert [event for event in mopped if stopped < event.time < started] == []
    assert {round(event.data["grams"]) for event in mopped if event.time == stopped} != {26}
    assert round(mopped[-1].data["grams"], 1) == 26.0, "2.5 s at 4 g/s, the pause not counted"


def test_the_checker_sees_dirt_that_is_left_or_cleaned_from_afar() -> None:
    truth = truth_of(PROJECT)
    false = falsified(
        truth,
        event=lambda e: e if not cleaned(e, "kitchen", "stains") or e.data["percent"] > 2 else None,
    )
    assert check(false).complaints == ["1.0 g of the stains in the kitchen are left, not 0.0"]
    wrong = next(event for event in truth.events if cleaned(event, "kitchen", "stains"))
    false = falsified(truth, event=lambda e: e._replace(y=1.5) if e is wrong else e)
    assert check(false).complaints == ["the robot cleaned the kitchen 0.5 m from its corner"]


def tasks(truth: GroundTruth) -> list[RobotEvent]:
    return truth.events_of("task")


def test_the_checker_sees_a_task_done_in_another_room_or_outside_of_all() -> None:
    truth = truth_of(PROJECT)
    wrong = tasks(truth)[2]
    false = falsified(
        truth, event=lambda e: e._replace(data={**e.data, "room": "kitchen"}) if e is wrong else e
    )
    assert check(false).complaints == ["the robot did 'scrub tub bathroom' in the kitchen"]
    wrong = tasks(truth)[0]
    false = falsified(truth, event=lambda e: e._replace(data={**e.data, "room": None}) if e is wrong else e)
    assert not check(false).passed


def test_the_checker_sees_tasks_in_the_wrong_order_left_out_or_unwanted() -> None:
    truth = truth_of(PROJECT)
    scrub, mop = tasks(truth)[2:4]

    def swapped(event: RobotEvent) -> RobotEvent:
        if event is scrub:
            return event._replace(data=mop.data)
        return event._replace(data=scrub.data) if event is mop else event

    assert not check(falsified(truth, event=swapped)).passed
    last = tasks(truth)[-1]
    assert (
        check(falsified(truth, event=lambda e: e if e is not last else None)).complaints[0]
        == "15 tasks, not 16"
    )


def test_the_checker_sees_an_unwanted_task() -> None:
    more = RobotEvent(199.0, "turtlebot", "task", 0, 0, 0, {"task": "mop floor hallway", "room": "hallway"})
    assert not check(falsified(truth_of(PROJECT), more=[more])).passed
    assert not check(falsified(truth_of(PROJECT), event=lambda e: e if e.kind != "task" else None)).passed


def test_the_checker_sees_an_empty_battery() -> None:
    empty = RobotEvent(100.0, "turtlebot", "battery_empty", 0.0, 1.0, 0.0, {"level": 0})
    assert check(falsified(truth_of(PROJECT), more=[empty])).complaints == ["the battery was empty"]
    false = falsified(truth_of(PROJECT), event=lambda e: e if e.kind != "charging" else None)
    assert check(false).complaints == ["0 recharges, not 1"]
    truth = truth_of(PROJECT)
    second_round = tasks(truth)[4].time
    false = falsified(truth, lambda s: s if s.time > second_round else s._replace(y=s.y + 0.1 * (s.y < 0.5)))
    assert not check(false).passed
