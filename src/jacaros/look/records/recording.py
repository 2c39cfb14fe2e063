"""A recorded run in memory, read from a recorder's file."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec
from msgspec import Struct, ValidationError, convert

from jacaros.look.records.line_format import MAGIC, unpacked
from jacaros.look.records.records import (
    VERSION,
    AnyLine,
    Data,
    EventLine,
    FiniteNumber,
    Frame,
    TextLine,
    WorldLine,
    decoded,
)
from jacaros.robots.world.data.ground_truth import RobotState
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import LARGEST, file_bytes, printable, text_of

LARGEST_RECORDING = 2**32
"""Maximum size of a recording to read, in bytes."""
LARGEST_RATIO = 32
"""A compressed recording contains at most this number of times its size, or `LARGEST` bytes: runs reach 8 to 15 times."""

_COLUMNS = len(RobotState._fields)
_BEGINNING = '{"kind": '


class _Robot(Struct):
    """A robot of a drawing, as far as viewers rely on it."""

    name: str
    radius: FiniteNumber = 0.0


class _Drawing(Struct):
    robots: Sequence[_Robot] = ()
    bounds: Sequence[FiniteNumber] = ()


class _Kind(Struct):
    kind: str


_read_line = msgspec.json.Decoder(AnyLine).decode
_KINDS = ("world", "frame", "text", "event")


NOWHERE: dict[str, Any] = {
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
        return {**NOWHERE, **self.world}

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
        """Take all lines out of a list: the memory of each is free once it is read."""
        described = damaged = False
        last = len(lines)
        lines.reverse()
        for number in range(1, last + 1):
            line = lines.pop()
            try:
                record = _record(line)
                self._take(record)
                described = described or isinstance(record, WorldLine)
            except (ValueError, RecursionError) as error:
                cut_off = number == last or line.startswith(_BEGINNING)
                if (cut_off and isinstance(error, json.JSONDecodeError)) or self.warnings:
                    damaged = True
                    continue
                raise _not_a_recording(f"{path}:{number}", str(error)) from None
        if not described:
            raise _not_a_recording(str(path), "no line of it describes a world")
        if damaged and not self.warnings:
            self.warnings.append(f"{path} is cut off or damaged: what can be read of it is shown")

    def _take(self, record: AnyLine | None) -> None:
        match record:
            case WorldLine():
                convert(record.world, _Drawing)
                self.world = record.world
            case Frame():
                rows = tuple(_row(row, exactly=not self.warnings) for row in record.robots)
                self.frames.append(Frame(record.t, rows))
            case TextLine():
                self.texts.append((record.t, record.agent, record.text))
            case EventLine():
                self._take_event(record.t, record.event, record.data)

    def _take_event(self, t: float, kind: str, data: Data) -> None:
        try:
            decoded(kind, data)
            self.events.append((t, kind, dict(data)))
        except ValidationError as error:
            if not self.warnings:
                self.warnings.append(f"malformed events are skipped: `{kind}` at {t:g} s: {error}")


def _record(line: str) -> AnyLine | None:
    """Return the record of a line; None for one of an unknown kind.

    Raises:
        ValidationError: it is not a record.
        JSONDecodeError: it is not JSON.
    """
    try:
        return _read_line(line)
    except ValidationError:
        if msgspec.json.decode(line, type=_Kind).kind in _KINDS:
            raise
        return None
    except ValueError:  # NaN and lone surrogates, which only Python's decoder knows
        return convert(json.loads(line), AnyLine)  # type: ignore[no-any-return]


def _row(values: Any, exactly: bool) -> RobotState:
    """Return a robot's row of a frame; unless it has to have *exactly* its columns, further ones are dropped."""
    row = convert(values, list[FiniteNumber])
    if len(row) < _COLUMNS or (exactly and len(row) != _COLUMNS):
        raise ValidationError(f"a robot has {_COLUMNS} numbers, not {len(row)}")
    return RobotState._make(row[:_COLUMNS])


def older_part(path: Path) -> Path:
    """Return the file that holds the older part of *path*."""
    return path.with_name(f"{path.name}.1")


def _lines(path: Path, warnings: list[str]) -> list[str]:
    data = file_bytes(path, LARGEST_RECORDING)
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
    end = data.rfind(b"\n") + 1
    cut_off, data = data[end:], data[: max(0, end - 1)]
    try:
        text = text_of(data)
    except UnicodeError as error:
        raise _not_a_recording(str(path), str(error)) from None
    del data  # hours of a run are hundreds of megabytes
    lines = text.split("\n") if end else []
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
