"""Maps in the format of ROS's map_server: a YAML file, and beside it an image (PGM; PNG can be read, too).

Places are in a key of their own, ``places``, which map_server ignores.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from jacaros.artifacts.map.cells import FREE, Cell
from jacaros.artifacts.map.grids import Grid
from jacaros.artifacts.map.poses import ORIGIN
from jacaros.artifacts.robots.control import Pose
from jacaros.errors import JacarosError
from jacaros.grey_images import WHITE, GreyImage, ImageError, pgm_bytes, read_image
from jacaros.text_files import file_text
from jacaros.yaml_nodes import Node, Problem, YamlFileError, read_document

_BLACK, _WHITE, _GREY = 0, 254, 205
"""Shades of obstacles, free cells and unknown ones, as map_saver writes them."""

_YAML = """\
image: {image}
mode: trinary
resolution: {resolution:g}
origin: [{x:g}, {y:g}, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


class MapFileError(JacarosError):
    """Raised for a map file that cannot be used."""


def save(file: Path, size: float, labels: Mapping[Cell, str], places: Mapping[str, Cell]) -> None:
    """Write a map: *file*, and an image of the same name that ends with ``.pgm``.

    Args:
        file: ends with ``.yaml``; its folder is made if it does not exist.
        size: side of a cell, in metres.
        labels: the obstacles and the free cells; any label that is not ``free`` is an obstacle.
        places: cells by name.

    Raises:
        OSError: a file cannot be written.
    """
    cells = list(labels) or [(0, 0)]
    left, right = min(x for x, _ in cells), max(x for x, _ in cells)
    bottom, top = min(y for _, y in cells), max(y for _, y in cells)
    width, height = right - left + 1, top - bottom + 1
    pixels = bytearray([_GREY]) * (width * height)
    for (x, y), label in labels.items():
        pixels[(top - y) * width + x - left] = _WHITE if label == FREE else _BLACK
    text = _YAML.format(
        image=file.with_suffix(".pgm").name,
        resolution=size,
        x=round((left - 0.5) * size, 9),
        y=round((bottom - 0.5) * size, 9),
    )
    if places:
        text += "places:\n"
        text += "".join(
            f"  {_quoted(name)}: [{x * size:g}, {y * size:g}]\n" for name, (x, y) in places.items()
        )
    file.parent.mkdir(parents=True, exist_ok=True)
    file.with_suffix(".pgm").write_bytes(pgm_bytes(GreyImage(width, height, bytes(pixels))))
    file.write_text(text, encoding="utf-8")


def _quoted(name: str) -> str:
    return "'" + name.replace("'", "''").replace("\n", " ") + "'"


@dataclass(frozen=True, slots=True)
class Saved:
    """A map from a file.

    Attributes:
        grid: its image.
        places: x and y in metres, by name.
    """

    grid: Grid
    places: Mapping[str, tuple[float, float]]


def load(file: Path) -> Saved:
    """Read a map.

    Raises:
        MapFileError: a file does not exist or cannot be read, or has mistakes.
    """
    try:
        text = file_text(file)
        problems: list[Problem] = []
        header = _Header(read_document(text, problems, "a map"))
        if problems:
            raise YamlFileError(file.name, text, problems)
        image = read_image(file.parent / header.image)
    except ImageError as error:
        raise MapFileError(f"cannot read the map {file}: {error}; {error.cure}") from None
    except (OSError, ValueError, JacarosError) as error:
        raise MapFileError(f"cannot read the map {file}: {error}") from None
    shades = [header.percent(shade / WHITE) for shade in range(WHITE + 1)]
    rows = range(image.height - 1, -1, -1)
    width = image.width
    occupancy = [shades[shade] for row in rows for shade in image.pixels[row * width : (row + 1) * width]]
    return Saved(Grid(header.resolution, width, header.origin, occupancy), header.places)


class _Header:
    """What the YAML file of a map says; its mistakes are noted at the document."""

    def __init__(self, document: Node) -> None:
        keys = document.mapping(required=("image", "resolution", "origin"))

        def number(key: str, default: float) -> float:
            return keys[key].number(0.0, default=default) if key in keys else default

        self.image = keys["image"].text() if "image" in keys else ""
        self.resolution = keys["resolution"].number(0.001, default=1.0) if "resolution" in keys else 1.0
        self.origin = ORIGIN
        if "origin" in keys:
            numbers = [each.number() for each in keys["origin"].sequence()]
            if len(numbers) == 3:
                self.origin = Pose(*numbers)
            else:
                keys["origin"].wrong("'origin' must be x, y and yaw", "write [0, 0, 0]: metres and radians")
        self.negate = number("negate", 0.0) != 0.0
        self.occupied, self.free = number("occupied_thresh", 0.65), number("free_thresh", 0.25)
        places = keys["places"].entries() if "places" in keys else ()
        self.places = {name.text(): place.pair() for name, place in places}

    def percent(self, shade: float) -> int:
        """Return the occupancy that a shade from black (0) to white (1) means."""
        share = shade if self.negate else 1.0 - shade
        return 100 if share > self.occupied else 0 if share < self.free else -1
