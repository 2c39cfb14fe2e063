"""Words for the values of fields, for manuals: their kind, unit and rounding, from the definitions of the message types."""

from collections.abc import Sequence

from jacaros.artifacts.mapping.declared import Conversion, FieldPart, Source, ValuePart
from jacaros.artifacts.mapping.interfaces import Interfaces, chosen, constants, constants_by_field
from jacaros.artifacts.mapping.message_units import unit_at
from jacaros.artifacts.mapping.paths import Path, WrongPath, follow
from jacaros.artifacts.mapping.read_fields import ANGLES
from jacaros.artifacts.mapping.taking import octet, owner_of
from jacaros.env.values import text
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.fields import FLOATS, INTEGER_RANGES, FieldType
from jacaros.ros.message import TIMES

_SMALL = ("byte", "char", "int8", "uint8", "int16", "uint16")
"""Types of integers whose range an ordinary value can exceed."""
_FEW = 8
"""So many names of constants are told."""

_UNIT_WORDS = {
    "m": "metres",
    "rad or m": "radians or metres",
    "rad/s or m/s": "radians or metres per second",
    "N m": "newton metres",
    "N m or N": "newton metres or newtons",
    "T": "teslas",
    "Ah": "ampere hours",
    "s": "seconds",
    "m/s": "metres per second",
    "m/s²": "metres per second squared",
    "rad": "radians",
    "rad/s": "radians per second",
    "N": "newtons",
    "V": "volts",
    "A": "amperes",
    "Pa": "pascals",
    "lx": "lux",
    "°C": "degrees Celsius",
}
"""Units of messages as people read them; others stay as they are."""


def word_for_field(
    field: FieldPart, message: FieldType, element: FieldType | None, interfaces: Interfaces
) -> str:
    """What an agent gets of a field: ``number in metres, 2 decimals``; empty when that is not known."""
    root = message if element is None or field.path.of_message else element
    try:
        leaf = follow(field.path, root, interfaces.fields)
        if field.conversion.kind == "object":
            return f"a reference to {leaf}"
        word = _converted(field.conversion, field.path, leaf, root, interfaces)
    except (WrongPath, UnknownInterface):
        return ""
    whole = field.shares is not None or field.conversion.kind in ("count", "min", "max", "mean")
    levels = 0 if whole else field.path.lists + leaf.array
    lists = "list of " * levels if field.path.lists else _list_of(leaf) * levels
    return lists + word


def word_for_value(part: ValuePart, message: FieldType, interfaces: Interfaces) -> str:
    """What an agent gives for a field of a message; empty when that is not known."""
    try:
        leaf = follow(part.target, message, interfaces.fields)
        if part.source is Source.ELEMENTS:
            return _elements(part, FieldType(leaf.base), interfaces)
        word = _converted(part.conversion, part.target, leaf, message, interfaces)
        if word == "whole number" and leaf.base in _SMALL and part.conversion.line is None:
            word += " from {} to {}".format(*INTEGER_RANGES[leaf.base])
    except (WrongPath, UnknownInterface):
        return ""
    return _list_of(leaf) * leaf.array + word


def _list_of(leaf: FieldType) -> str:
    if not leaf.length:
        return "list of "
    return f"list ({leaf.length} elements) of " if leaf.fixed else f"list (at most {leaf.length}) of "


def _elements(part: ValuePart, element: FieldType, interfaces: Interfaces) -> str:
    """A list that fills a list of messages, by the parts of its elements."""
    given = {each.parameter: each for each in part.elements if each.source is Source.PARAMETER}
    words = [word_for_value(each, element, interfaces) or "a value" for _, each in sorted(given.items())]
    return f"list, of each element: {'; '.join(words)}" if words else "list"


def _converted(
    conversion: Conversion, path: Path, leaf: FieldType, root: FieldType, interfaces: Interfaces
) -> str:
    kind = conversion.kind
    if conversion.names:
        return _names([name for _, name in conversion.names])
    if kind == "name":
        owner, last = owner_of(path, root, interfaces)
        return _names(list(chosen(constants(interfaces, owner), last, conversion.prefix)))
    if kind == "atom":
        return "atom"
    if kind == "count":
        return "whole number"
    unit = "radians" if kind in ANGLES else unit_at(path, root, interfaces)
    unit = _UNIT_WORDS.get(unit, unit)
    word = _kind(leaf.base, conversion, "number" if kind in (*ANGLES, "mean") else "", unit)
    limited = not kind and not unit and conversion.line is None and not leaf.is_message
    return word + _limits(path, leaf, root, interfaces) if limited else word


def _limits(path: Path, leaf: FieldType, root: FieldType, interfaces: Interfaces) -> str:
    """What the definition allows: a longest string, the constants of the field."""
    longest = f" of at most {leaf.bound} characters" if leaf.bound else ""
    if path.steps and isinstance(path.steps[-1], str) and path.steps[-1].startswith("."):
        owner, last = owner_of(path, root, interfaces)
        if named := constants_by_field(interfaces, owner).get(last):
            values = [f"{text(octet(value), quoted=True)} = {name}" for name, value in named.items()]
            return f"{longest} ({_listed(values)})"
    return longest


def _kind(base: str, conversion: Conversion, kind: str, unit: str) -> str:
    """A plain value, with its unit and decimals."""
    if base in TIMES:
        kind, unit = "number", "seconds"
    if not kind:
        if base == "bool":
            return "true or false"
        if base == "string":
            return "text"
        if base in INTEGER_RANGES:
            kind = "number" if conversion.line is not None else "whole number"
        elif base in FLOATS:
            kind = "number"
        else:
            return base.rpartition("/")[2]
    return with_unit(kind, _shown_unit(conversion, unit), conversion.digits)


def with_unit(kind: str, unit: str, digits: int | None) -> str:
    """A number: ``number in metres, 2 decimals``, ``whole number in percent``, ``number from 0 to 1``."""
    if digits == 0:
        kind = "whole number"
    told = f" from {unit}" if unit[:1].isdigit() else f" in {unit}" if unit else ""
    return f"{kind}{told}" + (f", {digits} decimal{'s' if digits > 1 else ''}" if digits else "")


def _shown_unit(conversion: Conversion, unit: str) -> str:
    """The unit for the agent: what the mapping says, or else that of the message, unless the mapping scales it."""
    if conversion.unit:
        per_second = unit == "radians per second" and conversion.unit == "degrees"
        return "degrees per second" if per_second else conversion.unit.replace("_", " ")
    return unit if conversion.line is None else ""


def _names(names: Sequence[str]) -> str:
    return f"one of {_listed(names)}"


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words[:_FEW]) + (", ..." if len(words) > _FEW else "")
