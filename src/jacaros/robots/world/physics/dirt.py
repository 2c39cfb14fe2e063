"""Dirt on the floor, and the cleaning tools of robots that remove it."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from jacaros.robots.plane.shapes import Rectangle
from jacaros.robots.world.data.robot import CleaningTool
from jacaros.robots.world.data.world import Dirt, Room, WorldDescription
from jacaros.robots.world.physics.robot import Robot

CELL = 0.1
"""Approximate side of a cell, in metres: a whole number of cells fills the area."""


class DirtField:
    """One kind of dirt in one room.

    Attributes:
        room: name of the room.
        kind: kind of dirt.
        grams: remaining amount.
    """

    def __init__(self, room: Room, dirt: Dirt, boxes: Sequence[Rectangle] = ()) -> None:
        """Create the field; dirt without an area of its own is not spread below the furniture *boxes*."""
        self.room, self.kind, self.grams = room.name, dirt.kind, dirt.grams
        self._all = dirt.grams
        self._area = dirt.area or room.area
        self._boxes = () if dirt.area is not None else tuple(boxes)
        self._columns = max(1, round((self._area.x_max - self._area.x_min) / CELL))
        self._rows = max(1, round((self._area.y_max - self._area.y_min) / CELL))
        self._width = (self._area.x_max - self._area.x_min) / self._columns
        self._height = (self._area.y_max - self._area.y_min) / self._rows
        self._cells: list[float] = []
        self._dirty = 0

    @property
    def percent(self) -> int:
        """Remaining percent, rounded up: 0 means clean."""
        return math.ceil(100.0 * self.grams / self._all) if self.grams > 0.0 else 0

    def near(self, x: float, y: float, reach: float) -> list[tuple[float, int]]:
        """Return the dirty cells with their centres within *reach* metres of a point, as squared distance and number."""
        if not self._cells:
            self._spread()
        area, columns = self._area, self._columns
        first = max(0, math.floor((x - reach - area.x_min) / self._width))
        last = min(columns, math.floor((x + reach - area.x_min) / self._width) + 1)
        bottom = max(0, math.floor((y - reach - area.y_min) / self._height))
        top = min(self._rows, math.floor((y + reach - area.y_min) / self._height) + 1)
        found = []
        for row in range(bottom, top):
            dy = area.y_min + (row + 0.5) * self._height - y
            for column in range(first, last):
                dx = area.x_min + (column + 0.5) * self._width - x
                apart2 = dx * dx + dy * dy
                if apart2 <= reach * reach and self._cells[row * columns + column] > 0.0:
                    found.append((apart2, row * columns + column))
        return found

    def take(self, cell: int, most: float) -> float:
        """Remove up to *most* grams of dirt from a cell; return the amount removed, in grams."""
        here = self._cells[cell]
        if here > most:
            self._cells[cell] = here - most
            self.grams -= most
            return most
        if here > 0.0:
            self._cells[cell] = 0.0
            self._dirty -= 1
            # Exactly 0: repeated differences leave rounding errors.
            self.grams = self.grams - here if self._dirty else 0.0
        return here

    def is_clean(self, cell: int) -> bool:
        """Return whether a cell is clean."""
        return self._cells[cell] <= 0.0

    def _spread(self) -> None:
        """Create the cells when a tool comes near: fields that are never cleaned cost nothing."""
        centres = [
            (self._area.x_min + (column + 0.5) * self._width, self._area.y_min + (row + 0.5) * self._height)
            for row in range(self._rows)
            for column in range(self._columns)
        ]
        free = [not any(box.contains(x, y) for box in self._boxes) for x, y in centres]
        self._dirty = sum(free) or len(free)
        share = self._all / self._dirty
        self._cells = [share if lies or not any(free) else 0.0 for lies in free]
        if share == 0.0:
            self._dirty = 0


class Cleaning:
    """The dirt of a world and the running tools.

    Args:
        description: the world.
        room_at: returns the room at a point, in metres.
        tell: takes the events ``tool_started``, ``tool_stopped`` (tool) and ``cleaned`` (room, dirt, remaining grams and
            percent) of a robot; ``cleaned`` at each whole percent, and when the tool stops.

    Attributes:
        fields: all dirt of the world, in the order of the file.
        at_work: running tools, by robot name.
    """

    def __init__(
        self,
        description: WorldDescription,
        room_at: Callable[[float, float], str | None],
        tell: Callable[[Robot, str, dict[str, Any]], None],
    ) -> None:
        self.fields = [
            DirtField(room, dirt, description.boxes) for room in description.rooms for dirt in room.dirt
        ]
        self.at_work: dict[str, ToolAtWork] = {}
        self._room_at, self._tell = room_at, tell
        self._reported = {field: (field.percent, field.grams) for field in self.fields}

    def use(self, robot: Robot, name: str) -> None:
        """Start a tool of *robot*, and stop its running tool; an unknown name only stops."""
        before = self.at_work.get(robot.name)
        if before is not None:
            if before.tool.name == name:
                return
            del self.at_work[robot.name]
            self._tell_removed(robot, before, at_the_end=True)
            self._tell(robot, "tool_stopped", {"tool": before.tool.name})
        for tool in robot.description.tools:
            if tool.name == name:
                self.at_work[robot.name] = ToolAtWork(tool, self.fields)
                self._tell(robot, "tool_started", {"tool": name})

    def settle(self, robot: Robot) -> None:
        """Report what the tool of *robot* has removed, from where it was removed: the robot is about to be carried away."""
        work = self.at_work.get(robot.name)
        if work is not None:
            self._tell_removed(robot, work, at_the_end=True)

    def step(self, dt: float, robots: dict[str, Robot]) -> None:
        """Run the tools for *dt* seconds; a robot with an empty battery, or one that hangs in the air, does not clean."""
        for name, work in self.at_work.items():
            robot = robots[name]
            if robot.battery.empty or robot.wheels_drop:
                continue
            if work.step(dt, robot.x, robot.y, self._room_at(robot.x, robot.y)):
                self._tell_removed(robot, work, at_the_end=False)

    def _tell_removed(self, robot: Robot, work: "ToolAtWork", at_the_end: bool) -> None:
        for field in work.fields:
            percent, grams = self._reported[field]
            if field.percent != percent or (at_the_end and field.grams != grams):
                self._reported[field] = (field.percent, field.grams)
                left = {"grams": field.grams, "percent": field.percent}
                self._tell(robot, "cleaned", {"room": field.room, "dirt": field.kind, **left})


class ToolAtWork:
    """A running tool.

    It removes dirt only in the room that contains the robot, because walls separate rooms.

    Attributes:
        tool: the tool.
        fields: the dirt that it can remove, in all rooms.
    """

    def __init__(self, tool: CleaningTool, fields: list[DirtField]) -> None:
        self.tool = tool
        self.fields = [field for field in fields if field.kind in tool.removes]
        self._place: tuple[float, float, str | None] | None = None
        self._near: list[tuple[float, int, int]] = []
        """Cells in reach, as squared distance, number of the field and cell; the nearest one last."""

    def step(self, dt: float, x: float, y: float, room: str | None) -> bool:
        """Clean for *dt* seconds at a point (metres) of a room; return whether there was dirt to remove."""
        if (x, y, room) != self._place:
            self._place, self._near = (x, y, room), self._cells_near(x, y, room)
        if not self._near:
            return False
        most = self.tool.rate * dt
        while self._near and most > 0.0:
            _, number, cell = self._near[-1]
            most -= self.fields[number].take(cell, most)
            if self.fields[number].is_clean(cell):
                self._near.pop()
        return True

    def _cells_near(self, x: float, y: float, room: str | None) -> list[tuple[float, int, int]]:
        found = [
            (apart2, number, cell)
            for number, field in enumerate(self.fields)
            if field.room == room
            for apart2, cell in field.near(x, y, self.tool.reach)
        ]
        return sorted(found, reverse=True)
