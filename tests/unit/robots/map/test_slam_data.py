"""ArtSlamData: labels, range of view, routes."""

import math
import random
from collections import deque
from itertools import pairwise

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Atom, Out, Structure
from jacaros.robots.map.cells import Cell
from jacaros.robots.map.routes import route
from jacaros.robots.map.slam_data import ArtSlamData


def cell(*arguments: object) -> Structure:
    return Structure("cell", arguments)


async def label(lab: Lab, artifact: ArtifactId, rows: list[str]) -> None:
    """Write a map: the first row is y = 0; # obstacle, . free, G goal, blank unknown."""
    words = {"#": "obstacle", ".": "free", "G": "goal"}
    for y, row in enumerate(rows):
        for x, sign in enumerate(row):
            if sign != " ":
                await lab.do(artifact, "updateSlamData", x, y, words[sign])


pytestmark = made(ArtSlamData)


async def test_a_range_of_view_shows_all_its_cells(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    """Defect 10: one property took all cells in turn, so a belief base ended with the last one alone."""
    await label(lab, artifact, ["...", ".#.", " .G"])
    await lab.do(artifact, "getVisionRange", 0, 0, 1)
    seen = [(0, 0, "free"), (0, 1, "free"), (1, 0, "free"), (1, 1, "obstacle")]
    assert watcher.holds("cell") == seen
    assert watcher.holds("currentRange") == [([cell(*each) for each in seen],)]
    assert watcher.signals == [("currentRange", each) for each in seen]


async def test_the_next_range_replaces_the_cells_and_reports_only_new_ones(lab: Lab) -> None:
    artifact = await lab.make(ArtSlamData)
    watcher = lab.watch(artifact)
    await label(lab, artifact, ["....."])
    await lab.do(artifact, "getVisionRange", 1, 0, 1)
    told = len(watcher.values("cell"))
    await lab.do(artifact, "updateSlamData", 1, 0, "home")
    await lab.do(artifact, "getVisionRange", 2, 0, 1)
    assert sorted(watcher.holds("cell")) == [(1, 0, "home"), (2, 0, "free"), (3, 0, "free")]
    assert watcher.values("cell")[told:] == [(1, 0, "home"), (3, 0, "free")]
    await lab.do(artifact, "getVisionRange", 50, 50, 1)
    assert watcher.holds("cell") == []
    await lab.do(artifact, "getVisionRange", 2, 0, 99)
    assert len(watcher.holds("cell")) == 5


async def test_nothing_is_written_by_looking(lab: Lab, artifact: ArtifactId) -> None:
    """Defect 10: the original overwrote the cell 0, 0 with test data at each look."""
    await lab.do(artifact, "getVisionRange", 0, 0, 3)
    out = Out()
    await lab.do(artifact, "getSlamData", 0, 0, out)
    assert out.value == Atom("unknown")
    await lab.do(artifact, "updateSlamData", 0, 0, "home")
    await lab.do(artifact, "getSlamData", 0, 0, out)
    assert out.value == "home"


async def test_the_agents_cell_is_shown_and_the_map_can_be_forgotten(lab: Lab) -> None:
    artifact = await lab.make(ArtSlamData)
    watcher = lab.watch(artifact)
    await label(lab, artifact, ["..G"])
    await lab.do(artifact, "updatePos", 1, 0)
    await lab.do(artifact, "getVisionRange", 1, 0, 1)
    await lab.do(artifact, "getRoute")
    assert watcher.holds("pos2d") == [(1, 0), ("me", 1, 0), ("goal", 2, 0)]
    await lab.do(artifact, "clear")
    assert watcher.holds("pos2d") == [(1, 0), ("me", 1, 0)]
    assert watcher.holds("cell") == []
    assert watcher.holds("route") == [([],)]
    assert (await lab.call(artifact, "getRoute")).reason == "no_goal"


async def test_the_range_of_view_signals_each_cell_as_in_the_thesis(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    """Listing B.1: column by column, and again for a cell that was in view before."""
    await label(lab, artifact, ["..", ".#"])
    await lab.do(artifact, "getVisionRange", 0, 0, 1)
    await lab.do(artifact, "getVisionRange", 1, 1, 0)
    cells = [(0, 0, "free"), (0, 1, "free"), (1, 0, "free"), (1, 1, "obstacle"), (1, 1, "obstacle")]
    assert [arguments for _, arguments in watcher.signals] == cells
    assert watcher.holds("currentRange") == [([cell(1, 1, "obstacle")],)]


async def test_objects_have_their_cells_and_obstacles_while_they_are_in_view(lab: Lab) -> None:
    artifact = await lab.make(ArtSlamData)
    watcher = lab.watch(artifact)
    await label(lab, artifact, ["..G", ".#."])
    await lab.do(artifact, "updateSlamData", 0, 1, "home")
    await lab.do(artifact, "updateObject", "robot_2", 5, 5)
    places = {("me", 0, 0), ("goal", 2, 0), ("home", 0, 1)}
    assert objects(watcher) == places | {("robot_2", 5, 5)}
    await lab.do(artifact, "updateObject", "robot_2", 5, 6)
    await lab.do(artifact, "getVisionRange", 0, 0, 1)
    assert objects(watcher) == places | {("robot_2", 5, 6), ("obstacle", 1, 1)}
    await lab.do(artifact, "removeObject", "robot_2")
    await lab.do(artifact, "removeObject", "robot_3")
    await lab.do(artifact, "updateSlamData", 0, 1, "free")
    await lab.do(artifact, "getVisionRange", 9, 9, 1)
    assert objects(watcher) == {("me", 0, 0), ("goal", 2, 0)}
    await lab.do(artifact, "updateSlamData", 1, 0, "free")
    assert isinstance(next(iter(objects(watcher)))[0], Atom)


def objects(watcher: Watcher) -> set[tuple[object, ...]]:
    return {values for values in watcher.holds("pos2d") if len(values) == 3}


async def test_steps_move_the_agent_and_turn_it(lab: Lab, artifact: ArtifactId, watcher: Watcher) -> None:
    await label(lab, artifact, ["...", "..."])
    for step, here in [("moveUp", (0, 1)), ("moveRight", (1, 1)), ("moveDown", (1, 0))]:
        await lab.do(artifact, step)
        assert watcher.holds("pos2d") == [here, ("me", *here)]
    await lab.do(artifact, "getRoute", 2, 0)
    assert watcher.holds("direction") == [("east",)]
    assert watcher.holds("degrees") == [(90,)]
    await lab.do(artifact, "moveLeft")
    await lab.do(artifact, "getRoute", 1, 0)
    assert watcher.holds("degrees") == [(180,)]
    await lab.do(artifact, "updatePos", "north", 1, 0)
    await lab.do(artifact, "getRoute", 2, 0)
    assert watcher.holds("degrees") == [(-90,)]
    await lab.do(artifact, "getRoute", 1, 0)
    assert watcher.holds("direction") == [("reached",)]
    assert (await lab.call(artifact, "updatePos", "up", 1, 0)).reason == 'unknown_direction("up")'


@made(ArtSlamData, Structure("cell_size", (0.5,)))
async def test_the_distance_is_that_since_the_last_question(lab: Lab, artifact: ArtifactId) -> None:
    out, told = Out(), []
    for _ in range(3):
        await lab.do(artifact, "moveUp")
    for place in ((4, 3), (4, 3), (1, 7)):
        await lab.do(artifact, "updatePos", *place)
        await lab.do(artifact, "getDistance", out)
        told.append(out.value)
    assert told == [3.5, 0, 2.5]


async def test_the_map_is_printed_north_at_the_top(lab: Lab) -> None:
    artifact = await lab.make(ArtSlamData, name="map")
    await label(lab, artifact, [".#G", ". .", "..."])
    await lab.do(artifact, "updateSlamData", 2, 2, "unknown")
    await lab.do(artifact, "updateObject", "robot_2", 1, 2)
    await lab.do(artifact, "updatePos", -1, 1)
    await lab.do(artifact, "printSlamData")
    assert lab.logged == ["[map]    2  .R", "[map]    1 @. .", "[map]    0  .#G", "[map]    x -1"]


async def test_a_route_leads_round_obstacles_to_the_goal_and_shows_the_direction(lab: Lab) -> None:
    artifact = await lab.make(ArtSlamData)
    watcher = lab.watch(artifact)
    await label(lab, artifact, ["...", "##.", "G.."])
    out = Out()
    await lab.do(artifact, "getRoute", out)
    way = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2)]
    assert out.value == [cell(*each) for each in way]
    assert watcher.holds("route") == [(out.value,)]
    assert watcher.holds("degrees") == [(0,)]
    await lab.do(artifact, "updatePos", 2, 0)
    await lab.do(artifact, "getRoute", 2, 2)
    assert watcher.holds("degrees") == [(90,)]
    await lab.do(artifact, "getRoute", 2, 1, out)
    assert out.value == [cell(2, 0), cell(2, 1)]


