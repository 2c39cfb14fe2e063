"""Read ``operations``, and the values of their messages: parameters, the time, constants, lists of messages."""

import dataclasses
import re
from collections.abc import Callable, Iterator
from typing import Any

from jacaros.artifacts.mapping.declared import (
    ALL,
    HERE,
    WHOLE,
    Conversion,
    FieldPart,
    OperationKind,
    OperationPart,
    Path,
    Source,
    Success,
    ValuePart,
    Written,
)
from jacaros.artifacts.mapping.read_fields import (
    ANGLES,
    CONVERSION,
    NAMESPACE,
    UNNAMED,
    belief_name,
    constant,
    each_of,
    path_of,
    place_of,
    read_conversion,
    read_fields,
    ros_name,
    type_written,
)
from jacaros.artifacts.mapping.read_properties import is_misplaced, positive, read_feedback, read_qos
from jacaros.files.texts import close_matches, did_you_mean
from jacaros.files.yaml import Node, Problem

_COMMON = ("parameters", "description", "uses")
KEYS: dict[str, tuple[str, ...]] = {
    "publish": ("type", "fields", "qos", "rate", "duration", "at_end", "match_timeout", "unmatched"),
    "service": ("type", "request", "outputs", "success", "timeout"),
    "action": ("type", "goal", "outputs", "success", "feedback", "timeout", "suspend", "code", "aborted"),
    "set_parameter": ("node", "value", "timeout"),
    "get_parameter": ("node", "outputs", "timeout"),
    "refresh": (),
    "read": (),
}
"""The keys of each kind of operation."""
_ALL_KEYS = tuple(dict.fromkeys((*_COMMON, *(key for keys in KEYS.values() for key in keys))))

_SUSPEND = ("go_on", "cancel")

_PARAMETER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
CALL_TIMEOUT = 10.0
"""Default number of seconds that a service may take."""

Reader = Callable[[OperationPart, dict[str, Node]], OperationPart]


def read_operation(name: Node, node: Node) -> OperationPart:
    """Read one operation."""
    part = OperationPart(belief_name(name), place_of(name), OperationKind.REFRESH)
    if is_misplaced(name, node, _ALL_KEYS, "an operation"):
        return dataclasses.replace(part, name=UNNAMED)
    kinds = [kind for kind in KEYS if isinstance(node.value, dict) and kind in node.value]
    if len(kinds) != 1:
        found = f"has {' and '.join(kinds)}" if kinds else "does not name what it does"
        written = map(str, node.value) if isinstance(node.value, dict) and not kinds else ()
        near = [each for key in written if key not in _ALL_KEYS for each in close_matches(key, KEYS)]
        help = did_you_mean(near[:1], f"write one of {', '.join(KEYS)}")
        name.wrong(f"the operation `{part.name}` {found}", help)
        return part
    kind = OperationKind(kinds[0])
    entries = node.mapping(
        kind.value, *_COMMON, *KEYS[kind.value], required=("value",) if kind is OperationKind.SET else ()
    )
    part = dataclasses.replace(
        part,
        kind=kind,
        parameters=_parameters(entries["parameters"]) if "parameters" in entries else (),
        description=entries["description"].text() if "description" in entries else "",
        uses=_uses(entries["uses"]) if "uses" in entries else (),
    )
    part = _READERS[kind](part, entries)
    node.problems += _forgotten(part)
    return part


def _uses(node: Node) -> tuple[str, ...]:
    """Read the resources that an operation holds."""
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


def _forgotten(part: OperationPart) -> Iterator[Problem]:
    """Yield constants with the name of a parameter that is not used."""
    ends = () if part.at_end is None else part.at_end
    spell = () if part.duration is None else (part.duration,)
    values = [*part.values, *(each for other in part.other_values for each in other), *ends, *spell]
    used = {
        part.parameters[each.parameter]
        for each in values
        if each.source in (Source.PARAMETER, Source.ELEMENTS) and each.parameter < len(part.parameters)
    }
    for each in values:
        if each.source is Source.CONSTANT and each.value in part.parameters and each.value not in used:
            yield each.place.problem(
                f"`{each.value}` is a text here, not the parameter", f"write ${each.value}"
            )


