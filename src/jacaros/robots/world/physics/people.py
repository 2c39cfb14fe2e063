"""People who walk through a world, from point to point of their paths.

A person stops in front of a closed door, and of a robot: at 0.3 m, or on contact if careless. People pass through each
other. A person blocks a robot like a wall.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from jacaros.robots.plane.contact import TOUCHING, WallIndex
from jacaros.robots.plane.shapes import Circle
from jacaros.robots.world.data.world import Door, PersonDescription
from jacaros.robots.world.physics.robot import Robot
from jacaros.runtime.errors import UsageError

DISTANCE = 0.3
"""Distance in metres that a careful person keeps from robots in front, and every person from closed doors."""
_ELBOW = 0.05
"""Distance in metres at which a careful person passes robots at its side."""
_AHEAD = 0.01


class Person:
    """One person.

    Attributes:
        description: name, size and path.
        x, y: position, in metres.
        vx, vy: velocity, in m/s; 0 while standing.
        direction: direction of the next step, as a unit vector.
        waits_for: name of the robot or door that blocks the person, "" for none.
    """

    def __init__(self, description: PersonDescription) -> None:
        self.description = description
        self.name = description.name
        self.x, self.y = description.path[0]
        self.vx = self.vy = 0.0
        self.waits_for = ""
        self._rest = 0.0
        self._next = 0
        self.direction = (0.0, 0.0)
        self._walks = self._turn()

    @property
    def circle(self) -> Circle:
        """Position and radius, in metres."""
        return self.x, self.y, self.description.radius

    def step(self, dt: float, in_the_way: Callable[["Person"], str]) -> bool:
        """Walk for *dt* seconds unless *in_the_way* names an obstacle; return whether the velocity has changed."""
        before = (self.vx, self.vy)
        self.waits_for = ""
        self.vx = self.vy = 0.0
        if self._rest > 0.0:
            self._rest = round(self._rest - dt, 9)
        elif self._walks:
            self.waits_for = in_the_way(self)
            if not self.waits_for:
                self._walk(dt)
        return (self.vx, self.vy) != before

    def _walk(self, dt: float) -> None:
        self.vx, self.vy = (part * self.description.speed for part in self.direction)
        tx, ty = self.description.path[self._next]
        ex, ey, way = tx - self.x, ty - self.y, self.description.speed * dt
        if ex * ex + ey * ey > way * way:
            self.x, self.y = self.x + self.vx * dt, self.y + self.vy * dt
            return
        self.x, self.y = tx, ty
        self._rest = self.description.pause
        self._walks = self._turn()

    def _turn(self) -> bool:
        """Turn to the next point; return False at the end of the path."""
        path = self.description.path
        if self._next + 1 == len(path) and not self.description.loop:
            return False
        self._next = (self._next + 1) % len(path)
        ex, ey = path[self._next][0] - self.x, path[self._next][1] - self.y
        apart = math.sqrt(ex * ex + ey * ey)
        if apart > 0.0:
            self.direction = (ex / apart, ey / apart)
        return len(path) > 1


class People:
    """The people of a world.

    Args:
        descriptions: people at the start.
        tell: takes the events of a person: ``person_walks`` (vx, vy), ``person_stands`` (waits_for),
            ``person_comes`` (radius, color, path, loop) and ``person_goes``.

    Attributes:
        by_name: people who are present.
    """

    def __init__(
        self,
        descriptions: Iterable[PersonDescription],
        tell: Callable[[Person, str, dict[str, Any]], None],
    ) -> None:
        self.by_name = {each.name: Person(each) for each in descriptions}
        self._tell = tell

    def add(self, description: PersonDescription) -> Person:
        """Add a person.

        Raises:
            UsageError: the name is taken.
        """
        if description.name in self.by_name:
            raise UsageError(f"duplicate name of a person: '{description.name}'")
        person = self.by_name[description.name] = Person(description)
        self._tell(person, "person_comes", description.drawing())
        return person

    def remove(self, name: str) -> None:
        """Remove a person.

        Raises:
            UsageError: the person is unknown.
        """
        if name not in self.by_name:
            raise UsageError(f"unknown person '{name}'; people: {', '.join(self.by_name) or 'none'}")
        self._tell(self.by_name.pop(name), "person_goes", {})

    def step(self, dt: float, robots: Sequence[Robot], doors: Sequence[Door], walls: WallIndex) -> None:
        """Let everyone walk for *dt* seconds, and push robots away; *doors* are the closed doors."""

        def in_the_way(person: Person) -> str:
            return _robot_before(person, robots) or _door_before(person, doors)

        for person in self.by_name.values():
            if person.step(dt, in_the_way):
                if person.vx or person.vy:
                    self._tell(person, "person_walks", {"vx": person.vx, "vy": person.vy})
                else:
                    self._tell(person, "person_stands", {"waits_for": person.waits_for})
            for robot in robots:
                robot.hold_off(person.name, *person.circle, walls, dt)


def _robot_before(person: Person, robots: Sequence[Robot]) -> str:
    """Return the name of the robot ahead that is too near, "" for none; robots behind are ignored."""
    across, up = person.direction
    distance, elbow = (TOUCHING, 0.0) if person.description.careless else (DISTANCE, _ELBOW)
    for robot in robots:
        ex, ey = robot.x - person.x, robot.y - person.y
        ahead, beside = ex * across + ey * up, ex * up - ey * across
        both = person.description.radius + robot.description.radius
        if (
            ahead > 0.0
            and abs(beside) < both + elbow
            and ex * ex + ey * ey < (both + distance) * (both + distance)
        ):
            return robot.name
    return ""


def _door_before(person: Person, doors: Sequence[Door]) -> str:
    """Return the name of the door ahead that is too near, "" for none."""
    across, up = person.direction
    for door in doors:
        near = door.segment.distance(person.x, person.y)
        nearer = door.segment.distance(person.x + across * _AHEAD, person.y + up * _AHEAD) < near
        if nearer and near < person.description.radius + DISTANCE:
            return door.name
    return ""
