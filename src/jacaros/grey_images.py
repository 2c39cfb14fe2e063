"""Grey images, in which ROS's map_server keeps its maps: PGM, and PNG if Pillow is installed."""

import re
from dataclasses import dataclass
from importlib import import_module
from io import BytesIO
from pathlib import Path

from jacaros.text_files import LARGEST, file_bytes

WHITE = 255
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
    if largest != WHITE:
        values = values.translate(bytes(min(WHITE, value * WHITE // largest) for value in range(256)))
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
    if largest > WHITE:
        raise ImageError(
            "the image has 16 bits a pixel", "save it with 8 bits: magick old.pgm -depth 8 new.pgm"
        )
    return width, height, largest, place


def _written(text: bytes, count: int) -> bytes:
    """The pixels of an image in text."""
    numbers = re.sub(rb"#[^\r\n]*", b"", text).split()[:count]
    try:
        return bytes(min(WHITE, int(number)) for number in numbers)
    except ValueError:
        raise ImageError("a pixel is not a non-negative integer", "save the map again") from None


def pgm_bytes(image: GreyImage) -> bytes:
    """The content of a binary PGM file."""
    return b"P5\n%d %d\n%d\n" % (image.width, image.height, WHITE) + image.pixels
