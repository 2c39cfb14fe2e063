"""The file of a recording: records are packed some at a time, on the loop that makes them.

A thread that packed them all made the run slower than the packing is: 600 s of the patrol took 2.9 s instead of 2.1.  One
that packs what a loop has left behind costs nothing, and saves the last records of a loop that is stuck.
"""

import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from io import FileIO
from pathlib import Path
from typing import Any, Protocol

from jacaros.inspector.recording import older_part
from jacaros.output import CLOSING, PATIENCE, Output

FLUSH = 0.2
"""Seconds after which a record is in the file: as much is lost when the process is killed."""
_BATCH = 64
"""Records that are packed together at most: to pack many costs less, and to keep many more memory."""

Data = Mapping[str, Any]


class Format(Protocol):
    """How records become bytes; one object for one file."""

    def begin(self, header: Data) -> bytes:
        """Return what a file begins with; *header* is the newest record of kind ``world``."""

    def pack(self, records: Sequence[Data]) -> bytes:
        """Return records as bytes, so that a file that ends behind them can be read."""

    def end(self) -> bytes:
        """Return what a file ends with."""


class RecordingFile:
    """Writes records to a file; a file that has half of the limit becomes ``FILE.1``, and a new one begins.

    Records must not change after `write`.  Nothing here raises an error or waits for a disk: see
    `jacaros.output.Output`.

    Args:
        path: the file.
        make_format: makes the format of a file; called again for each further part.
        warn: takes a line about a file that cannot be written.
        limit: bytes that the file and its older part may have together.

    Raises:
        OSError: the file cannot be written.
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
        self._header: Data = {}
        self._part, self._size = 1, 0
        self._pending: deque[Data] = deque()
        self._packing = threading.Lock()
        self._closing = threading.Event()
        self._thread: threading.Thread | None = None
        self._packed = time.monotonic()
        """When records were packed last, on a clock of real time."""
        self._file: FileIO | None = None
        self._output: Output | None = None
        self._open()

    def write(self, record: Data) -> None:
        """Have *record* written soon: with others, by the next `flush` that is due, or by the thread."""
        self._pending.append(record)
        if len(self._pending) >= self._batch:
            self._pack_pending(FLUSH)
        elif self._thread is None:
            self._thread = threading.Thread(target=self._watch_loop, name=str(self._path), daemon=True)
            self._thread.start()

    def flush(self) -> None:
        """Write what waits if that was last done half of `FLUSH` ago; to be called several times a second."""
        if self._pending and time.monotonic() - self._packed >= 0.5 * FLUSH:
            self._pack_pending(0.0)

    def close(self) -> None:
        """Write what waits and close the file; closing twice does no harm."""
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
        """Write what waits; False when another thread still does that after *patience* seconds."""
        if not self._packing.acquire(timeout=patience):
            return False
        try:
            while self._pending:
                self._put([self._pending.popleft() for _ in range(min(len(self._pending), self._batch))])
            self._packed = time.monotonic()
        finally:
            self._packing.release()
        return True

    def _put(self, batch: Sequence[Data]) -> None:
        for record in batch:
            if record["kind"] == "world":
                self._header = record
        data = self._format.pack(batch)
        self._send(data)
        if self._size + len(data) > self._limit // 2:  # the next ones are about as large
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
        """Make the file the older part, and begin a new one; a device or a pipe has no parts."""
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
        self._send(self._format.begin({**self._header, "part": self._part}))
