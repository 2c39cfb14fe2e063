"""Grey images in the format PGM (binary, one byte for each pixel), in which ROS keeps maps."""

import re
from dataclasses import dataclass

_HEADER = re.compile(rb"P5(?:\s|#[^\n]*\n)+(\d+)(?:\s|#[^\n]*\n)+(\d+)(?:\s|#[^\n]*\n)+(\d+)\s")
"""Width, height and the shade of white, with comments between them."""


@dataclass(frozen=True, slots=True)
class Image:
    """A grey image.

    Attributes:
        width, height: columns and rows.
        white: the largest shade.
        pixels: shades, the rows from the top.
    """

    width: int
    height: int
    white: int
    pixels: bytes

    def row(self, number: int) -> bytes:
        """Return a row, counted from the top."""
        return self.pixels[number * self.width : (number + 1) * self.width]


def read_pgm(data: bytes) -> Image:
    """Read an image; raises `ValueError` if the data are something else, or cut off."""
    header = _HEADER.match(data)
    if header is None:
        raise ValueError("the image is not a binary PGM (P5)")
    width, height, white = (int(each) for each in header.groups())
    if not 0 < white < 256:
        raise ValueError(f"the image has shades up to {white}; expected one byte for each pixel")
    pixels = data[header.end() : header.end() + width * height]
    if len(pixels) < width * height:
        raise ValueError(f"the image is cut off: {len(pixels)} of {width * height} pixels")
    return Image(width, height, white, pixels)


def pgm(image: Image) -> bytes:
    """Return an image as the content of a file."""
    return b"P5\n%d %d\n%d\n" % (image.width, image.height, image.white) + image.pixels
