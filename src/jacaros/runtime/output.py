"""Output that cannot hurt the program that writes it, whatever happens to the reader or the disk.

The loop of a run must not wait for a terminal, a pipe or a disk, and a step must not fail because of one. The lines of an
`Output` pass through a bounded queue, which a daemon thread writes; `Output.write` waits for it a moment, so that lines on
two streams keep their order, and a line before a crash is not lost. If the queue stays full, or the sink raises an
exception, lines are lost: they are counted and reported.
"""

import codecs
import contextlib
import errno
import io
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import IO, Any, NamedTuple, TextIO

from jacaros.runtime.files.texts import is_worth_a_line, visible

LIMIT = 8 << 20
"""Maximum number of bytes waiting for a sink."""
PATIENCE = 0.2
"""Seconds that a writer waits for a full queue of which the sink accepts nothing."""
CLOSING = 2.0
"""Seconds without progress after which `Output.close` drops the rest."""
_RETRY = 1.0
"""Seconds until a sink that raised an error is tried again."""
_PIECE = 1 << 16
_ATOMIC = 4096 if os.name == "posix" else _PIECE
"""Bytes written at a time (PIPE_BUF of Linux): a pipe takes them as soon as it has room, which counts as progress.
A console of Windows takes no part of a character.
"""
_MOMENT = 0.01
"""Seconds that a writer waits for its text to be written, unless earlier text still waits."""


PLAIN = "jacaros.plain"
"""Name of what becomes of characters that an encoding lacks: one that looks similar, or an escape; see `codecs`."""
_SIMILAR = str.maketrans(
    dict(zip("→↗↑↖←↙↓↘▒◎☻█░·×–—‘’“”²", ">/^\\</v\\#O@#.-x--''\"\"2", strict=True))
    | dict.fromkeys("─━═", "-")
    | dict.fromkeys("│┃║", "|")
    | dict.fromkeys("┌┐└┘├┤┬┴┼╭╮╯╰┏┓┗┛┡┩╇", "+")
    | dict.fromkeys(map(chr, range(0x2801, 0x2900)), ":")  # dots of the map
    | {"\u2800": " ", "…": "...", "°": ""}
)


