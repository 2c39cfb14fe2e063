"""MCAP files of JSON messages, written by the library ``mcap``, which the extra ``foxglove`` installs."""

import json
from collections.abc import Iterable
from typing import Any, BinaryIO, NamedTuple

from jacaros.look.records.line_format import encoded
from jacaros.runtime.errors import UsageError
from jacaros.version import VERSION

try:
    from mcap.writer import Writer
except ImportError:
    raise UsageError(
        "error: mcap, which writes MCAP files, is not installed\n  = help: pip install 'jacaros[foxglove]'"
    ) from None


class Message(NamedTuple):
    """A message at *t* seconds; all messages of a topic have the same schema."""

    t: float
    topic: str
    schema: str
    content: dict[str, Any]


def write_messages(messages: Iterable[Message], file: BinaryIO) -> dict[str, str]:
    """Write messages to an empty file, which stays open. Return the topics with their schemas.

    The first message of a schema defines its fields.
    """
    writer, topics = Writer(file), dict[str, str]()
    schemas, channels = dict[str, int](), dict[str, int]()
    writer.start(library=f"jacaros {VERSION}")
    for t, topic, schema, content in messages:
        if schema not in schemas:
            shape = json.dumps({"title": schema, **_shape(content)}).encode()
            schemas[schema] = writer.register_schema(schema, "jsonschema", shape)
        if topic not in channels:
            channels[topic] = writer.register_channel(topic, "json", schemas[schema])
            topics[topic] = schema
        nanoseconds = max(0, round(t * 1e9))
        writer.add_message(channels[topic], nanoseconds, encoded(content), nanoseconds)
    writer.finish()  # type: ignore[no-untyped-call]
    return topics


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
