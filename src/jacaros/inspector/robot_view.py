"""What viewers and recorders are shown of a robot."""

from typing import NamedTuple

from jacaros.sim import World

UNKNOWN = -1.0
"""The level of a battery that nobody tells of."""


class RobotView(NamedTuple):
    """A robot at one moment: pose (metres, radians), battery (percent, or `UNKNOWN`) and what happens to it.

    Of the embedded world the true pose, of a robot on a real graph the one that it believes in.
    """

    name: str
    x: float
    y: float
    yaw: float
    battery: float
    charging: bool = False
    touching: bool = False


def views_of(world: World) -> list[RobotView]:
    """All robots of *world* as they are now."""
    return [
        RobotView(
            robot.name,
            robot.x,
            robot.y,
            robot.yaw,
            robot.battery.level,
            robot.battery.charging,
            bool(robot.touching),
        )
        for robot in world.robots.values()
    ]
