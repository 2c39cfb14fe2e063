"""The ``objects`` of a world file, which a robot with a gripper can carry::

objects:
  - {name: cup, x: 1, y: 0.5, radius: 0.03, color: red}
"""

from jacaros.files.yaml import Node
from jacaros.sim.description import ObjectDescription
from jacaros.sim.files.box import read_color


def read_objects(node: Node) -> tuple[ObjectDescription, ...]:
    """Read all objects, in the order of the file; their names must differ."""
    found: list[ObjectDescription] = []
    for item in node.sequence():
        each = _object(item)
        if any(other.name == each.name for other in found):
            item.wrong(f"duplicate object '{each.name}'", "give it another name")
        found.append(each)
    return tuple(found)


def _object(node: Node) -> ObjectDescription:
    entries = node.mapping("name", "x", "y", "radius", "color", required=("name", "x", "y"))
    return ObjectDescription(
        name=entries["name"].text() if "name" in entries else "",
        x=entries["x"].number() if "x" in entries else 0.0,
        y=entries["y"].number() if "y" in entries else 0.0,
        radius=entries["radius"].number(0.005, 0.5, 0.03) if "radius" in entries else 0.03,
        color=read_color(entries["color"]) if "color" in entries else "",
    )
