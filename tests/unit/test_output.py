"""Output cannot hurt the program that writes it."""

import errno
import io
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import SimpleNamespace
from typing import TextIO

import pytest

from jacaros.runtime import output
from jacaros.runtime.output import Output

pytestmark = pytest.mark.skipif(os.name != "posix", reason="pipes are written by descriptor on POSIX only")

LINE = "a line of text that is written again and again\n"


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """A queue that is full soon."""
    monkeypatch.setattr(output, "LIMIT", 100_000)


@contextmanager
def pipe() -> Iterator[tuple[int, TextIO]]:
    """The end to read from, as a descriptor, and the stream to write to."""
    reader, writer = os.pipe()
    with open(writer, "w", encoding="utf-8") as stream:
        yield reader, stream
    os.close(reader)


def fill(stream: TextIO) -> int:
    """Fill a pipe with lines, as many as it holds."""
    os.set_blocking(stream.fileno(), False)
    count = 0
    with suppress(BlockingIOError):
        while os.write(stream.fileno(), LINE.encode()):
            count += 1
    os.set_blocking(stream.fileno(), True)
    return count


def read_all(reader: int, until: int) -> bytes:
    """Read *until* bytes, all of them in the end."""
    parts = []
    while until > 0 and (part := os.read(reader, 1 << 16)):
        parts.append(part)
        until -= len(part)
    return b"".join(parts)


def test_lines_are_written_immediately_and_after_earlier_output() -> None:
    with pipe() as (reader, stream):
        out = Output(stream, "standard output")
        stream.write("before\n")
        out.write("line\n")
        assert os.read(reader, 100) == b"before\nline\n"
        out.close()


def test_a_slow_reader_gets_every_line_in_order() -> None:
    count = 200_000
    expected = "".join(f"line {number}\n" for number in range(count)).encode()
    found = []
    with pipe() as (reader, stream):
        thread = threading.Thread(target=lambda: found.append(read_all(reader, len(expected))))
        out = Output(stream, "standard output", patience=60)
        for number in range(count):
            out.write(f"line {number}\n")
            if number == 10_000:  # more than a pipe holds
                thread.start()
        out.close(patience=60)
        thread.join()
    assert found == [expected]


def test_a_blocked_reader_loses_lines_but_no_time(small: None) -> None:
    warnings: list[str] = []
    with pipe() as (reader, stream):
        held = fill(stream)
        out = Output(stream, "standard output", warnings.append, patience=0.0)
        for _ in range(10_000):
            out.write(LINE)
        assert warnings == [
            "cannot write to standard output: the reader accepts nothing; dropping lines until it works again"
        ]
        out.close(patience=0.0)
        in_the_pipe = os.read(reader, 1 << 20)
    assert warnings[1].endswith(" lines could not be written to standard output")
    assert int(warnings[1].split()[0]) >= 9_999, "a part of a line may have fitted"
    assert in_the_pipe.count(b"\n") == held


def test_lines_continue_when_a_blocked_reader_reads_again(small: None) -> None:
    warnings: list[str] = []
    told = threading.Event()

    def warn(text: str) -> None:
        warnings.append(text)
        if "lost" in text:
            told.set()

    with pipe() as (reader, stream):
        out = Output(stream, "standard output", warn, patience=0.0)
        while not warnings:
            out.write(LINE)
        os.set_blocking(reader, False)
        while not told.is_set():
            with suppress(BlockingIOError):
                os.read(reader, 1 << 12)
        os.set_blocking(reader, True)
        out.write("the last line\n")
        rest = b""
        while b"the last line" not in rest:
            rest += os.read(reader, 1 << 16)
        out.close()
    assert warnings[1] == "standard output works again; 1 line lost"


def test_a_terminal_that_is_stopped_does_not_stop_the_writer(small: None) -> None:
    import pty

    warnings: list[str] = []
    master, slave = pty.openpty()
    with open(slave, "w", encoding="utf-8") as stream:
        out = Output(stream, "standard output", warnings.append, patience=0.0)
        for _ in range(10_000):
            out.write(LINE)
        out.close(patience=0.0)
    os.close(master)
    assert "the reader accepts nothing" in warnings[0]


