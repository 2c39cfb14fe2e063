"""Foreign maps: occupancy grids of messages, and files in the format of ROS's map_server.

Such a file is YAML, with an image next to it (PGM; PNG can be read, too). Places have a key of their own, ``places``,
which map_server ignores."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jacaros.robots.map.cells import FREE, OBSTACLE, Cell
from jacaros.robots.plane.pose import Pose
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.maps import (
    BLACK,
    GREY,
    OCCUPIED,
    UNKNOWN,
    WHITE,
    GreyImage,
    ImageError,
    header_text,
    meanings,
    pgm_bytes,
    read_header,
    read_image,
)
from jacaros.runtime.files.texts import file_text
from jacaros.runtime.files.yaml import Problem, YamlFileError, read_document


@dataclass(frozen=True, slots=True)
class OccupancyGrid:
    """A grid of free, occupied and unknown cells.

    Attributes:
        resolution: side of a cell, in metres.
        width: cells per row.
        origin: pose of the corner of the first cell.
        cells: what each cell means (see `jacaros.runtime.files.maps`); rows from the bottom.
    """

    resolution: float
    width: int
    origin: Pose
    cells: bytes

    @staticmethod
    def of(message: Any) -> "OccupancyGrid":
        """Read a ``nav_msgs/msg/OccupancyGrid``."""
        info = message.info
        return OccupancyGrid(
            float(info.resolution), int(info.width), Pose.of(info.origin), meanings(message.data)
        )

    def labels(self, size: float) -> dict[Cell, str]:
        """Return free cells and obstacles as cells of another *size* (metres), which must not be smaller.

        A cell is an obstacle if any part of it is, and free if its known parts are free.
        """
        found: dict[Cell, str] = {}
        corner, step = self.origin, self.resolution / size
        sine, cosine = step * math.sin(corner.yaw), step * math.cos(corner.yaw)
        for index, meaning in enumerate(self.cells):
            if meaning != UNKNOWN:
                row, column = divmod(index, self.width)
                u, v = column + 0.5, row + 0.5
                x = corner.x / size + cosine * u - sine * v
                y = corner.y / size + sine * u + cosine * v
                cell = (math.floor(x + 0.5), math.floor(y + 0.5))
                if meaning == OCCUPIED:
                    found[cell] = OBSTACLE
                else:
                    found.setdefault(cell, FREE)
        return found


class MapFileError(JacarosError):
    """Raised for a map file that cannot be used."""


def save(file: Path, size: float, labels: Mapping[Cell, str], places: Mapping[str, Cell]) -> None:
    """Write a map: *file*, and an image of the same name with the suffix ``.pgm``.

    Args:
        file: ends with ``.yaml``; its folder is created if necessary.
        size: side of a cell, in metres.
        labels: the obstacles and the free cells; any label other than ``free`` is an obstacle.
        places: cells by name.

    Raises:
        OSError: a file cannot be written.
    """
    cells = list(labels) or [(0, 0)]
    left, right = min(x for x, _ in cells), max(x for x, _ in cells)
    bottom, top = min(y for _, y in cells), max(y for _, y in cells)
    width, height = right - left + 1, top - bottom + 1
    pixels = bytearray([GREY]) * (width * height)
    for (x, y), label in labels.items():
        pixels[(top - y) * width + x - left] = WHITE if label == FREE else BLACK
    corner = [round((side - 0.5) * size, 9) for side in (left, bottom)]
    text = header_text(file.with_suffix(".pgm").name, size, *corner)
    if places:
        text += "places:\n"
        text += "".join(
            f"  {_quoted(name)}: [{x * size:g}, {y * size:g}]\n" for name, (x, y) in places.items()
        )
    file.parent.mkdir(parents=True, exist_ok=True)
    file.with_suffix(".pgm").write_bytes(pgm_bytes(GreyImage(width, height, bytes(pixels))))
    file.write_text(text, encoding="utf-8", newline="\n")


def _quoted(name: str) -> str:
    return "'" + name.replace("'", "''").replace("\n", " ") + "'"


@dataclass(frozen=True, slots=True)
class Saved:
    """A map from a file.

    Attributes:
        grid: its image.
        places: x and y in metres, by name.
    """

    grid: OccupancyGrid
    places: Mapping[str, tuple[float, float]]


def load(file: Path) -> Saved:
    """Read a map.

    Raises:
        MapFileError: a file does not exist, cannot be read, or has mistakes.
    """
    try:
        text = file_text(file)
        problems: list[Problem] = []
        header = read_header(read_document(text, problems, "a map"))
        if problems:
            raise YamlFileError(file.name, text, problems)
        image = read_image(file.parent / header.image)
    except ImageError as error:
        raise MapFileError(f"cannot read the map `{file}`: {error}; {error.help}") from None
    except (OSError, ValueError, JacarosError) as error:
        raise MapFileError(f"cannot read the map `{file}`: {error}") from None
    grid = OccupancyGrid(header.resolution, image.width, Pose(*header.origin), header.read(image))
    return Saved(grid, header.places)
