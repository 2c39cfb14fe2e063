"""Maps of ROS's map_server (a YAML file and an image) as walls, and worlds as maps.

The keys are those of `jacaros.runtime.files.maps`; the origin must not be rotated.

Unknown cells are not walls: laser beams and robots pass through them.
"""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from jacaros.robots.plane.shapes import Rectangle, Segment
from jacaros.robots.world.data.grid import Grid
from jacaros.robots.world.data.world import WorldDescription
from jacaros.runtime.files.maps import (
    BLACK,
    FREE,
    KEYS,
    OCCUPIED,
    UNKNOWN,
    WHITE,
    GreyImage,
    ImageError,
    MapHeader,
    header_text,
    pgm_bytes,
    read_header,
    read_image,
)
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.files.yaml import Problem, YamlNode, read_document, read_text, top_keys

_ROOM_FOR_ROBOT = 0.4
"""Metres of free floor around an automatically placed robot."""
_LATTICE = 0.25
"""Metres between the candidate places for it."""


@dataclass(frozen=True, slots=True)
class OccupancyMap:
    """Cells in rows from the bottom: `FREE`, `OCCUPIED` or `UNKNOWN`.

    ``resolution`` is the side of a cell; ``x_min`` and ``y_min`` are the lower left corner; all in metres.
    """

    resolution: float
    x_min: float
    y_min: float
    width: int
    height: int
    cells: bytes

    @property
    def bounds(self) -> Rectangle:
        """The whole map."""
        return Rectangle(self.x_min, self.y_min, self._x(self.width), self._y(self.height))

    def _x(self, column: int) -> float:
        return self.x_min + column * self.resolution

    def _y(self, row: int) -> float:
        return self.y_min + row * self.resolution

    def boxes(self) -> list[Rectangle]:
        """Return disjoint rectangles that cover the occupied cells."""
        found: list[Rectangle] = []
        open_runs: dict[tuple[int, int], int] = {}
        for row in range(self.height + 1):
            runs = _runs(self._row(row)) if row < self.height else []
            for run in sorted(open_runs.keys() - set(runs)):
                first = open_runs.pop(run)
                found.append(Rectangle(self._x(run[0]), self._y(first), self._x(run[1]), self._y(row)))
            for run in runs:
                open_runs.setdefault(run, row)
        return found

    def walls(self) -> list[Segment]:
        """Return the boundary of the occupied cells: horizontal segments, then vertical ones, each as long as possible."""
        rows = [self._row(row) for row in range(self.height)]
        columns = [self.cells[column :: self.width].translate(_SOLID) for column in range(self.width)]
        return [
            *(Segment(self._x(a), self._y(row), self._x(b), self._y(row)) for row, a, b in _edges(rows)),
            *(Segment(self._x(at), self._y(a), self._x(at), self._y(b)) for at, a, b in _edges(columns)),
        ]

    def known_part(self) -> Rectangle:
        """Return the bounding rectangle of all known cells; the whole map without known cells."""
        known = self.cells.translate(_KNOWN)
        rows = [row for row in range(self.height) if 1 in known[row * self.width : (row + 1) * self.width]]
        columns = [column for column in range(self.width) if 1 in known[column :: self.width]]
        if not rows:
            return self.bounds
        return Rectangle(
            self._x(columns[0]), self._y(rows[0]), self._x(columns[-1] + 1), self._y(rows[-1] + 1)
        )

    def _row(self, row: int) -> bytes:
        return self.cells[row * self.width : (row + 1) * self.width].translate(_SOLID)

    def free_place(self, radius: float) -> tuple[float, float] | None:
        """Find the point nearest to (0, 0), where maps usually begin, with *radius* metres of free cells around."""
        reach = math.ceil(radius / self.resolution)
        step = max(1, math.floor(_LATTICE / self.resolution))
        places = [
            (self._x(column) + 0.5 * self.resolution, self._y(row) + 0.5 * self.resolution, column, row)
            for row in range(reach, self.height - reach, step)
            for column in range(reach, self.width - reach, step)
            if self.cells[row * self.width + column] == FREE
        ]
        for x, y, column, row in sorted(places, key=lambda place: place[0] * place[0] + place[1] * place[1]):
            first, last = column - reach, column + reach + 1
            if not any(
                any(self.cells[each * self.width + first : each * self.width + last])
                for each in range(row - reach, row + reach + 1)
            ):
                return x, y
        return None


_SOLID = bytes(1 if value == OCCUPIED else 0 for value in range(256))
_KNOWN = bytes(0 if value == UNKNOWN else 1 for value in range(256))


