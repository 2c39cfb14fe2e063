"""A robot as plain data, in metres, radians, seconds and percent: its parts, its names on the graph, and its kind."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Final

from jacaros.robots.plane.pose import ORIGIN, Pose
from jacaros.robots.plane.trigonometry import PI, TWO_PI, radians
from jacaros.runtime.files.entries import FieldSpec, either, flag, number, section, text, whole


def _angle(unit: str, help: str, key: str, least: float = 0.0, most: float = 1e9) -> FieldSpec:
    """Return the entry of an angle: degrees in the file, radians in Python."""
    return number(least, most, unit, help, key, radians)


_PER_TURN = number(0.0, 1e9, "%", "discharge by a turn", "drain_per_turn", lambda drain: drain / TWO_PI)


@dataclass(frozen=True, slots=True)
class BatterySettings:
    """Discharge and charge rates of a battery; levels are in percent, 0 to 100.

    The defaults last about two hours of driving, as for a TurtleBot.
    """

    level: Annotated[float, number(0.0, 100.0, "%", "charge at the start")] = 100.0
    drain_per_second: Annotated[float, number(unit="%", help="discharge, also at rest")] = 0.01
    drain_per_metre: Annotated[float, number(unit="%", help="discharge by driving")] = 0.02
    drain_per_radian: Annotated[float, _PER_TURN] = 0.0
    charge_per_second: Annotated[float, number(unit="%", help="charge at a dock")] = 5.0


_ROOT = math.sqrt(TWO_PI)
# The error of a whole turn is that of 2 pi radians, and the squares of errors add up.
_TURN = number(
    0.0, 1e9, "°", "error of the angle", "noise_degrees_per_turn", lambda turn: radians(turn) / _ROOT
)


@dataclass(frozen=True, slots=True)
class OdometrySettings:
    """The origin of odometry and its errors.

    ``per_metre`` and ``per_radian`` are the standard deviations of the distance after one metre and of the angle after one
    radian (both grow with the square root of the distance); 0 is a perfect encoder. ``turn_per_metre`` is the heading error
    (radians) per metre driven.
    """

    from_start: Annotated[bool, either("where it counts from", "origin", "world", "start")] = False
    per_metre: Annotated[float, number(unit="m", help="error of the distance", key="noise_per_metre")] = 0.0
    per_radian: Annotated[float, _TURN] = 0.0
    turn_per_metre: Annotated[float, _angle("°", "error of the heading", "noise_degrees_per_metre")] = 0.0

    @property
    def noisy(self) -> bool:
        """Whether any error is not zero."""
        return self.per_metre > 0.0 or self.per_radian > 0.0 or self.turn_per_metre > 0.0

    def with_noise(self, factor: float) -> "OdometrySettings":
        """Return the same odometry with its errors times *factor*, or with those of `SLIPPING` if it has none."""
        known = self if self.noisy else SLIPPING
        errors = known.per_metre, known.per_radian, known.turn_per_metre
        return OdometrySettings(self.from_start, *(factor * each for each in errors))


SLIPPING = OdometrySettings(False, 0.02, radians(2.0) / math.sqrt(2.0 * PI), radians(1.0))
"""Odometry of wheels that slip as a TurtleBot's: 2 % in a metre, 2 degrees in a turn, 1 degree per metre."""


@dataclass(frozen=True, slots=True)
class LaserSettings:
    """The laser range finder, at the centre of the robot, facing ahead.

    ``beams_per_turn`` sets the step between beams, ``field`` (radians) the field of view, and ``noise`` the half width
    (metres) of the uniform error of a range. With ``always`` it publishes even without subscriptions.
    """

    enabled: Annotated[bool, flag("whether the robot has a laser")] = True
    beams_per_turn: Annotated[int, whole(4, "beams in 360°")] = 360
    field: Annotated[float, _angle("°", "field of view", "field_degrees", 1.0, 360.0)] = 2.0 * PI
    range_min: Annotated[float, number(unit="m", help="shortest range")] = 0.1
    range_max: Annotated[float, number(0.1, unit="m", help="longest range")] = 10.0
    noise: Annotated[float, number(0.0, 1.0, "m", "largest error of a range")] = 0.0
    always: Annotated[bool, either("when it publishes", "publish", "on demand", "always")] = False


