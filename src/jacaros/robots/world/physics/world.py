"""The running world: robots on a plane with walls, stepped at a fixed rate.

It is independent of clocks, middleware and agents: `jacaros.robots.world.node` connects it to those.  The same description
and seed and the same commands at the same steps give the same run, to the last bit.
"""

import math
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from jacaros.robots.plane.contact import WallIndex, push_apart
from jacaros.robots.plane.pose import Pose, distance
from jacaros.robots.plane.shapes import Circle, Segment
from jacaros.robots.plane.trigonometry import PI, sine_cosine
from jacaros.robots.world.data.faults import Fault, Progress
from jacaros.robots.world.data.ground_truth import GroundTruth, RobotEvent
from jacaros.robots.world.data.world import Dock, PersonDescription, WorldDescription
from jacaros.robots.world.files.faults import read_faults
from jacaros.robots.world.files.world import load_world, read_world
from jacaros.robots.world.physics.dirt import Cleaning
from jacaros.robots.world.physics.effects import ON_ROBOT, near, without_current
from jacaros.robots.world.physics.faults import Effect, Faults
from jacaros.robots.world.physics.people import People, Person
from jacaros.robots.world.physics.ranging import Laser
from jacaros.robots.world.physics.robot import Robot
from jacaros.robots.world.physics.things import Objects
from jacaros.runtime.errors import UsageError

DOCK_SEEN_FROM = 2.0
"""Distance in metres at which a robot detects a dock."""
STEP = 0.02
"""Length of a step in seconds: 50 Hz."""
SAMPLES_PER_SECOND = 10
DOOR_ROOM = 0.25
"""Metres that a robot must be away from a door for it to close."""
CARRIED = 0.05
"""Metres by which a robot must be carried to be affected."""
_DRAWS = 100
"""Maximum number of places that are tried for a kidnapped robot."""


