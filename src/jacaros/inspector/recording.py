"""A recorded run in memory, read from a recorder's file."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from jacaros.errors import JacarosError
from jacaros.files.texts import LARGEST, file_bytes, printable, text_of
from jacaros.inspector.line_format import MAGIC, unpacked
from jacaros.sim.data.ground_truth import FIELDS, RobotState, present_kind

VERSION = 2
"""Version of the written format; older versions are read completely, and known records of newer ones."""
LARGEST_RECORDING = 2**32
"""Maximum size of a recording to read, in bytes."""
LARGEST_RATIO = 32
"""A compressed recording contains at most this number of times its size, or `LARGEST` bytes: runs reach 8 to 15 times."""

_COLUMNS = len(RobotState._fields)
_LARGEST = 1e15


class Frame(NamedTuple):
    """The robots at a time."""

    t: float
    robots: tuple[RobotState, ...]

    def record(self) -> dict[str, Any]:
        """Return the record of the frame."""
        return {"kind": "frame", **self._asdict()}


def world_record(world: Mapping[str, Any]) -> dict[str, Any]:
    """Return the record of a world: its drawing, see `jacaros.sim.WorldDescription.drawing`."""
    return {"kind": "world", "version": VERSION, "world": world}


def text_record(t: float, agent: str, text: str) -> dict[str, Any]:
    """Return the record of a line of an agent's output."""
    return {"kind": "text", "t": round(t, 3), "agent": agent, "text": text}


