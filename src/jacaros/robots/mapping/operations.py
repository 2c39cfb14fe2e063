"""What agents do: ``operations``, and the values of their messages, and how they are read."""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any, Literal

from jacaros.robots.mapping.fields import (
    ALL,
    ANGLES,
    AS_IT_IS,
    CONVERSION,
    HERE,
    NAMESPACE,
    NOTHING,
    UNNAMED,
    WHOLE,
    Conversion,
    FieldPart,
    FieldPath,
    FilePosition,
    Written,
    belief_name,
    constant,
    each_of,
    path_of,
    place_of,
    read_conversion,
    read_fields,
    ros_name,
    type_written,
    written,
)
from jacaros.robots.mapping.properties import TopicPart, is_misplaced, positive, read_feedback, read_qos
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.files.texts import close_matches, did_you_mean
from jacaros.runtime.files.yaml import Problem, YamlNode

if TYPE_CHECKING:
    from jacaros.artifacts.env.expectation import Expect


class ValueSource(StrEnum):
    """The source of a value for a message."""

    CONSTANT = "constant"
    PARAMETER = "parameter"
    NOW = "now"
    ELEMENTS = "elements"


@dataclass(frozen=True, slots=True)
class ValuePart:
    """A value for a field of a message.

    Attributes:
        target: path of the field; empty for the value of a node's parameter.
        source: kind of the source.
        value: value of a constant.
        parameter: number of the operation's parameter; within `elements`, number of the element's part, -1 for the
            whole element.
        elements: the values of each message in a list whose elements come from `parameter`.
    """

    target: FieldPath
    place: FilePosition
    source: ValueSource = ValueSource.CONSTANT
    value: object = None
    parameter: int = 0
    conversion: Conversion = AS_IT_IS
    elements: "tuple[ValuePart, ...]" = ()


@dataclass(frozen=True, slots=True)
class Success:
    """The field of a response or result that shows success, its value then, and the reason of failure otherwise; None: the
    usual one."""

    path: FieldPath
    place: FilePosition
    value: object = True
    reason: str | None = None


class OperationKind(StrEnum):
    """The kind of an operation."""

    PUBLISH = "publish"
    SERVICE = "service"
    ACTION = "action"
    SET = "set_parameter"
    REFRESH = "refresh"


@dataclass(frozen=True, slots=True)
class OperationPart:
    """An operation.

    Attributes:
        parameters: names of the inputs.
        target: topic, service, action or parameter of a node.
        type_name: None: found at run time, or not needed.
        values: fields of the message, request or goal; the value of a parameter.
        other_values: alternatives for other versions of the type, tried in turn if ``values`` does not match.
        outputs: fields of the response or result for the output parameters.
        success: None: a field ``success`` if there is one.
        any_success: success is not checked.
        duration: seconds of repeated publishing.
        node: the node whose parameter is set; empty for our own.
        properties: properties that are refreshed.
        feedback: properties from the feedback.
        suspend: effect of suspending the intention on the goal: ``go_on`` or ``cancel``.
        uses: resources that it holds while it runs; empty: those of a motion, if it is one.
        expect: effects on properties, with their places.
        meanwhile: what must hold while it runs, with places.
    """

    name: str
    place: FilePosition
    kind: OperationKind
    parameters: tuple[str, ...] = ()
    target: Written = NOTHING
    type_name: Written | None = None
    values: tuple[ValuePart, ...] = ()
    other_values: tuple[tuple[ValuePart, ...], ...] = ()
    outputs: tuple[FieldPart, ...] = ()
    success: Success | None = None
    any_success: bool = False
    qos: QoS | None = None
    rate: float | None = None
    duration: ValuePart | None = None
    timeout: float | None = None
    feedback: tuple[TopicPart, ...] = ()
    suspend: Literal["go_on", "cancel"] = "cancel"
    node: str = ""
    properties: tuple[Written, ...] = ()
    description: str = ""
    uses: tuple[str, ...] = ()
    expect: "tuple[tuple[FilePosition, Expect], ...]" = ()
    meanwhile: "tuple[tuple[FilePosition, Expect], ...]" = ()


_PARAMETER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
CALL_TIMEOUT = 10.0
"""Default number of seconds that a service may take."""


# Values of messages.

_VALUE = ("value", *CONVERSION)
_LIST = ("each", "fields")
_WRITTEN = ("", *ANGLES, "name")
"""Values of ``as`` on the way to a message."""

ALL_OF_IT = -1
"""Number of the part of an element that means the whole element."""


