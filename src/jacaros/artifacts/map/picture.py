"""A map of labelled cells as lines of text."""

from collections.abc import Mapping

from jacaros.artifacts.map.cells import FREE, OBSTACLE, UNKNOWN, Cell, LabelledCells

WIDEST = 200
"""Maximum number of columns and rows, around the agent."""

_SIGNS = {FREE: ".", OBSTACLE: "#", UNKNOWN: " "}


def picture(cells: LabelledCells, things: Mapping[Cell, str], here: Cell) -> list[str]:
    """Draw a map, the highest y first.

    Args:
        cells: the cells to draw.
        things: names of further objects, by cell.
        here: the agent's cell, drawn as ``@``.

    Returns:
        The lines; each begins with the y of its cells, and the last has the x of the first column.
    """
    labels = {cell: cells.label(cell) or UNKNOWN for cell in cells.known()} | dict(things)
    signs = {cell: "#" if label == cells.obstacle else _sign(label) for cell, label in labels.items()}
    signs[here] = "@"
    half = WIDEST // 2
    shown = [cell for cell in signs if max(abs(cell[0] - here[0]), abs(cell[1] - here[1])) <= half]
    left, right = min(x for x, _ in shown), max(x for x, _ in shown)
    bottom, top = min(y for _, y in shown), max(y for _, y in shown)
    lines = [
        f"{y:>4} " + "".join(signs.get((x, y), " ") for x in range(left, right + 1)).rstrip()
        for y in range(top, bottom - 1, -1)
    ]
    return [*lines, f"   x {left}"]


def _sign(label: str) -> str:
    return _SIGNS.get(label) or label[:1].upper() or "?"
