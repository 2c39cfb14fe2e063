"""The names under which a robot is on the ROS graph: those of its kind, renamed and added to in the world file."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final


def _names(text: str) -> tuple[str, ...]:
    return tuple(text.split())


TOPICS: Final = _names(
    """
    amcl_pose battery_state camera/camera_info camera/depth/image_raw camera/image_raw cleaning/task
    cleaning/tool cmd_audio cmd_lightring cmd_vel cmd_vel_mux/input/navi dock_status goal_pose
    hazard_detection imu initialpose jason/perception mobile_base/commands/velocity
    mobile_base/events/bumper mobile_base/events/cliff mobile_base/events/wheel_drop
    mobile_base/sensors/core move_base_simple/goal odom scan sensor_state sonar
    """
)
SERVICES: Final = _names(
    """
    global_costmap/clear_entirely_global_costmap local_costmap/clear_entirely_local_costmap
    move_base/clear_costmaps
    """
)
ACTIONS: Final = _names(
    """
    dock dock_drive_action dock_robot drive_distance follow_waypoints gripper_controller/gripper_cmd
    move_base navigate_through_poses navigate_to_pose rotate_angle undock undock_robot
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
CAMERA: Final = frozenset(name for name in TOPICS if name.startswith("camera/"))
SONAR: Final = frozenset(_names("sonar"))
"""Names that only some robots have: those of a base or of its driver, and of optional sensors."""


@dataclass(frozen=True, slots=True)
class OwnTopic:
    """A topic of the user's robot that the simulator does not know.

    Attributes:
        name: below the robot's namespace; absolute with a leading slash.
        type_name: message type.
        message: fields of the message that is published.
        rate: messages per second; 0 for a topic that the robot subscribes to.
    """

    name: str
    type_name: str
    message: Mapping[str, Any] = field(default_factory=dict)
    rate: float = 1.0


@dataclass(frozen=True, slots=True)
class OwnService:
    """A service of the user's robot that the simulator does not know, and the fields of its response."""

    name: str
    type_name: str
    response: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Interface:
    """The names of one robot's topics, services and actions.

    Attributes:
        lacking: names of other kinds of robots, which this one does not have.
        renamed: its own names for those of the simulator; these are offered even if they are lacking otherwise.
        topics: further topics.
        services: further services.
    """

    lacking: frozenset[str] = frozenset()
    renamed: Mapping[str, str] = field(default_factory=dict)
    topics: tuple[OwnTopic, ...] = ()
    services: tuple[OwnService, ...] = ()

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


EVERYTHING: Final = Interface()
"""All names of the simulator."""


def absolute(name: str, prefix: str) -> str:
    """Return an absolute name; relative ones are below *prefix*."""
    return name if name.startswith("/") else f"{prefix}/{name}"