def event_record(t: float, event: str, data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the record of an event; *t* is a whole millisecond."""
    return {"kind": "event", "t": t, "event": event, "data": data}


_NOWHERE: dict[str, Any] = {
    "name": "",
    "bounds": [-1, -1, 1, 1],
    **{
        each: []
        for each in (
            "walls",
            "boxes",
            "furniture",
            "rooms",
            "docks",
            "doors",
            "cliffs",
            "robots",
            "people",
            "objects",
        )
    },
}
"""The drawing of an unknown world."""


@dataclass
class Recording:
    """A recorded run.

    Attributes:
        world: data of the world; empty if nothing is known about it.
        frames: robots over time.
        texts: output of agents as (t, agent, text).
        events: events as (t, kind, data).
        warnings: warnings about unreadable parts; empty for a complete recording of this version.
    """

    world: dict[str, Any] = field(default_factory=dict)
    frames: list[Frame] = field(default_factory=list)
    texts: list[tuple[float, str, str]] = field(default_factory=list)
    events: list[tuple[float, str, dict[str, Any]]] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list, compare=False)

    @property
    def duration(self) -> float:
        """Seconds from the start to the last record."""
        ends = [frame.t for frame in self.frames[-1:]]
        ends += [t for t, *_ in self.texts[-1:]] + [t for t, *_ in self.events[-1:]]
        return max(ends, default=0.0)

    @property
    def robots(self) -> list[str]:
        """Names of the robots, in the order of the rows of a frame."""
        return [robot["name"] for robot in self.world.get("robots", [])]

    @property
    def drawing(self) -> dict[str, Any]:
        """The drawing of the world, with everything that viewers expect."""
        return {**_NOWHERE, **self.world}

    def rows(self) -> list[list[RobotState]]:
        """The rows of each robot, one per frame; before its discovery, a robot stays where it was discovered."""
        found = []
        for index in range(max((len(frame.robots) for frame in self.frames), default=0)):
            rows = [frame.robots[index] if index < len(frame.robots) else None for frame in self.frames]
            first = next(row for row in rows if row is not None)
            found.append([first if row is None else row for row in rows])
        return found

    @classmethod
    def read(cls, path: str | Path) -> "Recording":
        """Read a recorder's file, plain or compressed, and the older part of a long one.

        Lines truncated by a crash or a full disk, and unknown records of newer versions, are skipped; see `warnings`.

        Raises:
            OSError: the file cannot be read.
            JacarosError: the file is not a recording.
        """
        recording, path = cls(), Path(path)
        lines = _lines(path, recording.warnings)
        first = _header_of(lines[0]) if lines else {}
        if first.get("version", 1) > VERSION:
            recording.warnings.append(
                f"{path} has version {first['version']}, which is newer than {VERSION}: unknown records are skipped"
            )
        part = first.get("part", 1)
        if part > 1 and older_part(path).is_file():
            before = _lines(older_part(path), recording.warnings)
            if before and _header_of(before[0]).get("part", 1) == part - 1:
                recording._take_all(before, older_part(path))
        recording._take_all(lines, path)
        return recording

    def _take_all(self, lines: list[str], path: Path) -> None:
        described = damaged = False
        for number, line in enumerate(lines, 1):
            try:
                record = _mapping(json.loads(line))
                self._take(record)
                described = described or record["kind"] == "world"
            except (ValueError, KeyError, TypeError, RecursionError, OverflowError) as error:
                cut_off = number == len(lines) or line.startswith(_BEGINNING)
                if (cut_off and isinstance(error, json.JSONDecodeError)) or self.warnings:
                    damaged = True
                    continue
                raise _not_a_recording(f"{path}:{number}", _reason(error)) from None
        if not described:
            raise _not_a_recording(str(path), "no line of it describes a world")
        if damaged and not self.warnings:
            self.warnings.append(f"{path} is cut off or damaged: what can be read of it is shown")

    def _take(self, record: dict[str, Any]) -> None:
        kind = record["kind"]
        if kind == "world":
            self.world = _world(record["world"])
        elif kind == "frame":
            width = _COLUMNS if not self.warnings else None
            rows = tuple(_row(row, width) for row in record["robots"])
            self.frames.append(Frame(_number(record["t"]), rows))
        elif kind == "text":
            self.texts.append((_number(record["t"]), _text(record["agent"]), _text(record["text"])))
        elif kind == "event":
            self._take_event(_number(record["t"]), _text(record["event"]), _mapping(record["data"]))

    def _take_event(self, t: float, kind: str, data: dict[str, Any]) -> None:
        kind = present_kind(kind, data)
        missing = [name for name in FIELDS.get(kind, ()) if name not in data]
        if not missing:
            self.events.append((t, kind, data))
        elif not self.warnings:
            self.warnings.append(
                f"events without data are skipped: `{kind}` at {t:g} s without `{missing[0]}`"
            )


def _reason(error: Exception) -> str:
    """Return the error in a line, as text."""
    if isinstance(error, KeyError):
        return f"the key {error} is missing"
    if isinstance(error, json.JSONDecodeError):
        return f"invalid JSON: {error.msg}"
    return str(error)


def _number(value: Any) -> float:
    """Return a number of a recording that pages and pictures can scale."""
    if not isinstance(value, int | float) or not -_LARGEST < value < _LARGEST:
        raise TypeError(f"a number is expected, not {str(value)[:40]}")
    return value


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"a text is expected, not {str(value)[:40]}")
    return value


def _mapping(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise TypeError(f"names with values are expected, not {str(value)[:40]}")
    return value


def _row(values: Any, width: int | None = _COLUMNS) -> RobotState:
    """Return a robot's row of a frame; without *width*, further columns are dropped."""
    row = tuple(map(_number, values))
    if len(row) < _COLUMNS or (width is not None and len(row) != width):
        raise TypeError(f"a robot has {_COLUMNS} numbers, not {len(row)}")
    return RobotState._make(row[:_COLUMNS])


def _world(drawing: Any) -> dict[str, Any]:
    """Return a drawing of the world that viewers can draw."""
    world = _mapping(drawing)
    for robot in world.get("robots", []):
        _text(_mapping(robot)["name"])
        _number(robot.get("radius", 0.0))
        for number in robot.get("footprint", []):
            _number(number)
    for number in world.get("bounds", []):
        _number(number)
    return world


_BEGINNING = '{"kind": '
"""Maximum size of a line."""


def older_part(path: Path) -> Path:
    """Return the file that holds the older part of *path*."""
    return path.with_name(f"{path.name}.1")


def _lines(path: Path, warnings: list[str]) -> list[str]:
    data = file_bytes(path, LARGEST_RECORDING)
    if data.startswith(b"\x89MCAP0"):
        raise JacarosError(
            f"error: a recording of MCAP is for other programs, such as Foxglove: {printable(str(path))}\n"
            "  = help: `jacaros run FILE --record RUN.jsonl` makes one that jacaros reads"
        )
    if data.startswith(MAGIC):
        largest = max(LARGEST, LARGEST_RATIO * len(data))
        data, broken = unpacked(data, largest + 1)
        if len(data) > largest:
            raise JacarosError(
                f"error: compressed content is larger than {largest >> 20} MiB: {printable(str(path))}\n"
                f"  = help: if you trust the file, unpack it first: gzip -dc {printable(str(path))} > run.jsonl"
            )
        if broken:
            warnings.append(f"{path} is damaged: what can be read of it is shown")
    whole, end, cut_off = data.rpartition(b"\n")
    try:
        lines = text_of(whole).split("\n") if end else []
    except UnicodeError as error:
        raise _not_a_recording(str(path), str(error)) from None
    # The last line may be truncated in the middle of a character.
    return [*lines, cut_off.decode("utf-8", "replace")] if cut_off else lines


def _header_of(line: str) -> dict[str, Any]:
    """Return version and part of a file from its first line; empty for a line without these integers."""
    try:
        header = json.loads(line)
        return {key: header[key] for key in ("version", "part") if type(header.get(key)) is int}
    except (ValueError, TypeError, AttributeError, RecursionError, OverflowError):
        return {}


def _not_a_recording(place: str, why: str) -> JacarosError:
    return JacarosError(
        f"error: not a recording: {printable(why)}\n  --> {printable(place)}\n"
        "  = help: `jacaros run FILE --record RUN.jsonl` makes one"
    )
