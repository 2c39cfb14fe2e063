"""Frontier exploration: the border between known free ground and unknown ground (Yamauchi 1997)."""

from collections import deque
from collections.abc import Collection, Iterator

from jacaros.artifacts.map.cells import Cell

_NEXT = ((1, 0), (0, 1), (-1, 0), (0, -1))
_AROUND = (*_NEXT, (1, 1), (-1, 1), (-1, -1), (1, -1))


def frontier(free: Collection[Cell], known: Collection[Cell], least: int) -> set[Cell]:
    """Return the free cells next to an unknown one, without connected pieces of fewer than *least* cells."""
    edge = {
        (x, y)
        for x, y in free
        # Unrolled: a loop over the four neighbours takes three times as long, and maps have 100,000 cells.
        if (x + 1, y) not in known
        or (x - 1, y) not in known
        or (x, y + 1) not in known
        or (x, y - 1) not in known
    }
    kept: set[Cell] = set()
    rest = set(edge)
    while rest:
        piece = set(_spread({rest.pop()}, edge, len(edge), _AROUND))
        rest -= piece
        if len(piece) >= least:
            kept |= piece
    return kept


def around(cells: Collection[Cell], free: Collection[Cell], reach: int) -> set[Cell]:
    """Return the free cells at most *reach* steps over free cells from some cells."""
    return set(_spread(set(cells), free, reach, _AROUND))


def nearest(start: Cell, enterable: Collection[Cell], wanted: Collection[Cell]) -> Cell | None:
    """Return the nearest wanted cell that can be reached over enterable cells, None if none exists."""
    return next((cell for cell in _spread({start}, enterable, len(enterable), _NEXT) if cell in wanted), None)


def _spread(seeds: set[Cell], over: Collection[Cell], reach: int, steps: tuple[Cell, ...]) -> Iterator[Cell]:
    """Yield the cells reached from *seeds*, nearest first, in the same order in every run."""
    seen = set(seeds)
    waiting = deque((cell, 0) for cell in sorted(seeds))
    while waiting:
        (x, y), depth = waiting.popleft()
        yield x, y
        if depth == reach:
            continue
        for dx, dy in steps:
            cell = (x + dx, y + dy)
            if cell in over and cell not in seen:
                seen.add(cell)
                waiting.append((cell, depth + 1))
