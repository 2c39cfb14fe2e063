"""What agents perceive: ``properties``, ``signals``, ``frames``, ``parameters`` and ``derived``, and how they are read."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated, Any

from jacaros.robots.mapping.fields import (
    START,
    UNITS,
    UNNAMED,
    WHOLE,
    FieldPart,
    FieldPath,
    FilePosition,
    Written,
    belief_name,
    constant,
    each_of,
    entry,
    is_type,
    path_of,
    place_of,
    read_fields,
    read_path,
    ros_name,
    shown,
    type_of,
    units_of,
    with_entries,
    written,
)
from jacaros.robots.ros.errors import ParameterRefused
from jacaros.robots.ros.parameter import DeclaredParameter, ParameterValue, checked_value, fault_of
from jacaros.robots.ros.qos import DEFAULT_QOS, LATCHED, SENSOR_DATA, QoS
from jacaros.robots.streams import (
    LONGEST,
    OPERATORS,
    PARTNERS_WAIT,
    DeclarationProblem,
    ReadingPolicy,
    Spec,
    faults,
    unknown,
)
from jacaros.runtime.files.yaml import Problem, YamlNode


def positive(node: YamlNode) -> float:
    """Read a number above zero."""
    value = node.number(default=1.0)
    if value <= 0.0:
        text = f"{node.what} is {value:g}, but must be above zero"
        node.wrong(text, f"leave {node.what} out, or write a number")
        return 1.0
    return value


PROFILES = {"sensor_data": SENSOR_DATA, "default": DEFAULT_QOS, "latched": LATCHED}


CHOICES = {"reliability": ("reliable", "best_effort"), "durability": ("volatile", "transient_local")}
"""Words of a quality of service."""
_PARTS = {word: f"write qos: {{{key}: {word}}}" for key, words in CHOICES.items() for word in words}
"""What to write for a part of a quality of service that is given alone."""


def read_qos(node: YamlNode) -> QoS:
    """Read a quality of service; the default one after a mistake."""
    if not isinstance(node.value, dict):
        if node.value not in PROFILES:
            listed = f"write {', '.join(PROFILES)}, or {{reliability: ..., durability: ..., depth: ..., deadline: ...}}"
            node.wrong(f"unknown QoS profile {shown(node.value)}", _PARTS.get(str(node.value), listed))
        return PROFILES.get(node.value, DEFAULT_QOS)
    entries = node.mapping("reliability", "durability", "depth", "deadline")
    given: dict[str, Any] = {key: entries[key].choice(*CHOICES[key]) for key in CHOICES if key in entries}
    if "depth" in entries:
        given["depth"] = entries["depth"].whole(1, DEFAULT_QOS.depth)
    if "deadline" in entries:
        given["deadline"] = entries["deadline"].number(0.0, default=1.0) or None
        if given["deadline"] is None:
            entries["deadline"].wrong("`deadline` is 0, but must be above zero", "write seconds")
    return replace(DEFAULT_QOS, **given)


ALWAYS = ReadingPolicy()
"""Every change is published."""


@dataclass(frozen=True, slots=True)
class TopicPart:
    """A property or signal from a topic, or from the feedback of an action.

    Attributes:
        topic: name of the topic; None for feedback.
        type_name: message type; None: found at run time.
        frame: the only frame whose messages are shown; None: any.
        fields: None: the whole message.
        each: the array whose elements each have a property or signal; the first field identifies an element.
        when_changed: send a signal only if its values differ from the previous ones.
    """

    name: str
    place: FilePosition
    topic: Annotated[Written | None, entry(ros_name)] = None
    type_name: Annotated[Written | None, type_of("msg")] = None
    frame: Annotated[Written | None, entry(written)] = None
    fields: Annotated[tuple[FieldPart, ...] | None, entry(read_fields)] = None
    each: Annotated[FieldPath | None, entry(path_of)] = None
    each_place: FilePosition = START
    qos: Annotated[QoS | None, entry(read_qos)] = None
    description: Annotated[str, entry(YamlNode.text)] = ""
    policy: ReadingPolicy = ALWAYS
    when_changed: Annotated[bool, entry(YamlNode.truth)] = False
    signal: bool = False


_MESSAGE = ("topic", "type", "frame", "fields", "each", "qos", "description")
_POLICY = ("mode", "rate", "dead_band", "latest_only", "expire")
PROPERTY = (*_MESSAGE, *_POLICY)
SIGNAL = (*_MESSAGE, "when_changed")
FEEDBACK = ("fields", "description", "rate", "dead_band", "latest_only")


def read_property(name: YamlNode, node: YamlNode) -> TopicPart:
    """Read one property from a topic."""
    part, entries = _from_topic(name, node, PROPERTY, "a property")
    if not entries:
        return part
    for key in ("mode", "expire") if part.each is not None else ():
        if key in entries:
            text = "the properties of elements are those of the newest message"
            entries[key].wrong(text, f"leave `{key}` out, or `each`")
    return replace(part, policy=read_policy(entries, part.fields))


def read_signal(name: YamlNode, node: YamlNode) -> TopicPart:
    """Read one signal."""
    return replace(_from_topic(name, node, SIGNAL, "a signal")[0], signal=True)


def _from_topic(
    name: YamlNode, node: YamlNode, keys: tuple[str, ...], what: str
) -> tuple[TopicPart, dict[str, YamlNode]]:
    """Read what properties and signals share. Return the entries, too; none of a short form."""
    place = place_of(name)
    if is_misplaced(name, node, keys, what):
        return TopicPart(UNNAMED, place, Written("unnamed", place)), {}
    if isinstance(node.value, str):
        return TopicPart(belief_name(name), place, ros_name(node)), {}
    entries = node.mapping(*keys, required=("topic",))
    return _of_message(TopicPart(belief_name(name), place), entries), entries


def read_feedback(name: YamlNode, node: YamlNode) -> TopicPart:
    """Read a property from the feedback of an action."""
    part = TopicPart(belief_name(name), place_of(name))
    if node.value is None or isinstance(node.value, str | list):
        return replace(part, fields=read_fields(node) if node.value is not None else None)
    entries = node.mapping(*FEEDBACK)
    part = _of_message(part, entries)
    return replace(part, policy=read_policy(entries, part.fields))


def _of_message(part: TopicPart, entries: dict[str, YamlNode]) -> TopicPart:
    each = entries.get("each")
    part = replace(with_entries(part, entries), each_place=place_of(each) if each is not None else part.place)
    if part.fields == ():
        entries["fields"].wrong("`fields` is empty", "name a field, or leave `fields` out for all of them")
    for field in part.fields or ():
        if each is None and (field.path.of_message or "i" in field.path.steps):
            entries["fields"].problems.append(
                field.place.problem(
                    f"`{field.path.text}` needs `each`", "without `each` write the path alone"
                )
            )
    return part


def is_misplaced(name: YamlNode, node: YamlNode, keys: tuple[str, ...], what: str) -> bool:
    """Report a key of a property (*what*) used where the name of a property is expected. Return whether it was."""
    if name.value not in keys or isinstance(node.value, dict):
        return False
    if isinstance(node.value, str) and not is_type(node.value):
        return False  # a property may have this name, and this be its topic
    text = f"`{name.value}` is used like the name of {what}"
    name.wrong(text, "indent it, below the name that it belongs to")
    return True


def read_policy(entries: dict[str, YamlNode], fields: tuple[FieldPart, ...] | None) -> ReadingPolicy:
    """Read when to update."""
    mode = entries["mode"].choice("verbose", "on_demand") if "mode" in entries else "verbose"
    rate, expire = entries.get("rate"), entries.get("expire")
    latest = entries.get("latest_only")
    return ReadingPolicy(
        on_demand=mode == "on_demand",
        rate=positive(rate) if rate is not None else None,
        dead_band=_bands(entries.get("dead_band"), fields),
        latest_only=latest is None or latest.truth(),
        expire=positive(expire) if expire is not None else None,
        finite=False,  # fields have their own replacements for such numbers
    )


def _bands(node: YamlNode | None, fields: tuple[FieldPart, ...] | None) -> float | tuple[float, ...]:
    """Read one number for all values, or one for each value."""
    if node is None:
        return 0.0
    if not isinstance(node.value, list):
        return node.number(0.0)
    given = tuple(item.number(0.0) for item in node.sequence())
    if fields is not None and len(given) != (count := sum(field.count for field in fields)):
        text = f"`dead_band` has {len(given)} numbers, but the property has {count} values"
        node.wrong(text, "write one number for all, or one for each value")
    return given


# Frames.

TRANSFORM = {
    **dict.fromkeys(("x", "y", "z"), "length"),
    **dict.fromkeys(("roll", "pitch", "yaw"), "angle"),
    "stamp": "time",
}
"""The parts of a transform that can be shown, and their kinds."""


@dataclass(frozen=True, slots=True)
class FramePart:
    """A property from tf.

    Attributes:
        target, source: frames, as written.
        fields: have paths of one step, ``x`` to ``stamp``.
        rate: look-ups per second.
        oldest: maximum age of a transform, in seconds; None: any.
    """

    name: str
    place: FilePosition
    target: Annotated[str, entry(YamlNode.text)] = ""
    source: Annotated[str, entry(YamlNode.text)] = ""
    fields: Annotated[tuple[FieldPart, ...], entry(read_fields)] = ()
    description: Annotated[str, entry(YamlNode.text)] = ""
    rate: float = 10.0
    oldest: float | None = None
    policy: ReadingPolicy = ALWAYS


FRAME = ("target", "source", "fields", "description", *_POLICY)


def read_frame(name: YamlNode, node: YamlNode) -> FramePart:
    """Read a property from tf."""
    entries = node.mapping(*FRAME, required=("target", "source"))
    place = place_of(name)
    pose = tuple(FieldPart(read_path(each), place, name=each) for each in ("x", "y", "yaw"))
    part = with_entries(FramePart(belief_name(name), place, fields=pose), entries)
    for field in part.fields:
        node.problems += _of_transform(field)
    for key in ("target", "source"):
        if key in entries and entries[key].value == "":
            entries[key].wrong(f"`{key}` is empty", "write the name of a frame, such as base_link")
    policy = read_policy(entries, part.fields)
    rest = replace(policy, rate=None, expire=None)
    return replace(part, rate=policy.rate or part.rate, oldest=policy.expire, policy=rest)


def _of_transform(field: FieldPart) -> Iterator[Problem]:
    place, conversion = field.path.text, field.conversion
    if place not in TRANSFORM:
        yield field.place.problem(f"a transform has no `{place}`", f"it has {', '.join(TRANSFORM)}")
    elif conversion.kind or conversion.names or field.shares is not None:
        text = f"{place} of a transform is a number"
        yield field.place.problem(text, "it can only have a unit, scale, offset and round")
    elif conversion.unit and UNITS[conversion.unit].kind != (wanted := TRANSFORM[place]):
        kind, unit = UNITS[conversion.unit].kind, conversion.unit
        told = f"{place} of a transform is a {wanted}, but {unit} is a unit of {kind}"
        yield field.place.problem(told, f"units of {wanted} are {', '.join(units_of(wanted))}")


# Parameters of our own node.


def _field(node: YamlNode) -> FieldPart | None:
    fields = read_fields(node)
    if len(fields) != 1 or fields[0].path.steps:
        node.wrong("a parameter has one value and no fields", "write fields: {path: ., unit: degrees}")
        return None
    kind = fields[0].conversion.kind
    if kind not in ("", "atom") or fields[0].shares is not None or fields[0].otherwise is not None:
        told = "`otherwise`" if fields[0].otherwise is not None else f"`as: {kind}`" if kind else "`sample`"
        text = f"{told} is for messages"
        node.wrong(text, "a parameter can have: as: atom, names, unit, scale, offset, round")
    return replace(fields[0], path=WHOLE)


@dataclass(frozen=True, slots=True)
class ParameterPart:
    """A property from a parameter of our own node.

    Attributes:
        parameter: its name.
        declaration: declared type, default and limits.
    """

    name: str
    place: FilePosition
    parameter: Annotated[str, entry(YamlNode.text)]
    declaration: DeclaredParameter
    field: Annotated[FieldPart | None, entry(_field, "fields")] = None
    description: Annotated[str, entry(YamlNode.text)] = ""
    policy: ReadingPolicy = ALWAYS


OWN = ("default", "parameter", "fields", "dead_band", "description", "minimum", "maximum", "read_only")


def read_parameter(name: YamlNode, node: YamlNode) -> ParameterPart:
    """Read a property from a parameter of our own node."""
    entries = {"default": node}  # a value is short for {default: ...}
    if isinstance(node.value, dict):
        entries = node.mapping(*OWN, required=("default",))
    declaration = _declaration(entries["default"], entries) if "default" in entries else DeclaredParameter(0)
    part = ParameterPart(belief_name(name), place_of(name), str(name.value), declaration)
    part = with_entries(part, entries)
    if part.field is not None and "default" in entries:
        _require_shown(entries["default"], part.field, declaration.default)
    band = {key: each for key, each in entries.items() if key == "dead_band"}
    policy = read_policy(band, (part.field,) if part.field is not None else None)
    # No field has a replacement for numbers that are not finite.
    return replace(part, policy=replace(policy, finite=True))


def _require_shown(node: YamlNode, field: FieldPart, default: ParameterValue) -> None:
    """Check the default of a parameter of our own: as it keeps its type, its conversion works for every value."""
    values = (default or [""]) if isinstance(default, list) else [default]
    wrong = [each for each in values if isinstance(each, bool) or not isinstance(each, int | float)]
    if wrong and field.conversion.needs_number:
        found, name = json.dumps(wrong[0], ensure_ascii=False), node.what.strip("'")
        help = "leave out its unit, scale, offset and round"
        node.wrong(f"parameter `{name}`: expected a number, found {found}", help)


def _declaration(node: YamlNode, entries: dict[str, YamlNode]) -> DeclaredParameter:
    """Read the declaration of a parameter of our own; *node* is its default."""
    default = _value(node)
    limits = {key: entries[key].number() for key in ("minimum", "maximum") if key in entries}
    if limits and (isinstance(default, bool) or not isinstance(default, int | float)):
        text = f"only numbers have a range, but the default is {default!r}"
        entries[next(iter(limits))].wrong(text, "leave minimum and maximum out")
        limits = {}
    declaration = DeclaredParameter(
        default,
        entries["description"].text() if "description" in entries else "",
        entries["read_only"].truth() if "read_only" in entries else False,
        limits.get("minimum"),
        limits.get("maximum"),
    )
    if (fault := fault_of(default, declaration)) is not None:
        text = f"the default is outside its range: it is {fault}"
        node.wrong(text, "write another default, or another range")
    return declaration


def _value(node: YamlNode) -> ParameterValue:
    if node.value is None:
        node.wrong("the parameter has no default", "write a number, true or false, a text, or a list of them")
        return 0
    try:
        return checked_value(constant(node))
    except ParameterRefused as refused:
        node.wrong(str(refused), "write numbers of one type in a list: [1.0, 2.5]")
        return 0


# Derived: events composed of those of other properties and signals of the file.

DERIVED = ("value", "lateness", "description")
"""The keys of all derived properties, beside those of their operators."""
_EXAMPLE = "write one, such as {count: bump, within: 5, at_least: 3}"


@dataclass(frozen=True, slots=True)
class DerivedPart:
    """A property derived from events of others.

    Attributes:
        spec: the pattern; None after a mistake.
        sources: the properties and signals, as written.
    """

    name: str
    place: FilePosition
    spec: Spec | None = None
    sources: tuple[Written, ...] = ()
    description: Annotated[str, entry(YamlNode.text)] = ""


def read_derived(name: YamlNode, node: YamlNode) -> DerivedPart:
    """Read one derived property."""
    part = DerivedPart(belief_name(name), place_of(name))
    if not isinstance(node.value, dict):
        node.wrong(f"`{name.value}` has no operator", _EXAMPLE)
        return part
    entries = node.mapping()
    operator = _operator(name, node, entries)
    if operator is None:
        return part
    streams = entries[operator]
    sources = tuple(map(written, each_of(streams) if operator == "together" else [streams]))
    names = tuple(each.text for each in sources)
    options = {
        key: constant(each) if key == "equals" else each.value
        for key, each in entries.items()
        if key not in (operator, *DERIVED)
    }
    wrong = list(faults(operator, names, options))
    for fault in wrong:
        _report(fault, entries, node)
    value, lateness = entries.get("value"), entries.get("lateness")
    if value is not None and not OPERATORS[operator].valued:
        value.wrong(f"`{operator}` does not use values", "leave `value` out")
    if lateness is not None and operator != "together":
        lateness.wrong(f"`{operator}` waits for nothing", "leave `lateness` out: delayed messages count")
    usual = PARTNERS_WAIT if operator == "together" else 0.0
    spec = Spec(
        operator,
        names,
        options,
        value.whole(1, 1) - 1 if value is not None else 0,
        usual if lateness is None else lateness.number(0.0, LONGEST),
    )
    return with_entries(replace(part, spec=None if wrong else spec, sources=sources), entries)


def _operator(name: YamlNode, node: YamlNode, entries: dict[str, YamlNode]) -> str | None:
    """Return the operator of an entry; None after reporting a mistake."""
    named = [key for key in entries if key in OPERATORS]
    if len(named) == 1:
        return named[0]
    if len(named) > 1:
        text = f"`{named[0]}` and `{named[1]}` are alternatives"
        entries[named[1]].wrong(text, "derive one name for each operator")
    elif entries:
        first = next(iter(entries))
        fault = unknown(first)
        help_ = fault.help if fault.help.startswith("did") else f"{_EXAMPLE}; {fault.help}"
        _at_key(node, first).wrong(f"`{name.value}` has no operator", help_)
    else:
        name.wrong(f"`{name.value}` has no operator", _EXAMPLE)
    return None


def _report(fault: DeclarationProblem, entries: dict[str, YamlNode], node: YamlNode) -> None:
    if fault.option in entries and fault.message.endswith(f"has no option `{fault.option}`"):
        _at_key(node, fault.option).wrong(fault.message, fault.help)
    else:
        entries.get(fault.option, node).wrong(fault.message, fault.help)


def _at_key(node: YamlNode, key: str) -> YamlNode:
    """Return the position of a key of a mapping."""
    return next((name for name, _ in node.entries() if str(name.value) == key), node)
