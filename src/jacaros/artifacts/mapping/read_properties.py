"""Read ``properties``, ``signals``, ``frames``, ``parameters`` and ``derived``; and ``qos``: a profile, or its parts."""

import dataclasses
import json
from collections.abc import Iterator
from typing import Any

from jacaros.artifacts.mapping.declared import (
    WHOLE,
    ArtifactPart,
    DerivedPart,
    FieldPart,
    FramePart,
    ParameterPart,
    Place,
    RangeOfView,
    TopicPart,
    Written,
    read_path,
)
from jacaros.artifacts.mapping.read_fields import (
    ANGLES,
    UNITS,
    UNNAMED,
    belief_name,
    constant,
    each_of,
    is_type,
    path_of,
    place_of,
    read_field,
    read_fields,
    ros_name,
    shown,
    type_written,
    units_of,
)
from jacaros.artifacts.streams import (
    LONGEST,
    OPERATORS,
    PARTNERS_WAIT,
    Fault,
    ReadingPolicy,
    Spec,
    faults,
    unknown,
)
from jacaros.files.texts import suggestion
from jacaros.files.yaml import Node, Problem
from jacaros.ros.errors import ParameterRefused
from jacaros.ros.parameter import Declaration, ParameterValue, checked_value, fault_of
from jacaros.ros.qos import DEFAULT_QOS, LATCHED, SENSOR_DATA, QoS

_MESSAGE = ("topic", "type", "frame", "fields", "each", "key", "annotations", "qos", "description")
_POLICY = ("mode", "rate", "dead_band", "latest_only", "expire")
PROPERTY = (*_MESSAGE, *_POLICY, "initial", "range_of_view")
SIGNAL = (*_MESSAGE, "rate", "when_changed")
FEEDBACK = ("fields", "annotations", "description", "rate", "dead_band", "latest_only")
FRAME = ("target", "source", "fields", "annotations", "description", *_POLICY)
PLACES = ("x", "y", "z", "roll", "pitch", "yaw", "stamp")
"""The parts of a transform that can be shown."""


def read_property(name: Node, node: Node) -> TopicPart:
    """Read one property from a topic."""
    place = place_of(name)
    if is_misplaced(name, node, PROPERTY, "a property"):
        return TopicPart(UNNAMED, place, Written("unnamed", place))
    if isinstance(node.value, str):
        return TopicPart(belief_name(name), place, ros_name(node))
    entries = node.mapping(*PROPERTY, required=("topic",))
    part = _topic_part(belief_name(name), place, entries)
    fields, policy = part.fields, read_policy(entries, part.fields)
    initial = entries.get("initial")
    if policy.on_demand and part.each is not None:
        entries["mode"].wrong("a property for each element is always up to date", "leave `mode` out")
    return dataclasses.replace(
        part,
        policy=policy,
        initial=_initial(initial, fields, part.each is not None) if initial is not None else None,
        view=_view(entries["range_of_view"], part.each is not None) if "range_of_view" in entries else None,
    )


def read_signal(name: Node, node: Node) -> TopicPart:
    """Read one signal."""
    if is_misplaced(name, node, SIGNAL, "a signal"):
        return TopicPart(UNNAMED, place_of(name), Written("unnamed", place_of(name)), signal=True)
    if isinstance(node.value, str):
        return TopicPart(belief_name(name), place_of(name), ros_name(node), signal=True)
    entries = node.mapping(*SIGNAL, required=("topic",))
    part = _topic_part(belief_name(name), place_of(name), entries)
    if "annotations" in entries:
        entries["annotations"].wrong("signals have no annotations", "write the field in `fields`")
    changed = entries.get("when_changed")
    return dataclasses.replace(
        part,
        policy=read_policy(entries, part.fields, latest_only=False),
        when_changed=changed is not None and changed.truth(),
        signal=True,
    )


def is_misplaced(name: Node, node: Node, keys: tuple[str, ...], what: str) -> bool:
    """Report a key of a property (*what*) used where the name of a property is expected. Return whether it was."""
    if name.value not in keys or isinstance(node.value, dict):
        return False
    if isinstance(node.value, str) and not is_type(node.value):
        return False  # a property may have this name, and this be its topic
    name.wrong(
        f"`{name.value}` is used like the name of {what}", "indent it, below the name that it belongs to"
    )
    return True