@dataclass(frozen=True, slots=True)
class RobotLimits:
    """Limits of the base: metres and radians, per second and per second squared (TurtleBot)."""

    speed: Annotated[float, number(0.01, 5.0, "m/s", "highest speed")] = 0.65
    turn_rate: Annotated[float, _angle("°/s", "highest turn rate", "turn_rate_degrees", 0.1, 3600.0)] = PI
    acceleration: Annotated[float, number(0.01, unit="m/s²", help="highest acceleration")] = 0.8
    turn_acceleration: Annotated[float, _angle("°/s²", "of turning", "turn_acceleration_degrees", 0.1)] = 5.0
    command_timeout: Annotated[float, number(0.05, unit="s", help="time to a stop without commands")] = 0.5


@dataclass(frozen=True, slots=True)
class NavigationSettings:
    """Whether the robot offers navigation and docking, and its speed in m/s."""

    enabled: Annotated[bool, flag("whether the robot navigates")] = True
    speed: Annotated[float, number(0.05, 5.0, "m/s", "highest speed of navigation")] = 0.4


@dataclass(frozen=True, slots=True)
class CleaningTool:
    """A tool that removes dirt of some kinds (``removes``) within ``reach`` metres of the robot's centre.

    It removes ``rate`` grams per second, the nearest dirt first, as a brush guided by hand or by an arm.
    """

    name: str
    removes: Annotated[tuple[str, ...], FieldSpec("list of texts", "kinds of dirt")]
    rate: Annotated[float, number(0.0, 1e6, "g/s", "dirt removed")] = 5.0
    reach: Annotated[float, number(0.01, 10.0, "m", "from the robot's centre")] = 0.3


def _names(text: str) -> tuple[str, ...]:
    return tuple(text.split())


TOPICS: Final = _names(
    """
    amcl_pose battery_state cleaning/task
    cleaning/tool cmd_audio cmd_lightring cmd_vel cmd_vel_mux/input/navi dock_status goal_pose
    hazard_detection initialpose jason/perception mobile_base/commands/velocity
    mobile_base/events/bumper mobile_base/events/cliff mobile_base/events/wheel_drop
    mobile_base/sensors/core move_base_simple/goal odom scan sensor_state
    """
)
SERVICES: Final = _names(
    """
    global_costmap/clear_entirely_global_costmap global_localization
    local_costmap/clear_entirely_local_costmap move_base/clear_costmaps
    reinitialize_global_localization
    """
)
ACTIONS: Final = _names(
    """
    dock dock_drive_action dock_robot drive_distance drive_on_heading follow_waypoints
    gripper_controller/gripper_cmd move_base navigate_through_poses navigate_to_pose rotate_angle spin undock undock_robot
    """
)
"""All that the simulator can offer below a robot's namespace."""

KOBUKI: Final = frozenset(
    name for name in TOPICS + ACTIONS if name.startswith(("mobile_base/", "cmd_vel_mux/", "dock_drive"))
)
CREATE3: Final = frozenset(
    _names("cmd_audio cmd_lightring dock dock_status drive_distance hazard_detection rotate_angle undock")
)
TURTLEBOT3: Final = frozenset(_names("sensor_state"))
"""Names that only some robots have: those of a base or of its driver."""


