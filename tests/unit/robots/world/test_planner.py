"""Planning: checked against a simple search and against the walls; reasons when there is no path."""

import heapq
import itertools
import math
import random
from collections.abc import Sequence

import pytest

from jacaros.robots.plane.path import DIAGONAL, cheapest_path
from jacaros.robots.plane.pose import distance
from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.world import World
from jacaros.robots.world.data.grid import REACH, RESOLUTION, Grid
from jacaros.robots.world.data.world import WorldDescription
from jacaros.robots.world.navigation.driver import Route
from jacaros.robots.world.navigation.planner import (
    GOAL_OCCUPIED,
    GOAL_OUTSIDE_MAP,
    MARGIN,
    NO_VALID_PATH,
    START_OCCUPIED,
    START_OUTSIDE_MAP,
    NavigationFailure,
    Planner,
)

RADIUS = 0.17
SHIPPED = ["empty", "house", "patrol", "two_robots"]


def from_wall(x: float, y: float, walls: Sequence[Segment]) -> float:
    """Return the distance to the nearest wall, by trying all of them."""
    nearest = math.inf
    for ax, ay, bx, by in walls:
        dx, dy = bx - ax, by - ay
        place = max(0.0, min(1.0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)))
        nearest = min(nearest, math.hypot(x - ax - place * dx, y - ay - place * dy))
    return nearest


def dijkstra(weights: Sequence[float], width: int, start: int, goal: int) -> float:
    """Return the cost of the cheapest path, found without an estimate of the rest; infinite without a path."""
    costs, waiting = {start: 0.0}, [(0.0, start)]
    while waiting:
        cost, cell = heapq.heappop(waiting)
        if cost > costs[cell]:
            continue
        for dy in (-1, 0, 1):
            for dx in (-1, 0, 1):
                near = cell + dy * width + dx
                if (dx or dy) and weights[near]:
                    new = cost + (DIAGONAL if dx and dy else 1.0) * weights[near]
                    if new < costs.get(near, math.inf) - 1e-12:
                        costs[near] = new
                        heapq.heappush(waiting, (new, near))
    return costs.get(goal, math.inf)


def cost_of(path: Sequence[int], weights: Sequence[float], width: int) -> float:
    total = 0.0
    for before, after in itertools.pairwise(path):
        (row, column), (to_row, to_column) = divmod(before, width), divmod(after, width)
        assert max(abs(row - to_row), abs(column - to_column)) == 1
        total += (DIAGONAL if row != to_row and column != to_column else 1.0) * weights[after]
    return total


@pytest.mark.parametrize("seed", range(40))
def test_the_search_finds_as_cheap_a_path_as_dijkstra(seed: int) -> None:
    draw = random.Random(seed)
    width, height = draw.randint(4, 30), draw.randint(4, 30)
    weights = [
        0.0
        if row in (0, height - 1) or column in (0, width - 1) or draw.random() < 0.3
        else draw.choice([1.0, 1.0, 1.7, 4.0])
        for row in range(height)
        for column in range(width)
    ]
    inner = [row * width + column for row in range(1, height - 1) for column in range(1, width - 1)]
    start, goal = draw.choice(inner), draw.choice(inner)
    wanted = dijkstra(weights, width, start, goal) if weights[goal] else math.inf
    path = cheapest_path(weights, width, start, goal)
    if path is None:
        assert wanted == math.inf
    else:
        assert (path[0], path[-1]) == (start, goal)
        assert cost_of(path, weights, width) == pytest.approx(wanted)


@pytest.mark.parametrize("name", SHIPPED)
def test_the_clearance_of_a_cell_is_its_distance_from_the_nearest_wall(name: str) -> None:
    world = World.load(name).description
    grid = Grid(world)
    draw = random.Random(name)
    for _ in range(300):
        row, column = draw.randrange(1, grid.height - 1), draw.randrange(1, grid.width - 1)
        cell = row * grid.width + column
        x, y = grid.centre(cell)
        assert grid.cell(x, y) == cell
        if any(box.contains(x, y) for box in world.boxes):
            assert grid.clearance[cell] == 0.0
        else:
            assert grid.clearance[cell] == pytest.approx(min(REACH, from_wall(x, y, world.segments)))


def test_a_slanting_wall_is_measured_too() -> None:
    walls = (Segment(-1.0, -1.5, 1.2, 1.9),)
    grid = Grid(WorldDescription(bounds=Rectangle(-2, -2, 2, 2), segments=walls))
    draw = random.Random(3)
    for _ in range(300):
        x, y = draw.uniform(-1.9, 1.9), draw.uniform(-1.9, 1.9)
        assert grid.clearance_at(x, y) == pytest.approx(min(REACH, from_wall(x, y, walls)), abs=0.03)


