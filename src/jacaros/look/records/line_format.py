"""Records as lines of JSON, plain or compressed."""

import contextlib
import json
import zlib
from collections.abc import Mapping, Sequence
from typing import Any

import msgspec

from jacaros.look.records.records import RecordingLine

_MEMBER = 1 << 20
"""Size of the lines in one independently readable part of a compressed file, in bytes."""
_LEVEL = 1
_PIECE = 1 << 16
_GZIP = 31
"""Window of zlib for the gzip format."""


def _as_json(value: Any) -> Any:
    """Return what JSON has for a value that is of no type of it."""
    for kind in (str, int, float):
        if isinstance(value, kind):
            return kind(value)
    return dict(value) if isinstance(value, Mapping) else str(value)


_encode = msgspec.json.Encoder(enc_hook=_as_json).encode


def encoded(data: object, spaced: bool = False) -> bytes:
    """Return *data* as JSON in one line, with null for NaN and infinity; compact, or *spaced* for people."""
    try:
        text = _encode(data)
        return msgspec.json.format(text, indent=0) if spaced else text
    except UnicodeEncodeError:  # a lone surrogate, which Python's encoder escapes
        plain = msgspec.to_builtins(data, enc_hook=_as_json)
        return json.dumps(plain, separators=None if spaced else (",", ":")).encode()


class Lines:
    """A file of lines (see `jacaros.look.page.recorder.RecordingFile`)."""

    def pack(self, records: Sequence[RecordingLine]) -> bytes:
        """Return lines of JSON; each begins with its ``kind``."""
        return b"".join(encoded(each, spaced=True) + b"\n" for each in records)

    def end(self) -> bytes:
        """Return nothing: the file is complete."""
        return b""


class CompressedLines(Lines):
    """A file of lines in the gzip format.

    All packed records are readable wherever the file is truncated. The file consists of members of about 1 MB that are
    readable independently: a part that a full disk has lost costs one of them.
    """

    def __init__(self) -> None:
        self._packer: Any = None
        self._size = 0

    def pack(self, records: Sequence[RecordingLine]) -> bytes:
        """Return lines, compressed."""
        data = super().pack(records)
        if self._packer is None:
            self._packer = zlib.compressobj(_LEVEL, zlib.DEFLATED, _GZIP)
        packed: bytes = self._packer.compress(data)
        self._size += len(data)
        if self._size >= _MEMBER:
            return packed + self.end()
        return packed + self._packer.flush(zlib.Z_SYNC_FLUSH)  # type: ignore[no-any-return]

    def end(self) -> bytes:
        """Return the end of the member."""
        packed: bytes = self._packer.flush() if self._packer is not None else b""
        self._packer, self._size = None, 0
        return packed


MAGIC = b"\x1f\x8b\x08"
"""First bytes of a member of a compressed file."""


def unpacked(data: bytes, largest: int) -> tuple[bytes, bool]:
    """Return the readable content of a compressed file, and whether a part of it is damaged.

    A truncated file is not damaged.

    Args:
        data: file content.
        largest: maximum number of bytes to decompress; the rest is skipped.
    """
    found: list[bytes] = []
    broken = False
    left, at = largest, data.find(MAGIC)
    while at >= 0 and left > 0:
        member = _Member(data, at, left)
        found.append(member.content)
        left -= len(member.content)
        if member.end is None:
            found.append(b"\n")  # the missing part begins in the middle of a line
        broken = broken or member.broken
        at = data.find(MAGIC, at + 1 if member.end is None else member.end)
    return b"".join(found), broken


class _Member:
    """The readable part of a member of a compressed file.

    Attributes:
        content: decompressed content.
        end: position of its end in the file; None if it is truncated or damaged.
        broken: whether it contains invalid data.
    """

    def __init__(self, data: bytes, start: int, largest: int) -> None:
        self.end: int | None = None
        self.broken = False
        self._unpacker = zlib.decompressobj(_GZIP)
        self._pieces: list[bytes] = []
        self._left = largest
        for at in range(start, len(data), _PIECE):
            piece = data[at : at + _PIECE]
            if not self._take(piece) or self._left <= 0:
                break
            if self._unpacker.eof:
                self.end = at + len(piece) - len(self._unpacker.unused_data)
                break
        self.content = b"".join(self._pieces)

    def _take(self, piece: bytes) -> bool:
        before = self._unpacker.copy()
        try:
            self._add(self._unpacker.decompress(piece, self._left))
        except zlib.error:
            self.broken = True
            with contextlib.suppress(zlib.error):  # up to the invalid byte
                for at in range(len(piece)):
                    self._add(before.decompress(piece[at : at + 1], self._left))
        return not self.broken

    def _add(self, content: bytes) -> None:
        self._pieces.append(content)
        self._left -= len(content)