@dataclass(frozen=True, slots=True)
class RobotInterface:
    """The names of one robot's topics, services and actions.

    Attributes:
        lacking: names of other kinds of robots, which this one does not have.
        renamed: its own names for those of the simulator; these are offered even if they are lacking otherwise.
    """

    lacking: frozenset[str] = frozenset()
    renamed: Mapping[str, str] = field(default_factory=dict)

    def name_of(self, name: str, prefix: str = "") -> str | None:
        """Return the absolute name for a name of the simulator; None if the robot does not have it.

        Args:
            name: such as ``/scan``.
            prefix: "" or "/robot_1".
        """
        plain = name.strip("/")
        if plain in self.lacking and plain not in self.renamed:
            return None
        return absolute(self.renamed.get(plain, plain), prefix)


EVERYTHING: Final = RobotInterface()
"""All names of the simulator."""


def absolute(name: str, prefix: str) -> str:
    """Return an absolute name; relative ones are below *prefix*."""
    return name if name.startswith("/") else f"{prefix}/{name}"


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """A robot: its name, the namespace of its topics ("" for none), its initial pose and its properties.

    ``gripper_reach`` is the reach of the gripper, in metres from the robot's
    centre; 0 without a gripper. ``interface`` has the names of its topics, services and actions.
    """

    name: Annotated[str, text("unique name")] = "turtlebot"
    namespace: Annotated[str, FieldSpec("text", "prefix of its topics, services and actions")] = ""
    pose: Annotated[Pose, FieldSpec("`{x, y, yaw_degrees}`", "initial pose")] = ORIGIN
    radius: Annotated[float, number(0.02, 2.0, "m", "of a round robot")] = 0.17
    limits: Annotated[RobotLimits, section("limits of the base")] = RobotLimits()
    battery: Annotated[BatterySettings, section("charge and discharge")] = BatterySettings()
    odometry: Annotated[OdometrySettings, section("origin and errors of odometry")] = OdometrySettings()
    laser: Annotated[LaserSettings, section("laser range finder")] = LaserSettings()
    navigation: Annotated[NavigationSettings, FieldSpec("mapping or flag", "navigation")] = (
        NavigationSettings()
    )
    tools: Annotated[tuple[CleaningTool, ...], FieldSpec("mapping", "cleaning tools by name")] = ()
    gripper_reach: Annotated[float, FieldSpec("mapping or flag", "gripper", "gripper")] = 0.0
    interface: RobotInterface = EVERYTHING


USUAL: Final = "turtlebot"

KINDS: Final[Mapping[str, RobotDescription]] = {
    USUAL: RobotDescription(),
    # Kobuki: its data sheet and kobuki_node. It has no laser: a depth camera image is converted to a scan.
    "turtlebot2": RobotDescription(
        radius=0.177,
        limits=RobotLimits(speed=0.7, turn_rate=PI, acceleration=0.8, command_timeout=0.6),
        laser=LaserSettings(field=radians(57.0), range_min=0.45, range_max=10.0),
        interface=RobotInterface(CREATE3 | TURTLEBOT3),
    ),
    # Burger: its specification, the acceleration of its Nav2 parameters, and the LDS-01.
    "turtlebot3": RobotDescription(
        radius=0.105,
        limits=RobotLimits(speed=0.22, turn_rate=2.84, acceleration=2.5, turn_acceleration=3.2),
        laser=LaserSettings(range_min=0.12, range_max=3.5),
        navigation=NavigationSettings(speed=0.22),
        interface=RobotInterface(KOBUKI | CREATE3),
    ),
    # Create 3 with its safety features on, and the RPLIDAR A1.
    "turtlebot4": RobotDescription(
        radius=0.175,
        limits=RobotLimits(speed=0.306, turn_rate=1.9, acceleration=0.9),
        laser=LaserSettings(range_min=0.15, range_max=12.0),
        navigation=NavigationSettings(speed=0.26),
        interface=RobotInterface(KOBUKI | TURTLEBOT3),
    ),
}
"""Robots that a world file names by kind, with the data of their makers and drivers.

A robot without a kind is a ``turtlebot``: the robot of the thesis, with a laser that covers all directions, and with the
topics, services and actions of all kinds.
"""