def read_values(
    node: YamlNode, parameters: tuple[str, ...], within_list: bool = False
) -> tuple[ValuePart, ...]:
    """Read the fields of a message by their paths."""
    found = []
    for key, value in node.entries():
        target = path_of(key)
        if target.of_message or ALL in target.steps or HERE in target.steps or not target.steps:
            text = f"`{target.text}` is not a single field"
            key.wrong(text, "write a path like pose.position.x or poses[0]")
        found.append(read_value(value, target, parameters, within_list))
    return tuple(found)


def read_value(
    node: YamlNode, target: FieldPath, parameters: tuple[str, ...], within_list: bool = False
) -> ValuePart:
    """Read one value for *target*."""
    place = place_of(node)
    if not isinstance(node.value, dict):
        source, value, parameter = _source(node, parameters, within_list)
        return ValuePart(target, place, source, value, parameter)
    if "each" in node.value:
        return _list(node, target, parameters)
    if node.value and not set(node.value) & {*_VALUE, *_LIST}:
        inner = next(iter(node.value))
        text = f"`{target.text}` has no fields of its own here"
        node.wrong(text, f"write their paths: {target.text}.{inner}: ...")
        return ValuePart(target, place)
    entries = node.mapping(*_VALUE, required=("value",))
    conversion = read_conversion(entries)
    if conversion.kind not in _WRITTEN:
        text = f"`as: {conversion.kind}` is for fields that an agent reads"
        entries["as"].wrong(text, f"here: {', '.join(_WRITTEN[1:])}")
        conversion = Conversion()
    if "value" not in entries:
        return ValuePart(target, place, conversion=conversion)
    source, value, parameter = _source(entries["value"], parameters, within_list)
    return ValuePart(target, place, source, value, parameter, conversion)


def _list(node: YamlNode, target: FieldPath, parameters: tuple[str, ...]) -> ValuePart:
    """Read a list of messages, one for each element of a parameter."""
    entries = node.mapping(*_LIST, required=_LIST)
    parameter = 0
    if "each" in entries:
        source, _, parameter = _source(entries["each"], parameters, within_list=False)
        if source is not ValueSource.PARAMETER:
            entries["each"].wrong("`each` must be a parameter that is a list", "write each: $poses")
    elements = read_values(entries["fields"], parameters, within_list=True) if "fields" in entries else ()
    return ValuePart(target, place_of(node), ValueSource.ELEMENTS, None, parameter, elements=elements)


def _source(
    node: YamlNode, parameters: tuple[str, ...], within_list: bool
) -> tuple[ValueSource, object, int]:
    value = node.value
    if isinstance(value, str) and value.startswith("$"):
        return ValueSource.PARAMETER, None, _parameter(node, str(value)[1:], parameters, within_list)
    if value == "now":
        return ValueSource.NOW, None, 0
    help = "for a nested field write its path, as in linear.x: 0.5"
    return ValueSource.CONSTANT, constant(node, "a number, a text, $parameter or now", help), 0


def _parameter(node: YamlNode, name: str, parameters: tuple[str, ...], within_list: bool) -> int:
    """Return the number of a parameter. The parts of an element are $1, $2 and so on, the whole element is $0."""
    if within_list:
        if name.isdecimal():
            return int(name) - 1
        text = f"an element has no part ${name}"
        node.wrong(text, "write $1, $2 and so on for its parts, $0 for the whole element")
        return ALL_OF_IT
    if name in parameters:
        return parameters.index(name)
    near = [f"${each}" for each in close_matches(name, parameters)]
    help = did_you_mean(near, f"add it to `parameters`: [{', '.join((*parameters, name))}]")
    node.wrong(f"the operation has no parameter `{name}`", help)
    return 0


# The keys of each kind of operation, in the order of messages: the fields of the part that a value is read into.

ReadPart = Callable[[YamlNode, OperationPart], dict[str, Any]]


def _into(name: str, read: Callable[[YamlNode], object]) -> ReadPart:
    """Return the reader of a key into one field."""
    return lambda node, part: {name: read(node)}


def _message(node: YamlNode, part: OperationPart) -> dict[str, Any]:
    """Read the content of a message: fields, or a list of them for several versions of its type."""
    if not isinstance(node.value, list):
        return {"values": read_values(node, part.parameters)}
    first, *others = [read_values(each, part.parameters) for each in node.sequence()] or [()]
    return {"values": first, "other_values": tuple(others)}


def _duration(node: YamlNode, part: OperationPart) -> dict[str, Any]:
    spell = read_value(node, WHOLE, part.parameters)
    if spell.source is ValueSource.CONSTANT and not _is_positive(spell.value):
        node.wrong("`duration` must be a number of seconds above zero", "write duration: 2")
    return {"duration": spell}


