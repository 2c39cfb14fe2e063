"""The ``robots`` part of a world file: one mapping to a `RobotDescription`.

All keys are optional; these are the defaults, except for the noise of odometry and laser (0)::

    - name: turtlebot
      kind: turtlebot               # or turtlebot2, turtlebot3, turtlebot4, with other defaults: `jacaros.sim.robot.kinds`
      namespace: ""                 # prefix of the topics
      pose: {x: 0, y: 0, yaw_degrees: 0}
      radius: 0.17                  # or footprint: [length, width], a rectangle
      limits: {speed: 0.65, turn_rate_degrees: 180, acceleration: 0.8, turn_acceleration_degrees: 286.5,
               command_timeout: 0.5}
      battery: {level: 100, drain_per_second: 0.01, drain_per_metre: 0.02, drain_per_turn: 0,
                charge_per_second: 5}
      odometry: {origin: world,     # or start: counts from the initial pose
                 noise_per_metre: 0.02, noise_degrees_per_turn: 2, noise_degrees_per_metre: 1}
      laser: {enabled: true, beams_per_turn: 360, field_degrees: 360, range_min: 0.1, range_max: 10,
              noise: 0.01, publish: on demand}    # or always
      navigation: {enabled: true, speed: 0.4}    # or true, or false
      gripper: {reach: 0.35}        # or true, or false, the default
      tools: {vacuum: {removes: [dust], rate: 5, reach: 0.3}}    # no tools by default
      topics, services, actions: see `jacaros.sim.files.interface`
"""

import math
import re

from jacaros.files.yaml import Node
from jacaros.sim.description import (
    BatterySettings,
    CleaningTool,
    LaserSettings,
    NavigationSettings,
    OdometrySettings,
    Pose,
    RobotDescription,
    RobotLimits,
)
from jacaros.sim.files.interface import SECTIONS, read_interface
from jacaros.sim.robot.kinds import KINDS, USUAL
from jacaros.sim.trigonometry import TWO_PI, radians

_NAMESPACE = re.compile(r"/?[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*")

_REACH = 0.35
"""Default reach of a gripper, in metres."""


def read_robot(node: Node) -> RobotDescription:
    """Read one robot; the defaults are those of its kind, at the origin."""
    entries = node.mapping(
        "name",
        "kind",
        "namespace",
        "pose",
        "radius",
        "footprint",
        "limits",
        "battery",
        "odometry",
        "laser",
        "navigation",
        "tools",
        "gripper",
        *SECTIONS,
    )
    usual = KINDS[entries["kind"].choice(*KINDS)] if "kind" in entries else KINDS[USUAL]
    footprint = _footprint(entries["footprint"]) if "footprint" in entries else None
    if footprint is not None and "radius" in entries:
        entries["radius"].wrong("'radius' and 'footprint' are alternatives", "remove one of them")
    return RobotDescription(
        name=entries["name"].text() if "name" in entries else "turtlebot",
        namespace=_namespace(entries.get("namespace")),
        pose=_pose(entries.get("pose")),
        radius=_radius(entries.get("radius"), footprint, usual.radius),
        footprint=footprint,
        limits=_limits(entries.get("limits"), usual.limits),
        battery=_battery(entries.get("battery")),
        odometry=_odometry(entries.get("odometry")),
        laser=_laser(entries.get("laser"), usual.laser),
        navigation=_navigation(entries.get("navigation"), usual.navigation),
        gripper_reach=_gripper_reach(entries.get("gripper")),
        interface=read_interface(entries, usual.interface),
        tools=tuple(_tool(name, tool) for name, tool in entries["tools"].entries())
        if "tools" in entries
        else (),
    )


def _footprint(node: Node) -> tuple[float, float]:
    length, width = node.pair()
    if not (0.04 <= length <= 4.0 and 0.04 <= width <= 4.0):
        node.wrong("a footprint is from 0.04 to 4 m long and wide", "write [length, width], in metres")
        return 0.34, 0.34
    return length, width


def _radius(node: Node | None, footprint: tuple[float, float] | None, usual: float) -> float:
    """Return the radius: that of the circle around a rectangular footprint, if there is one."""
    if footprint is not None:
        length, width = footprint
        return 0.5 * math.sqrt(length * length + width * width)
    return node.number(0.02, 2.0, usual) if node is not None else usual


def read_pose(entries: dict[str, Node]) -> Pose:
    """Read a pose from the keys ``x``, ``y`` (metres) and ``yaw_degrees``, each 0 by default."""

    def value(key: str) -> float:
        return entries[key].number() if key in entries else 0.0

    return Pose(value("x"), value("y"), radians(value("yaw_degrees")))


def _pose(node: Node | None) -> Pose:
    return read_pose(node.mapping("x", "y", "yaw_degrees")) if node is not None else Pose(0.0, 0.0, 0.0)


def _namespace(node: Node | None) -> str:
    text = node.text() if node is not None else ""
    if node is not None and text and not _NAMESPACE.fullmatch(text):
        node.wrong(
            f"'{text}' is not a ROS namespace", "use letters, digits and _, with / between parts: robot_1"
        )
    return text.strip("/")


