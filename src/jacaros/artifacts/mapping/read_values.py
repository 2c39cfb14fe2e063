"""Reads the values that operations put into messages: parameters, the time, constants, lists of messages."""

from jacaros.artifacts.mapping.declared import Conversion, Source, ValuePart
from jacaros.artifacts.mapping.paths import ALL, HERE, WHOLE, Path
from jacaros.artifacts.mapping.read_fields import (
    ANGLES,
    CONVERSION,
    path_of,
    place_of,
    read_conversion,
    shown,
)
from jacaros.yaml_nodes import Node

_VALUE = ("value", *CONVERSION)
_LIST = ("each", "fields")
_WRITTEN = ("", *ANGLES, "name")
"""What ``as`` can be on the way to a message."""

ALL_OF_IT = -1
"""Number of the part of an element that is all of it."""


def read_values(node: Node, parameters: tuple[str, ...], within_list: bool = False) -> tuple[ValuePart, ...]:
    """The fields of a message by their paths."""
    found = []
    for key, value in node.entries():
        target = path_of(key)
        if target.of_message or ALL in target.steps or HERE in target.steps or not target.steps:
            key.wrong(f"'{target.text}' is no single field", "write a path like pose.position.x or poses[0]")
        found.append(read_value(value, target, parameters, within_list))
    return tuple(found)


def read_value(node: Node, target: Path, parameters: tuple[str, ...], within_list: bool = False) -> ValuePart:
    """One value for *target*."""
    place = place_of(node)
    if not isinstance(node.value, dict):
        source, value, parameter = _source(node, parameters, within_list)
        return ValuePart(target, place, source, value, parameter)
    if "each" in node.value:
        return _list(node, target, parameters)
    if node.value and not set(node.value) & {*_VALUE, *_LIST}:
        inner = next(iter(node.value))
        node.wrong(
            f"'{target.text}' has no fields of its own here", f"write their paths: {target.text}.{inner}: ..."
        )
        return ValuePart(target, place)
    entries = node.mapping(*_VALUE, required=("value",))
    conversion = read_conversion(entries)
    if conversion.kind not in _WRITTEN:
        entries["as"].wrong(
            f"'as: {conversion.kind}' is for fields that an agent reads", f"here: {', '.join(_WRITTEN[1:])}"
        )
        conversion = Conversion()
    if "value" not in entries:
        return ValuePart(target, place, conversion=conversion)
    source, value, parameter = _source(entries["value"], parameters, within_list)
    return ValuePart(target, place, source, value, parameter, conversion)


def _list(node: Node, target: Path, parameters: tuple[str, ...]) -> ValuePart:
    """A list of messages, one for each element of a parameter."""
    entries = node.mapping(*_LIST, required=_LIST)
    parameter = 0
    if "each" in entries:
        source, _, parameter = _source(entries["each"], parameters, within_list=False)
        if source is not Source.PARAMETER:
            entries["each"].wrong("'each' must be a parameter that is a list", "write each: $poses")
    elements = read_values(entries["fields"], parameters, within_list=True) if "fields" in entries else ()
    return ValuePart(target, place_of(node), Source.ELEMENTS, None, parameter, elements=elements)


def _source(node: Node, parameters: tuple[str, ...], within_list: bool) -> tuple[Source, object, int]:
    value = node.value
    if isinstance(value, str) and value.startswith("$"):
        return Source.PARAMETER, None, _parameter(node, str(value)[1:], parameters, within_list)
    if value == "now":
        return Source.NOW, None, 0
    return Source.CONSTANT, constant(node), 0


def _parameter(node: Node, name: str, parameters: tuple[str, ...], within_list: bool) -> int:
    """The number of a parameter; those of an element's parts are $1, $2 and so on, all of it is $0."""
    if within_list:
        if name.isdecimal():
            return int(name) - 1
        node.wrong(
            f"there is no ${name} in an element", "write $1, $2 and so on for its parts, $0 for all of it"
        )
        return ALL_OF_IT
    if name in parameters:
        return parameters.index(name)
    import difflib  # here: only for mistakes

    near = difflib.get_close_matches(name, parameters, 1)
    listed = ", ".join((*parameters, name))
    cure = f"did you mean ${near[0]}?" if near else f"write it into 'parameters': [{listed}]"
    node.wrong(f"the operation has no parameter '{name}'", cure)
    return 0


def constant(node: Node) -> object:
    """A constant: a number, truth value, text, or a list of them."""
    value = node.value
    if isinstance(value, list):
        return [constant(item) for item in node.sequence()]
    if isinstance(value, bool):
        return value
    for kind in (int, float, str):
        if isinstance(value, kind):
            return kind(value)
    node.wrong(
        f"{node.what} must be a number, a text, $parameter or now, not {shown(value)}",
        "for a field of a field write its path, as in linear.x: 0.5",
    )
    return 0


def whole(node: Node, parameters: tuple[str, ...]) -> ValuePart:
    """The value of a node's parameter, or a duration."""
    return read_value(node, WHOLE, parameters)
