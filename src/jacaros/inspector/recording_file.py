"""The file of a recording: records are packed in batches, on the loop that creates them.

Packing all records in a thread slowed the run by more than the packing costs: 600 s of the patrol took 2.9 s instead of
2.1 s. A thread for the records that a loop has left behind costs nothing, and saves the last records of a blocked loop.
"""

import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from io import FileIO
from pathlib import Path
from typing import Protocol

from msgspec.structs import replace

from jacaros.inspector.recording import older_part
from jacaros.mas.history.records import Line, World
from jacaros.runtime.output import CLOSING, PATIENCE, Output

FLUSH = 0.2
"""Maximum seconds until a record is in the file, and is safe from a kill of the process."""
_BATCH = 64
"""Maximum number of records packed together: more would save time, but cost memory."""


class Format(Protocol):
    """Converts records to bytes; one object for each file."""

    def pack(self, records: Sequence[Line]) -> bytes:
        """Return records as bytes, so that a file that ends after them is readable."""

    def end(self) -> bytes:
        """Return the last bytes of a file."""


class RecordingFile:
    """Writes records to a file; a file of half the limit becomes ``FILE.1``, and a new one begins.

    Records must not change after `write`.  Nothing here raises an error or waits for a disk: see
    `jacaros.runtime.output.Output`.

    Args:
        path: output file.
        make_format: creates the format of a file; called again for each further part.
        warn: takes a warning that the file cannot be written.
        limit: maximum size in bytes of the file and its older part together.

    Raises:
        OSError: the file cannot be opened.
    """

    def __init__(
        self,
        path: Path,
        make_format: Callable[[], Format],
        warn: Callable[[str], None] | None,
        limit: int,
    ) -> None:
        self._path, self._make_format, self._warn, self._limit = path, make_format, warn, limit
        self._batch = max(1, min(_BATCH, limit // 100_000))
        self._format = make_format()
        self._header = World(world={})
        self._part, self._size = 1, 0
        self._pending: deque[Line] = deque()
        self._packing = threading.Lock()
        self._closing = threading.Event()
        self._thread: threading.Thread | None = None
        self._packed = time.monotonic()
        """Time of the last packing, on a clock of real time."""
        self._file: FileIO | None = None
        self._output: Output | None = None
        self._open()

    def write(self, record: Line) -> None:
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

    def _put(self, batch: Sequence[Line]) -> None:
        for record in batch:
            if isinstance(record, World):
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
