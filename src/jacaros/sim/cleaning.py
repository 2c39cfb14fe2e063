"""Robots that clean: the running tool of each robot, and the dirt that it removes."""

from collections.abc import Callable
from typing import Any

from jacaros.sim.description import CleaningTool, WorldDescription
from jacaros.sim.dirt import DirtField
from jacaros.sim.robot.robot import Robot


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

    def step(self, dt: float, robots: dict[str, Robot]) -> None:
        """Run the tools for *dt* seconds; a robot with an empty battery does not clean."""
        for name, work in self.at_work.items():
            robot = robots[name]
            if not robot.battery.empty and work.step(dt, robot.x, robot.y, self._room_at(robot.x, robot.y)):
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
