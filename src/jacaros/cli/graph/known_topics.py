"""Entries of a first mapping file for topics that most robots have."""

from collections.abc import Callable, Mapping, Sequence

Body = tuple[str, str, Sequence[str]]
"""Section, comment and lines of an entry."""


def _odometry(name: str) -> Body:
    return (
        "properties",
        f"{name}(X, Y, Yaw): metres, metres, degrees",
        [
            "fields:",
            "  - {path: pose.pose.position.x, round: 2}",
            "  - {path: pose.pose.position.y, round: 2}",
            "  - {path: pose.pose.orientation, as: yaw, unit: degrees, round: 1}",
            "rate: 5   # updates per second, at most",
            "dead_band: [0.02, 0.02, 1]   # smaller changes are ignored",
        ],
    )


def _laser(name: str) -> Body:
    return (
        "properties",
        f"{name}(R0, R25, R50, R75, R100): metres, five ranges from the first to the last",
        ["fields: [{path: ranges, sample: 5, otherwise: range_max, round: 2}]", "rate: 2", "dead_band: 0.02"],
    )


def _battery(name: str) -> Body:
    return (
        "properties",
        f"{name}(Percent, Status): such as {name}(80, discharging)",
        [
            "fields:",
            "  - {path: percentage, unit: percent, round: down}",
            "  - {path: power_supply_status, as: name}",
        ],
    )


def _joints(name: str) -> Body:
    return (
        "properties",
        f"{name}(Joint, Position): one for each joint; radians, or metres for a prismatic joint",
        [
            "each: name",
            'fields: [{path: ., name: joint}, {path: "/position[i]", round: 3}]',
            "rate: 5",
            "dead_band: 0.01",
        ],
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
        [
            "each: detections",
            "fields: [{path: type, as: name}, {path: header.frame_id, as: atom}]",
            "when_changed: true   # once, not repeatedly while it lasts",
        ],
    )


def _kobuki_bumper(name: str) -> Body:
    return (
        "signals",
        f"{name}(Where, State): such as {name}(left, pressed)",
        ["fields:", f"  - {{path: bumper, {_SIDES}}}", "  - {path: state, names: {0: released, 1: pressed}}"],
    )


def _kobuki_cliff(name: str) -> Body:
    return (
        "signals",
        f"{name}(Where, State): such as {name}(left, cliff)",
        ["fields:", f"  - {{path: sensor, {_SIDES}}}", "  - {path: state, names: {0: floor, 1: cliff}}"],
    )


_SIDES = "names: {0: left, 1: center, 2: right}"

KNOWN: Mapping[str, Callable[[str], Body]] = {
    "nav_msgs/msg/Odometry": _odometry,
    "sensor_msgs/msg/LaserScan": _laser,
    "sensor_msgs/msg/BatteryState": _battery,
    "sensor_msgs/msg/JointState": _joints,
    "diagnostic_msgs/msg/DiagnosticArray": _diagnostics,
    "irobot_create_msgs/msg/HazardDetectionVector": _hazards,
    "kobuki_msgs/msg/BumperEvent": _kobuki_bumper,
    "kobuki_msgs/msg/CliffEvent": _kobuki_cliff,
}