def _similar(error: UnicodeError) -> tuple[str | bytes, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    wanted = error.object[error.start : error.end]
    plain = wanted.translate(_SIMILAR)
    return plain.encode("ascii", "backslashreplace").decode("ascii"), error.end


codecs.register_error(PLAIN, _similar)


class Output:
    """A sink of text. `write` raises no error and waits at most `patience` seconds; it may be called in any thread.

    Args:
        stream: the stream, or a function that returns the present one; None stands for a closed one.
        name: its name in warnings.
        warn: called with a warning of one line, without ``warning:``; None for no warnings.
        patience: seconds that `write` waits if the queue is full and the sink accepts nothing; then lines are dropped until
            half of the queue is free.
        delay: seconds that text may be collected before the thread writes it; 0 waits a moment until it is written.
        raw: write control characters as they are; otherwise they are escaped (`jacaros.runtime.files.texts.visible`).

    Attributes:
        when_gone: called once, in any thread, instead of a warning when the reader has closed its end of a pipe.
    """

    def __init__(
        self,
        stream: IO[Any] | Callable[[], IO[Any] | None] | None,
        name: str,
        warn: Callable[[str], None] | None = None,
        patience: float = PATIENCE,
        delay: float = 0.0,
        raw: bool = False,
    ) -> None:
        self._find = stream if callable(stream) else lambda: stream
        self._raw = raw
        self._name, self._warn, self._patience, self._delay = name, warn, patience, delay
        self.when_gone: Callable[[], object] | None = None
        # Reentrant: a signal handler may log in the middle of a write.
        self._changed = threading.Condition(threading.RLock())
        self._stream: IO[Any] | None = None
        self._sink: _Sink | None = None
        self._queue: deque[bytes] = deque()
        self._waiting = 0
        self._progress = 0.0
        self._thread: threading.Thread | None = None
        self._closed = self._blocked = False
        self._retry_at: float | None = None
        self._failures = self._lost = 0
        self._cut = self._in_line = False

    @property
    def waiting(self) -> bool:
        """Whether the sink has not accepted all of the text yet."""
        return self._waiting > 0

    def write(self, text: str | bytes) -> None:
        """Write whole lines; bytes only to a file that was opened for them (`io.FileIO`)."""
        if isinstance(text, str) and not self._raw:
            text = visible(text)
        lines = text.count("\n") if isinstance(text, str) else text.count(b"\n")
        with self._changed:
            if self._retry_at is not None and time.monotonic() < self._retry_at:
                self._lost += lines
                return
            if self._closed and self._waiting:
                return
            stream = beneath(self._find())
            if stream is not self._stream:
                self._stream, self._sink = stream, _sink_of(stream)
            if self._sink is None or self._closed or not self._has_thread():
                self._write_to_stream(text, lines)
                return
            data = text if isinstance(text, bytes) else self._sink.encode(text)
            if not self._has_room(len(data)):
                self._lost += lines
                return
            keeps_up = not self._waiting
            self._enqueue(data)
            if keeps_up and not self._delay and threading.current_thread() is not self._thread:
                self._changed.wait_for(lambda: not self._waiting, _MOMENT)

    def _write_to_stream(self, text: str | bytes, lines: int) -> None:
        try:
            if self._stream is None:
                raise OSError(errno.EBADF, "it is closed")
            self._stream.write(text)
            self._stream.flush()
        except Exception as error:
            self._lost += lines
            self._fail(error)
        else:
            self._recover()

    # ---- the queue

    def _has_room(self, size: int) -> bool:
        """Wait for room as long as the sink makes progress; return False if it makes none."""
        if self._blocked and self._waiting > LIMIT // 2:
            return False
        while self._waiting and self._waiting + size > LIMIT:
            left = self._progress + self._patience - time.monotonic()
            if left <= 0:
                self._blocked = True
                self._fail(None)
                return False
            self._changed.wait(left)
        return True

    def _enqueue(self, data: bytes) -> None:
        if not self._waiting:
            self._progress = time.monotonic()
        before = self._waiting
        self._queue.append(data)
        self._waiting += len(data)
        if not before or before < _PIECE <= self._waiting:
            self._changed.notify_all()

    def _has_thread(self) -> bool:
        """Start the thread at the first line; return False while the interpreter shuts down."""
        if self._thread is None or not self._thread.is_alive():  # not started yet, or in a forked process
            thread = threading.Thread(target=self._drain, name=self._name, daemon=True)
            try:
                thread.start()
            except RuntimeError:
                return False
            self._thread = thread
        return True

    def _drain(self) -> None:
        """Write pending text until `close`; the body of the thread."""
        while True:
            with self._changed:
                while not self._queue:
                    if self._closed:
                        return
                    self._changed.wait()
                begun = time.monotonic()
                while self._waiting < _PIECE and (left := begun + self._delay - time.monotonic()) > 0:
                    self._changed.wait(left)
                stream, sink, piece = self._stream, self._sink, self._next_piece()
            written, error = 0, None
            try:
                if stream is None or sink is None:
                    raise OSError(errno.EBADF, "it is closed")
                stream.flush()  # what others have printed comes first
                if self._cut:  # a full disk has taken a part of a line
                    self._cut = not sink.write(b"\n")
                written = sink.write(piece)
            except Exception as raised:
                error = raised
            with self._changed:
                self._progressed(piece, written, error)

    def _next_piece(self) -> bytes:
        taken, size = [], 0
        while self._queue and size < _PIECE:
            taken.append(self._queue.popleft())
            size += len(taken[-1])
        return b"".join(taken)

    def _progressed(self, piece: bytes, written: int, error: Exception | None) -> None:
        if error is not None:
            self._cut = self._cut or self._in_line
            self._lost += piece.count(b"\n") + sum(data.count(b"\n") for data in self._queue)
            self._queue.clear()
            self._waiting = 0
            self._fail(error)
        else:
            if written < len(piece):
                self._queue.appendleft(piece[written:])
            self._waiting -= written
            if written:
                self._in_line = piece[written - 1] != 10  # a line feed
                self._progress = time.monotonic()
                if self._retry_at is not None or (self._blocked and self._waiting <= LIMIT // 2):
                    self._recover()
        self._changed.notify_all()

    # ---- errors

    def _fail(self, error: Exception | None) -> None:
        """Note an error of the sink, or that it blocks (None)."""
        if error is not None:
            first, self._retry_at = self._retry_at is None, time.monotonic() + _RETRY
            if not first:
                return
        if isinstance(error, BrokenPipeError) and self.when_gone is not None:
            told, self.when_gone, self._warn = self.when_gone, None, None
            told()
            return
        self._failures += 1
        if is_worth_a_line(self._failures):
            known = getattr(error, "strerror", None) or str(error) or type(error).__name__
            why = "the reader accepts nothing" if error is None else known
            self._report(f"cannot write to {self._name}: {why}; dropping lines until it works again")

    def _recover(self) -> None:
        """Note that the sink has accepted something."""
        if self._retry_at is None and not self._blocked:
            return
        self._retry_at, self._blocked = None, False
        if is_worth_a_line(self._failures) and self._lost:
            self._report(f"{self._name} works again; {_lines(self._lost)} lost")
            self._lost = 0

    def _report(self, text: str) -> None:
        if self._warn is not None:
            with contextlib.suppress(Exception):
                self._warn(text)

    # ---- the end

    def close(self, patience: float | None = CLOSING, limit: float | None = None) -> None:
        """Write pending text, drop what the sink does not accept, and report the lines that were lost.

        The stream itself stays open; later text is dropped if it is stuck.

        Args:
            patience: seconds to wait without progress; None for no limit.
            limit: total seconds to wait; None for no limit.
        """
        with self._changed:
            self._delay = 0.0
            self._changed.notify_all()
            self._wait_until_written(patience, limit)
            self._closed = True
            self._lost += sum(data.count(b"\n") for data in self._queue)
            if self._waiting:
                self._lost = max(self._lost, 1)  # the thread is stuck with a piece of it
            self._queue.clear()
            self._changed.notify_all()
            if self._lost:
                self._report(f"{_lines(self._lost)} could not be written to {self._name}")
                self._lost = 0

    def _wait_until_written(self, patience: float | None, limit: float | None) -> None:
        begun = time.monotonic()
        while self._waiting:
            now = time.monotonic()
            if patience is not None and now >= max(self._progress, begun) + patience:
                return
            if limit is not None and now >= begun + limit:
                return
            self._changed.wait(0.1)


class Wrapped(io.TextIOBase):
    """A text stream in front of another one, whose properties it has.

    Args:
        stream: the other stream.
    """

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    def writable(self) -> bool:
        """Return True."""
        return True

    def isatty(self) -> bool:
        """Return whether the stream is a terminal."""
        return self.stream.isatty()

    def fileno(self) -> int:
        """Return the stream's file descriptor."""
        return self.stream.fileno()

    @property
    def encoding(self) -> str:  # type: ignore[override]
        """The encoding of the stream."""
        return self.stream.encoding

    @property
    def errors(self) -> str | None:  # type: ignore[override]
        """How characters that the encoding lacks are handled."""
        return self.stream.errors


class Printed(Wrapped):
    """Replaces a standard stream during a run, for code that prints by itself.

    ``print`` in project code, loggers and warnings write to `sys.stdout` and `sys.stderr` directly. There a full disk would
    raise an exception in the middle of an operation, and a blocked reader would stop the loop. Here complete lines go to
    *output*. Otherwise it behaves like the stream itself.

    Args:
        stream: the stream.
        output: writes to it.
    """

    def __init__(self, stream: TextIO, output: Output) -> None:
        super().__init__(stream)
        self._output = output
        self._lock = threading.RLock()
        self._line = ""

    def write(self, text: str) -> int:
        """Write the lines that *text* completes; the rest waits for its end, for `flush`, or for a line of an agent.

        Raises:
            TypeError: *text* is not a string.
        """
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        with self._lock:
            lines, end, self._line = (self._line + text).rpartition("\n")
            if end:
                self._output.write(lines + end)
        return len(text)

    def flush(self) -> None:
        """Write the incomplete last line."""
        with self._lock:
            line, self._line = self._line, ""
            if line:
                self._output.write(line)

    def close(self) -> None:
        """Flush: the process needs the stream itself."""
        self.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


class Visible(Wrapped):
    """A standard stream of a command: whatever is written, control characters are escaped.

    It has no ``buffer``, by which libraries would write past it. `beneath` returns the stream for own styles and pictures.
    """

    def write(self, text: str) -> int:
        """Write *text*."""
        self.stream.write(visible(text))
        return len(text)

    def flush(self) -> None:
        """Flush the stream."""
        self.stream.flush()


def beneath(stream: Any) -> Any:
    """Return the stream itself, for text that is escaped already."""
    return stream.stream if isinstance(stream, Visible) else stream


class _Sink(NamedTuple):
    """The file of a stream of the process; only the thread of an `Output` writes to it, and may have to wait."""

    file: io.RawIOBase
    encoding: str
    errors: str
    line_end: str = "\n"

    def encode(self, text: str) -> bytes:
        """Return the bytes of *text*; characters that the encoding lacks are escaped."""
        text = text if self.line_end == "\n" else text.replace("\n", self.line_end)
        try:
            return text.encode(self.encoding, self.errors)
        except UnicodeError:
            return text.encode(self.encoding, PLAIN)

    def write(self, data: bytes) -> int:
        """Write what is accepted; return the number of bytes.

        Raises:
            OSError: the sink is full, gone or broken.
            ValueError: it was closed.
        """
        written = self.file.write(data[:_ATOMIC])
        if written is None:  # another process has the same terminal, and does not want to wait for it
            time.sleep(_MOMENT)
        return written or 0


def _sink_of(stream: IO[Any] | None) -> _Sink | None:
    """Return the sink of a stream of the process; None for a stream made by other code, such as a test."""
    if type(stream) is io.FileIO:
        return _Sink(stream, "utf-8", PLAIN)
    if type(stream) is not io.TextIOWrapper or stream.closed:
        return None
    file = getattr(stream.buffer, "raw", stream.buffer)  # python -u has no buffer
    if not isinstance(file, io.RawIOBase):
        return None
    return _Sink(file, stream.encoding, stream.errors or "strict", os.linesep)


def _lines(number: int) -> str:
    return "1 line" if number == 1 else f"{number} lines"