def _parameters(node: Node) -> tuple[str, ...]:
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


def _filled(node: Node | None, parameters: tuple[str, ...]) -> dict[str, Any]:
    """Read the content of a message: fields, or a list of them for several versions of its type."""
    if node is None:
        return {}
    if not isinstance(node.value, list):
        return {"values": read_values(node, parameters)}
    first, *others = [read_values(each, parameters) for each in node.sequence()] or [()]
    return {"values": first, "other_values": tuple(others)}


def _publish(part: OperationPart, entries: dict[str, Node]) -> OperationPart:
    rate, duration = entries.get("rate"), entries.get("duration")
    if rate is None and duration is not None:
        duration.wrong("`duration` needs `rate`", "write messages per second: rate: 10")
    if rate is not None and duration is None:
        rate.wrong("`rate` needs `duration`", "write seconds: duration: 2, or duration: $seconds")
    spell = read_value(duration, WHOLE, part.parameters) if duration is not None else None
    if spell is not None and spell.source is Source.CONSTANT and not _is_positive(spell.value):
        assert duration is not None
        duration.wrong("`duration` must be a number of seconds above zero", "write duration: 2")
    return dataclasses.replace(
        part,
        target=ros_name(entries["publish"]),
        type_name=_type(entries, "msg"),
        **_filled(entries.get("fields"), part.parameters),
        qos=read_qos(entries["qos"]) if "qos" in entries else None,
        rate=positive(rate) if rate is not None else None,
        duration=spell,
        at_end=read_values(entries["at_end"], part.parameters) if "at_end" in entries else None,
        match_timeout=_timeout(entries, None, "match_timeout"),
        unmatched=entries["unmatched"].choice("warn", "fail") if "unmatched" in entries else None,
    )


def _service(part: OperationPart, entries: dict[str, Node]) -> OperationPart:
    return dataclasses.replace(
        _answered(part, entries),
        target=ros_name(entries["service"]),
        type_name=_type(entries, "srv"),
        **_filled(entries.get("request"), part.parameters),
        timeout=_timeout(entries, CALL_TIMEOUT),
    )


def _action(part: OperationPart, entries: dict[str, Node]) -> OperationPart:
    feedback = entries["feedback"].entries() if "feedback" in entries else ()
    return dataclasses.replace(
        _answered(part, entries),
        target=ros_name(entries["action"]),
        type_name=_type(entries, "action"),
        **_filled(entries.get("goal"), part.parameters),
        feedback=tuple(read_feedback(key, value) for key, value in feedback),
        timeout=_timeout(entries, None),
        code=_code(entries["code"]) if "code" in entries else None,
        aborted=_outputs(entries["aborted"]) if "aborted" in entries else (),
        **_suspend(entries.get("suspend")),
    )


def _suspend(node: Node | None) -> dict[str, Any]:
    """Read the effect of suspending the intention on a goal."""
    if node is None:
        return {}
    if node.value == "pause":
        node.wrong(
            "an action can only be cancelled, not paused",
            "name operations that pause and resume the server: suspend: {pause: hold, resume: go_on}",
        )
        return {}
    if not isinstance(node.value, dict):
        if node.value not in _SUSPEND:
            node.wrong(
                f"invalid `suspend`: {node.value!r}",
                f"write {' or '.join(_SUSPEND)}, or operations that pause and resume the server: "
                "{pause: hold, resume: go_on}",
            )
            return {}
        return {"suspend": node.value}
    entries = node.mapping("pause", "resume", required=("pause", "resume"))
    named = {key: Written(each.text(), place_of(each)) for key, each in entries.items()}
    return {"suspend": "pause", **named}


