"""Maps as ROS's map_server keeps them: the YAML header, and the grey image."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any, Final

from jacaros.runtime.files.texts import LARGEST, close_matches, file_bytes
from jacaros.runtime.files.yaml import YamlNode

WHITE_LEVEL = 255
_NUMBER = re.compile(rb"(?:\s|#[^\r\n]*+)*+(\d{1,9})")
"""A number of the header, behind blanks and comments."""
_PNG = b"\x89PNG"
_KNOWN = ((b"\xff\xd8", "JPEG"), (b"BM", "BMP"), (b"GIF8", "GIF"))
_HEADER = ("width", "height", "largest value")


class ImageError(Exception):
    """An image that cannot be used; ``str()`` says why, and `help` how to fix it."""

    def __init__(self, message: str, help: str) -> None:
        super().__init__(message)
        self.help = help


@dataclass(frozen=True, slots=True)
class GreyImage:
    """Pixels from 0 (black) to 255 (white), in rows from the top."""

    width: int
    height: int
    pixels: bytes


def read_image(path: Path) -> GreyImage:
    """Read a PGM file, binary (P5) or as text (P2), or a PNG file.

    Raises:
        OSError: it does not exist, or cannot be read.
        ImageError: it is not an image of these kinds, or incomplete; or it is a PNG, and Pillow is not installed.
    """
    data = file_bytes(path)
    if data.startswith(_PNG):
        return _read_png(data, path)
    if data[:2] not in (b"P5", b"P2"):
        kind = next(
            (f"a {name} image" for begins, name in _KNOWN if data.startswith(begins)), "something else"
        )
        raise ImageError(
            f"expected a PGM or PNG image, found {kind}", f"magick {path} {path.with_suffix('.pgm')}"
        )
    width, height, largest, start = _header(data)
    count = width * height
    values = data[start + 1 : start + 1 + count] if data[:2] == b"P5" else _written(data[start:], count)
    if len(values) < count:
        raise ImageError(
            f"the image ends after {len(values)} of {count} pixels ({width} x {height})", "save the map again"
        )
    if largest != WHITE_LEVEL:
        values = values.translate(
            bytes(min(WHITE_LEVEL, value * WHITE_LEVEL // largest) for value in range(256))
        )
    return GreyImage(width, height, values)


def _read_png(data: bytes, path: Path) -> GreyImage:
    try:
        pillow = import_module("PIL.Image")
    except ImportError:
        raise ImageError(
            "Pillow, which reads PNG images, is not installed",
            f"pip install 'jacaros[maps]', or magick {path} {path.with_suffix('.pgm')}",
        ) from None
    try:
        image = pillow.open(BytesIO(data))
        if image.width * image.height <= LARGEST:
            image = image.convert("L")
            return GreyImage(image.width, image.height, image.tobytes())
    except Exception as error:  # Pillow raises errors of many kinds, SyntaxError among them
        raise ImageError(f"the PNG image is broken: {error}", "save the map again") from error
    raise ImageError(
        f"the image has more than {LARGEST >> 20} million pixels ({image.width} x {image.height})",
        "use a smaller map, or a coarser resolution",
    )


def _header(data: bytes) -> tuple[int, int, int, int]:
    """Return width, height, largest value, and where the header ends."""
    numbers: list[int] = []
    place = 2
    for what in _HEADER:
        found = _NUMBER.match(data, place)
        if found is None or int(found[1]) == 0:
            raise ImageError(f"header without {what}", "save the map again")
        numbers.append(int(found[1]))
        place = found.end()
    width, height, largest = numbers
    if largest > WHITE_LEVEL:
        raise ImageError(
            "the image has 16 bits a pixel", "save it with 8 bits: magick old.pgm -depth 8 new.pgm"
        )
    return width, height, largest, place


def _written(text: bytes, count: int) -> bytes:
    numbers = re.sub(rb"#[^\r\n]*", b"", text).split()[:count]
    try:
        return bytes(min(WHITE_LEVEL, int(number)) for number in numbers)
    except ValueError:
        raise ImageError("a pixel is not a non-negative integer", "save the map again") from None


def pgm_bytes(image: GreyImage) -> bytes:
    """The content of a binary PGM file."""
    return b"P5\n%d %d\n%d\n" % (image.width, image.height, WHITE_LEVEL) + image.pixels


# The YAML file of a map, as ROS's ``map_server`` reads and writes it: the header of an image.
#
# The keys and their meaning are those of Nav2's ``map_server`` and ROS 1's ``map_server``::
#
# image: office.pgm           # or PNG; its path is relative to this file
# resolution: 0.05            # metres per pixel
# origin: [-10, -5, 0]        # of the lower left corner: metres, and radians
# negate: 0                   # 1: black is free
# occupied_thresh: 0.65       # darker pixels are occupied
# free_thresh: 0.25           # brighter pixels are free; the rest is unknown
# mode: trinary               # or scale, which means the same here; or raw: pixels are percent
#
# Other keys are allowed, such as ``places`` (names and positions in metres), which map servers ignore.


KEYS: Final = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")
_REQUIRED: Final = ("image", "resolution", "origin")

FREE, OCCUPIED, UNKNOWN = 0, 1, 2
"""What a cell of a map is."""
_OCCUPIED_FROM, _FREE_TO = 65, 25
CELLS: Final = bytes(
    FREE if value <= _FREE_TO else OCCUPIED if _OCCUPIED_FROM <= value <= 100 else UNKNOWN
    for value in range(256)
)
"""What the occupancy of a cell (percent) means: the thresholds of both ``map_saver``; negative numbers count from 256."""


def meanings(data: Any) -> bytes:
    """Return what the cells of a ``nav_msgs/msg/OccupancyGrid`` mean: int8 arrays of client libraries without a loop."""
    try:
        view = memoryview(data)
    except TypeError:
        return bytes(value & 255 for value in data).translate(CELLS)
    return (view.tobytes() if view.itemsize == 1 else bytes(value & 255 for value in data)).translate(CELLS)


BLACK, WHITE, GREY = 0, 254, 205
"""Pixels of occupied, free and unknown cells in a written map."""


def header_text(image: str, resolution: float, x: float, y: float) -> str:
    """Return the file of a map that is not rotated; *x* and *y* are the lower left corner, in metres.

    As in ROS 1, the threshold of free cells is just below `GREY`: with the 0.25 of Nav2 a map server takes unknown cells
    for free.
    """
    return (
        f"image: {image}\nmode: trinary\nresolution: {resolution:g}\norigin: [{x:g}, {y:g}, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )


@dataclass(frozen=True, slots=True)
class MapHeader:
    """What the YAML file of a map contains.

    Attributes:
        nodes: the values by key, for further checks.
        image: path of the image, relative to the file; empty after a mistake.
        resolution: side of a pixel, in metres.
        origin: x and y (metres) and heading (radians) of the lower left corner.
        cells: what each of the 256 values of a pixel means.
        places: x and y by name, in metres.
    """

    nodes: Mapping[str, YamlNode]
    image: str
    resolution: float
    origin: tuple[float, float, float]
    cells: bytes
    places: Mapping[str, tuple[float, float]]

    def read(self, image: GreyImage) -> bytes:
        """Return what the cells of the image mean, in rows from the bottom."""
        meant, width = image.pixels.translate(self.cells), image.width
        return b"".join(meant[row * width : (row + 1) * width] for row in reversed(range(image.height)))


def read_header(document: YamlNode) -> MapHeader:
    """Read the header of a map; mistakes are noted at the nodes of the *document*."""
    # Map servers ignore unknown keys; an unknown key that resembles a known one is a mistake.
    given = document.value if isinstance(document.value, dict) else {}
    others = [str(key) for key in given if not close_matches(str(key), KEYS)]
    nodes = document.mapping(*KEYS, *others, required=_REQUIRED)
    places = nodes["places"].entries() if "places" in nodes else ()
    return MapHeader(
        nodes,
        nodes["image"].text() if "image" in nodes else "",
        nodes["resolution"].number(0.001, 10.0, 1.0) if "resolution" in nodes else 1.0,
        _origin(nodes.get("origin")),
        _cells(nodes),
        {name.text(): place.pair() for name, place in places},
    )


def _origin(node: YamlNode | None) -> tuple[float, float, float]:
    usual, help = (0.0, 0.0, 0.0), "write [x, y, yaw] of the lower left corner"
    x, y, yaw = usual if node is None else node.numbers("three", help, usual)
    return x, y, yaw


def _cells(nodes: Mapping[str, YamlNode]) -> bytes:
    inverted = "negate" in nodes and _truth(nodes["negate"])
    raw = "mode" in nodes and nodes["mode"].choice("trinary", "scale", "raw") == "raw"
    occupied = nodes["occupied_thresh"].number(0.0, 1.0, 0.65) if "occupied_thresh" in nodes else 0.65
    free = nodes["free_thresh"].number(0.0, 1.0, 0.25) if "free_thresh" in nodes else min(0.25, occupied)
    if free > occupied:
        nodes.get("free_thresh", nodes["occupied_thresh"]).wrong(
            "'free_thresh' is more than 'occupied_thresh'",
            "free pixels are the bright ones: write 0.25 and 0.65",
        )

    def meaning(pixel: int) -> int:
        dark = (pixel if inverted else 255 - pixel) / 255
        return OCCUPIED if dark > occupied else FREE if dark < free else UNKNOWN

    return CELLS if raw else bytes(map(meaning, range(256)))


def _truth(node: YamlNode) -> bool:
    """Return ``0`` or ``1``, as map_server writes it, or ``false`` or ``true``."""
    return node.truth() if isinstance(node.value, bool) else node.number(0.0, 1.0) == 1.0