def read_feedback(name: Node, node: Node) -> TopicPart:
    """Read a property from the feedback of an action."""
    place = place_of(name)
    if node.value is None or isinstance(node.value, str | list):
        fields = read_fields(node) if node.value is not None else None
        return TopicPart(belief_name(name), place, None, fields=fields)
    entries = node.mapping(*FEEDBACK)
    part = _topic_part(belief_name(name), place, entries)
    return dataclasses.replace(part, policy=read_policy(entries, part.fields))


def _written(node: Node) -> Written:
    return Written(node.text(), place_of(node))


def _topic_part(name: str, place: Place, entries: dict[str, Node]) -> TopicPart:
    each = entries.get("each")
    key = entries.get("key")
    if key is not None and each is None:
        key.wrong("`key` needs `each`", "write the array with the elements: each: detections")
    fields = read_fields(entries["fields"]) if "fields" in entries else None
    if fields == ():
        entries["fields"].wrong("`fields` is empty", "name a field, or leave `fields` out for all of them")
    for field in fields or ():
        if each is None and (field.path.of_message or "i" in field.path.steps):
            entries["fields"].problems.append(
                field.place.problem(
                    f"`{field.path.text}` needs `each`", "without `each` write the path alone"
                )
            )
    return TopicPart(
        name,
        place,
        ros_name(entries["topic"]) if "topic" in entries else None,
        type_written(entries["type"], "msg") if "type" in entries else None,
        fields,
        path_of(each) if each is not None else None,
        place_of(each) if each is not None else place,
        read_field(key) if key is not None else None,
        read_annotations(entries["annotations"]) if "annotations" in entries else (),
        None,
        read_qos(entries["qos"]) if "qos" in entries else None,
        frame=_written(entries["frame"]) if "frame" in entries else None,
        description=entries["description"].text() if "description" in entries else "",
    )


def read_annotations(node: Node) -> tuple[FieldPart, ...]:
    """Read annotations by name; the name of the annotation is that of the field."""
    return tuple(
        dataclasses.replace(read_field(value), name=belief_name(name)) for name, value in node.entries()
    )


def read_policy(
    entries: dict[str, Node], fields: tuple[FieldPart, ...] | None, latest_only: bool = True
) -> ReadingPolicy:
    """Read when to update."""
    mode = entries["mode"].choice("verbose", "on_demand") if "mode" in entries else "verbose"
    rate, expire = entries.get("rate"), entries.get("expire")
    latest = entries.get("latest_only")
    return ReadingPolicy(
        on_demand=mode == "on_demand",
        rate=positive(rate) if rate is not None else None,
        dead_band=_bands(entries.get("dead_band"), fields),
        latest_only=latest.truth() if latest is not None else latest_only,
        expire=positive(expire) if expire is not None else None,
        finite=False,  # fields have their own replacements for such numbers
    )


def positive(node: Node) -> float:
    """Read a number above zero."""
    value = node.number(default=1.0)
    if value <= 0.0:
        node.wrong(
            f"{node.what} is {value:g}, but must be above zero", f"leave {node.what} out, or write a number"
        )
        return 1.0
    return value


def _bands(node: Node | None, fields: tuple[FieldPart, ...] | None) -> float | tuple[float, ...]:
    """Read one number for all values, or one for each value."""
    own = any(field.dead_band is not None for field in fields or ())
    if node is None:
        return _each_band(fields or (), 0.0) if own else 0.0
    if not isinstance(node.value, list):
        band = node.number(0.0)
        return _each_band(fields or (), band) if own else band
    given = tuple(item.number(0.0) for item in node.sequence())
    if fields is not None and len(given) != (count := sum(field.count for field in fields)):
        node.wrong(
            f"`dead_band` has {len(given)} numbers, but the property has {count} values",
            "write one number for all, or one for each value",
        )
    return given


def _each_band(fields: tuple[FieldPart, ...], usual: float) -> tuple[float, ...]:
    return tuple(
        usual if field.dead_band is None else field.dead_band for field in fields for _ in range(field.count)
    )


def _initial(node: Node, fields: tuple[FieldPart, ...] | None, each: bool) -> tuple[object, ...]:
    if each:
        node.wrong("a property for each element has no initial values", "leave `initial` out")
    values = tuple(map(constant, each_of(node)))
    if fields is not None and len(values) != (count := sum(field.count for field in fields)):
        node.wrong(
            f"`initial` has {len(values)} values, but the property has {count}", "write one for each value"
        )
    return values