class _Section:
    """A mapping of optional numbers with their defaults."""

    def __init__(self, node: Node | None, *known: str) -> None:
        self.entries = node.mapping(*known) if node is not None else {}

    def number(self, key: str, default: float, minimum: float = 0.0, maximum: float = 1e9) -> float:
        entry = self.entries.get(key)
        return entry.number(minimum, maximum, default) if entry is not None else default

    def angle(self, key: str, default: float, minimum: float = 0.0, maximum: float = 1e9) -> float:
        """Return an angle in radians, like its default; the file has degrees."""
        return radians(self.number(key, 0.0, minimum, maximum)) if key in self.entries else default

    def truth(self, key: str, default: bool) -> bool:
        return self.entries[key].truth() if key in self.entries else default


def _limits(node: Node | None, usual: RobotLimits) -> RobotLimits:
    section = _Section(
        node,
        "speed",
        "turn_rate_degrees",
        "acceleration",
        "turn_acceleration_degrees",
        "command_timeout",
    )
    return RobotLimits(
        speed=section.number("speed", usual.speed, 0.01, 5.0),
        turn_rate=section.angle("turn_rate_degrees", usual.turn_rate, 0.1, 3600.0),
        acceleration=section.number("acceleration", usual.acceleration, 0.01),
        turn_acceleration=section.angle("turn_acceleration_degrees", usual.turn_acceleration, 0.1),
        command_timeout=section.number("command_timeout", usual.command_timeout, 0.05),
    )


def _battery(node: Node | None) -> BatterySettings:
    usual = BatterySettings()
    section = _Section(
        node, "level", "drain_per_second", "drain_per_metre", "drain_per_turn", "charge_per_second"
    )
    return BatterySettings(
        level=section.number("level", usual.level, 0.0, 100.0),
        drain_per_second=section.number("drain_per_second", usual.drain_per_second),
        drain_per_metre=section.number("drain_per_metre", usual.drain_per_metre),
        drain_per_radian=section.number("drain_per_turn", 0.0) / TWO_PI,
        charge_per_second=section.number("charge_per_second", usual.charge_per_second),
    )


def _odometry(node: Node | None) -> OdometrySettings:
    section = _Section(node, "origin", "noise_per_metre", "noise_degrees_per_turn", "noise_degrees_per_metre")
    origin = section.entries.get("origin")
    per_turn = radians(section.number("noise_degrees_per_turn", 0.0))
    return OdometrySettings(
        from_start=origin is not None and origin.choice("world", "start") == "start",
        per_metre=section.number("noise_per_metre", 0.0),
        # The error of a whole turn is that of 2 pi radians, and the squares of errors add up.
        per_radian=per_turn / math.sqrt(TWO_PI),
        turn_per_metre=radians(section.number("noise_degrees_per_metre", 0.0)),
    )


def _laser(node: Node | None, usual: LaserSettings) -> LaserSettings:
    section = _Section(
        node, "enabled", "beams_per_turn", "field_degrees", "range_min", "range_max", "noise", "publish"
    )
    beams = section.entries.get("beams_per_turn")
    publish = section.entries.get("publish")
    field = section.angle("field_degrees", usual.field, 1.0, 360.0)
    return LaserSettings(
        enabled=section.truth("enabled", True),
        beams_per_turn=beams.whole(4, 360) if beams is not None else usual.beams_per_turn,
        field=field,
        range_min=section.number("range_min", usual.range_min),
        range_max=section.number("range_max", usual.range_max, 0.1),
        noise=section.number("noise", usual.noise, 0.0, 1.0),
        always=publish is not None and publish.choice("on demand", "always") == "always",
    )


def _gripper_reach(node: Node | None) -> float:
    if node is not None and isinstance(node.value, dict):
        return _Section(node, "reach").number("reach", _REACH, 0.05, 5.0)
    return _REACH if node is not None and node.truth() else 0.0


def _navigation(node: Node | None, usual: NavigationSettings) -> NavigationSettings:
    if node is not None and not isinstance(node.value, dict):
        return NavigationSettings(node.truth(), usual.speed)
    section = _Section(node, "enabled", "speed")
    return NavigationSettings(
        enabled=section.truth("enabled", usual.enabled), speed=section.number("speed", usual.speed, 0.05, 5.0)
    )


def _tool(name: Node, node: Node) -> CleaningTool:
    entries = node.mapping("removes", "rate", "reach", required=("removes",))
    usual = CleaningTool(name.text(), ())
    if "removes" in entries and not entries["removes"].value:
        entries["removes"].wrong(
            "a tool removes at least one kind of dirt", "write the kinds: [dust, crumbs]"
        )
    return CleaningTool(
        usual.name,
        tuple(kind.text() for kind in entries["removes"].sequence()) if "removes" in entries else (),
        entries["rate"].number(0.0, 1e6, usual.rate) if "rate" in entries else usual.rate,
        entries["reach"].number(0.01, 10.0, usual.reach) if "reach" in entries else usual.reach,
    )