class World:
    """A world and its robots.

    Attributes:
        description: the description that it was made from.
        time: seconds since the start of the world.
        robots: robots by name, in the order of the file.
        lasers: the laser of each robot, by name.
        doors: whether each door, by name, is open.
        segments: all walls and closed doors.
        cleaning: the dirt, and the running cleaning tools.
        people: people who walk about, by name.
        obstacles: round obstacles put on the floor during the run, by name.
        objects: objects that grippers can carry.
        faults: faults of the fault file.
        docks: docks that robots detect and dock in, those of another make first.
        currents: for each fault of a dock, the dock's name, and a function that returns whether it gives current.
        stuck_doors: stuck doors, and whether the next request to move each fails.
    """

    def __init__(
        self, description: WorldDescription, seed: int | None = None, faults: Iterable[Fault] = ()
    ) -> None:
        """Make a world from its description; *seed* overrides that of the description, and *faults* can be triggered."""
        self.description = description if seed is None else replace(description, seed=seed)
        self.time = 0.0
        self.robots = {
            robot.name: Robot(robot, self.description.seed, self._note) for robot in description.robots
        }
        self._row = tuple(self.robots.values())
        self.docks = description.docks
        self.currents: dict[str, tuple[str, Callable[[], bool]]] = {}
        self.stuck_doors: dict[str, Callable[[], bool]] = {}
        for robot in self._row:
            robot.has_current = self._has_current
        self.doors = {door.name: door.open for door in description.doors}
        self.lasers = {
            name: Laser(robot.description.laser, f"{self.description.seed}/{name}/laser")
            for name, robot in self.robots.items()
        }
        self._put_up_walls()
        self._people = People(self.description.people, self._note_person)
        self.people = self._people.by_name
        self.obstacles: dict[str, Circle] = {}
        self._obstacle_count = 0
        self.cleaning = Cleaning(self.description, self.room_at, self._note)
        self.objects = Objects(self.description.objects, self._note, lambda: self._closed)
        self._truth = GroundTruth(self.robots, description.drawing())
        self._charge_shown = {robot.name: (False, math.ceil(robot.battery.level)) for robot in self._row}
        self._next_sample = 0.0
        self._move_listeners: tuple[Callable[[], None], ...] = ()
        self._sample_robots(all_of_them=True)
        seed = self.description.seed
        self.faults = Faults(
            faults, seed, lambda: self.time, self._let_happen, self._reached, self._note_fault
        )
        self.faults.step(self.time)

    @classmethod
    def load(
        cls,
        source: str | Path,
        seed: int | None = None,
        faults: str | Path | None = None,
        noise: float | None = None,
    ) -> "World":
        """Make a world from a file, from the name of a shipped world, or from the text of a world file.

        Args:
            source: path, name or text of the world.
            seed: seed for noise, instead of that in the file.
            faults: path or text of a fault file; None for no faults.
            noise: factor for the noise of the sensors, see `WorldDescription.with_noise`; None for that in the file.

        Raises:
            WorldError: a file does not exist or has mistakes.
        """
        text = isinstance(source, str) and "\n" in source
        description = read_world(str(source)) if text else load_world(str(source))
        if noise is not None:
            description = description.with_noise(noise)
        return cls(description, seed, () if faults is None else read_faults(faults, description))

    @property
    def ground_truth(self) -> GroundTruth:
        """What truly happened up to this moment."""
        for robot in self._row:
            self._truth.update_latest(robot.name, robot.sample(self.time))
        for field in self.cleaning.fields:
            self._truth.dirt[field.room, field.kind] = field.grams
        return self._truth

    @property
    def log(self) -> list[RobotEvent]:
        """All events so far, oldest first."""
        return self._truth.events

    def robot(self, name: str | None = None) -> Robot:
        """Return the robot with that name; the first one by default.

        Raises:
            UsageError: the name is unknown.
        """
        if name is None and self._row:
            return self._row[0]
        if name not in self.robots:
            raise UsageError(
                f"unknown robot '{name}' in world '{self.description.name}'; robots: {', '.join(self.robots)}"
            )
        return self.robots[name]

    def room_at(self, x: float, y: float) -> str | None:
        """Return the name of the room at a point; None outside all rooms, the first of the file where two overlap."""
        return next((room.name for room in self.description.rooms if room.area.contains(x, y)), None)

    def command(self, name: str, speed: float, turn_rate: float) -> None:
        """Command a robot (m/s, rad/s); takes effect at the next step."""
        self.robot(name).command(speed, turn_rate)

    def log_task(self, name: str, text: str) -> None:
        """Record the task that a robot announces, with the room that it is in.

        If the first word of *text* names a cleaning tool of the robot, start that tool.
        """
        robot = self.robot(name)
        robot.tasks += 1
        self._note(robot, "task", {"task": text, "room": self.room_at(robot.x, robot.y)})
        self.cleaning.use(robot, text.partition(" ")[0])

    def use_tool(self, name: str, tool: str) -> None:
        """Start a cleaning tool of a robot, instead of the running one; "" or an unknown name only stops it."""
        self.cleaning.use(self.robot(name), tool)

    def _put_up_walls(self) -> None:
        self._closed = tuple(door for door in self.description.doors if not self.doors[door.name])
        self.segments = self.description.segments + tuple(door.segment for door in self._closed)
        radius = max((robot.radius for robot in self.description.robots), default=0.17)
        self._walls = WallIndex(self.segments, radius)
        for laser in self.lasers.values():
            laser.segments = self.segments

    def move_door(self, name: str, opened: bool) -> str | None:
        """Open or close a door.

        Returns:
            Why the door cannot close (a robot or a person is in the way); None on success.

        Raises:
            UsageError: the door is unknown.
        """
        door = next((door for door in self.description.doors if door.name == name), None)
        if door is None:
            raise UsageError(f"unknown door '{name}' in world '{self.description.name}'")
        if self.doors[name] == opened:
            return None
        if not opened:
            for other, (x, y, radius) in self._standing():
                if door.segment.distance(x, y) < radius + DOOR_ROOM:
                    return f"{other} is in the way"
        self.doors[name] = opened
        self._put_up_walls()
        ax, ay, bx, by = door.segment
        kind = "door_opened" if opened else "door_closed"
        self._note_place(kind, 0.5 * (ax + bx), 0.5 * (ay + by), {"door": name})
        return None

    def scan(self, name: str) -> list[float]:
        """Return the ranges that a robot's laser measures now, in metres."""
        robot = self.robot(name)
        return self.lasers[name].scan(robot.x, robot.y, robot.yaw, self.others(robot))

    def others(self, robot: Robot) -> list[Circle]:
        """Return all other robots, people and obstacles (metres): what *robot*'s laser sees unless a wall hides it."""
        others = [other.circle for other in self._row if other is not robot]
        others += (person.circle for person in self.people.values())
        others += self.obstacles.values()
        return others

    def _standing(self) -> list[tuple[str, Circle]]:
        """Return all robots and people by name, with their positions and radii."""
        robots = [(robot.name, robot.circle) for robot in self._row]
        return robots + [(person.name, person.circle) for person in self.people.values()]

    def visible_dock(self, robot: Robot) -> Dock | None:
        """Return the nearest dock that a robot detects: within 2 m, and not behind a wall."""
        seen = []
        for dock in self.docks:
            dx, dy = robot.x - dock.pose.x, robot.y - dock.pose.y
            apart = math.sqrt(dx * dx + dy * dy)
            way = Segment(robot.x, robot.y, dock.pose.x, dock.pose.y)
            if apart <= DOCK_SEEN_FROM and not way.crosses(*self.segments):
                seen.append((apart, dock))
        return min(seen, key=lambda pair: pair[0])[1] if seen else None

    def _has_current(self, dock: Dock) -> bool:
        return all(gives() for name, gives in self.currents.values() if name == dock.name)

    def add_person(self, description: PersonDescription) -> Person:
        """Add a person at the first point of the path.

        Raises:
            UsageError: a person or a robot has that name, or a robot stands there.
        """
        if description.name in self.robots:
            raise UsageError(f"the name '{description.name}' belongs to a robot")
        x, y = description.path[0]
        for robot in self._row:
            dx, dy, reach = robot.x - x, robot.y - y, robot.description.radius + description.radius
            if dx * dx + dy * dy < reach * reach:
                raise UsageError(f"no room for '{description.name}': {robot.name} is in the way")
        return self._people.add(description)

    def remove_person(self, name: str) -> None:
        """Remove a person.

        Raises:
            UsageError: the person is unknown.
        """
        self._people.remove(name)

    def _carry(self, robot: Robot, pose: Pose) -> None:
        """Put a robot down at *pose*."""
        self.cleaning.settle(robot)
        robot.put_down(pose)

    def place(self, name: str, x: float, y: float, yaw: float | None = None) -> None:
        """Put a robot down at another place, in metres and radians; the heading is kept unless *yaw* is given.

        Raises:
            UsageError: the robot is unknown, or something is in the way.
        """
        robot = self.robot(name)
        self.check_room(x, y, robot.description.radius, robot.name)
        self._carry(robot, Pose(x, y, robot.yaw if yaw is None else yaw))
        self._note(robot, "robot_placed", {"x": x, "y": y, "yaw": robot.yaw})
        self._sample_robots(all_of_them=True)

    def add_obstacle(self, x: float, y: float, radius: float) -> str:
        """Put a round obstacle on the floor, in metres; return its name.

        It blocks robots, people and lasers, and is not on the robots' map.

        Raises:
            UsageError: the radius is not between 0.02 and 2, or something is in the way.
        """
        if not 0.02 <= radius <= 2.0:
            raise UsageError("the radius of an obstacle must be between 0.02 and 2 metres")
        self.check_room(x, y, radius)
        self._obstacle_count += 1
        name = f"obstacle_{self._obstacle_count}"
        self.obstacles[name] = (x, y, radius)
        self._note_place("obstacle_placed", x, y, {"obstacle": name, "x": x, "y": y, "radius": radius})
        return name

    def remove_obstacle(self, name: str) -> None:
        """Remove an obstacle.

        Raises:
            UsageError: it does not exist.
        """
        if name not in self.obstacles:
            raise UsageError(f"unknown obstacle: `{name}`")
        x, y, _ = self.obstacles.pop(name)
        self._note_place("obstacle_removed", x, y, {"obstacle": name})

    def set_battery(self, name: str, level: float) -> None:
        """Set the level of a robot's battery, in percent.

        Raises:
            UsageError: the robot is unknown, or the level is not between 0 and 100.
        """
        robot = self.robot(name)
        if not 0.0 <= level <= 100.0:
            raise UsageError("the level of a battery must be between 0 and 100 percent")
        robot.battery.level = level
        robot.battery.feed(robot.battery.charging)
        self._note(robot, "battery_set", {"level": level})

    def check_room(self, x: float, y: float, radius: float, but_for: str = "") -> None:
        """Check that there is room for something round at a point.

        Raises:
            UsageError: the point is outside of the world, in a wall or a box, or something is in the way.
        """
        if not self.description.bounds.contains(x, y):
            raise UsageError(f"({x:.2f}, {y:.2f}) is outside of the world")
        in_box = any(box.contains(x, y) for box in self.description.boxes)
        if in_box or any(wall.distance(x, y) < radius for wall in self.segments):
            raise UsageError(f"no room at ({x:.2f}, {y:.2f}): a wall is in the way")
        for name, (other_x, other_y, other_radius) in (*self._standing(), *self.obstacles.items()):
            if name != but_for and math.hypot(other_x - x, other_y - y) < other_radius + radius:
                raise UsageError(f"no room at ({x:.2f}, {y:.2f}): {name} is in the way")

    def step(self, dt: float = STEP) -> None:
        """Advance the world by *dt* seconds."""
        # Rounded to a nanosecond: fifty steps make a second, not almost a second.
        self.time = round(self.time + dt, 9)
        if self.time >= self.faults.next:
            self.faults.step(self.time)
        for robot in self._row:
            robot.step(dt, self._walls)
        if len(self._row) > 1:
            self._part_robots(dt)
        if self.people:
            self._people.step(dt, self._row, self._closed, self._walls)
        for name, circle in self.obstacles.items():
            for robot in self._row:
                robot.hold_off(name, *circle, self._walls, dt)
        if self.cleaning.at_work:
            self.cleaning.step(dt, self.robots)
        if self.description.cliffs:
            for robot in self._row:
                robot.settle_fall(self.description.cliffs)
        for robot in self._row:
            robot.settle_contacts()
            robot.settle_dock(self.docks)
            self._watch_battery(robot)
        if self.time >= self._next_sample:
            self._sample_robots(all_of_them=False)

    def run(self, seconds: float) -> None:
        """Advance the world by *seconds*; commands stay unchanged, and time out."""
        for _ in range(round(seconds / STEP)):
            self.step()

    def _part_robots(self, dt: float) -> None:
        row = self._row
        for index, one in enumerate(row):
            for other in row[index + 1 :]:
                reach = one.description.radius + other.description.radius
                if abs(one.x - other.x) > reach + 0.01 or abs(one.y - other.y) > reach + 0.01:
                    continue
                push = push_apart(one.x, one.y, other.x, other.y, reach)
                if push is not None:
                    x, y, towards_x, towards_y = push
                    one.touch(other.name, push, self._walls, dt)
                    other.touch(one.name, (-x, -y, -towards_x, -towards_y), self._walls, dt)

    def _watch_battery(self, robot: Robot) -> None:
        battery = robot.battery
        shown = (battery.charging, math.ceil(battery.level))
        before = self._charge_shown[robot.name]
        if shown == before:
            return
        self._charge_shown[robot.name] = shown
        if shown[0] and not before[0]:
            self._note(robot, "charging", {"level": battery.level})
        if before[0] and not shown[0] and battery.level >= 100.0:
            self._note(robot, "charged", {"level": battery.level})
        if shown[1] != before[1]:
            self._note(robot, "battery_empty" if battery.empty else "battery", {"level": shown[1]})

    def _sample_robots(self, all_of_them: bool) -> None:
        self._next_sample = round(self.time + 1.0 / SAMPLES_PER_SECOND, 9)
        for robot in self._row:
            if all_of_them or robot.moving or self.time - self._truth.path(robot.name)[-1].time >= 1.0:
                self._truth.record_sample(robot.name, robot.sample(self.time))
        for moved in self._move_listeners:
            moved()

    def when_moved(self, moved: Callable[[], None]) -> Callable[[], None]:
        """Call *moved* ten times a second after the poses of robots were recorded; return a function that stops this."""
        self._move_listeners = (*self._move_listeners, moved)

        def end() -> None:
            self._move_listeners = tuple(each for each in self._move_listeners if each is not moved)

        return end

    def _note(self, robot: Robot, kind: str, data: dict[str, Any]) -> None:
        self._truth.record_event(RobotEvent(self.time, robot.name, kind, robot.x, robot.y, robot.yaw, data))

    def _note_place(self, kind: str, x: float, y: float, data: dict[str, Any]) -> None:
        self._truth.record_event(RobotEvent(self.time, "", kind, x, y, 0.0, data))

    def _reached(self, progress: Progress) -> bool:
        robot = self.robot(progress.robot or None)
        return progress.reached(robot.odometer, robot.battery.level, robot.tasks)

    def _let_happen(self, fault: Fault) -> Effect:
        """Let a fault happen.

        Raises:
            UsageError: it cannot happen now.
        """
        if fault.kind in ON_ROBOT:
            return ON_ROBOT[fault.kind](self.robot(fault.robot), fault, self.description.seed)
        match fault.kind:
            case "kidnapped_robot":
                return self._kidnap(self.robot(fault.robot), fault)
            case "dead_dock" | "dirty_contact" | "wrong_dock":
                return self._spoil_dock(fault)
            case "closed_door":
                return self._shut_door(fault.door)
            case "stuck_door":
                self.stuck_doors[fault.door] = self.faults.chance(fault)
                return Effect(partial(self.stuck_doors.pop, fault.door, None))
            case "missed_grasp":
                robot = self.robot(fault.robot)
                robot.misses = self.faults.chance(fault)
                return Effect(partial(setattr, robot, "misses", None))
        person = self.add_person(self._person_of(fault))
        met = near(self._row, lambda x, y: distance((x, y), (person.x, person.y)))
        return Effect(partial(self.remove_person, fault.name), met)

    def _shut_door(self, name: str) -> Effect:
        if not self.doors[name]:
            return Effect(lambda: None)
        why = self.move_door(name, opened=False)
        if why is not None:
            raise UsageError(why)
        shut = next(door.segment for door in self.description.doors if door.name == name)
        return Effect(partial(self.move_door, name, opened=True), near(self._row, shut.distance))

    def _kidnap(self, robot: Robot, fault: Fault) -> Effect:
        before = (robot.x, robot.y)
        self._carry(robot, fault.pose if fault.by is None else self._place_near(robot, fault, fault.by))
        metres = distance(before, (robot.x, robot.y))
        return Effect(felt=metres >= CARRIED, data={"x": robot.x, "y": robot.y, "metres": metres})

    def _place_near(self, robot: Robot, fault: Fault, metres: float) -> Pose:
        """Draw a free place at that distance from a robot, and a heading."""
        draw = fault.draw(self.description.seed, "by")
        for _ in range(_DRAWS):
            sine, cosine = sine_cosine(PI * (2.0 * draw() - 1.0))
            pose = Pose(robot.x + metres * cosine, robot.y + metres * sine, PI * (2.0 * draw() - 1.0))
            if any(cliff.contains(pose.x, pose.y) for cliff in self.description.cliffs):
                continue
            with suppress(UsageError):
                self.check_room(pose.x, pose.y, robot.description.radius, robot.name)
                return pose
        raise UsageError(f"no free place {metres:g} m from {robot.name}")

    def _spoil_dock(self, fault: Fault) -> Effect:
        """Take the current from a dock, always or now and then, or add a dock that has none."""
        dirty, wrong = fault.kind == "dirty_contact", Dock(fault.name, fault.pose)
        if fault.kind == "wrong_dock":
            if any(dock.name == fault.name for dock in self.docks):
                raise UsageError(f"a dock has the name '{fault.name}'")
            self.docks = (wrong, *self.docks)
        seed, spoilt = self.description.seed, fault.dock or fault.name
        self.currents[fault.name] = (spoilt, lambda: dirty and fault.connects(seed, self.time))

        def end() -> None:
            self.docks = tuple(dock for dock in self.docks if dock is not wrong)
            del self.currents[fault.name]

        return Effect(end, without_current(self._row, spoilt))

    def _person_of(self, fault: Fault) -> PersonDescription:
        assert fault.person is not None
        if fault.kind == "person":
            return fault.person
        robot, radius = self.robot(fault.robot), fault.person.radius
        place = robot.placement.point(robot.description.radius + fault.gap + radius, 0.0)
        self.check_room(*place, radius)
        return replace(fault.person, path=(place,))

    def _note_fault(self, name: str, data: dict[str, Any]) -> None:
        if name:
            self._note(self.robot(name), "fault", data)
        else:
            self._note_place("fault", 0.0, 0.0, data)

    def _note_person(self, person: Person, kind: str, data: dict[str, Any]) -> None:
        # The place is in the data too: observers of a run do not receive the poses of events.
        where = {"person": person.name, "x": person.x, "y": person.y}
        self._note_place(kind, person.x, person.y, {**where, **data})
