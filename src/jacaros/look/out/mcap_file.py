"""A writer of MCAP files, as far as recordings need it: JSON messages in chunks, with an index.

Chunks are not compressed: ``mcap compress`` does that. Text and byte fields begin with their length.
"""

import json
import zlib
from struct import pack
from typing import Any, BinaryIO

_MAGIC = b"\x89MCAP0\r\n"
_CHUNK = 1 << 20
"""Size from which a chunk is written, in bytes."""
_HEADER, _FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _FULL_CHUNK, _MESSAGE_INDEX, _CHUNK_INDEX = range(1, 9)
_STATISTICS, _DATA_END = 0x0B, 0x0F


def _field(data: bytes) -> bytes:
    return pack("<I", len(data)) + data


def _text(text: str) -> bytes:
    return _field(text.encode())


def _record(kind: int, content: bytes) -> bytes:
    return pack("<BQ", kind, len(content)) + content


class McapFile:
    """An MCAP file with a channel for each topic.

    Args:
        file: empty file, which stays open.
        library: name of the program that writes it.
    """

    def __init__(self, file: BinaryIO, library: str) -> None:
        self._file, self._at = file, 0
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._definitions: dict[int, list[bytes]] = {_SCHEMA: [], _CHANNEL: []}
        self._counts: dict[int, int] = {}
        self._chunks: list[bytes] = []
        self._span: list[int] = []
        self._records = bytearray()
        self._index: dict[int, list[tuple[int, int]]] = {}
        self._write(_MAGIC + _record(_HEADER, _text("") + _text(library)))

    def add(self, nanoseconds: int, topic: str, schema: str, message: dict[str, Any], data: bytes) -> None:
        """Add a message.

        Args:
            nanoseconds: its time.
            topic: its topic, whose messages all have the same schema.
            schema: name of the schema.
            message: its content, of which the first one of a schema defines the fields.
            data: its content as JSON.
        """
        channel = self._channels.get(topic) or self._add_channel(topic, schema, message)
        self._index.setdefault(channel, []).append((nanoseconds, len(self._records)))
        sequence = self._counts[channel] = self._counts.get(channel, 0) + 1
        head = pack("<HIQQ", channel, sequence, nanoseconds, nanoseconds)
        self._records += _record(_MESSAGE, head + data)
        if len(self._records) >= _CHUNK:
            self._end_chunk()

    def finish(self) -> None:
        """Write the rest and the index."""
        self._end_chunk()
        self._write(_record(_DATA_END, pack("<I", 0)))
        groups = {kind: b"".join(records) for kind, records in self._definitions.items()}
        groups[_STATISTICS] = _record(_STATISTICS, self._statistics())
        groups[_CHUNK_INDEX] = b"".join(self._chunks)
        # The checksum includes the beginning of the footer.
        summary = b"".join(groups.values()) + pack("<BQQQ", _FOOTER, 20, self._at, 0)
        self._write(summary + pack("<I", zlib.crc32(summary)) + _MAGIC)

    def _add_channel(self, topic: str, schema: str, message: dict[str, Any]) -> int:
        number = self._schemas.get(schema)
        if number is None:
            number = self._schemas[schema] = len(self._schemas) + 1
            shape = json.dumps({"title": schema, **_shape(message)})
            self._define(_SCHEMA, pack("<H", number) + _text(schema) + _text("jsonschema") + _text(shape))
        channel = self._channels[topic] = len(self._channels) + 1
        self._define(_CHANNEL, pack("<HH", channel, number) + _text(topic) + _text("json") + _field(b""))
        return channel

    def _define(self, kind: int, content: bytes) -> None:
        self._definitions[kind].append(_record(kind, content))
        self._records += _record(kind, content)

    def _end_chunk(self) -> None:
        times = [time for entries in self._index.values() for time, _ in entries]
        if not times:
            return
        records, first, last, start = bytes(self._records), min(times), max(times), self._at
        head = pack("<QQQI", first, last, len(records), zlib.crc32(records)) + _text("")
        self._write(_record(_FULL_CHUNK, head + pack("<Q", len(records)) + records))
        end, places = self._at, b""
        for channel, entries in self._index.items():
            places += pack("<HQ", channel, self._at)
            entry = b"".join(pack("<QQ", *each) for each in entries)
            self._write(_record(_MESSAGE_INDEX, pack("<H", channel) + _field(entry)))
        index = pack("<QQQQ", first, last, start, end - start) + _field(places) + pack("<Q", self._at - end)
        index += _text("") + pack("<QQ", len(records), len(records))
        self._chunks.append(_record(_CHUNK_INDEX, index))
        self._span = [min([first, *self._span]), max([last, *self._span])]
        self._records.clear()
        self._index.clear()

    def _statistics(self) -> bytes:
        counts = b"".join(pack("<HQ", *each) for each in self._counts.items())
        sizes = len(self._schemas), len(self._channels), 0, 0, len(self._chunks)
        messages = sum(self._counts.values())
        return pack("<QHIIIIQQ", messages, *sizes, *(self._span or (0, 0))) + _field(counts)

    def _write(self, data: bytes) -> None:
        self._file.write(data)
        self._at += len(data)


_TYPES = {bool: "boolean", int: "number", float: "number", str: "string"}
_TIMES = {"timestamp": "time", "lifetime": "duration"}


def _shape(content: Any, name: str = "") -> dict[str, Any]:
    """Return a JSON schema for similar content; Foxglove needs the items of arrays, even of empty ones."""
    if isinstance(content, dict):
        title = {"title": _TIMES[name]} if name in _TIMES else {}
        properties = {key: _shape(each, key) for key, each in content.items()}
        return {"type": "object", **title, "properties": properties}
    if isinstance(content, list | tuple):
        return {"type": "array", "items": _shape(content[0] if content else {})}
    return {"type": _TYPES[type(content)]}
