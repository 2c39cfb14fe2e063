"""Read ``properties``, ``signals`` and ``frames``, and ``qos``: a profile, or its parts."""

import dataclasses
from collections.abc import Iterator
from typing import cast

from jacaros.artifacts.env.values import Atom
from jacaros.artifacts.kit.reading import ReadingPolicy
from jacaros.artifacts.mapping.declared import FieldPart, FramePart, Place, RangeOfView, TopicPart, Written
from jacaros.artifacts.mapping.read_fields import ANGLES, path_of, place_of, read_field, read_fields, shown
from jacaros.artifacts.mapping.read_names import UNNAMED, belief_name, is_type, ros_name, type_written
from jacaros.artifacts.mapping.units import UNITS
from jacaros.files.yaml import Node, Problem
from jacaros.ros.qos import DEFAULT_QOS, LATCHED, SENSOR_DATA, Durability, QoS, Reliability

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
    values = (
        tuple(map(plain_constant, node.sequence()))
        if isinstance(node.value, list)
        else (plain_constant(node),)
    )
    if fields is not None and len(values) != (count := sum(field.count for field in fields)):
        node.wrong(
            f"`initial` has {len(values)} values, but the property has {count}", "write one for each value"
        )
    return values


def plain_constant(node: Node) -> object:
    """Read a constant that an agent perceives: a number, truth value, text or list; lower-case words are atoms."""
    value = node.value
    if isinstance(value, list):
        return [plain_constant(item) for item in node.sequence()]
    if isinstance(value, bool | int | str):
        return (
            Atom(value) if isinstance(value, str) and value.isidentifier() and value[0].islower() else value
        )
    if isinstance(value, float):
        return float(value)
    node.wrong(f"{node.what} must be a number, a text or a list, found {shown(value)}")
    return 0


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


_KINDS = {**dict.fromkeys(("x", "y", "z"), "length"), **dict.fromkeys(ANGLES, "angle"), "stamp": "time"}
"""Kinds of the parts of a transform."""


def _of_transform(field: FieldPart) -> Iterator[Problem]:
    """Yield mistakes in the conversion of a part of a transform."""
    place, conversion = field.path.text, field.conversion
    if conversion.kind or conversion.names or field.shares is not None:
        yield field.place.problem(
            f"{place} of a transform is a number", "it can only have a unit, scale, offset and round"
        )
    elif conversion.unit and UNITS[conversion.unit].kind != _KINDS[place]:
        listed = ", ".join(name for name, each in UNITS.items() if each.kind == _KINDS[place])
        kind, unit = UNITS[conversion.unit].kind, conversion.unit
        told = f"{place} of a transform is a {_KINDS[place]}, but {unit} is a unit of {kind}"
        yield field.place.problem(told, f"units of {_KINDS[place]} are {listed}")


def _pose(place: Place) -> tuple[FieldPart, ...]:
    from jacaros.artifacts.mapping.paths import read_path

    return tuple(FieldPart(read_path(name), place, name=name) for name in ("x", "y", "yaw"))


PROFILES = {"sensor_data": SENSOR_DATA, "default": DEFAULT_QOS, "latched": LATCHED}


_PARTS = {
    **{each: f"write qos: {{reliability: {each}}}" for each in ("reliable", "best_effort")},
    **{each: f"write qos: {{durability: {each}}}" for each in ("volatile", "transient_local")},
}
"""What to write for a part of a quality of service that is given alone."""


def read_qos(node: Node) -> QoS:
    """Read a quality of service; the default one after a mistake."""
    if not isinstance(node.value, dict):
        if node.value not in PROFILES:
            listed = f"write {', '.join(PROFILES)}, or {{reliability: ..., durability: ..., depth: ..., deadline: ...}}"
            node.wrong(f"unknown QoS profile {shown(node.value)}", _PARTS.get(str(node.value), listed))
        return PROFILES.get(node.value, DEFAULT_QOS)
    entries = node.mapping("reliability", "durability", "depth", "deadline")
    usual = DEFAULT_QOS
    deadline = entries["deadline"].number(0.0, default=1.0) if "deadline" in entries else None
    if deadline == 0.0:
        entries["deadline"].wrong("`deadline` is 0, but must be above zero", "write seconds")
        deadline = None
    return QoS(
        cast(Reliability, entries["reliability"].choice("reliable", "best_effort"))
        if "reliability" in entries
        else usual.reliability,
        cast(Durability, entries["durability"].choice("volatile", "transient_local"))
        if "durability" in entries
        else usual.durability,
        entries["depth"].whole(1, usual.depth) if "depth" in entries else usual.depth,
        deadline,
    )
