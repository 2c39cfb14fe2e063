"""The ground truth of a world: events with the true pose, and the path of every robot.

Checkers of scenarios judge from this alone, never from what an agent or its odometry believes.  The same
object is filled by a running `jacaros.sim.world.World` or read back from the file that
`jacaros.sim.process.serve` writes, so one checker judges runs of both kinds.
"""

import hashlib
import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from jacaros.errors import JacarosError
from jacaros.sim.description import Pose
from jacaros.text_files import file_text

Record = dict[str, Any]
"""One line of a ground truth file: ``kind`` is ``world``, ``sample``, ``event`` or ``end``."""


class Event(NamedTuple):
    """Something that happened to a robot, ``time`` seconds after the world began; the pose is the true one.

    Kinds, with what their data hold: ``docked`` and ``undocked`` (dock), ``charging``, ``charged``,
    ``battery_empty`` and ``battery`` at each whole percent (level), ``bump`` against a wall (side),
    ``collision`` (with, side), ``command_timeout`` and ``bad_command`` (speed, turn_rate), ``task`` (task as
    text, room), ``tool_started`` and ``tool_stopped`` (tool), ``cleaned`` at each whole percent of a room's dirt, and
    when the tool stops (room, dirt, and what is left: grams, percent), ``fell`` down a cliff (nothing),
    ``lights`` (colors) and ``sound`` (notes, append), ``picked`` and ``placed`` (object, and its place: x, y).  Of no robot
    (``""``): ``door_opened`` and ``door_closed`` (door), in the middle of the door; ``person_walks`` (velocity: vx, vy),
    ``person_stands`` (waits_for: a robot, a door or ""), ``person_comes`` and ``person_goes``, each with person, x and y.
    A person stands before its first event, at the beginning of its path.
    """

    time: float
    robot: str
    kind: str
    x: float
    y: float
    yaw: float
    data: dict[str, Any]


