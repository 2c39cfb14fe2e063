"""Things in the rooms of a world file: the ``box`` among the walls, solid furniture, and the ``objects`` of grippers."""

import re
from dataclasses import replace

from jacaros.files.entries import read, values
from jacaros.files.yaml import Node
from jacaros.sim.description import Furniture, ObjectDescription
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
    box = Furniture(corners_of(node, entries))
    return replace(box, **values(entries, box, color=read_color))


def read_color(node: Node, _: object) -> str:
    """Read a colour, a name or ``#rrggbb``; return it as ``#rrggbb``."""
    text = node.text().lower()
    if text in COLORS or not text:
        return COLORS.get(text, "")
    if not _RGB.fullmatch(text):
        node.wrong(f"'{node.value}' is not a colour", f'write "#rrggbb" or one of: {", ".join(COLORS)}')
    return text


def read_objects(node: Node, _: object) -> tuple[ObjectDescription, ...]:
    """Read all objects, in the order of the file; their names must differ."""
    found: list[ObjectDescription] = []
    for item in node.sequence():
        each = read(item, ObjectDescription("", 0.0, 0.0), color=read_color)
        if any(other.name == each.name for other in found):
            item.wrong(f"duplicate object '{each.name}'", "give it another name")
        found.append(each)
    return tuple(found)