def _view(node: Node, each: bool) -> RangeOfView:
    entries = node.mapping("metres", "distance", "at", "from", required=("metres",))
    place = place_of(node)
    if not isinstance(node.value, dict):
        return RangeOfView(1.0, place)  # already reported
    if "distance" in entries and ("at" in entries or "from" in entries):
        node.wrong("`distance` and `at` are alternatives", "remove one of them")
    if "distance" not in entries and "at" not in entries:
        node.wrong(
            "`range_of_view` needs a position", "add `at: [position.x, position.y]`, or `distance: range`"
        )
    at = tuple(path_of(item) for item in entries["at"].sequence()) if "at" in entries else ()
    if "at" in entries and len(at) != 2:
        entries["at"].wrong("`at` must be the paths of two coordinates", "write [position.x, position.y]")
        at = ()
    origin = entries.get("from")
    return RangeOfView(
        positive(entries["metres"]) if "metres" in entries else 1.0,
        place,
        path_of(entries["distance"]) if "distance" in entries else None,
        at,
        Written(origin.text(), place_of(origin)) if origin is not None else None,
    )


def read_frame(name: Node, node: Node) -> FramePart:
    """Read a property from tf."""
    entries = node.mapping(*FRAME, required=("target", "source"))
    place = place_of(name)
    fields = read_fields(entries["fields"]) if "fields" in entries else _pose(place)
    annotations = read_annotations(entries["annotations"]) if "annotations" in entries else ()
    for field in (*fields, *annotations):
        if field.path.text not in PLACES:
            node.problems.append(
                field.place.problem(f"a transform has no `{field.path.text}`", f"it has {', '.join(PLACES)}")
            )
        else:
            node.problems += _of_transform(field)
    for key in ("target", "source"):
        if key in entries and entries[key].value == "":
            entries[key].wrong(f"`{key}` is empty", "write the name of a frame, such as base_link")
    policy = read_policy(entries, fields)
    return FramePart(
        belief_name(name),
        place,
        entries["target"].text() if "target" in entries else "",
        entries["source"].text() if "source" in entries else "",
        fields,
        annotations,
        policy.rate or 10.0,
        policy.expire,
        dataclasses.replace(policy, rate=None, expire=None),
        entries["description"].text() if "description" in entries else "",
    )


TRANSFORM = {**dict.fromkeys(("x", "y", "z"), "length"), **dict.fromkeys(ANGLES, "angle"), "stamp": "time"}
"""Kinds of the parts of a transform."""


def _of_transform(field: FieldPart) -> Iterator[Problem]:
    """Yield mistakes in the conversion of a part of a transform."""
    place, conversion = field.path.text, field.conversion
    if conversion.kind or conversion.names or field.shares is not None:
        yield field.place.problem(
            f"{place} of a transform is a number", "it can only have a unit, scale, offset and round"
        )
    elif conversion.unit and UNITS[conversion.unit].kind != (wanted := TRANSFORM[place]):
        kind, unit = UNITS[conversion.unit].kind, conversion.unit
        told = f"{place} of a transform is a {wanted}, but {unit} is a unit of {kind}"
        yield field.place.problem(told, f"units of {wanted} are {', '.join(units_of(wanted))}")


def _pose(place: Place) -> tuple[FieldPart, ...]:
    return tuple(FieldPart(read_path(name), place, name=name) for name in ("x", "y", "yaw"))


PROFILES = {"sensor_data": SENSOR_DATA, "default": DEFAULT_QOS, "latched": LATCHED}


_CHOICES = {"reliability": ("reliable", "best_effort"), "durability": ("volatile", "transient_local")}
_PARTS = {word: f"write qos: {{{key}: {word}}}" for key, words in _CHOICES.items() for word in words}
"""What to write for a part of a quality of service that is given alone."""


def read_qos(node: Node) -> QoS:
    """Read a quality of service; the default one after a mistake."""
    if not isinstance(node.value, dict):
        if node.value not in PROFILES:
            listed = f"write {', '.join(PROFILES)}, or {{reliability: ..., durability: ..., depth: ..., deadline: ...}}"
            node.wrong(f"unknown QoS profile {shown(node.value)}", _PARTS.get(str(node.value), listed))
        return PROFILES.get(node.value, DEFAULT_QOS)
    entries = node.mapping("reliability", "durability", "depth", "deadline")
    given: dict[str, Any] = {key: entries[key].choice(*_CHOICES[key]) for key in _CHOICES if key in entries}
    if "depth" in entries:
        given["depth"] = entries["depth"].whole(1, DEFAULT_QOS.depth)
    if "deadline" in entries:
        given["deadline"] = entries["deadline"].number(0.0, default=1.0) or None
        if given["deadline"] is None:
            entries["deadline"].wrong("`deadline` is 0, but must be above zero", "write seconds")
    return dataclasses.replace(DEFAULT_QOS, **given)


