"""Records as lines of JSON, plain or compressed."""

import json
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import msgspec

from jacaros.look.records.records import RecordingLine

_MEMBER = 1 << 20
"""Size of the lines in one independently readable part of a compressed file, in bytes."""
_LEVEL = 1
_PIECE = 1 << 12
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


def unpacked(data: bytes, largest: int, damaged: Callable[[], None]) -> Iterator[bytes]:
    """Yield the readable content of a compressed file, member by member.

    A truncated file is not damaged. The content of a damaged member is lost from about the damage on.

    Args:
        data: file content.
        largest: maximum number of bytes to decompress; the rest is skipped.
        damaged: called once before the content of the first damaged member.
    """
    is_whole = True
    left, at = largest, data.find(MAGIC)
    while at >= 0 and left > 0:
        content, end, is_damaged = _member(data, at, left)
        if is_damaged and is_whole:
            is_whole = False
            damaged()
        yield (
            content if end is not None else content + b"\n"
        )  # the missing part begins in the middle of a line
        left -= len(content)
        at = data.find(MAGIC, at + 1 if end is None else end)


def _member(data: bytes, start: int, largest: int) -> tuple[bytes, int | None, bool]:
    """Return the readable content of a member, its end in the file (None if missing), and whether it is damaged."""
    unpacker = zlib.decompressobj(_GZIP)
    pieces: list[bytes] = []
    left = largest
    for at in range(start, len(data), _PIECE):
        try:
            pieces.append(unpacker.decompress(data[at : at + _PIECE], left))
        except zlib.error:
            return b"".join(pieces), None, True
        left -= len(pieces[-1])
        if unpacker.eof:
            end = min(at + _PIECE, len(data)) - len(unpacker.unused_data)
            return b"".join(pieces), end, False
        if left <= 0:
            break
    return b"".join(pieces), None, False
