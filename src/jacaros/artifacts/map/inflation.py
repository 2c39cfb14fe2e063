"""Clearance for the robot: routes avoid cells that are too close to an obstacle."""

import math
from collections.abc import Collection

from jacaros.artifacts.map.cells import Cell


def inflated(passable: set[Cell], blocked: Collection[Cell], radius: float, here: Cell) -> set[Cell]:
    """Return the passable cells whose centres are farther than *radius* from those of obstacles.

    A robot that is already too close to an obstacle may drive away: the passable cells around it stay.

    Args:
        passable: cells that a point could enter.
        blocked: the obstacles.
        radius: in cells; 0 keeps all passable cells.
        here: the robot's cell.
    """
    if radius <= 0.0:
        return passable
    disc = offsets(radius)
    near = {(x + dx, y + dy) for x, y in blocked for dx, dy in disc}
    wide = passable - near
    if here not in wide:
        x, y = here
        around = {(x + dx, y + dy) for dx, dy in offsets(2.0 * radius)}
        wide |= passable & around
    return wide


def offsets(radius: float) -> list[Cell]:
    """Return the cells of a disc around 0, 0; *radius* in cells."""
    reach = math.floor(radius)
    span = range(-reach, reach + 1)
    return [(dx, dy) for dx in span for dy in span if math.hypot(dx, dy) <= radius]
