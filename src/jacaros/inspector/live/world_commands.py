"""Commands that change the embedded world: robots, doors, obstacles, people, batteries and faults."""

from collections.abc import Callable, Mapping

from jacaros.inspector.live.commands import Command, Given, Refused, flag_in, number_in, text_in
from jacaros.mas.system import System
from jacaros.sim import World
from jacaros.sim.data.world import PersonDescription

RADIUS = 0.2
"""Default radius of an obstacle, in metres."""


def world_commands(system: System, world: World, show: Callable[[], None]) -> Mapping[str, Command]:
    """Return the commands for the embedded world of a system; *show* updates the view after a change."""
    commands = _WorldCommands(world, system.ros.catch_up)
    found: dict[str, Command] = {"obstacle": commands.obstacle, "person": commands.person}
    if world.robots:
        found |= {"move_robot": commands.move_robot, "battery": commands.battery}
    if world.doors:
        found["door"] = commands.door
    if world.faults.by_name:
        found["fault"] = commands.fault
    return {name: _shown(command, show) for name, command in found.items()}


def _shown(command: Command, show: Callable[[], None]) -> Command:
    def change(given: Given) -> object:
        result = command(given)
        show()  # even while the run is paused
        return result

    return change


class _WorldCommands:
    """Create the commands; *catch_up* makes the due steps of the world, so that a change happens now and not earlier."""

    def __init__(self, world: World, catch_up: Callable[[], None]) -> None:
        self._world, self._catch_up = world, catch_up
        self._people = 0

    def move_robot(self, given: Given) -> None:
        """Put a robot down at another place."""
        self._catch_up()
        x, y = number_in(given, "x"), number_in(given, "y")
        yaw = number_in(given, "yaw") if given.get("yaw") is not None else None
        self._world.place(text_in(given, "robot"), x, y, yaw)

    def battery(self, given: Given) -> None:
        """Set the level of a battery."""
        self._catch_up()
        self._world.set_battery(text_in(given, "robot"), number_in(given, "level"))

    def door(self, given: Given) -> None:
        """Open or close a door."""
        self._catch_up()
        refused = self._world.move_door(text_in(given, "name"), flag_in(given, "open"))
        if refused is not None:
            raise Refused(refused)

    def obstacle(self, given: Given) -> str:
        """Place an obstacle, or remove one with `remove`; return its name."""
        self._catch_up()
        if given.get("remove") is not None:
            name = text_in(given, "remove")
            self._world.remove_obstacle(name)
            return name
        x, y = number_in(given, "x"), number_in(given, "y")
        return self._world.add_obstacle(x, y, number_in(given, "radius", RADIUS))

    def person(self, given: Given) -> str:
        """Add a person, or remove one with `remove`; return the name."""
        self._catch_up()
        if given.get("remove") is not None:
            name = text_in(given, "remove")
            self._world.remove_person(name)
            return name
        x, y = number_in(given, "x"), number_in(given, "y")
        visitor = PersonDescription(f"visitor_{self._people + 1}", ((x, y),))
        self._world.check_room(x, y, visitor.radius)
        self._world.add_person(visitor)
        self._people += 1
        return visitor.name

    def fault(self, given: Given) -> None:
        """Start or end a fault of the fault file."""
        self._catch_up()
        name = text_in(given, "name")
        if not flag_in(given, "on"):
            self._world.faults.end(name)
        elif (refused := self._world.faults.begin(name)) is not None:
            raise Refused(refused)
