"""The usual topics, services and actions of a robot, found by their types and names, and entries for some of them."""

from collections.abc import Iterator, Mapping

from jacaros.robots.ros.backend import GraphContents
from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.runtime.cli.graph.listing import GraphEntry, GraphKind, all_things

_BASE = ("nav_msgs/msg/Odometry", "sensor_msgs/msg/LaserScan")
"""A namespace with one of these topics, or a subscription to ``cmd_vel``, belongs to a robot."""
_USUAL = {
    **dict.fromkeys(VELOCITIES, "cmd_vel"),
    "nav_msgs/msg/OccupancyGrid": "map",
    "geometry_msgs/msg/PoseWithCovarianceStamped": "amcl_pose",
    "nav_msgs/msg/Odometry": "",
    "sensor_msgs/msg/LaserScan": "",
    "sensor_msgs/msg/BatteryState": "",
    "sensor_msgs/msg/Range": "",
    "sensor_msgs/msg/Imu": "",
    "irobot_create_msgs/msg/DockStatus": "",
}
"""Types of usual topics, and the last part of the topic's name; empty for any."""
_ROLES = (
    (
        "irobot_create_msgs/msg/HazardDetectionVector",
        "kobuki_msgs/msg/BumperEvent",
        "turtlebot3_msgs/msg/SensorState",
    ),
    ("nav2_msgs/action/NavigateToPose", "move_base_msgs/action/MoveBase"),
    ("irobot_create_msgs/action/Dock", "nav2_msgs/action/DockRobot", "kobuki_msgs/action/AutoDocking"),
    ("irobot_create_msgs/action/Undock", "nav2_msgs/action/UndockRobot"),
    ("irobot_create_msgs/action/DriveDistance",),
    ("irobot_create_msgs/action/RotateAngle",),
)
"""Roles, and the types for each: the first type found is used."""
_SERVICES = ("std_srvs/srv/Trigger", "std_srvs/srv/Empty")
_INNER = (
    "costmap",
    "lifecycle",
    "slam",
    "amcl",
    "recorder",
    "/_",
    "/rosbridge",
    "/rosapi",
    "global_localization",
)
"""Parts of names of services that belong to programs, not to the robot."""
SERVICES_AT_MOST = 10
_OF_ROS = ("/tf", "/tf_static", "/clock", "/statistics")
"""Topics that agents use in other ways, or not at all."""


_SIDES = "names: {0: left, 1: center, 2: right}"
KNOWN: Mapping[str, tuple[str, ...]] = {
    "nav_msgs/msg/Odometry": (
        "properties",
        "NAME(X, Y, Yaw): metres, metres, degrees",
        "fields:",
        "  - {path: pose.pose.position.x, round: 2}",
        "  - {path: pose.pose.position.y, round: 2}",
        "  - {path: pose.pose.orientation, as: yaw, unit: degrees, round: 1}",
        "rate: 5   # updates per second, at most",
        "dead_band: [0.02, 0.02, 1]   # smaller changes are ignored",
    ),
    "sensor_msgs/msg/LaserScan": (
        "properties",
        "NAME(R0, R25, R50, R75, R100): metres, five ranges from the first to the last",
        "fields: [{path: ranges, sample: 5, otherwise: range_max, round: 2}]",
        "rate: 2",
        "dead_band: 0.02",
    ),
    "sensor_msgs/msg/BatteryState": (
        "properties",
        "NAME(Percent, Status): such as NAME(80, discharging)",
        "fields:",
        "  - {path: percentage, unit: percent, round: down}",
        "  - {path: power_supply_status, as: name}",
    ),
    "sensor_msgs/msg/JointState": (
        "properties",
        "NAME(Joint, Position): one for each joint; radians, or metres for a prismatic joint",
        "each: name",
        'fields: [{path: ., name: joint}, {path: "/position[i]", round: 3}]',
        "rate: 5",
        "dead_band: 0.01",
    ),
    "diagnostic_msgs/msg/DiagnosticArray": (
        "properties",
        "NAME(Part, Level, Text): one for each part of the robot",
        "each: status",
        "key: name",
        "fields: [name, {path: level, names: {0: ok, 1: warning, 2: error, 3: stale}}, message]",
    ),
    "irobot_create_msgs/msg/HazardDetectionVector": (
        "signals",
        "NAME(Kind, Where): such as NAME(bump, bump_front_left)",
        "each: detections",
        "fields: [{path: type, as: name}, {path: header.frame_id, as: atom}]",
        "when_changed: true   # once, not repeatedly while it lasts",
    ),
    "kobuki_msgs/msg/BumperEvent": (
        "signals",
        "NAME(Where, State): such as NAME(left, pressed)",
        "fields:",
        f"  - {{path: bumper, {_SIDES}}}",
        "  - {path: state, names: {0: released, 1: pressed}}",
    ),
    "kobuki_msgs/msg/CliffEvent": (
        "signals",
        "NAME(Where, State): such as NAME(left, cliff)",
        "fields:",
        f"  - {{path: sensor, {_SIDES}}}",
        "  - {path: state, names: {0: floor, 1: cliff}}",
    ),
}
"""Section, comment and lines in a first mapping file for topics that most robots have; ``NAME`` stands for the name of
the entry.
"""


