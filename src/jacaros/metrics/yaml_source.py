"""Names and comments of mapping files and world files."""

from collections.abc import Iterator
from io import StringIO
from typing import Any

from ruamel.yaml import YAML

from jacaros.artifacts.mapping.file import ArtifactPart, MappingFile
from jacaros.metrics.comments import Stretch, between


def comments_of(text: str) -> list[Stretch]:
    """Return the comments of a valid YAML text."""
    tokens = YAML(typ="safe", pure=True).scan(StringIO(text))
    # Block ends have no text: they are at the start of the next token.
    places = ((each.start_mark.index, each.end_mark.index) for each in tokens)
    return list(between(text, (place for place in places if place[0] < place[1])))


def mapping_names(mapping: MappingFile) -> frozenset[str]:
    """Return the names defined in a mapping file: artifacts, properties, signals, operations and their parameters."""
    return frozenset(name for part in mapping.artifacts.values() for name in _names(part))


def _names(part: ArtifactPart) -> Iterator[str]:
    yield part.name
    for observable in (part.topics, part.frames, part.parameters, part.derived):
        yield from (each.name for each in observable)
    for operation in part.operations:
        yield operation.name
        yield from operation.parameters
        yield from (feedback.name for feedback in operation.feedback)


def named_things(value: Any) -> Iterator[str]:
    """Return the values of the keys ``name`` in a document: rooms, docks, doors, robots and so on."""
    if isinstance(value, dict):
        if isinstance(name := value.get("name"), str):
            yield name
        for each in value.values():
            yield from named_things(each)
    elif isinstance(value, list):
        for each in value:
            yield from named_things(each)