async def test_a_goal_that_cannot_be_reached_fails_and_leaves_the_route(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    await label(lab, artifact, [".#G"])
    for place, told in (((), "2,0"), ((1, 0), "1,0"), ((7, 7), "7,7")):
        assert (await lab.call(artifact, "getRoute", *place)).reason == f"no_route({told})"
    assert watcher.holds("route") == [([],)]


async def test_the_label_of_obstacles_is_an_option(lab: Lab) -> None:
    artifact = await lab.make(ArtSlamData, Structure("obstacle", ("wall",)))
    for x, word in enumerate(["free", "wall", "goal"]):
        await lab.do(artifact, "updateSlamData", x, 0, word)
    assert (await lab.call(artifact, "getRoute")).reason == "no_route(2,0)"


# The search.


def test_a_diagonal_step_does_not_cut_a_corner() -> None:
    free = {(0, 0), (1, 0), (1, 1), (2, 1)}
    assert route(free, (0, 0), (1, 1)) == [(0, 0), (1, 0), (1, 1)]
    assert route(free | {(0, 1)}, (0, 0), (1, 1)) == [(0, 0), (1, 1)]


def test_a_route_to_where_one_is_is_that_cell() -> None:
    assert route(set(), (3, 3), (3, 3)) == [(3, 3)]


@pytest.mark.parametrize("seed", range(10))
def test_routes_are_as_short_as_those_of_an_exhaustive_search(seed: int) -> None:
    chance = random.Random(seed)
    free = {(x, y) for x in range(10) for y in range(10) if chance.random() < 0.7}
    found = route(free, (0, 0), (9, 9))
    shortest = relaxed(free | {(0, 0), (9, 9)}, (0, 0)).get((9, 9))
    if found is None:
        assert shortest is None
        return
    assert found[0] == (0, 0)
    length = sum(math.dist(a, b) for a, b in pairwise(found))
    assert length == pytest.approx(shortest)


def relaxed(free: set[Cell], start: Cell) -> dict[Cell, float]:
    """Costs of all cells, found by relaxing until nothing changes."""
    costs = {start: 0.0}
    waiting = deque([start])
    while waiting:
        x, y = waiting.popleft()
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                there = (x + dx, y + dy)
                if there in free and {(x + dx, y), (x, y + dy)} <= free:
                    cost = costs[(x, y)] + math.hypot(dx, dy)
                    if cost < costs.get(there, math.inf) - 1e-9:
                        costs[there] = cost
                        waiting.append(there)
    return costs


async def test_a_route_along_an_axis_is_a_word_and_how_far_to_turn_for_it(lab: Lab) -> None:
    """The grid navigation of the original system: one axis after the other."""
    artifact = await lab.make(ArtSlamData, "north")
    watcher = lab.watch(artifact)
    told = []
    for current, goal, axis in ((0, -4, "Y"), (0, 3, "x"), (3, 3, "X"), (0, 2, "Y"), (5, 1, "X")):
        await lab.do(artifact, "getRoute", current, goal, axis)
        told.append((*watcher.holds("route")[0], *watcher.holds("degrees")[0]))
    assert told == [("south", 180), ("east", 90), ("reached", 0), ("north", 90), ("west", 90)]
    assert watcher.signals == [("tick_route", ())] * 5
    await lab.do(artifact, "updateProperties", "east", 0)
    await lab.do(artifact, "getRoute", 0, 1, "Y")
    assert watcher.holds("degrees") == [(90,)]
    assert (await lab.call(artifact, "getRoute", 0, 1, "Z")).reason == 'unknown_axis("Z")'
