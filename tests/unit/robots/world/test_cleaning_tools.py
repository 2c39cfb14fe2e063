"""Dirt and the tools that remove it: amounts, places, kinds, and the ground truth."""

import math
from pathlib import Path

import pytest

from jacaros.robots.world import GroundTruth, World, WorldError, read_world
from jacaros.robots.world.process import GroundTruthFile

WORLD = """
name: flat
size: [6, 4]
walls:
  - box: {from: [-3, -2], to: [-2, 2]}
rooms:
  hall:
    from: [-3, -2]
    to: [1, 2]
    dirt: {dust: 30, stains: {grams: 8, from: [-0.4, -0.4], to: [0.4, 0.4]}}
  office: {from: [1, -2], to: [3, 2], dirt: {dust: 10}}
robots:
  - name: a
    pose: {x: -1, y: 0}
    tools:
      vacuum: {removes: [dust], rate: 2, reach: 0.5}
      mop: {removes: [stains, dust], rate: 4}
  - {name: b, namespace: b, pose: {x: 2, y: 1}, tools: {vacuum: {removes: [dust], rate: 1}}}
"""


def world(**changes: str) -> World:
    text = WORLD
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    return World.load(text)


def left(world: World) -> dict[tuple[str, str], float]:
    return {(field.room, field.kind): field.grams for field in world.cleaning.fields}


def vacuuming(seconds: float, robots: str = "a", **changes: str) -> World:
    """A world in which some robots have used their vacuum for a while."""
    flat = world(**changes)
    for robot in robots:
        flat.use_tool(robot, "vacuum")
    flat.run(seconds)
    return flat


def test_a_tool_removes_only_its_kinds_of_dirt_at_its_rate() -> None:
    flat = vacuuming(0.5)
    flat.use_tool("a", "")
    flat.run(1.0)
    dust = pytest.approx(29.0)
    assert left(flat) == {("hall", "dust"): dust, ("hall", "stains"): 8.0, ("office", "dust"): 10.0}


def test_dirt_does_not_lie_below_furniture_and_a_standing_robot_cleans_within_its_reach() -> None:
    flat = vacuuming(20.0)
    # 30 g on 3 m x 4 m of free floor are 2.5 g on a square metre; the cells make the circle a little uneven.
    assert 30.0 - left(flat)["hall", "dust"] == pytest.approx(2.5 * math.pi * 0.25, rel=0.05)


def test_the_nearest_dirt_is_removed_first() -> None:
    flat = world()
    (dust, _, _) = flat.cleaning.fields
    before = dust.near(-1.0, 0.0, 0.5)
    flat.use_tool("a", "vacuum")
    flat.run(0.2)
    gone = [apart2 for apart2, cell in before if dust.is_clean(cell)]
    kept = [apart2 for apart2, cell in before if not dust.is_clean(cell)]
    assert len(gone) > 10
    assert max(gone) <= min(kept)


def test_a_driving_robot_cleans_its_path() -> None:
    flat = vacuuming(2.0)
    for _ in range(50):
        flat.command("a", 0.2, 0.0)
        flat.run(0.1)
    way = flat.robot("a").odometer
    assert way > 0.9
    assert 30.0 - left(flat)["hall", "dust"] == pytest.approx(2.5 * (math.pi * 0.25 + way), rel=0.05)


def test_walls_keep_a_tool_in_the_room_of_its_robot() -> None:
    flat = vacuuming(20.0, **{"x: -1, y: 0": "x: 0.9, y: 0"})
    assert left(flat)["office", "dust"] == 10.0
    assert left(flat)["hall", "dust"] < 30.0


def test_two_robots_clean_the_same_dirt() -> None:
    flat = vacuuming(0.1, "ab", **{"x: -1, y: 0": "x: 2, y: 0.6"})
    assert left(flat)["office", "dust"] == pytest.approx(9.7)


def test_a_clean_room_has_exactly_no_dirt_and_one_event() -> None:
    flat = world(**{"reach: 0.5": "reach: 9"})
    flat.use_tool("a", "mop")
    flat.use_tool("a", "vacuum")
    flat.run(16.0)
    assert left(flat)["hall", "dust"] == 0.0
    percents = [event.data["percent"] for event in flat.log if event.kind == "cleaned"]
    assert percents == list(range(99, -1, -1))
    assert flat.ground_truth.dirt["hall", "dust"] == 0.0


