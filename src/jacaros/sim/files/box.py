"""A ``box`` among the walls of a world file: solid furniture with an optional kind and colour::

box: {from: [2, 2], to: [2.5, 3], kind: table, color: brown}      # or color: "#8b5a2b"
"""

import re

from jacaros.files.yaml import Node
from jacaros.sim.description import Furniture
from jacaros.sim.files.room import corners_of

COLORS = {
    "black": "#202020",
    "blue": "#2f6fb5",
    "brown": "#8b5a2b",
    "gray": "#8c8c8c",
    "green": "#3f8f4f",
    "orange": "#e08a2c",
    "pink": "#e48fb0",
    "purple": "#7a4fa3",
    "red": "#c0392b",
    "white": "#f4f4f4",
    "yellow": "#f2c14e",
}
"""Colour names as ``#rrggbb``."""
_RGB = re.compile(r"#[0-9a-f]{6}")


def read_box(node: Node) -> Furniture:
    """Read a box; its colour becomes ``#rrggbb``."""
    entries = node.mapping("from", "to", "kind", "color", required=("from", "to"))
    kind = entries["kind"].text() if "kind" in entries else ""
    return Furniture(
        corners_of(node, entries), kind, read_color(entries["color"]) if "color" in entries else ""
    )


def read_color(node: Node) -> str:
    """Read a colour, a name or ``#rrggbb``; return it as ``#rrggbb``."""
    text = node.text().lower()
    if text in COLORS or not text:
        return COLORS.get(text, "")
    if not _RGB.fullmatch(text):
        node.wrong(f"'{node.value}' is not a colour", f'write "#rrggbb" or one of: {", ".join(COLORS)}')
    return text
