"""The ``rooms`` part of a world file: names for parts of the floor, and the dirt in them.

Lengths are metres, dirt is in grams::

    kitchen: {from: [1, 1], to: [3, 3]}
    office:
      from: [3, 1]
      to: [9, 3]
      dirt:
        dust: 40                                              # on the whole floor except below furniture
        stains: {grams: 5, from: [4, 1], to: [5, 2]}          # only in this area
"""

from jacaros.files.yaml import Node
from jacaros.sim.description import Dirt, Rectangle, Room

LARGEST = 10_000.0
"""Largest area of one field of dirt, in square metres: a million cells of 10 cm."""
_MOST = 1e9


def read_rooms(node: Node, _: object) -> tuple[Room, ...]:
    """Read all rooms, in the order of the file."""
    return tuple(_room(name, room) for name, room in node.mapping().items())


def _room(name: str, node: Node) -> Room:
    entries = node.mapping("from", "to", "dirt", required=("from", "to"))
    area = corners_of(node, entries)
    if "dirt" not in entries:
        return Room(name, area)
    return Room(name, area, tuple(_dirt(kind, dirt, area) for kind, dirt in entries["dirt"].entries()))


def _dirt(kind: Node, node: Node, room: Rectangle) -> Dirt:
    if isinstance(node.value, dict):
        entries = node.mapping("grams", "from", "to", required=("grams", "from", "to"))
        grams = entries["grams"].number(0.0, _MOST) if "grams" in entries else 0.0
        area: Rectangle | None = corners_of(node, entries)
    else:
        grams, area = node.number(0.0, _MOST), None
    x_min, y_min, x_max, y_max = area or room
    if (x_max - x_min) * (y_max - y_min) > LARGEST:
        node.wrong(
            f"{node.what} covers more than {LARGEST:g} square metres",
            "give it a smaller area with 'from' and 'to'",
        )
    return Dirt(kind.text(), grams, area)


def read_rectangle(node: Node) -> Rectangle:
    """Read the opposite corners ``from`` and ``to``, in metres."""
    return corners_of(node, node.mapping("from", "to", required=("from", "to")))


def corners_of(node: Node, entries: dict[str, Node]) -> Rectangle:
    """Return the rectangle between the opposite corners ``from`` and ``to`` among the *entries* of a node."""
    if not {"from", "to"} <= entries.keys():
        return Rectangle(0.0, 0.0, 1.0, 1.0)
    ax, ay = entries["from"].pair()
    bx, by = entries["to"].pair()
    if ax == bx or ay == by:
        node.wrong(f"{node.what} has no area", "'from' and 'to' are opposite corners")
    return Rectangle(min(ax, bx), min(ay, by), max(ax, bx), max(ay, by))
