"""Things on the floor: objects that robots carry, and round obstacles put down during a run.

Objects block neither robots nor lasers; only grippers touch them. Obstacles block robots, people and lasers; they are not
on the robots' map.
"""

from collections.abc import Callable, Iterable
from typing import Any

from jacaros.robots.plane.shapes import Segment
from jacaros.robots.world.data.world import Door, ObjectDescription
from jacaros.robots.world.physics.robot import Robot

_BEFORE = 0.05
"""Distance in metres from the edge of a robot to the centre of an object that it carries or puts down."""


class Thing:
    """An object of the world.

    Attributes:
        description: description from the world file.
        carrier: robot that holds it, or None.
    """

    def __init__(self, description: ObjectDescription) -> None:
        self.description = description
        self.name = description.name
        self.carrier: Robot | None = None
        self._place = (description.x, description.y)

    @property
    def width(self) -> float:
        """Width that a gripper must open to take it, in metres."""
        return 2.0 * self.description.radius

    @property
    def place(self) -> tuple[float, float]:
        """Position of its centre, in metres."""
        if self.carrier is None:
            return self._place
        return self.carrier.placement.point(self.carrier.description.radius + _BEFORE, 0.0)

    def lie(self) -> None:
        """Stay at the current position."""
        self._place, self.carrier = self.place, None


class Objects:
    """All objects of a world.

    Args:
        descriptions: objects of the world file.
        note: takes the events ``picked`` and ``placed`` of a robot.
        closed_doors: returns the closed doors; grippers do not reach through them.

    Attributes:
        by_name: objects, in the order of the file.
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
        """Return the object that a robot carries."""
        return next((each for each in self.by_name.values() if each.carrier is robot), None)

    def before(self, robot: Robot) -> Thing | None:
        """Return the nearest object within a robot's reach, at most 45 degrees to the left or right of straight ahead."""
        frame = robot.placement
        nearest, least = None, robot.description.gripper_reach * robot.description.gripper_reach
        for each in self.by_name.values():
            dx, dy = each.place[0] - robot.x, each.place[1] - robot.y
            ahead, left = frame.local(*each.place)
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
        """Put an object down in front of the robot that carries it."""
        thing.lie()
        self._tell(robot, "placed", thing)

    def _tell(self, robot: Robot, kind: str, thing: Thing) -> None:
        x, y = thing.place
        self._note(robot, kind, {"object": thing.name, "x": x, "y": y})