def _code(node: Node) -> FieldPart:
    if isinstance(node.value, list):
        node.wrong(
            "`code` must be one field", "write code: error_code, or code: {path: error_code, as: name}"
        )
        return FieldPart(WHOLE, place_of(node))
    return _outputs(node)[0]


def _answered(part: OperationPart, entries: dict[str, Node]) -> OperationPart:
    success = entries.get("success")
    nothing = success is not None and success.value == "none"
    return dataclasses.replace(
        part,
        outputs=_outputs(entries["outputs"]) if "outputs" in entries else (),
        any_success=nothing,
        success=_success(success) if success is not None and not nothing else None,
    )


def _outputs(node: Node) -> tuple[FieldPart, ...]:
    fields = read_fields(node)
    for field in fields:
        if field.path.of_message or "i" in field.path.steps or field.dead_band is not None:
            node.problems.append(
                field.place.problem("an output has only a path and a conversion", "leave the rest out")
            )
    return fields


def _success(node: Node) -> Success:
    if not isinstance(node.value, dict):
        return Success(path_of(node, "write the field that is true, or {path: code, is: 0}"), place_of(node))
    entries = node.mapping("path", "is", required=("path", "is"))
    return Success(
        path_of(entries["path"]) if "path" in entries else WHOLE,
        place_of(node),
        constant(entries["is"]) if "is" in entries else True,
    )


def _set(part: OperationPart, entries: dict[str, Node]) -> OperationPart:
    return dataclasses.replace(
        _of_node(part, entries, "set_parameter"),
        values=(read_value(entries["value"], WHOLE, part.parameters),) if "value" in entries else (),
    )


def _get(part: OperationPart, entries: dict[str, Node]) -> OperationPart:
    outputs = entries.get("outputs")
    field = FieldPart(WHOLE, place_of(entries["get_parameter"]), name="value")
    if outputs is not None:
        listed = each_of(outputs)
        if len(listed) != 1:
            outputs.wrong("a parameter has one value, so it has one output", "write outputs: [value]")
        elif isinstance(listed[0].value, str):
            field = dataclasses.replace(field, name=str(listed[0].value))
        else:
            field = read_fields(listed[0])[0]
    return dataclasses.replace(_of_node(part, entries, "get_parameter"), outputs=(field,))


def _of_node(part: OperationPart, entries: dict[str, Node], key: str) -> OperationPart:
    node = entries[key]
    return dataclasses.replace(
        part,
        target=Written(node.text(), place_of(node)),
        node=ros_name(entries["node"]).text if "node" in entries else "",
        timeout=_timeout(entries, CALL_TIMEOUT),
    )


def _of_properties(part: OperationPart, entries: dict[str, Node]) -> OperationPart:
    node = entries[part.kind.value]
    if "parameters" in entries:
        entries["parameters"].wrong(f"`{part.kind}` takes no parameters", "leave `parameters` out")
    items = each_of(node)
    if part.kind is OperationKind.READ and len(items) != 1:
        node.wrong("`read` reads one property", "write an operation for each")
    named = tuple(Written(item.text(), place_of(item)) for item in items)
    return dataclasses.replace(part, parameters=(), target=Written("", place_of(node)), properties=named)


_READERS: dict[OperationKind, Reader] = {
    OperationKind.PUBLISH: _publish,
    OperationKind.SERVICE: _service,
    OperationKind.ACTION: _action,
    OperationKind.SET: _set,
    OperationKind.GET: _get,
    OperationKind.REFRESH: _of_properties,
    OperationKind.READ: _of_properties,
}


def _type(entries: dict[str, Node], kind: str) -> Written | None:
    return type_written(entries["type"], kind) if "type" in entries else None


def _timeout(entries: dict[str, Node], usual: float | None, key: str = "timeout") -> float | None:
    return positive(entries[key]) if key in entries else usual


