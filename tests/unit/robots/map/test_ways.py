"""Ways of a robot that has a size: inflation, legs, frontiers."""

import math

import pytest

from jacaros.robots.map.cells import Cell
from jacaros.robots.map.routes import Leg, around, frontier, inflated, nearest, next_leg
from jacaros.robots.plane.pose import Pose


def read(rows: list[str], sign: str = ".") -> set[Cell]:
    """The cells with a sign; the first row is y = 0."""
    return {(x, y) for y, row in enumerate(rows) for x, each in enumerate(row) if each == sign}


def test_cells_near_an_obstacle_are_not_entered() -> None:
    rows = [".......", "...#...", ".......", "......."]
    kept = inflated(read(rows), read(rows, "#"), 1.5, (0, 3))
    assert kept == read(["..   ..", "..   ..", "..   ..", "......."])
    assert inflated(read(rows), read(rows, "#"), 0.0, (0, 3)) == read(rows)


def test_a_robot_beside_an_obstacle_can_leave_it() -> None:
    rows = [".......", "...#...", "......."]
    kept = inflated(read(rows), read(rows, "#"), 1.5, (2, 1))
    assert {(2, 1), (1, 1), (2, 0), (2, 2)} <= kept
    assert (3, 1) not in kept


def test_a_leg_goes_as_far_as_the_way_is_straight() -> None:
    way = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 1), (3, 2)]
    free = set(way)
    turn, metres = next_leg(way, free, Pose(0.0, 0.0, math.pi / 2.0), Leg(0.5, 9.0))
    assert (turn, metres) == pytest.approx((-math.pi / 2.0, 1.5))
    assert next_leg(way, free, Pose(0.0, 0.0, 0.0), Leg(0.5, 1.0)) == pytest.approx((0.0, 1.0))
    assert next_leg(way, free, Pose(1.5, 0.0, 0.0), Leg(0.5, 9.0)) == pytest.approx((math.pi / 2.0, 1.0))


def test_a_leg_from_beside_the_way_leads_back_to_it_and_none_from_its_end() -> None:
    way = [(0, 0), (1, 0), (2, 0)]
    turn, metres = next_leg(way, set(way), Pose(0.0, 1.0, 0.0), Leg(1.0, 0.5))
    assert (turn, metres) == pytest.approx((-math.pi / 4.0, math.sqrt(2.0)))
    assert next_leg(way, set(way), Pose(2.1, 0.1, 2.0), Leg(1.0, 9.0)) == (0.0, 0.0)
    assert next_leg([(0, 0)], {(0, 0)}, Pose(0.0, 0.0, 0.0), Leg(1.0, 9.0)) == (0.0, 0.0)


def test_the_frontier_is_where_the_free_ground_ends_at_the_unknown() -> None:
    rows = ["######", "#.... ", "#.... ", "##.###", " # #  "]
    free, known = read(rows), read(rows) | read(rows, "#")
    assert frontier(free, known, 1) == {(4, 1), (4, 2), (2, 3)}
    assert frontier(free, known, 2) == {(4, 1), (4, 2)}
    assert frontier(free, known, 4) == set()


def test_the_nearest_place_to_look_from_is_found_over_enterable_cells() -> None:
    rows = ["........", "###.####", "........"]
    free = read(rows)
    edge = {(0, 2), (7, 0)}
    assert nearest((0, 0), free, edge) in edge
    assert nearest((0, 0), free, {(0, 2)}) == (0, 2)
    assert nearest((0, 0), free - {(3, 1)}, {(0, 2)}) is None
    # Beside a wall in the straight line is not beside it on foot.
    assert (0, 0) not in around({(0, 2)}, free, 2)
    assert around({(0, 2)}, free, 2) == {(0, 2), (1, 2), (2, 2)}