def test_an_empty_battery_stops_the_tool() -> None:
    flat = vacuuming(1.0, **{"pose: {x: -1, y: 0}": "battery: {level: 0}"})
    assert left(flat)["hall", "dust"] == 30.0


def test_a_task_starts_the_tool_that_it_names() -> None:
    flat = world()
    flat.log_task("a", "vacuum carpet hall")
    flat.log_task("a", "mop floor hall")
    flat.run(0.001)
    flat.log_task("a", "dance in the hall")
    told = [f"{event.kind} {event.data['tool']}" for event in flat.log if event.kind != "task"]
    assert told == ["tool_started vacuum", "tool_stopped vacuum", "tool_started mop", "tool_stopped mop"]


def test_a_stopped_tool_records_the_remaining_dirt_below_a_whole_percent() -> None:
    flat = vacuuming(0.1)
    assert [event.kind for event in flat.log] == ["tool_started"]
    flat.use_tool("a", "")
    assert [event.kind for event in flat.log] == ["tool_started", "cleaned", "tool_stopped"]
    assert flat.log[1].data["grams"] == left(flat)["hall", "dust"] < 30.0


def test_the_ground_truth_has_the_remaining_dirt(tmp_path: Path) -> None:
    flat = world()
    path = tmp_path / "truth.jsonl"
    with GroundTruthFile(path, flat, 0.0):
        flat.use_tool("a", "vacuum")
        flat.run(0.5)
        during = flat.log[-1].data["grams"]
    assert flat.ground_truth.dirt == left(flat)
    assert flat.ground_truth.dirt["hall", "dust"] < during, "the tool is still on"
    assert GroundTruth.read(path).dirt == flat.ground_truth.dirt


def test_equal_runs_clean_equally() -> None:
    def digest() -> str:
        flat = world()
        flat.use_tool("a", "mop")
        flat.command("a", 0.3, 0.7)
        flat.run(3.0)
        flat.use_tool("a", "")
        return flat.ground_truth.digest()

    assert digest() == digest()


def test_cells_are_created_when_a_tool_comes_near() -> None:
    flat = world()
    flat.run(1.0)
    assert all(field._cells == [] for field in flat.cleaning.fields)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("dust: 10", "dust: much", "'dust' must be a number"),
        ("dust: 10", "dust: -1", "'dust' is -1, but must lie between 0"),
        ("dust: 10", "dust: {from: [0, 0], to: [1, 1]}", "'dust' lacks the key 'grams'"),
        (
            "dust: 10",
            "dust: {grams: 1, from: [0, 0], to: [200, 100]}",
            "covers more than 10000 square metres",
        ),
        ("dirt: {dust: 10}", "dirt: 10", "'dirt' must be a mapping of names to values"),
        ("dirt: {dust: 10}", "dirty: {dust: 10}", "did you mean `dirt`?"),
        ("removes: [dust], rate: 2", "rate: 2", "'vacuum' lacks the key 'removes'"),
        ("removes: [dust], rate: 2", "removes: [], rate: 2", "removes at least one kind of dirt"),
        ("removes: [dust], rate: 2", "removes: dust, rate: 2", "'removes' must be a list"),
        ("reach: 0.5", "reach: 0", "'reach' is 0, but must lie between 0.01 and 10"),
    ],
)
def test_mistakes_in_rooms_and_tools_are_reported(old: str, new: str, message: str) -> None:
    assert old in WORLD
    with pytest.raises(WorldError) as caught:
        read_world(WORLD.replace(old, new, 1))
    assert message in str(caught.value)


def test_a_robot_that_is_carried_does_not_clean_where_it_is_put_down() -> None:
    flat = vacuuming(0.53)
    flat.place("a", -1.0, 1.0)
    flat.run(0.4)
    flat.use_tool("a", "")
    assert left(flat)["hall", "dust"] == pytest.approx(28.96)
    cleaned = flat.ground_truth.events_of("cleaned")
    assert cleaned[-1].data["grams"] == pytest.approx(28.96)
    assert {(event.x, event.y) for event in cleaned} == {(-1.0, 0.0)}
