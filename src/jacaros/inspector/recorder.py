"""Records a run as JSON lines: the world, frames of its robots, agents' prints, and events.

One line, one record; ``t`` is in seconds since the run began::

    {"kind": "world", "version": 1, "world": {...}}
    {"kind": "frame", "t": 0.1, "robots": [[x, y, yaw, battery, charging, touching], ...]}
    {"kind": "text", "t": 1.5, "agent": "patroller", "text": "low battery"}
    {"kind": "event", "t": 1.5, "event": "goal", "data": {...}}

Events that the replay knows how to show:

========================  ==========================================================================
``goal``                  ``agent``, ``goal``, ``state``: pursued, suspended, resumed, achieved,
                          failed, recovered, dropped or replaced (by a tail call); ``id`` tells goals apart,
                          ``intention`` the stacks they are on; of a failure ``why``, in lines: error and
                          place, step, terms for plans
``cause``                 what led to an act of an agent, and the act itself: ``id``, ``parent`` (the id of what led to
                          it, 0: nothing), ``kind`` (sample: a message of ROS, operation, property, act), ``what``,
                          and ``at``, when it arose; the page does not show them yet
events of the world       ``robot`` and what `jacaros.sim.ground_truth.Event` says: docked, undocked,
                          charging, charged, bump, collision, task, battery, ...
========================  ==========================================================================

Others are kept, and shown by their kind.

On a real graph the world is what the graph tells, and may come late, or more than once: the last line that describes one
counts, and robots that are found later are behind the others in the rows of frames.
"""

import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TextIO

from jacaros.inspector.recording import Frame, Recording, older_part
from jacaros.inspector.scene import RobotView
from jacaros.output import CLOSING, PATIENCE, Output

VERSION = 1
LIMIT = 500_000_000
"""Bytes that a recording may have."""
FLUSH = 0.2
"""Seconds after which a record is in the file: as much is lost when the process is killed."""


class Recorder:
    """Writes a recording while the run goes on.

    Frames in which nothing has changed are left out, but for the one before the next change, so that a
    reader that interpolates sees a robot rest and then move, not creep.

    Args:
        path: the file to write; None keeps the recording in memory only.
        keep: keep it in memory as well, as `recording`.
        warn: takes a line about a file that cannot be written; the run goes on without it.
        limit: bytes that the file and its older part may have together.  A file that has half of that becomes ``FILE.1``,
            in place of an older part, and a new one begins, with ``"part": 2``; `Recording.read` reads both.

    Raises:
        OSError: the file cannot be written.
    """

    def __init__(
        self,
        path: str | Path | None = None,
        keep: bool | None = None,
        warn: Callable[[str], None] | None = None,
        limit: int = LIMIT,
    ) -> None:
        self.path = Path(path) if path is not None else None
        self.recording = Recording()
        self._keep = keep if keep is not None else path is None
        self._warn, self._limit = warn, limit
        self._drawing: dict[str, Any] = {}
        self._part, self._size = 1, 0
        self._file: TextIO | None = None
        self._output: Output | None = None
        if self.path is not None:
            self._open(self.path)
        self._last: Frame | None = None
        self._held: Frame | None = None

    def world(self, drawing: Mapping[str, Any]) -> None:
        """The world, as `jacaros.sim.WorldDescription.drawing` gives it, before everything else; the last one counts."""
        self.recording.world = self._drawing = dict(drawing)
        self._write(self._header())

    def frame(self, t: float, robots: Iterable[RobotView]) -> None:
        """The robots at a moment, in the order of the world."""
        frame = Frame(_short(t), tuple(_row(robot) for robot in robots))
        if self._last is not None and frame.robots == self._last.robots:
            self._held = frame
            return
        if self._held is not None:
            self._take(self._held)
            self._held = None
        self._take(frame)

    def _take(self, frame: Frame) -> None:
        self._last = frame
        if self._keep:
            self.recording.frames.append(frame)
        self._write({"kind": "frame", "t": frame.t, "robots": frame.robots})

    def text(self, t: float, agent: str, text: str) -> None:
        """What an agent printed."""
        if self._keep:
            self.recording.texts.append((t, agent, text))
        self._write({"kind": "text", "t": _short(t), "agent": agent, "text": text})

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Something that happened; *data* is plain JSON data."""
        if self._keep:
            self.recording.events.append((t, kind, dict(data)))
        self._write({"kind": "event", "t": _short(t), "event": kind, "data": dict(data)})

    def close(self) -> None:
        """Write the last frame and close the file; closing twice does no harm."""
        if self._held is not None:
            self._take(self._held)
            self._held = None
        self._close_file(CLOSING)

    def _header(self) -> dict[str, Any]:
        part = {"part": self._part} if self._part > 1 else {}
        return {"kind": "world", "version": VERSION, **part, "world": self._drawing}

    def _write(self, record: dict[str, Any]) -> None:
        if self._output is None:
            return
        line = json.dumps(record, ensure_ascii=False, default=str) + "\n"
        self._size += len(line)
        if self._size > self._limit // 2 and self._size > len(line):
            self._begin_part()
            self._size += len(line)
        if self._output is not None:
            self._output.write(line)

    def _begin_part(self) -> None:
        """Make the file the older part, and begin a new one; a device or a pipe has no parts."""
        assert self.path is not None
        self._size = 0
        if not self.path.is_file():
            return
        self._close_file(PATIENCE)
        try:
            self.path.replace(older_part(self.path))
            self._part += 1
            self._open(self.path)
        except OSError as error:
            if self._warn is not None:
                self._warn(f"cannot continue the recording {self.path}: {error.strerror}")
        else:
            self._write(self._header())

    def _open(self, path: Path) -> None:
        self._file = path.open("w", encoding="utf-8")
        self._output = Output(self._file, str(path), self._warn, delay=FLUSH)

    def _close_file(self, patience: float) -> None:
        if self._output is not None and self._file is not None:
            self._output.close(patience)
            self._file.close()
            self._output = self._file = None


def _short(value: float) -> float:
    return round(value, 3)


def _row(robot: RobotView) -> tuple[Any, ...]:
    """A tenth of a millimetre is fine enough for a picture, and a third of the bytes."""
    _, x, y, yaw, battery, charging, touching = robot
    return round(x, 4), round(y, 4), round(yaw, 4), round(battery, 2), int(charging), int(touching)
