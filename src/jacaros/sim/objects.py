"""Objects that robots carry: the place of each, and the robot that holds it.

They block neither robots nor lasers: only grippers touch them.
"""

from collections.abc import Callable, Iterable
from typing import Any

from jacaros.sim.description import Door, ObjectDescription, Segment
from jacaros.sim.robot.robot import Robot
from jacaros.sim.trigonometry import sine_cosine

_BEFORE = 0.05
"""Metres from a robot's rim to the middle of what it carries or puts down."""


class Thing:
    """An object of the world.

    Attributes:
        description: how it is made.
        carrier: the robot that has it, or None.
    """

    def __init__(self, description: ObjectDescription) -> None:
        self.description = description
        self.name = description.name
        self.carrier: Robot | None = None
        self._place = (description.x, description.y)

    @property
    def width(self) -> float:
        """Metres that a gripper must open to take it."""
        return 2.0 * self.description.radius

    @property
    def place(self) -> tuple[float, float]:
        """Where its middle is, in metres."""
        if self.carrier is None:
            return self._place
        sine, cosine = sine_cosine(self.carrier.yaw)
        ahead = self.carrier.description.radius + _BEFORE
        return self.carrier.x + ahead * cosine, self.carrier.y + ahead * sine

    def lie(self) -> None:
        """Stay where it is now."""
        self._place, self.carrier = self.place, None


class Objects:
    """All objects of a world.

    Args:
        descriptions: how they are made.
        note: takes the events ``picked`` and ``placed`` of a robot.
        closed_doors: gives the doors that are closed; no gripper reaches through one.

    Attributes:
        by_name: the objects, in the order of the file.
    """

    def __init__(
        self,
        descriptions: Iterable[ObjectDescription],
        note: Callable[[Robot, str, dict[str, Any]], None],
        closed_doors: Callable[[], Iterable[Door]] = tuple,
    ) -> None:
        self.by_name = {each.name: Thing(each) for each in descriptions}
        self._note, self._closed_doors = note, closed_doors

    def held_by(self, robot: Robot) -> Thing | None:
        """What a robot carries."""
        return next((each for each in self.by_name.values() if each.carrier is robot), None)

    def before(self, robot: Robot) -> Thing | None:
        """The nearest object that lies within a robot's reach, at most 45 degrees to the left or right of ahead."""
        sine, cosine = sine_cosine(robot.yaw)
        nearest, least = None, robot.description.gripper_reach * robot.description.gripper_reach
        for each in self.by_name.values():
            dx, dy = each.place[0] - robot.x, each.place[1] - robot.y
            ahead, left = cosine * dx + sine * dy, cosine * dy - sine * dx
            near = each.carrier is None and abs(left) <= ahead and dx * dx + dy * dy <= least
            if near and not self._behind_door(robot, *each.place):
                nearest, least = each, dx * dx + dy * dy
        return nearest

    def _behind_door(self, robot: Robot, x: float, y: float) -> bool:
        way = Segment(robot.x, robot.y, x, y)
        return any(way.crosses(door.segment) for door in self._closed_doors())

    def pick(self, robot: Robot, thing: Thing) -> None:
        """Give an object to a robot."""
        self._tell(robot, "picked", thing)
        thing.carrier = robot

    def put_down(self, robot: Robot, thing: Thing) -> None:
        """Lay an object before the robot that carries it."""
        thing.lie()
        self._tell(robot, "placed", thing)

    def _tell(self, robot: Robot, kind: str, thing: Thing) -> None:
        x, y = thing.place
        self._note(robot, kind, {"object": thing.name, "x": x, "y": y})
