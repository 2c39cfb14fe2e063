"""Robots that a world file names by kind, with the data of their makers and drivers.

A robot without a kind is a ``turtlebot``: the robot of the thesis, with a laser that covers all directions, and with the
topics, services and actions of all kinds.
"""

from collections.abc import Mapping
from typing import Final

from jacaros.plane.trigonometry import PI, radians
from jacaros.sim.description import LaserSettings, NavigationSettings, RobotDescription, RobotLimits
from jacaros.sim.interface import CAMERA, CREATE3, KOBUKI, SONAR, TURTLEBOT3, Interface

USUAL: Final = "turtlebot"

KINDS: Final[Mapping[str, RobotDescription]] = {
    USUAL: RobotDescription(),
    # Kobuki: its data sheet and kobuki_node. It has no laser: a depth camera image is converted to a scan.
    "turtlebot2": RobotDescription(
        radius=0.177,
        limits=RobotLimits(speed=0.7, turn_rate=PI, acceleration=0.8, command_timeout=0.6),
        laser=LaserSettings(field=radians(57.0), range_min=0.45, range_max=10.0),
        interface=Interface(CREATE3 | TURTLEBOT3 | SONAR),
    ),
    # Burger: its specification, the acceleration of its Nav2 parameters, and the LDS-01.
    "turtlebot3": RobotDescription(
        radius=0.105,
        limits=RobotLimits(speed=0.22, turn_rate=2.84, acceleration=2.5, turn_acceleration=3.2),
        laser=LaserSettings(range_min=0.12, range_max=3.5),
        navigation=NavigationSettings(speed=0.22),
        interface=Interface(KOBUKI | CREATE3 | CAMERA | SONAR),
    ),
    # Create 3 with its safety features on, and the RPLIDAR A1.
    "turtlebot4": RobotDescription(
        radius=0.175,
        limits=RobotLimits(speed=0.306, turn_rate=1.9, acceleration=0.9),
        laser=LaserSettings(range_min=0.15, range_max=12.0),
        navigation=NavigationSettings(speed=0.26),
        interface=Interface(KOBUKI | TURTLEBOT3 | SONAR),
    ),
}
"""Defaults of each kind."""