def test_a_large_world_gets_larger_cells() -> None:
    grid = Grid(WorldDescription(bounds=Rectangle(-50, -50, 50, 50)))
    assert grid.resolution == 4 * RESOLUTION
    assert grid.width == grid.height == 502


@pytest.mark.parametrize("name", SHIPPED)
def test_paths_keep_clear_of_walls_and_end_at_the_goal(name: str) -> None:
    world = World.load(name).description
    planner, draw, found = Planner(Grid(world), RADIUS), random.Random(name), 0
    bounds = world.bounds
    places = [
        (draw.uniform(bounds.x_min, bounds.x_max), draw.uniform(bounds.y_min, bounds.y_max))
        for _ in range(120)
    ]
    places = [place for place in places if from_wall(*place, world.segments) > RADIUS + MARGIN + RESOLUTION]
    places = [place for place in places if not any(box.contains(*place) for box in world.boxes)]
    for start, goal in itertools.pairwise(places):
        points = planner.plan(start, goal)
        assert (points[0], points[-1]) == (start, goal)
        route = Route(points)
        assert route.length < 2.5 * distance(start, goal) + 0.5
        for step in range(math.floor(route.length / 0.02)):
            assert from_wall(*route.point(0.02 * step), world.segments) > RADIUS + 0.02
        found += 1
    assert found > 20


def test_an_open_floor_is_crossed_straight() -> None:
    planner = Planner(Grid(World.load("empty").description), RADIUS)
    assert planner.plan((-2.0, -1.0), (1.5, 2.0)) == [(-2.0, -1.0), (1.5, 2.0)]


def test_the_path_avoids_an_obstacle_that_is_not_on_the_map() -> None:
    planner = Planner(Grid(World.load("empty").description), RADIUS)
    points = planner.plan((-2.0, 0.0), (2.0, 0.0), [(0.0, 0.05, 0.3)])
    route = Route(points)
    nearest = min(distance(route.point(0.02 * step), (0.0, 0.05)) for step in range(300))
    assert nearest > RADIUS + 0.3 + 0.02
    assert route.length < 4.5


def no_way(start: tuple[float, float], goal: tuple[float, float], *walls: Segment) -> NavigationFailure:
    bounds = Rectangle(-2.0, -2.0, 2.0, 2.0)
    planner = Planner(Grid(WorldDescription(bounds=bounds, segments=walls)), RADIUS)
    with pytest.raises(NavigationFailure) as failure:
        planner.plan(start, goal)
    return failure.value


def test_each_reason_has_nav2s_code() -> None:
    across = Segment(-2.0, 0.0, 2.0, 0.0)
    assert no_way((0, -1), (0, 1), across).code == NO_VALID_PATH
    assert no_way((0, -1), (0, -0.1), across).code == GOAL_OCCUPIED
    assert no_way((0, -1), (5, 0)).code == GOAL_OUTSIDE_MAP
    assert no_way((0, -5), (0, 0)).code == START_OUTSIDE_MAP
    pen = [Segment(*edge) for edge in Rectangle(-0.2, -0.2, 0.2, 0.2).edges()]
    ring = [Segment(*edge) for edge in Rectangle(-0.4, -0.4, 0.4, 0.4).edges()]
    outer = [Segment(*edge) for edge in Rectangle(-0.6, -0.6, 0.6, 0.6).edges()]
    assert no_way((0, 0), (1.5, 1.5), *pen, *ring, *outer).code == START_OCCUPIED
    assert "(5.00, 0.00)" in str(no_way((0, -1), (5, 0)))


def test_a_robot_at_a_wall_can_leave_it() -> None:
    bounds = Rectangle(-2.0, -2.0, 2.0, 2.0)
    planner = Planner(Grid(WorldDescription(bounds=bounds, segments=tuple(bounds.edges()))), RADIUS)
    points = planner.plan((-2.0 + RADIUS, 0.0), (1.0, 0.0))
    assert points[0] == (-2.0 + RADIUS, 0.0)
    assert points[-1] == (1.0, 0.0)


def test_a_route_knows_how_far_the_robot_is() -> None:
    route = Route([(0.0, 0.0), (2.0, 0.0), (2.0, 1.0)])
    assert route.length == 3.0
    assert route.advance((0.5, 0.1)) == pytest.approx(0.1)
    assert route.remaining == pytest.approx(2.5)
    route.advance((0.2, 0.0))
    assert route.done == pytest.approx(0.5), "it never goes back"
    for x in (1.0, 1.5, 2.0):
        route.advance((x, 0.0))
    assert route.advance((2.1, 0.5)) == pytest.approx(0.1)
    assert route.remaining == pytest.approx(0.5)
    assert route.point(2.25) == (2.0, 0.25)