def _runs(row: bytes) -> list[tuple[int, int]]:
    """Return the start and end of each run of solid cells."""
    found: list[tuple[int, int]] = []
    begin = row.find(1)
    while begin >= 0:
        end = row.find(0, begin)
        end = len(row) if end < 0 else end
        found.append((begin, end))
        begin = row.find(1, end)
    return found


def _edges(lines: list[bytes]) -> Iterator[tuple[int, int, int]]:
    """Yield the boundary of solid cells between neighbouring lines: the number of the second line, start and end."""
    outside = bytes(len(lines[0]))
    for number, (before, after) in enumerate(itertools.pairwise([outside, *lines, outside])):
        for start, end in _changes(before, after):
            yield number, start, end


def _changes(one: bytes, other: bytes) -> list[tuple[int, int]]:
    """Return the stretches along two rows of cells where always the same one of them is solid and the other is not."""
    if one == other:
        return []
    a, b = int.from_bytes(one), int.from_bytes(other)
    found = _runs((a & ~b).to_bytes(len(one))) + _runs((b & ~a).to_bytes(len(one)))
    return sorted(found)


def is_map(path: Path) -> bool:
    """Return whether a YAML file looks like a map of map_server, with or without mistakes."""
    keys = top_keys(path)
    return "image" in keys and len(keys & set(KEYS)) > 1


def open_document(path: Path, what: str, help: str = "") -> tuple[str, list[Problem], YamlNode | None]:
    """Return the text of a YAML file, the list of all its mistakes, and its content if it is YAML.

    Mistakes that are found in the content are added to the list.
    """
    try:
        text, wrong = read_text(path)
    except OSError as error:
        return "", [Problem(1, 1, f"cannot read the file: {error}", help)], None
    problems = [] if wrong is None else [wrong]
    document = read_document(text, problems, what) if not problems else None
    return text, problems, document if not problems else None


def read_map(path: Path) -> tuple[str, list[Problem], OccupancyMap | None]:
    """Return the text of a map file, all mistakes in it and its image, and the map if it has no mistakes."""
    text, problems, document = open_document(path, "a map", "check that the file exists and its permissions")
    found = _map(read_header(document), path.parent) if document is not None else None
    return text, problems, None if problems else found


def _map(header: MapHeader, folder: Path) -> OccupancyMap | None:
    x_min, y_min, heading = header.origin
    if heading != 0.0:
        header.nodes["origin"].wrong(
            f"the map is rotated by {heading:g} radians", "rotate the image, and write 0 here"
        )
    image = _image(header.nodes["image"], folder / header.image) if header.image else None
    if image is None:
        return None
    return OccupancyMap(header.resolution, x_min, y_min, image.width, image.height, header.read(image))


def free_place(found: OccupancyMap | None, problems: list[Problem]) -> tuple[float, float] | None:
    """Return a free place for a robot; None without one, after adding a problem to *problems*."""
    place = found.free_place(_ROOM_FOR_ROBOT) if found is not None else None
    if found is not None and place is None:
        problems.append(
            Problem(1, 1, "the map has no free place for a robot", "see 'free_thresh' and 'negate'")
        )
    return place


def _image(node: YamlNode, path: Path) -> GreyImage | None:
    try:
        return read_image(path)
    except FileNotFoundError:
        node.wrong(
            f"image not found: `{path}`", near_file(path, "*.pgm") or "its path is relative to the map file"
        )
    except OSError as error:
        node.wrong(f"cannot read the image `{path}`: {error}", "check its permissions")
    except ImageError as error:
        node.wrong(f"image `{path}`: {error}", error.help)
    return None


def near_file(path: Path, pattern: str) -> str:
    """Return a "did you mean" for a file of a similar name next to *path*; empty without one."""
    try:
        return suggestion(path.name, [each.name for each in path.parent.glob(pattern)])
    except (OSError, ValueError):
        return ""


def map_of_world(world: WorldDescription, image: str) -> tuple[str, bytes]:
    """Return the map of a world with open doors: the text of its YAML file, and the bytes of the image named *image*."""
    grid = Grid(world)
    width, height = grid.width - 2, grid.height - 2
    shades = bytes(BLACK if value else WHITE for value in grid.occupancy())
    rows = [shades[row * width : (row + 1) * width] for row in reversed(range(height))]
    text = header_text(image, grid.resolution, grid.x_min, grid.y_min)
    return text, pgm_bytes(GreyImage(width, height, b"".join(rows)))
