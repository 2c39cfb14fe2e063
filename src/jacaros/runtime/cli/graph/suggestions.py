"""Entries of a first mapping file: useful fields, rates and parameters, and a comment."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from jacaros.robots.mapping.fields import RESERVED
from jacaros.robots.mapping.interfaces import Interfaces
from jacaros.robots.ros.backend import TopicInfo
from jacaros.robots.ros.fields import FieldType
from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.robots.ros.names import feedback_type, goal_type, request_type, response_type, result_type
from jacaros.runtime.cli.graph.standard_topics import KNOWN
from jacaros.runtime.cli.graph.values import (
    HEADER,
    MANY,
    GivenValue,
    Unit,
    leaves,
    list_of,
    lists_of,
    messages,
    values_of,
)

_BIG = (
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/CompressedImage",
    "sensor_msgs/msg/PointCloud2",
    "sensor_msgs/msg/PointCloud",
    "nav_msgs/msg/OccupancyGrid",
    "nav_msgs/msg/Path",
)
"""Types too large for beliefs: agents get a reference, for operations and for internal actions in Python."""


_WORDS = "std_msgs/msg/String"


@dataclass(frozen=True, slots=True)
class MappingEntry:
    """A property, signal or operation of a mapping file.

    Attributes:
        section: ``properties``, ``signals`` or ``operations``.
        name: name for agents.
        comment: the belief, event or call in AgentSpeak, with units.
        lines: keys of the entry, not indented.
    """

    section: str
    name: str
    comment: str
    lines: tuple[str, ...]


def property_of(types: Interfaces, name: str, topic: str, info: TopicInfo) -> MappingEntry:
    """Return a property that follows a topic, or a signal if its messages are events. Raises `UnknownInterface`."""
    type_name = info.types[0]
    section, comment, *body = KNOWN.get(type_name) or _property(types, name, type_name)
    kept = _kept(info, type_name)
    if type_name == _WORDS and not kept:
        section = "signals"  # two equal messages are two events, but one belief
    return MappingEntry(
        section, name, comment.replace("NAME", name), (f"topic: {topic}", f"type: {type_name}", *body, *kept)
    )


def _property(types: Interfaces, name: str, type_name: str) -> tuple[str, ...]:
    if type_name in _BIG:
        comment = f"{name}(Object), for Python code; get_{name} reads the newest message"
        return "properties", comment, "fields: [{path: ., as: object}]", "mode: on_demand"
    values = values_of(types, type_name)
    if not values:
        return _only_lists(types, name, type_name)
    others = [value.path for value in values[MANY:]]
    others += [field for field, _ in lists_of(types, type_name) if not field.endswith("covariance")]
    more = [f"# further fields: {_some(others)}"] if others else []
    shown = values[:MANY]
    return "properties", _call(name, shown), *_fields(shown), *more, *_calm(shown)


_MOST_NAMES = 8
"""Number of field names listed in a comment."""


def _some(names: Sequence[str]) -> str:
    more = f", and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    return f"{', '.join(names[:_MOST_NAMES])}{more}"


def _only_lists(types: Interfaces, name: str, type_name: str) -> tuple[str, ...]:
    lists = lists_of(types, type_name)
    if not lists:
        return "signals", f"{name}, for each message (the type has no fields)"
    field, kind = lists[0]
    if not kind.is_message:
        return "properties", f"{name}(List)", f"fields: [{list_of(field, kind).as_field}]", "rate: 5"
    elements = values_of(types, kind.base)
    key = _key(elements)
    if key is None:
        comment = f"{name}(N): number of {field}; `each: {field}` gives each of them"
        return "properties", comment, f"fields: [{{path: {field}, as: count}}]"
    shown = [key, *(each for each in elements if each is not key)][:MANY]
    comment = f"{_call(name, shown)}, one for each element of {field}"
    return "properties", comment, f"each: {field}", *_fields(shown), *_calm(shown)


def _key(elements: Sequence[GivenValue]) -> GivenValue | None:
    """Return the field that identifies an element of a list."""
    for wanted in ("name", "id"):
        for value in elements:
            last = value.path.rpartition(".")[2]
            if last == wanted or (value.path == last and last.endswith(f"_{wanted}")):
                return value
    return None


def _fields(values: Sequence[GivenValue]) -> list[str]:
    return ["fields:", *(f"  - {value.as_field}{value.remark}" for value in values)]


def _calm(values: Sequence[GivenValue]) -> list[str]:
    """Return a rate and dead bands for numbers that keep changing a little."""
    if all(value.unit.digits is None for value in values):
        return []
    if not any(value.unit.band for value in values):
        return ["rate: 5"]
    return ["rate: 5", f"dead_band: [{', '.join(_figure(value.unit.band) for value in values)}]"]


def _figure(number: float) -> str:
    """Return a number in YAML notation without an exponent."""
    return f"{number:.5f}".rstrip("0").rstrip(".")


def _call(name: str, values: Sequence[GivenValue]) -> str:
    """Return the AgentSpeak notation: ``odom(X, Y, Yaw): metres, metres, degrees``."""
    arguments = ", ".join(_variable(value.name) for value in values)
    head = f"{name}({arguments})" if values else name
    if not any(value.unit.word for value in values):
        return head
    return f"{head}: {', '.join(value.unit.word or value.name for value in values)}"


def _variable(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def _kept(info: TopicInfo, type_name: str) -> list[str]:
    """Return the quality of service that receives the latched messages of a publisher."""
    offers = [each.qos for each in info.publishers if each.qos is not None]
    if any(each.durability != "transient_local" for each in offers):
        return []
    if any(each.reliability != "reliable" for each in offers):
        return ["qos: {durability: transient_local, reliability: best_effort}"]
    return ["qos: latched"] if offers or type_name == "nav_msgs/msg/OccupancyGrid" else []


def looking(entry: MappingEntry) -> MappingEntry | None:
    """Return the operation that reads a property on demand."""
    if "mode: on_demand" not in entry.lines:
        return None
    return MappingEntry(
        "operations", f"get_{entry.name}", "takes the newest message", (f"refresh: {entry.name}",)
    )


def publishing(types: Interfaces, name: str, topic: str, info: TopicInfo) -> list[MappingEntry]:
    """Return operations that publish on a topic; for velocities also one that stops."""
    type_name = info.types[0]
    if type_name in VELOCITIES:
        return _driving(name, topic, type_name)
    inputs, body = _filled(types, type_name, "fields")
    lines = [*_parameters(inputs), f"publish: {topic}", f"type: {type_name}", *body]
    wants = [each.qos for each in info.subscriptions if each.qos is not None]
    if any(each.durability == "transient_local" for each in wants):
        lines.append("qos: latched")
    return [MappingEntry("operations", name, _call(name, inputs), tuple(lines))]


def _driving(name: str, topic: str, type_name: str) -> list[MappingEntry]:
    inner = "" if type_name == VELOCITIES[0] else "twist."
    stamp = [] if not inner else ["  header.stamp: now", "  header.frame_id: base_link"]
    drive = (
        "parameters: [speed, turn, seconds]",
        f"publish: {topic}",
        f"type: {type_name}",
        "fields:",
        *stamp,
        f"  {inner}linear.x: $speed",
        f"  {inner}angular.z: {{value: $turn, unit: degrees}}",
        "rate: 10   # repeated, because robots stop without commands",
        "duration: $seconds   # stops after this time",
    )
    comment = f"{name}(Speed, Turn, Seconds): metres per second, degrees per second"
    stop = MappingEntry(
        "operations",
        "stop" if name == "drive" else f"stop_{name}",
        "stops immediately",
        (f"publish: {topic}", f"type: {type_name}"),
    )
    return [MappingEntry("operations", name, comment, drive), stop]


def calling(types: Interfaces, name: str, service: str, type_name: str) -> MappingEntry:
    """Return an operation that calls a service."""
    inputs, body = _filled(types, request_type(type_name), "request")
    outputs = _results(types, response_type(type_name))
    lines = (*_parameters(inputs), f"service: {service}", f"type: {type_name}", *body, *_outputs(outputs))
    return MappingEntry("operations", name, _call(name, [*inputs, *outputs]), lines)


def acting(types: Interfaces, name: str, action: str, type_name: str) -> MappingEntry:
    """Return an operation that sends a goal and waits for its result."""
    inputs, body = _filled(types, goal_type(type_name), "goal")
    outputs = _results(types, result_type(type_name))
    lines = [*_parameters(inputs), f"action: {action}", f"type: {type_name}", *body, *_outputs(outputs)]
    lines += _feedback(types, name, type_name)
    lines += [_SUCCESS[type_name]] if type_name in _SUCCESS else []
    lines.append("suspend: cancel   # .suspend cancels the goal and stops the robot; .resume sends it again")
    return MappingEntry("operations", name, _call(name, [*inputs, *outputs]), tuple(lines))


_SUCCESS = {
    "irobot_create_msgs/action/Dock": "success: is_docked",
    "irobot_create_msgs/action/Undock": "success: {path: is_docked, is: false}",
}
"""Fields that decide, apart from the status, whether an action succeeded."""


def _feedback(types: Interfaces, name: str, type_name: str) -> list[str]:
    values = values_of(types, feedback_type(type_name))
    way = [value for value in values if value.path == "distance_remaining"]
    shown = way or values[:3]
    if not shown:
        return []
    event, more = ("distance_left", ", dead_band: 0.1") if way else (f"{name}_feedback", "")
    items = ", ".join(value.as_field for value in shown)
    return ["feedback:", f"  # {_call(event, shown)}", f"  {event}: {{fields: [{items}], rate: 2{more}}}"]


_TOLD_ANYWAY = (
    "is_docked",
    "success",
    "message",
    "status_message",
    "error_code",
    "error_msg",
    "error_string",
)
"""Result fields that make the operation fail, with a reason."""
_REMARKS = ("kobuki_msgs/action/AutoDocking_Result",)
"""Result types with nothing but a message; plans for docking do not expect an output."""


def _results(types: Interfaces, type_name: str) -> list[GivenValue]:
    values = values_of(types, type_name) if type_name not in _REMARKS else []
    return [value for value in values if value.path not in _TOLD_ANYWAY and "pose." not in value.path][:3]


def _outputs(values: Sequence[GivenValue]) -> list[str]:
    return [f"outputs: [{', '.join(value.as_field for value in values)}]"] if values else []


def _parameters(inputs: Sequence[GivenValue]) -> list[str]:
    return [f"parameters: [{', '.join(value.name for value in inputs)}]"] if inputs else []


def _filled(types: Interfaces, type_name: str, key: str) -> tuple[list[GivenValue], list[str]]:
    """Return the parameters that fill a message, and its lines under *key*."""
    values = values_of(types, type_name)
    inputs, left = values[:MANY], [value.path for value in values[MANY:]]
    filled = (f"  {value.path}: {value.as_value}{value.remark}" for value in inputs)
    lines = [*_headers(types, type_name), *filled]
    for name, kind in lists_of(types, type_name):
        if len(inputs) >= MANY or not _can_be_given(kind):
            left.append(name)
        else:
            value, more = _list(types, name, kind)
            inputs = [*inputs, value]
            lines += more
    if left:
        lines.append(f"  # unchanged: {_some(left)}")
    return inputs, [f"{key}:", *lines] if any(not line.startswith("  #") for line in lines) else []


_PLACES = ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/Pose", "geometry_msgs/msg/Point")
_OCTETS = ("byte", "char", "int8", "uint8")


def _can_be_given(kind: FieldType) -> bool:
    """Return whether an agent can write the list: poses, or numbers and strings, but no covariances or images."""
    if kind.is_message:
        return kind.base in _PLACES
    return not kind.fixed and kind.base not in _OCTETS


def _list(types: Interfaces, name: str, kind: FieldType) -> tuple[GivenValue, list[str]]:
    """Return a list parameter, and the lines that put it into a message."""
    if not kind.is_message:
        value = list_of(name, kind)
        return value, [f"  {name}: {value.as_value}"]
    elements = values_of(types, kind.base)
    comment = f"a list of {_call('place', elements).partition(':')[0]}"
    lines = [
        f"  {name}:",
        f"    each: ${name.lower()}",
        f"    fields: {{{_elements(types, kind.base, elements)}}}",
    ]
    return GivenValue(name, name.lower(), "", Unit(comment)), lines


def _elements(types: Interfaces, type_name: str, values: Sequence[GivenValue]) -> str:
    """Return how the parts of each list element are filled."""
    headers = [line.strip() for line in _headers(types, type_name)]
    parts = [
        f"{value.path}: {replace(value, name=str(number)).as_value}" for number, value in enumerate(values, 1)
    ]
    return ", ".join([*headers, *parts])


_IN_A_FRAME = {f"geometry_msgs/msg/{name}" for name in ("Point", "Point32", "Pose2D", "Transform")}


def _headers(types: Interfaces, type_name: str) -> list[str]:
    """Return lines that stamp headers with the current time, and put poses into the map frame."""
    has_place = not _IN_A_FRAME.isdisjoint(messages(types.fields, type_name))
    lines = []
    for leaf in leaves(types.fields, type_name):
        path, _, last = leaf.path.rpartition(".")
        if leaf.owner == HEADER and last == "frame_id" and path and "[" not in path:
            lines += [f"  {path}.frame_id: map"] if has_place else []
            lines.append(f"  {path}.stamp: now")
    return lines


def plain_name(name: str) -> str:
    """Return a name for agents from a ROS name or a part of it: ``CamelCase`` becomes ``camel_case``."""
    snake = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name.strip("/")).lower()
    plain = re.sub(r"\W", "_", snake).strip("_")
    return plain if plain[:1].isalpha() and plain not in RESERVED else f"the_{plain}"
