"""MCAP files of JSON messages, written by the library ``mcap``, which the extra ``foxglove`` installs."""

import json
from typing import Any, BinaryIO

from jacaros.runtime.errors import UsageError

try:
    from mcap.writer import Writer
except ImportError:
    raise UsageError(
        "error: mcap, which writes MCAP files, is not installed\n  = help: pip install 'jacaros[foxglove]'"
    ) from None


class McapFile:
    """An MCAP file with a channel for each topic.

    Args:
        file: empty file, which stays open.
        library: name of the program that writes it.
    """

    def __init__(self, file: BinaryIO, library: str) -> None:
        self._writer = Writer(file)
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._writer.start(library=library)

    def add(self, nanoseconds: int, topic: str, schema: str, message: dict[str, Any], data: bytes) -> None:
        """Add a message.

        Args:
            nanoseconds: its time.
            topic: its topic, whose messages all have the same schema.
            schema: name of the schema.
            message: its content, of which the first one of a schema defines the fields.
            data: its content as JSON.
        """
        if schema not in self._schemas:
            shape = json.dumps({"title": schema, **_shape(message)}).encode()
            self._schemas[schema] = self._writer.register_schema(schema, "jsonschema", shape)
        if topic not in self._channels:
            self._channels[topic] = self._writer.register_channel(topic, "json", self._schemas[schema])
        self._writer.add_message(self._channels[topic], nanoseconds, data, nanoseconds)

    def finish(self) -> None:
        """Write the rest and the index."""
        self._writer.finish()  # type: ignore[no-untyped-call]


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
