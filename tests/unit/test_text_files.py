"""Files as editors leave them, and files that are not for reading."""

import os
import sys
from pathlib import Path

import pytest

from jacaros.runtime.files.texts import UnusableFile, file_bytes, file_text, is_file


def test_a_byte_order_mark_does_not_belong_to_the_text(tmp_path: Path) -> None:
    file = tmp_path / "a.asl"
    file.write_bytes(b"\xef\xbb\xbfp(1).\r\nq.\r\n")
    assert file_text(file) == "p(1).\nq.\n"


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b'p(1).\nq("caf\xe9").\n', "a byte (0xe9) that is not UTF-8; save the file as UTF-8"),
        (b"p.\n" + b"\0" * 4000, "a NUL byte; this is not a text file"),
    ],
)
def test_the_line_of_an_invalid_byte_is_reported(data: bytes, told: str, tmp_path: Path) -> None:
    file = tmp_path / "a.asl"
    file.write_bytes(data)
    with pytest.raises(UnicodeError) as wrong:
        file_text(file)
    assert str(wrong.value) == f"line 2 contains {told}"


def test_the_reason_for_an_unreadable_file_is_reported(tmp_path: Path) -> None:
    with pytest.raises(OSError, match=r"^it is a directory$"):
        file_text(tmp_path)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no named pipes in folders, and no /dev")
def test_a_pipe_without_a_writer_and_an_endless_device_are_refused_without_waiting(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.asl")
    for file in (tmp_path / "pipe.asl", "/dev/zero"):
        with pytest.raises(UnusableFile, match=r"^it is not a regular file$"):
            file_text(file)


def test_a_file_that_is_too_large_is_refused_before_it_fills_the_memory(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_bytes(b"p. " * 2**20)
    assert len(file_bytes(tmp_path / "a.asl")) == 3 * 2**20
    with pytest.raises(UnusableFile, match=r"^it is larger than 2 MiB$"):
        file_bytes(tmp_path / "a.asl", 2 * 2**20)


def test_a_name_that_no_file_can_have_is_not_a_file(tmp_path: Path) -> None:
    assert not is_file(tmp_path / ("x" * 300))
    assert not is_file(tmp_path / "nul\0")
    with pytest.raises(UnusableFile, match="File name too long"):
        file_bytes(tmp_path / ("x" * 300))