# Parameters: of other nodes, and of our own.

_SHOWN = ("parameter", "fields", "dead_band", "description")
OTHER = ("node", *_SHOWN, "rate")
OWN = ("default", *_SHOWN, "minimum", "maximum", "read_only")


def read_parameter(name: Node, node: Node) -> ParameterPart:
    """Read a property from a parameter, of another node or of our own."""
    if not isinstance(node.value, dict):
        # Short for {default: ...}.
        return ParameterPart(belief_name(name), place_of(name), "", str(name.value), _declaration(node, {}))
    own = not {"node", "rate"} & {str(key) for key in node.value}
    entries = node.mapping(*(OWN if own else OTHER), required=() if own else ("node",))
    if own and "default" not in entries:
        node.wrong(
            f"the parameter `{name.value}` has neither a node nor a default",
            "write the node that has it, node: controller_server, or its value if it is our own, default: 0.5",
        )
    field = _field(entries["fields"]) if "fields" in entries else None
    declaration = _declaration(entries["default"], entries) if "default" in entries else None
    if field is not None and declaration is not None:
        _require_shown(entries["default"], field, declaration.default)
    shown = (field,) if field is not None else None
    policy = read_policy({key: value for key, value in entries.items() if key != "rate"}, shown)
    policy = dataclasses.replace(policy, finite=True)  # no field has a replacement
    rate = entries.get("rate")
    return ParameterPart(
        belief_name(name),
        place_of(name),
        ros_name(entries["node"]).text if "node" in entries else "",
        entries["parameter"].text() if "parameter" in entries else str(name.value),
        declaration,
        field,
        positive(rate) if rate is not None else 1.0,
        policy,
        entries["description"].text() if "description" in entries else "",
    )


def _field(node: Node) -> FieldPart | None:
    """Read the conversion of the value."""
    fields = read_fields(node)
    if len(fields) != 1 or fields[0].path.steps:
        node.wrong("a parameter has one value and no fields", "write fields: {path: ., unit: degrees}")
        return None
    kind = fields[0].conversion.kind
    if kind not in ("", "atom") or fields[0].shares is not None or fields[0].otherwise is not None:
        told = "`otherwise`" if fields[0].otherwise is not None else f"`as: {kind}`" if kind else "`sample`"
        node.wrong(
            f"{told} is for messages", "a parameter can have: as: atom, names, unit, scale, offset, round"
        )
    return dataclasses.replace(fields[0], path=WHOLE)


def _require_shown(node: Node, field: FieldPart, default: ParameterValue) -> None:
    """Check the default of a parameter of our own: as it keeps its type, its conversion works for every value."""
    values = (default or [""]) if isinstance(default, list) else [default]
    wrong = [each for each in values if isinstance(each, bool) or not isinstance(each, int | float)]
    if wrong and field.conversion.needs_number:
        found, name = json.dumps(wrong[0], ensure_ascii=False), node.what.strip("'")
        help = "leave out its unit, scale, offset and round"
        node.wrong(f"parameter `{name}`: expected a number, found {found}", help)


def _declaration(node: Node, entries: dict[str, Node]) -> Declaration:
    """Read the declaration of a parameter of our own; *node* is its default."""
    default = _value(node)
    limits = {key: entries[key].number() for key in ("minimum", "maximum") if key in entries}
    if limits and (isinstance(default, bool) or not isinstance(default, int | float)):
        entries[next(iter(limits))].wrong(
            f"only numbers have a range, but the default is {default!r}", "leave minimum and maximum out"
        )
        limits = {}
    declaration = Declaration(
        default,
        entries["description"].text() if "description" in entries else "",
        entries["read_only"].truth() if "read_only" in entries else False,
        limits.get("minimum"),
        limits.get("maximum"),
    )
    if (fault := fault_of(default, declaration)) is not None:
        node.wrong(
            f"the default is outside its range: it is {fault}", "write another default, or another range"
        )
    return declaration


def _value(node: Node) -> ParameterValue:
    if node.value is None:
        node.wrong("the parameter has no default", "write a number, true or false, a text, or a list of them")
        return 0
    try:
        return checked_value(constant(node))
    except ParameterRefused as refused:
        node.wrong(str(refused), "write numbers of one type in a list: [1.0, 2.5]")
        return 0


# Derived: events composed of those of other properties and signals of the file.

_COMMON = ("value", "lateness", "description")
_EVENTS = frozenset({"count", "absent"})
"""Operators that use only the events, not their values, so each element of an array may be one."""
_EXAMPLE = "write one, such as {count: bump, within: 5, at_least: 3}"


