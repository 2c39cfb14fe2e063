"""The cheapest path over the cells of a grid, with eight neighbours per cell."""

import heapq
import math
from collections.abc import Mapping, Sequence

Weights = Sequence[float] | Mapping[int, float]
DIAGONAL = math.sqrt(2.0)


def cheapest_path(
    weights: Weights, width: int, start: int, goal: int, cuts_corners: bool = True
) -> list[int] | None:
    """Find the cheapest path by A*.

    Args:
        weights: cost per metre in each cell: 1 or more, or 0 for blocked cells; the outermost cells must be 0.
        width: columns of the grid.
        start, goal: cells; the start can be a blocked cell.
        cuts_corners: whether a diagonal step may pass a blocked cell; if not, both cells beside it must be free.

    Returns:
        The cells from start to goal, both included; None if there is no path. A step costs its length (in cells) times the
        weight of its second cell. Among equally cheap paths, the result is always the same.
    """
    if not weights[goal]:
        return None
    side = 0 if cuts_corners else 1
    steps = (
        (1, 1.0, 0), (-1, 1.0, 0), (width, 1.0, 0), (-width, 1.0, 0), (width + 1, DIAGONAL, side),
        (width - 1, DIAGONAL, -side), (1 - width, DIAGONAL, side), (-1 - width, DIAGONAL, -side),
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
        for offset, length, side in steps:
            near = cell + offset
            weight = weights[near]
            if not weight or near in done:
                continue
            if side and not (weights[cell + side] and weights[near - side]):
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
