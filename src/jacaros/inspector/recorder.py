"""Record a run: the world, frames of its robots, the output of agents, and events.

The format is described in ``docs/reference/recordings.md``.
"""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from jacaros.errors import UsageError
from jacaros.inspector.line_format import CompressedLines, Lines
from jacaros.inspector.recording import Recording
from jacaros.inspector.recording_file import Format, RecordingFile
from jacaros.inspector.scene import RobotView, row_of
from jacaros.mas.history.records import VERSION, Frame, Happened, Heard, Line, Text, World
from jacaros.ros.message import type_of
from jacaros.sim.ground_truth import RobotState

MCAP = ".mcap"
LIMIT = 500_000_000
"""Default size limit of a recording, in bytes."""


def format_of(path: Path) -> Callable[[], Format]:
    """Return the format for a file name.

    Raises:
        UsageError: the library for the format is not installed.
    """
    if path.suffix == MCAP:
        try:
            from jacaros.inspector.mcap_format import McapFile
        except ModuleNotFoundError as missing:
            raise UsageError(
                "error: mcap, which writes recordings of this kind, is not installed\n"
                "  = help: pip install 'jacaros[mcap]', or --record RUN.jsonl"
            ) from missing
        return McapFile
    return CompressedLines if path.suffix == ".gz" else Lines


class Recorder:
    """Writes a recording during the run.

    Frames without changes are left out, except for the one before the next change, so that a reader that interpolates
    sees a robot rest and then move, not creep.

    Args:
        path: file to write; None to keep the recording only in memory.
        keep: keep the recording in memory as well, as `recording`.
        warn: takes a warning that the file cannot be written; the run continues without it.
        limit: maximum size in bytes of the file and its older part together. A file of half that size becomes ``FILE.1``,
            replacing an older part, and a new one begins, with ``"part": 2``; `Recording.read` reads both.

    Attributes:
        takes_messages: whether ROS messages are recorded, too (`message`), which MCAP files support.

    Raises:
        OSError: the file cannot be opened.
        UsageError: the library for its format is not installed.
    """

    def __init__(
        self,
        path: str | Path | None = None,
        keep: bool | None = None,
        warn: Callable[[str], None] | None = None,
        limit: int = LIMIT,
    ) -> None:
        self.path = Path(path) if path is not None else None
        self.takes_messages = self.path is not None and self.path.suffix == MCAP
        self.recording = Recording()
        self._keep = keep if keep is not None else path is None
        self._file: RecordingFile | None = None
        if self.path is not None:
            self._file = RecordingFile(self.path, format_of(self.path), warn, limit)
        self._seen: tuple[RobotView, ...] | None = None
        self._last: tuple[RobotState, ...] | None = None
        self._rested: float | None = None
        """Time at which the robots were last seen at the poses in `_last`."""

    def world(self, drawing: Mapping[str, Any]) -> None:
        """Record the world (see `jacaros.sim.WorldDescription.drawing`), before everything else; the last call wins."""
        self.recording.world = dict(drawing)
        self._write(World(version=VERSION, world=self.recording.world))

    def frame(self, t: float, robots: Iterable[RobotView]) -> None:
        """Record the robots at a time, in the order of the world."""
        if self._file is not None:
            self._file.flush()
        robots = tuple(robots)
        if robots == self._seen:  # the common case: robots at rest
            self._rested = t
            return
        self._seen = robots
        rows = tuple(map(row_of, robots))
        if rows == self._last:
            self._rested = t
            return
        if self._rested is not None:
            self._take_rest()
        self._take(t, rows)

    def _take_rest(self) -> None:
        if self._rested is not None and self._last is not None:
            self._take(self._rested, self._last)
        self._rested = None

    def _take(self, t: float, rows: tuple[RobotState, ...]) -> None:
        self._last, frame = rows, Frame(round(t, 3), rows)
        if self._keep:
            self.recording.frames.append(frame)
        self._write(frame)

    def text(self, t: float, agent: str, text: str) -> None:
        """Record a line of an agent's output."""
        if self._keep:
            self.recording.texts.append((t, agent, text))
        self._write(Text(round(t, 3), agent, text))

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Record an event at a whole millisecond; *data* is plain JSON data that must not change afterwards."""
        if self._keep:
            self.recording.events.append((t, kind, dict(data)))
        self._write(Happened(t, kind, data))

    def message(self, t: float, topic: str, message: Any) -> None:
        """Record a ROS message that had an effect."""
        if self.takes_messages:
            self._write(Heard(round(t, 3), topic, type_of(message), message))

    def close(self) -> None:
        """Write the last frame and close the file; closing twice is harmless."""
        self._take_rest()
        if self._file is not None:
            self._file.close()
            self._file = None

    def _write(self, record: Line) -> None:
        if self._file is not None:
            self._file.write(record)