def read_derived(name: Node, node: Node) -> DerivedPart:
    """Read one derived property."""
    place = place_of(name)
    if not isinstance(node.value, dict):
        node.wrong(f"`{name.value}` has no operator", _EXAMPLE)
        return DerivedPart(belief_name(name), place, None, ())
    entries = node.mapping()
    operator = _operator(name, node, entries)
    if operator is None:
        return DerivedPart(belief_name(name), place, None, ())
    streams = entries[operator]
    sources = tuple(map(_written, each_of(streams) if operator == "together" else [streams]))
    options = {
        key: constant(each) if key == "equals" else each.value
        for key, each in entries.items()
        if key not in (operator, *_COMMON)
    }
    wrong = list(faults(operator, [each.text for each in sources], options))
    for fault in wrong:
        _report(fault, entries, node)
    if "value" in entries and not OPERATORS[operator].valued:
        entries["value"].wrong(f"`{operator}` does not use values", "leave `value` out")
    if "lateness" in entries and operator != "together":
        entries["lateness"].wrong(
            f"`{operator}` waits for nothing", "leave `lateness` out: delayed messages count"
        )
    spec = Spec(
        operator,
        tuple(each.text for each in sources),
        options,
        entries["value"].whole(1, 1) - 1 if "value" in entries else 0,
        _lateness(entries, operator),
    )
    told = entries["description"].text() if "description" in entries else ""
    return DerivedPart(belief_name(name), place, None if wrong else spec, sources, told)


def _lateness(entries: dict[str, Node], operator: str) -> float:
    if "lateness" in entries:
        return entries["lateness"].number(0.0, LONGEST)
    return PARTNERS_WAIT if operator == "together" else 0.0


def _operator(name: Node, node: Node, entries: dict[str, Node]) -> str | None:
    """Return the operator of an entry; None after reporting a mistake."""
    named = [key for key in entries if key in OPERATORS]
    if len(named) == 1:
        return named[0]
    if len(named) > 1:
        entries[named[1]].wrong(
            f"`{named[0]}` and `{named[1]}` are alternatives", "derive one name for each operator"
        )
    elif entries:
        first = next(iter(entries))
        fault = unknown(first)
        help_ = fault.help if fault.help.startswith("did") else f"{_EXAMPLE}; {fault.help}"
        _at_key(node, first).wrong(f"`{name.value}` has no operator", help_)
    else:
        name.wrong(f"`{name.value}` has no operator", _EXAMPLE)
    return None


def _report(fault: Fault, entries: dict[str, Node], node: Node) -> None:
    if fault.option in entries and fault.message.endswith(f"has no option `{fault.option}`"):
        _at_key(node, fault.option).wrong(fault.message, fault.help)
    else:
        entries.get(fault.option, node).wrong(fault.message, fault.help)


def _at_key(node: Node, key: str) -> Node:
    """Return the position of a key of a mapping."""
    return next((name for name, _ in node.entries() if str(name.value) == key), node)


def derived_problems(part: ArtifactPart) -> Iterator[Problem]:
    """Yield streams that the artifact does not have, or that an operator cannot use."""
    topics: dict[str, TopicPart] = {each.name: each for each in part.topics}
    known = [*topics, *(each.name for each in part.frames)]
    for derived in part.derived:
        for source in derived.sources:
            if source.text and source.text not in known:
                yield _unknown_stream(source, known)
            elif (topic := topics.get(source.text)) is not None and derived.spec is not None:
                yield from _unfit(derived.spec, topic, source.place)
        known.append(derived.name)


def _unknown_stream(source: Written, known: list[str]) -> Problem:
    listed = f"properties, signals, frames and entries above this one: {', '.join(known) or 'none'}"
    return source.place.problem(f"unknown property `{source.text}`", suggestion(source.text, known, listed))


def _unfit(spec: Spec, topic: TopicPart, place: Place) -> Iterator[Problem]:
    if topic.each is not None and spec.operator not in _EVENTS:
        yield place.problem(
            f"`{topic.name}` is one property for each element, but `{spec.operator}` needs a single one",
            f"use one of {', '.join(sorted(_EVENTS))}, or a property without `each`",
        )
    needed = spec.place + 1
    if OPERATORS[spec.operator].valued and topic.fields is not None:
        count = sum(field.count for field in topic.fields)
        if count < needed:
            yield place.problem(f"`{topic.name}` has {count} values, not {needed}", "write a smaller `value`")