def _is_positive(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and value > 0


_VALUE = ("value", *CONVERSION)
_LIST = ("each", "fields")
_WRITTEN = ("", *ANGLES, "name")
"""Values of ``as`` on the way to a message."""

ALL_OF_IT = -1
"""Number of the part of an element that means the whole element."""


def read_values(node: Node, parameters: tuple[str, ...], within_list: bool = False) -> tuple[ValuePart, ...]:
    """Read the fields of a message by their paths."""
    found = []
    for key, value in node.entries():
        target = path_of(key)
        if target.of_message or ALL in target.steps or HERE in target.steps or not target.steps:
            key.wrong(
                f"`{target.text}` is not a single field", "write a path like pose.position.x or poses[0]"
            )
        found.append(read_value(value, target, parameters, within_list))
    return tuple(found)


def read_value(node: Node, target: Path, parameters: tuple[str, ...], within_list: bool = False) -> ValuePart:
    """Read one value for *target*."""
    place = place_of(node)
    if not isinstance(node.value, dict):
        source, value, parameter = _source(node, parameters, within_list)
        return ValuePart(target, place, source, value, parameter)
    if "each" in node.value:
        return _list(node, target, parameters)
    if node.value and not set(node.value) & {*_VALUE, *_LIST}:
        inner = next(iter(node.value))
        node.wrong(
            f"`{target.text}` has no fields of its own here", f"write their paths: {target.text}.{inner}: ..."
        )
        return ValuePart(target, place)
    entries = node.mapping(*_VALUE, required=("value",))
    conversion = read_conversion(entries)
    if conversion.kind not in _WRITTEN:
        entries["as"].wrong(
            f"`as: {conversion.kind}` is for fields that an agent reads", f"here: {', '.join(_WRITTEN[1:])}"
        )
        conversion = Conversion()
    if "value" not in entries:
        return ValuePart(target, place, conversion=conversion)
    source, value, parameter = _source(entries["value"], parameters, within_list)
    return ValuePart(target, place, source, value, parameter, conversion)


def _list(node: Node, target: Path, parameters: tuple[str, ...]) -> ValuePart:
    """Read a list of messages, one for each element of a parameter."""
    entries = node.mapping(*_LIST, required=_LIST)
    parameter = 0
    if "each" in entries:
        source, _, parameter = _source(entries["each"], parameters, within_list=False)
        if source is not Source.PARAMETER:
            entries["each"].wrong("`each` must be a parameter that is a list", "write each: $poses")
    elements = read_values(entries["fields"], parameters, within_list=True) if "fields" in entries else ()
    return ValuePart(target, place_of(node), Source.ELEMENTS, None, parameter, elements=elements)


def _source(node: Node, parameters: tuple[str, ...], within_list: bool) -> tuple[Source, object, int]:
    value = node.value
    if isinstance(value, str) and value.startswith("$"):
        return Source.PARAMETER, None, _parameter(node, str(value)[1:], parameters, within_list)
    if value == "now":
        return Source.NOW, None, 0
    help = "for a nested field write its path, as in linear.x: 0.5"
    return Source.CONSTANT, constant(node, "a number, a text, $parameter or now", help), 0


def _parameter(node: Node, name: str, parameters: tuple[str, ...], within_list: bool) -> int:
    """Return the number of a parameter. The parts of an element are $1, $2 and so on, the whole element is $0."""
    if within_list:
        if name.isdecimal():
            return int(name) - 1
        node.wrong(
            f"an element has no part ${name}",
            "write $1, $2 and so on for its parts, $0 for the whole element",
        )
        return ALL_OF_IT
    if name in parameters:
        return parameters.index(name)
    near = [f"${each}" for each in close_matches(name, parameters)]
    help = did_you_mean(near, f"add it to `parameters`: [{', '.join((*parameters, name))}]")
    node.wrong(f"the operation has no parameter `{name}`", help)
    return 0