def usual_things(contents: GraphContents) -> list[GraphEntry]:
    """Return odometry, scan, velocity, battery, bumpers, map, actions to drive and dock, and plain services."""
    things = all_things(contents)
    spaces = robots(contents)
    taken = {thing for space in ("", *spaces) for thing in _in_roles(things, contents, space, spaces)}
    found = [thing for thing in things if thing in taken or _is_usual(thing, contents)]
    services = [thing for thing in found if thing.kind is GraphKind.SERVICE][:SERVICES_AT_MOST]
    return [thing for thing in found if thing.kind is not GraphKind.SERVICE] + services


def left_out(contents: GraphContents, taken: list[GraphEntry]) -> list[GraphEntry]:
    """Return the rest that could be mapped: actions, then topics with publishers, other topics, and services."""

    def order(thing: GraphEntry) -> int:
        if thing.kind is GraphKind.ACTION:
            return 0
        return 3 if thing.kind is GraphKind.SERVICE else 1 if _is_there(thing, contents) else 2

    others = [
        thing
        for thing in all_things(contents)
        if thing not in taken
        and thing.kind is not GraphKind.NODE
        and thing.type_name
        and thing.name not in _OF_ROS
        and not any(part in thing.name for part in _INNER)
    ]
    return sorted(others, key=order)


def _in_roles(
    things: list[GraphEntry], contents: GraphContents, space: str, spaces: list[str]
) -> Iterator[GraphEntry]:
    """Yield the entries of one robot for each role."""
    own = [thing for thing in things if robot_of(thing.name, spaces) == space and _is_there(thing, contents)]
    for role in _ROLES:
        for type_name in role:
            fitting = [thing for thing in own if thing.type_name == type_name]
            if fitting:
                yield from fitting
                break


def _is_there(thing: GraphEntry, contents: GraphContents) -> bool:
    return thing.kind is not GraphKind.TOPIC or bool(contents.topics[thing.name].publishers)


def _is_usual(thing: GraphEntry, contents: GraphContents) -> bool:
    if thing.kind is GraphKind.SERVICE:
        return thing.type_name in _SERVICES and not any(part in thing.name for part in _INNER)
    wanted = _USUAL.get(thing.type_name)
    if thing.kind is not GraphKind.TOPIC or wanted not in ("", thing.name.rpartition("/")[2]):
        return False
    info = contents.topics[thing.name]
    return bool(info.subscriptions if thing.type_name in VELOCITIES else info.publishers)


def robots(contents: GraphContents) -> list[str]:
    """Return the namespaces of robots without leading slash, sorted, without ``""``.

    Beside a robot without a namespace, a namespace with a single such topic is a part of that robot, such as a second
    laser.
    """
    found: dict[str, set[str]] = {}
    for name, info in contents.topics.items():
        space, _, last = name.strip("/").rpartition("/")
        kinds = set(info.types).intersection(_BASE)
        if last == "cmd_vel" and not set(VELOCITIES).isdisjoint(info.types):
            kinds.add(last)
        if kinds:
            found.setdefault(space, set()).update(kinds)
    return sorted(space for space, kinds in found.items() if space and (len(kinds) > 1 or "" not in found))


def robot_of(name: str, namespaces: list[str]) -> str:
    """Return the robot that owns a name; empty for none."""
    fitting = [space for space in namespaces if name.startswith(f"/{space}/")]
    return min(fitting, key=len, default="")
