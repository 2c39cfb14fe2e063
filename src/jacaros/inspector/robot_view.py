"""What viewers and recorders are shown of a robot."""

from typing import NamedTuple

from jacaros.sim import World


class RobotView(NamedTuple):
    """A robot at one moment: true pose (metres, radians), battery (percent) and what happens to it."""

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
