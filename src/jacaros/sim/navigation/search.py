"""A* on a grid: the cheapest way between two cells, eight neighbours a cell."""

import heapq
import math
from collections.abc import Sequence

DIAGONAL = math.sqrt(2.0)


def cheapest_path(weights: Sequence[float], width: int, start: int, goal: int) -> list[int] | None:
    """Find the cheapest path.

    Args:
        weights: what a metre costs in each cell: 1 or more, or 0 where nobody may go; the outermost cells must be 0.
        width: columns of the grid.
        start, goal: cells; the start may be one where nobody may go.

    Returns:
        The cells from start to goal, both included; None when there is no way.  A step costs its length (in cells)
        times the weight of the cell it leads to.  Of ways that cost the same, always the same one is found.
    """
    if not weights[goal]:
        return None
    steps = (
        (1, 1.0), (-1, 1.0), (width, 1.0), (-width, 1.0),
        (width + 1, DIAGONAL), (width - 1, DIAGONAL), (1 - width, DIAGONAL), (-1 - width, DIAGONAL),
    )  # fmt: skip
    goal_row, goal_column = divmod(goal, width)
    costs = {start: 0.0}
    origins: dict[int, int] = {}
    done: set[int] = set()
    waiting = [(0.0, start)]
    while waiting:
        _, cell = heapq.heappop(waiting)
        if cell == goal:
            return _back(origins, start, goal)
        if cell in done:
            continue
        done.add(cell)
        cost_here = costs[cell]
        for offset, length in steps:
            near = cell + offset
            weight = weights[near]
            if not weight or near in done:
                continue
            cost = cost_here + length * weight
            if cost < costs.get(near, math.inf):
                costs[near] = cost
                origins[near] = cell
                row, column = divmod(near, width)
                dx, dy = abs(column - goal_column), abs(row - goal_row)
                short, long = (dx, dy) if dx < dy else (dy, dx)
                heapq.heappush(waiting, (cost + long + (DIAGONAL - 1.0) * short, near))
    return None


def _back(origins: dict[int, int], start: int, goal: int) -> list[int]:
    path = [goal]
    while path[-1] != start:
        path.append(origins[path[-1]])
    path.reverse()
    return path
