"""Record a run: the world, frames of its robots, the output of agents, and events.

The format is described in ``docs/reference/recordings.md``.
"""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import FileIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from jacaros.look.page.scene import RobotView, row_of
from jacaros.look.page.watch import watch_of
from jacaros.look.records.line_format import CompressedLines, Lines
from jacaros.look.records.recording import Recording, older_part
from jacaros.look.records.records import (
    VERSION,
    EventLine,
    Frame,
    RecordingLine,
    TextLine,
    WorldLine,
)
from jacaros.robots.world.data.ground_truth import RobotState
from jacaros.runtime.output import CLOSING, PATIENCE, Output

if TYPE_CHECKING:
    from jacaros.runtime.mas.embedding.mas import Mas

LIMIT = 500_000_000
"""Default size limit of a recording, in bytes."""
FLUSH = 0.2
"""Maximum seconds until a record is in the file, and is safe from a kill of the process."""
_BATCH = 64
"""Maximum number of records packed together: more would save time, but cost memory."""


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

    Raises:
        OSError: the file cannot be opened.
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
        self._file: RecordingFile | None = None
        if self.path is not None:
            self._file = RecordingFile(self.path, warn, limit)
        self._seen: tuple[RobotView, ...] | None = None
        self._last: tuple[RobotState, ...] | None = None
        self._rested: float | None = None
        """Time at which the robots were last seen at the poses in `_last`."""

    def world(self, drawing: Mapping[str, Any]) -> None:
        """Record the world (see `WorldDescription.drawing`), before everything else; the last call wins."""
        self.recording.world = dict(drawing)
        self._write(WorldLine(version=VERSION, world=self.recording.world))

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
        self._write(TextLine(round(t, 3), agent, text))

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Record an event at a whole millisecond; *data* is plain JSON data that must not change afterwards."""
        if self._keep:
            self.recording.events.append((t, kind, dict(data)))
        self._write(EventLine(t, kind, data))

    def close(self) -> None:
        """Write the last frame and close the file; closing twice is harmless."""
        self._take_rest()
        if self._file is not None:
            self._file.close()
            self._file = None

    def _write(self, record: RecordingLine) -> None:
        if self._file is not None:
            self._file.write(record)


class RecordingFile:
    """Writes records to a file, in batches on the loop that creates them.

    A file of half the limit becomes ``FILE.1``, and a new one begins.

    Packing all records in a thread slowed the run by more than the packing costs: 600 s of the patrol took 2.9 s instead of
    2.1 s. A thread for the records that a loop has left behind costs nothing, and saves the last records of a blocked loop.

    Records must not change after `write`.  Nothing here raises an error or waits for a disk: see
    `jacaros.runtime.output.Output`.

    Args:
        path: output file.
        warn: takes a warning that the file cannot be written.
        limit: maximum size in bytes of the file and its older part together.

    Raises:
        OSError: the file cannot be opened.
    """

    def __init__(
        self,
        path: Path,
        warn: Callable[[str], None] | None,
        limit: int,
    ) -> None:
        self._path, self._warn, self._limit = path, warn, limit
        self._make_format = CompressedLines if path.suffix == ".gz" else Lines
        self._batch = max(1, min(_BATCH, limit // 100_000))
        self._format = self._make_format()
        self._header = WorldLine(world={})
        self._part, self._size = 1, 0
        self._pending: deque[RecordingLine] = deque()
        self._packing = threading.Lock()
        self._closing = threading.Event()
        self._thread: threading.Thread | None = None
        self._packed = time.monotonic()
        """Time of the last packing, on a clock of real time."""
        self._file: FileIO | None = None
        self._output: Output | None = None
        self._open()

    def write(self, record: RecordingLine) -> None:
        """Queue a record, to be written by the next due `flush`, or by the thread."""
        self._pending.append(record)
        if len(self._pending) >= self._batch:
            self._pack_pending(FLUSH)
        elif self._thread is None:
            self._thread = threading.Thread(target=self._watch_loop, name=str(self._path), daemon=True)
            self._thread.start()

    def flush(self) -> None:
        """Write the queue if half of `FLUSH` has passed since the last time; call it several times a second."""
        if self._pending and time.monotonic() - self._packed >= 0.5 * FLUSH:
            self._pack_pending(0.0)

    def close(self) -> None:
        """Write the queue and close the file; closing twice is harmless."""
        self._closing.set()
        if self._thread is not None:
            self._thread.join(CLOSING)
            self._thread = None
        if self._pack_pending(CLOSING):
            self._close_file(CLOSING)
        elif self._warn is not None:
            self._warn(f"{len(self._pending)} records could not be written to {self._path}")

    def _watch_loop(self) -> None:
        """Pack, in the thread, what the loop has not packed in time."""
        while not self._closing.wait(0.5 * FLUSH):
            if self._pending and time.monotonic() - self._packed >= 0.75 * FLUSH:
                self._pack_pending(FLUSH)

    def _pack_pending(self, patience: float) -> bool:
        """Write the queue; return False if another thread is still doing that after *patience* seconds."""
        if not self._packing.acquire(timeout=patience):
            return False
        try:
            while self._pending:
                self._put([self._pending.popleft() for _ in range(min(len(self._pending), self._batch))])
            self._packed = time.monotonic()
        finally:
            self._packing.release()
        return True

    def _put(self, batch: Sequence[RecordingLine]) -> None:
        for record in batch:
            if isinstance(record, WorldLine):
                self._header = record
        data = self._format.pack(batch)
        self._send(data)
        if self._size + len(data) > self._limit // 2:  # later batches are about as large
            self._begin_part()

    def _send(self, data: bytes) -> None:
        self._size += len(data)
        if data and self._output is not None:
            self._output.write(data)

    # ---- files

    def _open(self) -> None:
        self._file = FileIO(self._path, "w")
        self._output = Output(self._file, str(self._path), self._warn)

    def _close_file(self, patience: float) -> None:
        if self._output is not None and self._file is not None:
            self._send(self._format.end())
            self._output.close(patience)
            self._file.close()
            self._output = self._file = None

    def _begin_part(self) -> None:
        """Make the file the older part, and begin a new one; devices and pipes have no parts."""
        self._size = 0
        if not self._path.is_file():
            return
        self._close_file(PATIENCE)
        try:
            self._path.replace(older_part(self._path))
            self._open()
        except OSError as error:
            if self._warn is not None:
                self._warn(f"cannot continue the recording {self._path}: {error.strerror}")
            return
        self._part, self._size = self._part + 1, 0
        self._format = self._make_format()
        self._send(self._format.pack([replace(self._header, part=self._part)]))


@contextmanager
def record(
    mas: "Mas", path: str | Path | None = None, replay: str | Path | None = None
) -> Iterator[Recording | None]:
    """Record a run inside a ``with``: the world and its robots, and the output and goals of agents.

    ::

        async with Mas("patrol.jcm", seed=1) as mas:
            with record(mas, "patrol.jsonl", replay="patrol.html"):
                await mas.ended()

    Args:
        mas: the running system.
        path: file for the recording, as for ``jacaros run --record``; None for no file.
        replay: file for a page that shows it in a browser; None for no page.

    Returns:
        The recording, which grows; None if only a file is written.

    Raises:
        OSError: a file cannot be opened, or the page cannot be written. Later errors of the recording are logged.
        RunEnded: the system is not running.
    """
    keep = replay is not None or path is None
    recorder = Recorder(path, keep, lambda text: mas.system.console.log(f"warning: {text}", "warning"))
    watch = watch_of(mas.system, [recorder])
    watch.start()
    end_prints = mas.on_print(watch.text)
    try:
        yield recorder.recording if keep else None
    finally:
        end_prints()
        watch.stop()
        recorder.close()
    if replay is not None:
        from jacaros.look.page.page import write_replay  # here: few runs write a page

        write_replay(recorder.recording, replay)
