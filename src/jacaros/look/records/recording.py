"""A recorded run in memory, read from a recorder's file."""

import json
from collections.abc import Callable, Container, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import Any

import msgspec
from msgspec import Raw, Struct, ValidationError, convert

from jacaros.look.records.line_format import MAGIC, unpacked
from jacaros.look.records.records import (
    EVENTS,
    VERSION,
    AnyLine,
    EventLine,
    EventRecord,
    FiniteNumber,
    Frame,
    RecordingLine,
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
_PIECE = 1 << 20
_DAMAGED = "{} is damaged: what can be read of it is shown"


class _Robot(Struct):
    """A robot of a drawing, as far as viewers rely on it."""

    name: str
    radius: FiniteNumber = 0.0


class _Drawing(Struct):
    robots: Sequence[_Robot] = ()
    bounds: Sequence[FiniteNumber] = ()


class _Kind(Struct):
    kind: str


class _RawEvent(RecordingLine, tag="event", gc=False):
    """An `EventLine` whose data are decoded later, by its kind."""

    t: FiniteNumber
    event: str
    data: Raw


_read_line = msgspec.json.Decoder(WorldLine | Frame | TextLine | _RawEvent).decode
_read_data = msgspec.json.Decoder(dict[str, Any]).decode
_DECODERS = {kind: msgspec.json.Decoder(each).decode for kind, each in EVENTS.items()}
_STRUCTS = frozenset(each.kind for each in EventRecord.__subclasses__())
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
        recording = cls()
        recording.events.extend(recording.streamed(path))
        return recording

    def streamed(
        self, path: str | Path, without: Container[str] = (), is_plain: bool = True
    ) -> Iterator[tuple[float, str, Any]]:
        """Read a file as `read` does, and yield its events, which are not kept.

        Args:
            path: of the file.
            without: kinds of events of which only the time is wanted: their data are None.
            is_plain: whether data are dictionaries; otherwise, they are structs as far as `EventRecord` has them.
        """
        opened = _plain if is_plain else _typed
        path = Path(path)
        lines = _lines(path, self.warnings)
        begin = next(lines, "")
        first = _header_of(begin)
        if first.get("version", 1) > VERSION:
            self.warnings.append(
                f"{path} has version {first['version']}, which is newer than {VERSION}: unknown records are skipped"
            )
        part = first.get("part", 1)
        if part > 1 and older_part(path).is_file():
            before = _lines(older_part(path), self.warnings)
            older = next(before, "")
            if _header_of(older).get("part", 1) == part - 1:
                yield from self._take_all(chain([older], before), older_part(path), without, opened)
        yield from self._take_all(chain([begin] if begin else (), lines), path, without, opened)

    def _take_all(
        self, lines: Iterator[str], path: Path, without: Container[str], opened: Callable[[str, Raw], Any]
    ) -> Iterator[tuple[float, str, Any]]:
        described = damaged = False
        line, number = next(lines, None), 0
        while line is not None:
            following, number = next(lines, None), number + 1
            try:
                record = _record(line)
                if isinstance(record, (EventLine, _RawEvent)):
                    is_wanted = record.event not in without
                    data = self._data(record, opened) if is_wanted else None
                    if data is not None or not is_wanted:
                        yield record.t, record.event, data
                else:
                    self._take(record)
                    described = described or isinstance(record, WorldLine)
            except (ValueError, RecursionError) as error:
                cut_off = following is None or line.startswith(_BEGINNING)
                if not ((cut_off and isinstance(error, json.JSONDecodeError)) or self.warnings):
                    raise _not_a_recording(f"{path}:{number}", str(error)) from None
                damaged = True
            line = following
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

    def _data(self, event: "EventLine | _RawEvent", opened: Callable[[str, Raw], Any]) -> Any:
        """Return the data of an event; None if they are malformed."""
        data = event.data
        try:
            if isinstance(data, Raw):
                try:
                    return opened(event.event, data)
                except ValidationError:
                    raise
                except ValueError:  # as in `_record`
                    data = convert(json.loads(bytes(data)), dict[str, Any])
            decoded(event.event, data)
            return data
        except ValidationError as error:
            if isinstance(data, Raw) and not bytes(data).startswith(b"{"):
                raise
            if not self.warnings:
                self.warnings.append(
                    f"malformed events are skipped: `{event.event}` at {event.t:g} s: {error}"
                )
            return None


def _plain(kind: str, data: Raw) -> dict[str, Any]:
    if kind in _DECODERS:
        _DECODERS[kind](data)
    return _read_data(data)


def _typed(kind: str, data: Raw) -> Any:
    return _DECODERS[kind](data) if kind in _STRUCTS else _plain(kind, data)


def _record(line: str) -> "AnyLine | _RawEvent | None":
    """Return the record of a line; None for one of an unknown kind.

    Raises:
        ValidationError: it is not a record.
        JSONDecodeError: it is not JSON.
    """
    try:
        return _read_line(line)  # type: ignore[no-any-return]
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


def _lines(path: Path, warnings: list[str]) -> Iterator[str]:
    """Yield the lines of a file, which need not fit into memory together: hours of a run are hundreds of megabytes."""
    before, held = 0, []
    for piece in _pieces(path, warnings):
        begin, end, rest = piece.rpartition(b"\n")
        if not end:
            held.append(rest)
            continue
        try:
            lines = _text(b"".join([*held, begin]), before).split("\n")
        except UnicodeError as error:
            raise _not_a_recording(str(path), str(error)) from None
        before, held = before + len(lines), [rest]
        yield from lines
    # The last line may be truncated in the middle of a character.
    if last := b"".join(held):
        yield last.decode("utf-8", "replace")


def _text(data: bytes, before: int) -> str:
    try:
        return text_of(data)
    except UnicodeError:
        return text_of(b"\n" * before + data)  # the error names the line of the file


def _pieces(path: Path, warnings: list[str]) -> Iterator[bytes]:
    data = file_bytes(path, LARGEST_RECORDING)
    if not data.startswith(MAGIC):
        yield from (data[at : at + _PIECE] for at in range(0, len(data), _PIECE))
        return
    left = largest = max(LARGEST, LARGEST_RATIO * len(data))
    for content in unpacked(data, largest + 1, lambda: warnings.append(_DAMAGED.format(path))):
        left -= len(content)
        if left < 0:
            raise JacarosError(
                f"error: compressed content is larger than {largest >> 20} MiB: {printable(str(path))}\n"
                f"  = help: if you trust the file, unpack it first: gzip -dc {printable(str(path))} > run.jsonl"
            )
        yield content


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
