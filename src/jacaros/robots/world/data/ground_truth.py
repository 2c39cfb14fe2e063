"""The ground truth of a world: events with true poses, and the path of every robot.

Checkers of scenarios use only the ground truth, never what an agent or its odometry believes. A running
The `World` of `physics` fills it, or `read` reads it from the file that `serve` of `process` writes, so one
checker evaluates both kinds of runs.
"""

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

from jacaros.robots.plane.pose import Pose
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import file_text

JsonRecord = dict[str, Any]
"""One line of a ground truth file: ``kind`` is ``world``, ``sample``, ``event`` or ``end``."""


class RobotEvent(NamedTuple):
    """An event of a robot (``""`` for none), ``time`` seconds after the start of the world, with the true pose.

    The kinds, with the names in their data, are those of `FIELDS`.
    """

    time: float
    robot: str
    kind: str
    x: float
    y: float
    yaw: float
    data: dict[str, Any]


FIELDS: Final[Mapping[str, tuple[str, ...]]] = {
    "docked": ("dock",),
    "undocked": ("dock",),
    "charging": ("level",),
    "charged": ("level",),
    "battery": ("level",),  # at each whole percent
    "battery_empty": ("level",),
    "battery_set": ("level",),  # by hand
    "robot_placed": ("x", "y", "yaw"),  # by hand
    "bump": ("side",),  # against a wall
    "collision": ("with", "side"),
    "command_timeout": ("speed", "turn_rate"),
    "bad_command": ("speed", "turn_rate"),
    "task": ("task", "room"),
    "tool_started": ("tool",),
    "tool_stopped": ("tool",),
    # The rest, at each whole percent and when the tool stops:
    "cleaned": ("room", "dirt", "grams", "percent"),
    "fell": (),  # down a cliff
    "lights": ("colors",),
    "sound": ("notes", "append"),
    "picked": ("object", "x", "y"),  # by a gripper, and the place of the object
    "placed": ("object", "x", "y"),
    "fault": ("fault", "kind", "state"),
    # Without a robot:
    "door_opened": ("door",),  # at the middle of the door
    "door_closed": ("door",),
    "obstacle_placed": ("obstacle", "x", "y", "radius"),
    "obstacle_removed": ("obstacle",),
    "person_walks": ("person", "x", "y", "vx", "vy"),
    "person_stands": ("person", "x", "y", "waits_for"),  # a robot, a door or ""
    "person_comes": ("person", "x", "y", "name", "radius", "color", "path", "loop"),
    "person_goes": ("person", "x", "y"),
}
"""The kinds of events with the data that every event of the kind has: for writers, readers, pages and pictures."""


class RobotState(NamedTuple):
    """A robot at a time: pose (metres, radians), battery (percent), and whether it charges and touches something.

    Its fields are the columns of a robot's row in recordings, in this order.
    """

    x: float
    y: float
    yaw: float
    battery: float
    charging: bool = False
    touching: bool = False


class PathSample(NamedTuple):
    """A point of a robot's path; ``odometer`` is the true distance driven so far, in metres."""

    time: float
    x: float
    y: float
    yaw: float
    battery: float
    charging: bool
    touching: bool
    odometer: float


