"""Read ``fields``: the parts of a message that an agent perceives, and their conversion."""

from typing import Any

from jacaros.artifacts.mapping.declared import Conversion, FieldPart, Place
from jacaros.artifacts.mapping.paths import WHOLE, Path, WrongPath, read_path
from jacaros.artifacts.mapping.units import UNITS, Line, conversion, usual
from jacaros.files.texts import suggestion
from jacaros.files.yaml import Node

ANGLES = ("yaw", "pitch", "roll")
LISTS = ("count", "min", "max", "mean")
KINDS = (*ANGLES, "name", "atom", "object", *LISTS)
CONVERSION = ("as", "prefix", "names", "unit", "message_unit", "scale", "offset")
DOWN = "down"
"""Value of ``round: down``, the next lower integer, so that a battery at 99.7 % does not count as full."""
FIELD = ("path", *CONVERSION, "sample", "round", "otherwise", "dead_band", "name")


def place_of(node: Node) -> Place:
    """Return the position of a value."""
    return Place(node.line, node.column)


def path_of(node: Node, help: str = "") -> Path:
    """Read a path; the whole message after a mistake."""
    if not isinstance(node.value, str):
        node.wrong(
            f"{node.what} must be a path, found {shown(node.value)}",
            help or "write the path of a field, as in pose.x",
        )
        return WHOLE
    try:
        return read_path(node.value)
    except WrongPath as error:
        node.wrong(str(error), error.help)
        return WHOLE


def shown(value: Any) -> str:
    """Format a value of a file for a message."""
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list):
        return "a list"
    return "nothing" if value is None else repr(value)


def read_fields(node: Node) -> tuple[FieldPart, ...]:
    """Read a list of fields; a single one needs no brackets."""
    if isinstance(node.value, list):
        return tuple(read_field(item) for item in node.sequence())
    return (read_field(node),)


def read_field(node: Node) -> FieldPart:
    """Read one field."""
    place = place_of(node)
    if not isinstance(node.value, dict):
        path = path_of(node, "write a path, or a mapping such as {path: pose.orientation, as: yaw}")
        return FieldPart(path, place, name=_name(path))
    if node.value and not any(key in FIELD for key in node.value):
        node.wrong(
            f"{node.what} has no `path`, and `{next(iter(node.value))}` is not a key",
            "write a list of paths, or of mappings such as {path: pose.position.x, name: x}",
        )
        return FieldPart(WHOLE, place)
    entries = node.mapping(*FIELD, required=("path",))
    path = path_of(entries["path"]) if "path" in entries else WHOLE
    band = entries.get("dead_band")
    return FieldPart(
        path,
        place,
        read_conversion(entries),
        _shares(entries["sample"]) if "sample" in entries else None,
        _otherwise(entries["otherwise"]) if "otherwise" in entries else None,
        band.number(0.0) if band is not None else None,
        entries["name"].text() if "name" in entries else _name(path, entries),
    )


def _name(path: Path, entries: dict[str, Node] | None = None) -> str:
    """Return a word for a value, for the manual."""
    kind = entries["as"].value if entries is not None and "as" in entries else ""
    if kind in (*ANGLES, "count", "object"):
        return str(kind)
    names = [step[1:] for step in path.steps if isinstance(step, str) and step.startswith(".")]
    return names[-1] if names else "value"


def read_conversion(entries: dict[str, Node]) -> Conversion:
    """Read the keys that fields of properties and values of operations share."""
    kind = entries["as"].choice(*KINDS) if "as" in entries else ""
    digits, unit = entries.get("round"), entries.get("unit")
    if "prefix" in entries and kind != "name":
        entries["prefix"].wrong("`prefix` needs `as: name`", "add `as: name`")
    return Conversion(
        kind,
        entries["prefix"].text() if "prefix" in entries else "",
        _names(entries["names"]) if "names" in entries else (),
        _line(entries, kind),
        _digits(digits) if digits is not None else None,
        str(unit.value) if unit is not None and isinstance(unit.value, str) and unit.value in UNITS else "",
        "message_unit" in entries,
        digits is not None and digits.value == DOWN,
    )


def _digits(node: Node) -> int:
    return 0 if node.value == DOWN else node.whole(0, 0)


def _names(node: Node) -> tuple[tuple[object, str], ...]:
    found = []
    for key, value in node.entries():
        if not isinstance(value.value, str):
            value.wrong(
                f"the name of {key.value!r} must be a word, found {shown(value.value)}", "write a word"
            )
            continue
        found.append((key.value, str(value.value)))
    return tuple(found)


def _line(entries: dict[str, Node], kind: str) -> Line | None:
    steps = [
        _units(entries, kind),
        Line(_factor(entries["scale"])) if "scale" in entries else None,
        Line(1.0, entries["offset"].number()) if "offset" in entries else None,
    ]
    there = [step for step in steps if step is not None]
    if not there:
        return None
    whole = Line()
    for step in there:
        whole = whole.then(step)
    return whole


def _factor(node: Node) -> float:
    factor = node.number(default=1.0)
    if factor == 0.0:
        node.wrong("`scale` is 0, which removes the value", "write another number")
        return 1.0
    return factor


def _units(entries: dict[str, Node], kind: str) -> Line | None:
    there, here = entries.get("unit"), entries.get("message_unit")
    if there is None:
        if here is not None:
            here.wrong("`message_unit` needs `unit`", "write the agent's unit: unit: metres")
        return None
    wanted = _unit(there)
    if wanted is None:
        return None
    given = usual(wanted) if here is None else _unit(here)
    if given is None:
        return None
    asked, of_message = UNITS[wanted].kind, UNITS[given].kind
    if asked != of_message:
        (here or there).wrong(f"{given} is a unit of {of_message}, but {wanted} of {asked}", _of_kind(asked))
        return None
    if kind in ANGLES and asked != "angle":
        there.wrong(f"`as: {kind}` makes an angle, but {wanted} is a unit of {asked}", _of_kind("angle"))
        return None
    return conversion(given, wanted)


def _of_kind(kind: str) -> str:
    return f"units of {kind} are {', '.join(name for name, each in UNITS.items() if each.kind == kind)}"


def _unit(node: Node) -> str | None:
    if isinstance(node.value, str) and node.value in UNITS:
        return str(node.value)
    meant, listed = suggestion(str(node.value), UNITS), ", ".join(UNITS)
    help = f"{meant} Units: {listed}" if meant else f"units: {listed}"
    node.wrong(f"unknown unit {shown(node.value)}", help)
    return None


def _shares(node: Node) -> tuple[float, ...]:
    if isinstance(node.value, list):
        found = tuple(item.number(0.0, 1.0) for item in node.sequence())
        if not found:
            node.wrong("`sample` is empty", "write the number of elements, or their positions: [0, 0.5, 1]")
        return found or (0.0,)
    count = node.whole(1, 1)
    return tuple(place / (count - 1) for place in range(count)) if count > 1 else (0.0,)


def _otherwise(node: Node) -> float | Path:
    if isinstance(node.value, str):
        return path_of(node)
    return node.number()
