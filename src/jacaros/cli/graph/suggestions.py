"""What a first mapping says of a thing: sensible fields, rates and parameters, and a comment for its reader."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from jacaros.cli.graph.definitions import Fields
from jacaros.cli.graph.values import HEADER, MANY, Value, lists_of, values_of
from jacaros.ros.graph import TopicInfo
from jacaros.ros.names import feedback_type, goal_type, request_type, result_type

TWISTS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_BIG = (
    "sensor_msgs/msg/Image",
    "sensor_msgs/msg/CompressedImage",
    "sensor_msgs/msg/PointCloud2",
    "sensor_msgs/msg/PointCloud",
    "nav_msgs/msg/OccupancyGrid",
    "nav_msgs/msg/Path",
)
"""Nobody believes a picture: agents get a reference, for operations and internal actions in Python."""


@dataclass(frozen=True, slots=True)
class Entry:
    """A property, signal or operation of a mapping file.

    Attributes:
        section: ``properties``, ``signals`` or ``operations``.
        name: for agents.
        comment: how agents write it, and in which units.
        lines: its keys, without indentation in front.
    """

    section: str
    name: str
    comment: str
    lines: tuple[str, ...]


def property_of(fields: Fields, name: str, topic: str, info: TopicInfo) -> Entry:
    """A property that follows a topic; a signal where messages are events.  Raises `UnknownInterface`."""
    type_name = info.types[0]
    known = _KNOWN.get(type_name)
    section, comment, body = known(name) if known is not None else _property(fields, name, type_name)
    return Entry(
        section, name, comment, (f"topic: {topic}", f"type: {type_name}", *body, *_kept(info, type_name))
    )


Body = tuple[str, str, Sequence[str]]
"""Section, comment and further lines."""


def _property(fields: Fields, name: str, type_name: str) -> Body:
    if type_name in _BIG:
        comment = f"{name}(Object), for Python code; an agent looks with get_{name}"
        return "properties", comment, ["fields: [{path: ., as: object}]", "mode: on_demand"]
    values = values_of(fields, type_name)
    shown = values[:MANY]
    if not shown:
        return _only_lists(fields, name, type_name)
    more = (
        [f"# there are also {', '.join(value.path for value in values[MANY:])}"] if len(values) > MANY else []
    )
    return "properties", _call(name, shown), [*_fields(shown), *more, *_calm(shown)]


def _only_lists(fields: Fields, name: str, type_name: str) -> Body:
    lists = [(field, kind) for field, kind in lists_of(fields, type_name) if kind.base != HEADER]
    if not lists:
        return "properties", f"{name}: the message has no fields", ["fields: [{path: ., as: object}]"]
    field, kind = lists[0]
    if not kind.is_message:
        return "properties", f"{name}(List)", [f"fields: [{field}]", "rate: 5"]
    comment = f"{name}(N): how many {field} there are; `each: {field}` would show each of them"
    return "properties", comment, [f"fields: [{{path: {field}, as: count}}]"]


def _fields(values: Sequence[Value]) -> list[str]:
    return ["fields:", *(f"  - {value.as_field}" for value in values)]


def _calm(values: Sequence[Value]) -> list[str]:
    """Numbers that always change a little are told now and then."""
    if not any(value.conversion or value.unit for value in values):
        return []
    bands = {"degrees": "1", "metres": "0.02", "degrees per second": "1"}
    return ["rate: 5", f"dead_band: [{', '.join(bands.get(value.unit, '0.01') for value in values)}]"]


def _call(name: str, values: Sequence[Value]) -> str:
    """How agents write it: ``odom(X, Y, Yaw): metres, metres, degrees``."""
    arguments = ", ".join(_variable(value.name) for value in values)
    head = f"{name}({arguments})" if values else name
    if not any(value.unit for value in values):
        return head
    return f"{head}: {', '.join(value.unit or value.name for value in values)}"


def _variable(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def _odometry(name: str) -> Body:
    return (
        "properties",
        f"{name}(X, Y, Yaw): metres, metres, degrees",
        [
            "fields:",
            "  - pose.pose.position.x",
            "  - pose.pose.position.y",
            "  - {path: pose.pose.orientation, as: yaw, unit: degrees}",
            "rate: 5   # at most so many times a second",
            "dead_band: [0.02, 0.02, 1]   # smaller changes are not told",
        ],
    )


def _laser(name: str) -> Body:
    return (
        "properties",
        f"{name}(R0, R25, R50, R75, R100): metres, five of the ranges from the first to the last",
        ["fields: [{path: ranges, sample: 5, otherwise: range_max, round: 2}]", "rate: 2"],
    )


def _battery(name: str) -> Body:
    return (
        "properties",
        f"{name}(Percent, Status): such as {name}(80, discharging)",
        [
            "fields:",
            "  - {path: percentage, unit: percent, round: 0, otherwise: 0}",
            "  - {path: power_supply_status, as: name}",
        ],
    )


def _joints(name: str) -> Body:
    return (
        "properties",
        f"{name}(Joint, Position): one for each joint; radians, or metres of a joint that slides",
        ["each: name", 'fields: [., {path: "/position[i]"}]', "rate: 5", "dead_band: 0.01"],
    )


def _diagnostics(name: str) -> Body:
    return (
        "properties",
        f"{name}(Part, Level, Text): one for each part of the robot",
        [
            "each: status",
            "key: name",
            "fields: [name, {path: level, names: {0: ok, 1: warning, 2: error, 3: stale}}, message]",
        ],
    )


def _hazards(name: str) -> Body:
    return (
        "signals",
        f"{name}(Kind, Where): such as {name}(bump, bump_front_left)",
        ["each: detections", "fields: [{path: type, as: name}, {path: header.frame_id, as: atom}]"],
    )


_KNOWN: Mapping[str, Callable[[str], Body]] = {
    "nav_msgs/msg/Odometry": _odometry,
    "sensor_msgs/msg/LaserScan": _laser,
    "sensor_msgs/msg/BatteryState": _battery,
    "sensor_msgs/msg/JointState": _joints,
    "diagnostic_msgs/msg/DiagnosticArray": _diagnostics,
    "irobot_create_msgs/msg/HazardDetectionVector": _hazards,
}


def _kept(info: TopicInfo, type_name: str) -> list[str]:
    """The quality of service that hears what a publisher keeps for late comers."""
    offers = [each.qos for each in info.publishers if each.qos is not None]
    if offers and all(each.durability == "transient_local" for each in offers):
        if all(each.reliability == "reliable" for each in offers):
            return ["qos: latched"]
        return ["qos: {durability: transient_local, reliability: best_effort}"]
    if not offers and type_name == "nav_msgs/msg/OccupancyGrid":
        return ["qos: latched"]
    return []


def looking(entry: Entry) -> Entry | None:
    """The operation that looks for a property on demand."""
    if "mode: on_demand" not in entry.lines:
        return None
    return Entry("operations", f"get_{entry.name}", "takes the newest message", (f"refresh: {entry.name}",))


def publishing(fields: Fields, name: str, topic: str, info: TopicInfo) -> list[Entry]:
    """Operations that publish on a topic; for velocities also one that stops."""
    type_name = info.types[0]
    if type_name in TWISTS:
        return _driving(name, topic, type_name)
    inputs, body = _filled(fields, type_name, "fields")
    lines = [*_parameters(inputs), f"publish: {topic}", f"type: {type_name}", *body]
    wants = [each.qos for each in info.subscriptions if each.qos is not None]
    if any(each.durability == "transient_local" for each in wants):
        lines.append("qos: latched")
    return [Entry("operations", name, _call(name, inputs), tuple(lines))]


def _driving(name: str, topic: str, type_name: str) -> list[Entry]:
    inner = "" if type_name == TWISTS[0] else "twist."
    stamp = [] if not inner else ["  header.stamp: now", "  header.frame_id: base_link"]
    drive = (
        "parameters: [speed, turn, seconds]",
        f"publish: {topic}",
        f"type: {type_name}",
        "fields:",
        *stamp,
        f"  {inner}linear.x: $speed",
        f"  {inner}angular.z: {{value: $turn, unit: degrees}}",
        "rate: 10   # again and again, since robots stop when nothing comes",
        "duration: $seconds   # then it stops",
    )
    comment = f"{name}(Speed, Turn, Seconds): metres per second, degrees per second"
    stop = Entry(
        "operations",
        "stop" if name == "drive" else f"stop_{name}",
        "stops at once",
        (f"publish: {topic}", f"type: {type_name}"),
    )
    return [Entry("operations", name, comment, drive), stop]


def calling(fields: Fields, name: str, service: str, type_name: str) -> Entry:
    """An operation that calls a service."""
    inputs, body = _filled(fields, request_type(type_name), "request")
    outputs = _results(fields, f"{type_name}_Response")
    lines = [*_parameters(inputs), f"service: {service}", f"type: {type_name}", *body, *_outputs(outputs)]
    return Entry("operations", name, _call(name, [*inputs, *outputs]), tuple(lines))


def acting(fields: Fields, name: str, action: str, type_name: str) -> Entry:
    """An operation that sends a goal and waits for its result."""
    inputs, body = _filled(fields, goal_type(type_name), "goal")
    outputs = _results(fields, result_type(type_name))
    lines = [*_parameters(inputs), f"action: {action}", f"type: {type_name}", *body, *_outputs(outputs)]
    lines += _feedback(fields, name, type_name)
    lines += [_SUCCESS[type_name]] if type_name in _SUCCESS else []
    if _moves(type_name):
        lines.append("suspend: cancel   # .suspend stops the robot, .resume sends the goal again")
    return Entry("operations", name, _call(name, [*inputs, *outputs]), tuple(lines))


_SUCCESS = {
    "irobot_create_msgs/action/Dock": "success: is_docked",
    "irobot_create_msgs/action/Undock": "success: {path: is_docked, is: false}",
}
"""What else than its status tells whether an action went well."""


def _moves(type_name: str) -> bool:
    package = type_name.partition("/")[0]
    return package in ("nav2_msgs", "move_base_msgs", "irobot_create_msgs", "kobuki_msgs")


def _feedback(fields: Fields, name: str, type_name: str) -> list[str]:
    values = {value.path: value for value in values_of(fields, feedback_type(type_name))}
    if "distance_remaining" in values:
        return [
            "feedback:",
            "  distance_left: {fields: [distance_remaining], rate: 2, dead_band: 0.1}   # metres",
        ]
    shown = list(values.values())[:3]
    if not shown:
        return []
    items = ", ".join(value.as_field for value in shown)
    return [
        "feedback:",
        f"  # {_call(f'{name}_feedback', shown)}",
        f"  {name}_feedback: {{fields: [{items}], rate: 2}}",
    ]


_TOLD_ANYWAY = (
    "is_docked",
    "success",
    "message",
    "status_message",
    "error_code",
    "error_msg",
    "error_string",
)
"""Fields of results that make the operation fail, with a reason."""
_REMARKS = ("kobuki_msgs/action/AutoDocking_Result",)
"""Results that hold nothing but a remark; plans of docking expect none."""


def _results(fields: Fields, type_name: str) -> list[Value]:
    values = values_of(fields, type_name) if type_name not in _REMARKS else []
    return [value for value in values if value.path not in _TOLD_ANYWAY and "pose." not in value.path][:3]


def _outputs(values: Sequence[Value]) -> list[str]:
    if not values:
        return []
    return [f"outputs: [{', '.join(value.as_field for value in values)}]"]


def _parameters(inputs: Sequence[Value]) -> list[str]:
    return [f"parameters: [{', '.join(value.name for value in inputs)}]"] if inputs else []


def _filled(fields: Fields, type_name: str, key: str) -> tuple[list[Value], list[str]]:
    """The parameters that fill a message, and the lines that do it under *key*."""
    values = values_of(fields, type_name)
    inputs, left = values[:MANY], [value.path for value in values[MANY:]]
    lines = [*_headers(fields, type_name), *(f"  {value.path}: {value.as_value}" for value in inputs)]
    for name, kind in lists_of(fields, type_name):
        elements = values_of(fields, kind.base) if kind.is_message else []
        if kind.base not in _PLACES or len(inputs) >= MANY:
            left.append(name)
            continue
        inputs = [
            *inputs,
            Value(name, name.lower(), "", f"a list of {_call('place', elements).partition(':')[0]}"),
        ]
        lines += [
            f"  {name}:",
            f"    each: ${name.lower()}",
            f"    fields: {{{_elements(fields, kind.base, elements)}}}",
        ]
    if left:
        lines.append(f"  # left as they are: {', '.join(left)}")
    return inputs, [f"{key}:", *lines] if any(not line.startswith("  #") for line in lines) else []


_PLACES = ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/Pose", "geometry_msgs/msg/Point")


def _elements(fields: Fields, type_name: str, values: Sequence[Value]) -> str:
    """What becomes of the parts of each element of a list."""
    headers = [line.strip() for line in _headers(fields, type_name)]
    parts = [
        f"{value.path}: {replace(value, name=str(number)).as_value}" for number, value in enumerate(values, 1)
    ]
    return ", ".join([*headers, *parts])


def _headers(fields: Fields, type_name: str, path: str = "") -> list[str]:
    """Headers of what has a place are of the map and of now."""
    lines = []
    for name, kind in fields(type_name).items():
        here = f"{path}.{name}" if path else name
        if kind.base == HEADER and not kind.array:
            lines += [f"  {here}.frame_id: map", f"  {here}.stamp: now"]
        elif kind.is_message and not kind.array:
            lines += _headers(fields, kind.base, here)
    return lines


def plain_name(name: str) -> str:
    """A name for agents from a ROS name or a part of it: ``CamelCase`` becomes ``camel_case``."""
    snake = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name.strip("/")).lower()
    plain = re.sub(r"\W", "_", snake).strip("_")
    return plain if plain[:1].isalpha() else f"the_{plain}"