def _is_positive(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and value > 0


def _answer(node: YamlNode, part: OperationPart) -> dict[str, Any]:
    return {"any_success": True} if node.value == "none" else {"success": _success(node)}


def _value(node: YamlNode, part: OperationPart) -> dict[str, Any]:
    return {"values": (read_value(node, WHOLE, part.parameters),)}


def _properties(node: YamlNode, part: OperationPart) -> dict[str, Any]:
    return {"target": Written("", place_of(node)), "properties": tuple(map(written, each_of(node)))}


def _typed(kind: str) -> ReadPart:
    return _into("type_name", lambda node: type_written(node, kind))


def _outputs(node: YamlNode) -> tuple[FieldPart, ...]:
    fields = read_fields(node)
    for field in fields:
        if field.path.of_message or "i" in field.path.steps:
            node.problems.append(
                field.place.problem("an output has only a path and a conversion", "leave the rest out")
            )
    return fields


def _success(node: YamlNode) -> Success:
    if not isinstance(node.value, dict):
        return Success(path_of(node, "write the field that is true, or {path: code, is: 0}"), place_of(node))
    entries = node.mapping("path", "is", "else", required=("path",))
    if "is" not in entries and "else" not in entries:
        node.wrong(
            "`success` is incomplete", "write {path: code, is: 0}, or {path: stalled, else: nothing_grasped}"
        )
    return Success(
        path_of(entries["path"]) if "path" in entries else WHOLE,
        place_of(node),
        constant(entries["is"]) if "is" in entries else True,
        belief_name(entries["else"]) if "else" in entries else None,
    )


def _uses(node: YamlNode) -> tuple[str, ...]:
    found: list[str] = []
    for item in each_of(node):
        name = item.value
        if not isinstance(name, str):
            item.wrong(f"{item.what} must be the name of a resource, found {name!r}", "write uses: wheels")
        elif not NAMESPACE.fullmatch(name):
            help = "write uses: wheels, or uses: [base, arm]"
            item.wrong(f"invalid resource `{name}`; write a name, such as wheels", help)
        elif name in found:
            item.wrong(f"duplicate resource `{name}`", "leave one of them out")
        else:
            found.append(name)
    return tuple(found)


_SETTINGS = ("within", "else", "no")
"""Keys of an expectation that are not names of properties."""


def _expectations(node: YamlNode, part: OperationPart) -> "tuple[tuple[FilePosition, Expect], ...]":
    """Read what an operation expects: a mapping, or a list of them."""
    from jacaros.artifacts.env.expectation import Expect  # here: few files expect anything

    found = []
    for item in each_of(node):
        named = list(item.entries())
        settings = {name.value: value for name, value in named if name.value in _SETTINGS}
        patterns = [(pair, False) for pair in named if pair[0].value not in _SETTINGS]
        if "no" in settings:
            patterns += [(pair, True) for pair in settings["no"].entries()]
        if not patterns and isinstance(item.value, dict):
            item.wrong(f"{item.what} names no property", "write a property with its values: docked: [true]")
        within = settings["within"].number(minimum=0.0) if "within" in settings else 0.0
        reason = belief_name(settings["else"]) if "else" in settings else None
        for (name, values), signal in patterns:
            given = [_pattern(each, part.parameters) for each in values.sequence()]
            if given or values.value in (None, []):  # otherwise not a list, which is reported
                found.append((place_of(name), Expect(belief_name(name), given, within, reason, signal)))
    return tuple(found)


def _pattern(node: YamlNode, parameters: tuple[str, ...]) -> object:
    from jacaros.artifacts.env import expectation, values

    pattern = values.plain(node.value)
    if (wrong := expectation.mistake_in(pattern, parameters)) is not None:
        node.wrong(*wrong)
    return pattern


def _effects(node: YamlNode, part: OperationPart) -> dict[str, Any]:
    found = _expectations(node, part)
    for place in [place for place, each in found if each.signal]:
        text = "`no` is about signals while the operation runs"
        node.problems.append(place.problem(text, "write it below `meanwhile`"))
    return {"expect": found}


def _parameters(node: YamlNode) -> tuple[str, ...]:
    names: list[str] = []
    for item in node.sequence():
        name = item.value
        if not isinstance(name, str) or not _PARAMETER.fullmatch(name):
            item.wrong(f"{item.what} must be a name, found {name!r}", "write parameters: [x, y]")
        elif name in names:
            item.wrong(f"duplicate parameter `{name}`", "rename one of them")
        else:
            names.append(str(name))
    return tuple(names)


_TARGET = _into("target", ros_name)
_TIMEOUT = _into("timeout", positive)
_OUTPUTS = _into("outputs", _outputs)
KEYS: dict[str, dict[str, ReadPart]] = {
    "publish": {
        "publish": _TARGET,
        "type": _typed("msg"),
        "fields": _message,
        "qos": _into("qos", read_qos),
        "rate": _into("rate", positive),
        "duration": _duration,
    },
    "service": {
        "service": _TARGET,
        "type": _typed("srv"),
        "request": _message,
        "outputs": _OUTPUTS,
        "success": _answer,
        "timeout": _TIMEOUT,
    },
    "action": {
        "action": _TARGET,
        "type": _typed("action"),
        "goal": _message,
        "outputs": _OUTPUTS,
        "success": _answer,
        "feedback": _into("feedback", lambda node: tuple(read_feedback(*pair) for pair in node.entries())),
        "timeout": _TIMEOUT,
        "suspend": _into("suspend", lambda node: node.choice("cancel", "go_on")),
    },
    "set_parameter": {
        "set_parameter": _into("target", written),
        "node": _into("node", lambda node: ros_name(node).text),
        "value": _value,
        "timeout": _TIMEOUT,
    },
    "refresh": {"refresh": _properties},
}
"""The keys of each kind of operation, with their readers; the first names it."""
COMMON: dict[str, ReadPart] = {
    "parameters": _into("parameters", _parameters),
    "description": _into("description", YamlNode.text),
    "uses": _into("uses", _uses),
    "expect": _effects,
    "meanwhile": lambda node, part: {"meanwhile": _expectations(node, part)},
}
_ALL_KEYS = tuple(dict.fromkeys((*COMMON, *(key for kind in KEYS for key in list(KEYS[kind])[1:]))))


def read_operation(name: YamlNode, node: YamlNode) -> OperationPart:
    """Read one operation."""
    part = OperationPart(belief_name(name), place_of(name), OperationKind.REFRESH)
    if is_misplaced(name, node, _ALL_KEYS, "an operation"):
        return replace(part, name=UNNAMED)
    kinds = [kind for kind in KEYS if isinstance(node.value, dict) and kind in node.value]
    if len(kinds) != 1:
        found = f"has {' and '.join(kinds)}" if kinds else "does not name what it does"
        keys = map(str, node.value) if isinstance(node.value, dict) and not kinds else ()
        near = [each for key in keys if key not in _ALL_KEYS for each in close_matches(key, KEYS)]
        help = did_you_mean(near[:1], f"write one of {', '.join(KEYS)}")
        name.wrong(f"the operation `{part.name}` {found}", help)
        return part
    kind, own = OperationKind(kinds[0]), KEYS[kinds[0]]
    readers = {kinds[0]: own[kinds[0]], **COMMON, **own}
    entries = node.mapping(*readers, required=("value",) if kind is OperationKind.SET else ())
    waits = kind in (OperationKind.SERVICE, OperationKind.SET)
    part = replace(part, kind=kind, timeout=CALL_TIMEOUT if waits else None)
    for key in sorted(entries, key=["parameters", *readers].index):
        part = replace(part, **readers[key](entries[key], part))
    _check_keys(part, entries)
    node.problems += _forgotten(part)
    return part


def _check_keys(part: OperationPart, entries: dict[str, YamlNode]) -> None:
    """Report keys without those that they need."""
    if part.kind is OperationKind.REFRESH and "parameters" in entries:
        entries["parameters"].wrong(f"`{part.kind}` takes no parameters", "leave `parameters` out")
    if "duration" in entries and "rate" not in entries:
        entries["duration"].wrong("`duration` needs `rate`", "write messages per second: rate: 10")
    if "rate" in entries and "duration" not in entries:
        entries["rate"].wrong("`rate` needs `duration`", "write seconds: duration: 2, or duration: $seconds")


def _forgotten(part: OperationPart) -> Iterator[Problem]:
    """Yield constants with the name of a parameter that is not used."""
    spell = () if part.duration is None else (part.duration,)
    values = [*part.values, *(each for other in part.other_values for each in other), *spell]
    used = {
        part.parameters[each.parameter]
        for each in values
        if each.source in (ValueSource.PARAMETER, ValueSource.ELEMENTS)
        and each.parameter < len(part.parameters)
    }
    for each in values:
        if each.source is ValueSource.CONSTANT and each.value in part.parameters and each.value not in used:
            text = f"`{each.value}` is a text here, not the parameter"
            yield each.place.problem(text, f"write ${each.value}")
