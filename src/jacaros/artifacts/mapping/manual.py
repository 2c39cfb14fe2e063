"""The docstring of a mapped artifact: what `jacaros describe` and agents are told of it."""

from collections.abc import Iterator

from jacaros.artifacts.mapping.declared import ArtifactPart, FieldPart, MappingFile
from jacaros.artifacts.mapping.operation_methods import unlike, values_of


def documentation(mapping: MappingFile, part: ArtifactPart) -> str:
    """A docstring with the sections that manuals are made of."""
    sections = [part.description or f"Mapped by {mapping.file}."]
    for title, lines in (("Properties", list(_properties(part))), ("Signals", list(_signals(part)))):
        if lines:
            sections.append("\n".join([f"{title}:", *(f"    {line}" for line in lines)]))
    return "\n\n".join(sections)


def _properties(part: ArtifactPart) -> Iterator[str]:
    for topic in part.properties:
        assert topic.topic is not None
        each = ", one for each element" if topic.each is not None else ""
        yield f"{usage(topic.name, topic.fields)}: {topic.description or f'from topic {topic.topic.text}{each}'}."
    for frame in part.frames:
        told = frame.description or f"frame {frame.source} in {frame.target}"
        yield f"{usage(frame.name, frame.fields)}: {told}."
    for parameter in part.parameters:
        told = parameter.description or f"parameter {parameter.parameter} of {parameter.node}"
        yield f"{parameter.name}(Value): {told}."
    for operation in part.operations:
        for feedback in operation.feedback:
            told = feedback.description or f"feedback of {operation.name}"
            yield f"{usage(feedback.name, feedback.fields)}: {told}."


def _signals(part: ArtifactPart) -> Iterator[str]:
    for topic in part.signals:
        assert topic.topic is not None
        yield f"{usage(topic.name, topic.fields)}: {topic.description or f'from topic {topic.topic.text}'}."


def usage(name: str, fields: tuple[FieldPart, ...] | None) -> str:
    """A property as agents write it."""
    if fields is None:
        return f"{name}(...)"
    words = [
        "".join(part[:1].upper() + part[1:] for part in word.split("_"))
        for word in unlike((), values_of(fields))
    ]
    return f"{name}({', '.join(words)})" if words else name
