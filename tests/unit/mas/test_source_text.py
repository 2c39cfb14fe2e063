"""Files as editors leave them."""

from pathlib import Path

import pytest

from jacaros.mas.source_text import source_text


def test_a_byte_order_mark_does_not_belong_to_the_text(tmp_path: Path) -> None:
    file = tmp_path / "a.asl"
    file.write_bytes(b"\xef\xbb\xbfp(1).\r\nq.\r\n")
    assert source_text(file) == "p(1).\nq.\n"


def test_the_line_of_a_byte_that_is_no_utf_8_is_told(tmp_path: Path) -> None:
    file = tmp_path / "a.asl"
    file.write_bytes(b'p(1).\nq("caf\xe9").\n')
    with pytest.raises(UnicodeError) as wrong:
        source_text(file)
    assert str(wrong.value) == "line 2 holds a byte (0xe9) that is no UTF-8; save the file as UTF-8"


def test_why_a_file_cannot_be_read_is_told_in_words(tmp_path: Path) -> None:
    with pytest.raises(OSError, match=r"^Is a directory$"):
        source_text(tmp_path)