class GroundTruth:
    """Events and paths of one run.

    Attributes:
        events: all events, oldest first.
        world: data of the world (see `jacaros.robots.world.data.world.WorldDescription.drawing`).
        dirt: remaining dirt in grams, by room and kind: ``dirt["kitchen", "stains"]``.
        keep: minimum number of points of each path and of events to keep; None to keep all. Set it for worlds that run for
            days; listeners still receive every event.
    """

    def __init__(self, robots: Iterable[str] = (), world: JsonRecord | None = None) -> None:
        self.events: list[RobotEvent] = []
        self.world: JsonRecord = world or {}
        self.dirt: dict[tuple[str, str], float] = {
            (room["name"], dirt["kind"]): dirt["grams"]
            for room in self.world.get("rooms", ())
            for dirt in room.get("dirt", ())
        }
        self._paths: dict[str, list[PathSample]] = {robot: [] for robot in robots}
        self._latest: dict[str, PathSample] = {}
        self._listeners: list[Callable[[JsonRecord], None]] = []
        self._event_listeners: list[Callable[[JsonRecord], None]] = []
        self.keep: int | None = None

    @property
    def robots(self) -> list[str]:
        """Names of the robots, in the order of the world file."""
        return list(self._paths)

    def path(self, robot: str | None = None) -> list[PathSample]:
        """Return the path of *robot* (default: the first): ten samples per second in motion, one at rest."""
        return self._paths[robot or self._first()]

    def latest(self, robot: str | None = None) -> PathSample:
        """Return the newest sample of *robot* (default: the first)."""
        return self._latest[robot or self._first()]

    def pose(self, robot: str | None = None) -> Pose:
        """Return the true pose of *robot*, now or at the end of the file."""
        latest = self.latest(robot)
        return Pose(latest.x, latest.y, latest.yaw)

    def odometer(self, robot: str | None = None) -> float:
        """Return the true distance that *robot* has driven, in metres."""
        return self.latest(robot).odometer

    def battery(self, robot: str | None = None) -> float:
        """Return the battery level of *robot*, in percent."""
        return self.latest(robot).battery

    def events_of(self, *kinds: str, robot: str | None = None) -> list[RobotEvent]:
        """Return the events of the given kinds (default: all), of one robot or of all."""
        return [
            event
            for event in self.events
            if (not kinds or event.kind in kinds) and robot in (None, event.robot)
        ]

    def digest(self) -> str:
        """Return a hash of all events and paths: equal for equal runs, on every machine."""
        content = hashlib.sha256()
        for event in self.events:
            content.update(repr(tuple(event)).encode())
        for robot, path in self._paths.items():
            content.update(robot.encode())
            for sample in path:
                content.update(repr(tuple(sample)).encode())
        return content.hexdigest()

    def listen(self, listener: Callable[[JsonRecord], None]) -> Callable[[], None]:
        """Call *listener* with every record from now on; return a function that removes it."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def listen_to_events(self, listener: Callable[[JsonRecord], None]) -> Callable[[], None]:
        """Call *listener* with the record of every event from now on; return a function that removes it."""
        self._event_listeners.append(listener)
        return lambda: self._event_listeners.remove(listener)

    def record_event(self, event: RobotEvent) -> None:
        """Record an event; one of `FIELDS` has the data of its kind."""
        assert event.data.keys() >= set(FIELDS.get(event.kind, ())), event
        self._add(event)

    def _add(self, event: RobotEvent) -> None:
        self.events.append(event)
        if event.kind == "cleaned":
            self.dirt[event.data["room"], event.data["dirt"]] = event.data["grams"]
        self._forget(self.events)
        if self._listeners or self._event_listeners:
            record = event_record(event)
            self._tell(record)
            for listener in tuple(self._event_listeners):
                listener(record)

    def record_sample(self, robot: str, sample: PathSample) -> None:
        """Add a point to the path of *robot*."""
        path = self._paths.setdefault(robot, [])
        path.append(sample)
        self._forget(path)
        self._latest[robot] = sample
        if self._listeners:
            self._tell({"kind": "sample", "robot": robot, **sample._asdict()})

    def update_latest(self, robot: str, sample: PathSample) -> None:
        """Update the pose of *robot* without adding a point to its path."""
        self._latest[robot] = sample

    def _forget(self, items: list[Any]) -> None:
        """Drop old records, in batches to keep the cost low."""
        if self.keep is not None and len(items) >= 2 * self.keep:
            del items[: -self.keep]

    def _tell(self, record: JsonRecord) -> None:
        for listener in tuple(self._listeners):
            listener(record)

    def _first(self) -> str:
        return next(iter(self._paths))

    @classmethod
    def read(cls, path: str | Path) -> "GroundTruth":
        """Read a ground truth file, without lines truncated by a crash or a full disk.

        Raises:
            JacarosError: the file does not begin with a ``world`` record.
        """
        try:
            return cls._of_records(_records(path))
        except (ValueError, LookupError, TypeError, AttributeError, RecursionError, OverflowError) as error:
            message = f"not a ground truth file: `{path}`: {type(error).__name__}: {str(error)[:200]}"
            raise JacarosError(message) from None

    @classmethod
    def _of_records(cls, records: list[JsonRecord]) -> "GroundTruth":
        if not records or records[0].get("kind") != "world":
            raise ValueError("its first line does not describe a world")
        truth = cls([robot["name"] for robot in records[0]["world"]["robots"]], records[0]["world"])
        for record in records[1:]:
            truth._take(record)
        return truth

    def _take(self, record: JsonRecord) -> None:
        if record["kind"] == "sample":
            self.record_sample(record["robot"], PathSample(*(record[name] for name in PathSample._fields)))
        elif record["kind"] == "event":
            record = {**record, "kind": record["event"]}
            self._add(RobotEvent(*(record[name] for name in RobotEvent._fields)))
        elif record["kind"] == "end":
            self.dirt |= {(room, kind): grams for room, kind, grams in record.get("dirt", ())}


def _records(path: str | Path) -> list[JsonRecord]:
    lines = file_text(path, 2**32).splitlines()
    records = []
    for number, line in enumerate(lines, 1):
        try:
            records.append(json.loads(line))
        except json.JSONDecodeError:
            # A crash truncates the last line, and a full disk any line.
            if number < len(lines) and not line.startswith("{"):
                raise
    return records


def event_record(event: RobotEvent) -> JsonRecord:
    """Return the record of an event."""
    return {**event._asdict(), "kind": "event", "event": event.kind}


def header(world: JsonRecord, seed: int, epoch: float) -> JsonRecord:
    """Return the first record of a file; *epoch* is the clock's time (seconds) at which the world's time was 0."""
    return {"kind": "world", "world": world, "seed": seed, "epoch": epoch}