class Sample(NamedTuple):
    """One point of a robot's path; ``odometer`` is the true distance driven so far, in metres."""

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
        world: the drawing of the world (see `jacaros.sim.description.WorldDescription.drawing`).
        dirt: grams of dirt that are left, by room and kind: ``dirt["kitchen", "stains"]``.
        keep: how many points of each path and how many events are kept at least, None for all.  Set it for
            worlds that run for days; listeners still receive every event.
    """

    def __init__(self, robots: Iterable[str] = (), world: Record | None = None) -> None:
        self.events: list[Event] = []
        self.world: Record = world or {}
        self.dirt: dict[tuple[str, str], float] = {
            (room["name"], dirt["kind"]): dirt["grams"]
            for room in self.world.get("rooms", ())
            for dirt in room.get("dirt", ())
        }
        self._paths: dict[str, list[Sample]] = {robot: [] for robot in robots}
        self._latest: dict[str, Sample] = {}
        self._listeners: list[Callable[[Record], None]] = []
        self._event_listeners: list[Callable[[Record], None]] = []
        self.keep: int | None = None

    @property
    def robots(self) -> list[str]:
        """Names of the robots, in the order of the world file."""
        return list(self._paths)

    def path(self, robot: str | None = None) -> list[Sample]:
        """The path of *robot* (by default the first): ten samples a second in motion, one at rest."""
        return self._paths[robot or self._first()]

    def latest(self, robot: str | None = None) -> Sample:
        """The newest sample of *robot* (of the first one when not named)."""
        return self._latest[robot or self._first()]

    def pose(self, robot: str | None = None) -> Pose:
        """Where *robot* truly is now, or was at the end of the file."""
        latest = self.latest(robot)
        return Pose(latest.x, latest.y, latest.yaw)

    def odometer(self, robot: str | None = None) -> float:
        """Metres that *robot* has truly driven."""
        return self.latest(robot).odometer

    def battery(self, robot: str | None = None) -> float:
        """The level of *robot*'s battery, in percent."""
        return self.latest(robot).battery

    def events_of(self, *kinds: str, robot: str | None = None) -> list[Event]:
        """The events of the given kinds (of all kinds when none is given), of one robot or of all."""
        return [
            event
            for event in self.events
            if (not kinds or event.kind in kinds) and robot in (None, event.robot)
        ]

    def digest(self) -> str:
        """A hash of everything that happened: equal for equal runs, on any machine."""
        content = hashlib.sha256()
        for event in self.events:
            content.update(repr(tuple(event)).encode())
        for robot, path in self._paths.items():
            content.update(robot.encode())
            for sample in path:
                content.update(repr(tuple(sample)).encode())
        return content.hexdigest()

    def listen(self, listener: Callable[[Record], None]) -> Callable[[], None]:
        """Have *listener* called with every record from now on; returns what takes it off again."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def listen_to_events(self, listener: Callable[[Record], None]) -> Callable[[], None]:
        """Have *listener* called with the record of every event from now on; returns what takes it off again."""
        self._event_listeners.append(listener)
        return lambda: self._event_listeners.remove(listener)

    def record_event(self, event: Event) -> None:
        """Take note of an event."""
        self.events.append(event)
        if event.kind == "cleaned":
            self.dirt[event.data["room"], event.data["dirt"]] = event.data["grams"]
        self._forget(self.events)
        if self._listeners or self._event_listeners:
            record = event_record(event)
            self._tell(record)
            for listener in tuple(self._event_listeners):
                listener(record)

    def record_sample(self, robot: str, sample: Sample) -> None:
        """Add a point to the path of *robot*."""
        path = self._paths.setdefault(robot, [])
        path.append(sample)
        self._forget(path)
        self._latest[robot] = sample
        if self._listeners:
            self._tell({"kind": "sample", "robot": robot, **sample._asdict()})

    def update_latest(self, robot: str, sample: Sample) -> None:
        """Say where *robot* is now without adding a point to its path."""
        self._latest[robot] = sample

    def _forget(self, items: list[Any]) -> None:
        """Drop old records, rarely enough to cost nothing."""
        if self.keep is not None and len(items) >= 2 * self.keep:
            del items[: -self.keep]

    def _tell(self, record: Record) -> None:
        for listener in tuple(self._listeners):
            listener(record)

    def _first(self) -> str:
        return next(iter(self._paths))

    @classmethod
    def read(cls, path: str | Path) -> "GroundTruth":
        """Read a ground truth file; lines that a crash or a full disk has cut off are left out.

        Raises:
            JacarosError: when the file does not begin with a ``world`` record.
        """
        try:
            return cls._of_records(_records(path))
        except (ValueError, LookupError, TypeError, AttributeError, RecursionError, OverflowError) as error:
            told = f"{path} is not a ground truth file: {type(error).__name__}: {str(error)[:200]}"
            raise JacarosError(told) from None

    @classmethod
    def _of_records(cls, records: list[Record]) -> "GroundTruth":
        if not records or records[0].get("kind") != "world":
            raise ValueError("its first line describes no world")
        truth = cls([robot["name"] for robot in records[0]["world"]["robots"]], records[0]["world"])
        for record in records[1:]:
            truth._take(record)
        return truth

    def _take(self, record: Record) -> None:
        if record["kind"] == "sample":
            self.record_sample(record["robot"], Sample(*(record[name] for name in Sample._fields)))
        elif record["kind"] == "event":
            record = {**record, "kind": record["event"]}
            self.record_event(Event(*(record[name] for name in Event._fields)))
        elif record["kind"] == "end":
            self.dirt |= {(room, kind): grams for room, kind, grams in record.get("dirt", ())}


def _records(path: str | Path) -> list[Record]:
    lines = file_text(path, 2**32).splitlines()
    records = []
    for number, line in enumerate(lines, 1):
        try:
            records.append(json.loads(line))
        except json.JSONDecodeError:
            # A crash cuts the last line off, and a full disk any line.
            if number < len(lines) and not line.startswith("{"):
                raise
    return records


def event_record(event: Event) -> Record:
    """The record of an event."""
    return {**event._asdict(), "kind": "event", "event": event.kind}


def header(world: Record, seed: int, epoch: float) -> Record:
    """The first record of a file; *epoch* is the clock's time (seconds) at which the world's time was 0."""
    return {"kind": "world", "world": world, "seed": seed, "epoch": epoch}