def test_a_full_disk_is_warned_about_once_and_tried_again(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr(output, "time", SimpleNamespace(monotonic=lambda: now[0]))
    warnings: list[str] = []
    disk = FullDisk()
    out = Output(disk, "run.log", warnings.append)
    for _ in range(5):
        out.write(LINE)
    assert disk.tries == 1
    now[0] = 2.0
    out.write(LINE)
    assert disk.tries == 2
    disk.full = False
    now[0] = 4.0
    out.write("room again\n")
    assert disk.text == "room again\n"
    assert warnings == [
        "cannot write to run.log: No space left on device; dropping lines until it works again",
        "run.log works again; 6 lines lost",
    ]


def test_a_device_without_room_is_warned_about() -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("this system has no /dev/full")
    warnings: list[str] = []
    with open("/dev/full", "w", encoding="utf-8") as stream:
        for delay in (0.0, 0.001):
            out = Output(stream, "run.log", warnings.append, delay=delay)
            out.write(LINE)
            out.close()
    assert warnings == 2 * [
        "cannot write to run.log: No space left on device; dropping lines until it works again",
        "1 line could not be written to run.log",
    ]


def test_output_that_is_closed_loses_lines_and_raises_nothing() -> None:
    warnings: list[str] = []
    out = Output(lambda: None, "standard output", warnings.append)
    out.write(LINE)
    assert warnings == ["cannot write to standard output: it is closed; dropping lines until it works again"]


def test_a_reader_that_has_gone_is_reported_once() -> None:
    reader, writer = os.pipe()
    gone: list[str] = []
    with open(writer, "w", encoding="utf-8") as stream:
        out = Output(stream, "standard output", gone.append)
        out.when_gone = lambda: gone.append("gone")
        os.close(reader)
        out.write(LINE)
        out.write(LINE)
        out.close()
    assert gone == ["gone"]


def test_characters_that_the_encoding_lacks_are_escaped() -> None:
    reader, writer = os.pipe()
    with open(writer, "w", encoding="ascii") as stream:
        out = Output(stream, "standard output")
        out.write("5 \u20ac \ud800\n")
        assert os.read(reader, 100) == b"5 \\u20ac \\ud800\n"
        out.close()
    os.close(reader)


class FullDisk(io.StringIO):
    """A stream to a disk that has no room."""

    def __init__(self) -> None:
        super().__init__()
        self.tries, self.full, self.text = 0, True, ""

    def write(self, text: str) -> int:
        self.tries += 1
        if self.full:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        self.text += text
        return len(text)


def test_after_a_block_lines_are_dropped_until_half_of_the_queue_is_free(small: None) -> None:
    with pipe() as (reader, stream):
        out = Output(stream, "standard output", None, patience=0.0)
        while not out._blocked:
            out.write(LINE)
        lost, waiting = out._lost, out._waiting
        with out._changed:  # the reader takes a little: less than half of the queue is free
            out._waiting = waiting - 1000
            out.write(LINE)
            assert out._lost == lost + 1
            out._waiting = output.LIMIT // 2
            out.write(LINE)
            assert out._lost == lost + 1
            out._waiting = waiting + len(LINE.encode())
        os.set_blocking(reader, False)
        out.close(patience=0.0)


def test_control_characters_are_escaped_except_in_raw_output() -> None:
    text = "a\tb\x1b[2J\x07\x9b\x7f\u202e\r!\n"
    with pipe() as (reader, stream):
        out = Output(stream, "standard output")
        out.write(text)
        assert os.read(reader, 1000).decode() == "a\tb\\x1b[2J\\x07\\u009b\\u007f\\u202e\\x0d!\n"
        Output(stream, "the terminal", raw=True).write(text)
        assert os.read(reader, 1000).decode() == text


def test_a_visible_stream_escapes_whatever_is_written() -> None:
    with pipe() as (reader, stream):
        shown = output.Visible(stream)
        print("\x1b[2Jé", file=shown, flush=True)
        assert os.read(reader, 1000).decode() == "\\x1b[2Jé\n"
        assert not hasattr(shown, "buffer")
        assert output.beneath(shown) is stream
