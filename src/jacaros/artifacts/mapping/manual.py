"""What `jacaros describe` and agents are told of a mapped artifact; worked out only when somebody asks."""

from collections.abc import Iterator
from contextlib import suppress

from jacaros.artifacts.kit.reading import ReadingPolicy
from jacaros.artifacts.mapping.checking import message_types
from jacaros.artifacts.mapping.declared import (
    ArtifactPart,
    FieldPart,
    MappingFile,
    OperationKind,
    OperationPart,
    ParameterPart,
    Source,
    TopicPart,
    ValuePart,
)
from jacaros.artifacts.mapping.extracting import fields_of
from jacaros.artifacts.mapping.filling import filler, fitting
from jacaros.artifacts.mapping.interfaces import Interfaces, stored_interfaces
from jacaros.artifacts.mapping.operation_methods import unlike, values_of
from jacaros.artifacts.mapping.paths import WrongPath, follow
from jacaros.artifacts.mapping.value_words import with_unit, word_for_field, word_for_value
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.fields import FieldType
from jacaros.ros.guarded import VELOCITIES
from jacaros.ros.parameter_store import kind_of
from jacaros.yaml_nodes import Problem

_TRANSFORM = {"x": "metres", "y": "metres", "z": "metres", "stamp": "seconds"}


class Documentation:
    """The docstring of a mapped artifact, with the sections that manuals are made of.

    Args:
        mapping: the file.
        part: the artifact.
    """

    def __init__(self, mapping: MappingFile, part: ArtifactPart) -> None:
        self._mapping, self._part = mapping, part

    def __get__(self, instance: object, owner: type) -> str:
        part = self._part
        sections = [part.description or f"Mapped by {self._mapping.file}."]
        interfaces = stored_interfaces(part.interfaces)
        for title, lines in (
            ("Properties", list(_properties(part, interfaces))),
            ("Signals", list(_signals(part, interfaces))),
        ):
            if lines:
                sections.append("\n".join([f"{title}:", *(f"    {line}" for line in lines)]))
        return "\n\n".join(sections)


def _properties(part: ArtifactPart, interfaces: Interfaces) -> Iterator[str]:
    for topic in part.properties:
        yield _from_topic(topic, interfaces)
    for frame in part.frames:
        told = frame.description or f"frame {frame.source} in {frame.target}"
        words = [_of_transform(field) for field in frame.fields]
        yield f"{usage(frame.name, frame.fields)}: {_told(told, frame.fields, words)}."
    for parameter in part.parameters:
        yield f"{parameter.name}(Value): {_of_parameter(parameter)}."
    for operation in part.operations:
        for feedback in operation.feedback:
            told = feedback.description or f"feedback of {operation.name}"
            typed = operation.type_name
            type_name = message_types(operation.kind, typed.text)[2] if typed is not None else ""
            yield _observed(feedback, type_name, told, interfaces)


def _of_parameter(part: ParameterPart) -> str:
    """What a parameter is, and of our own its type, default and range."""
    declaration = part.declaration
    if declaration is None:
        return (part.description or f"parameter {part.parameter} of {part.node}").rstrip(".")
    told = (part.description or f"parameter {part.parameter} of our own").rstrip(".")
    low, high = declaration.minimum, declaration.maximum
    words = [
        kind_of(declaration.default),
        f"{declaration.default!r} unless given",
        f"at least {low:g}" if low is not None else "",
        f"at most {high:g}" if high is not None else "",
        "read-only" if declaration.read_only else "",
    ]
    return f"{told}. Value: {', '.join(filter(None, words))}"


def _signals(part: ArtifactPart, interfaces: Interfaces) -> Iterator[str]:
    for topic in part.signals:
        yield _from_topic(topic, interfaces)


def _from_topic(topic: TopicPart, interfaces: Interfaces) -> str:
    assert topic.topic is not None
    each = ", one for each element" if topic.each is not None else ""
    type_name = topic.type_name.text if topic.type_name is not None else ""
    of_type = f" ({type_name})" if type_name else ""
    told = topic.description or f"from topic {topic.topic.text}{of_type}{each}{_when(topic.policy)}"
    return _observed(topic, type_name, told, interfaces)


def _observed(topic: TopicPart, type_name: str, told: str, interfaces: Interfaces) -> str:
    """The entry of a property or signal."""
    fields, words = topic.fields, []
    if type_name:
        with suppress(WrongPath, UnknownInterface):
            element = _element(topic, FieldType(type_name), interfaces)
            fields = fields_of(topic, element or FieldType(type_name), interfaces)
            words = [word_for_field(each, FieldType(type_name), element, interfaces) for each in fields]
    return f"{usage(topic.name, fields)}: {_told(told, fields or (), words)}."


def _element(topic: TopicPart, message: FieldType, interfaces: Interfaces) -> FieldType | None:
    if topic.each is None:
        return None
    return FieldType(follow(topic.each, message, interfaces.fields).base)


def _when(policy: ReadingPolicy) -> str:
    """When it is told, after a comma."""
    words = [
        "on demand" if policy.on_demand else "",
        f"at most {policy.rate:g} times a second" if policy.rate is not None else "",
        f"gone after {policy.expire:g} s without a message" if policy.expire is not None else "",
    ]
    return "".join(f", {word}" for word in words if word)


def _of_transform(field: FieldPart) -> str:
    place = field.path.text
    unit = field.conversion.unit.replace("_", " ") or _TRANSFORM.get(place, "radians")
    return with_unit("number", unit, field.conversion.digits)


def _told(told: str, fields: tuple[FieldPart, ...], words: list[str]) -> str:
    """What a property is, and what its values are."""
    names, place = variables(fields), 0
    values = []
    for field, word in zip(fields, words, strict=False):
        own = names[place : place + field.count]
        place += field.count
        if word:
            values.append(f"{_span(own)}: {word}")
    told = told.rstrip(".")
    return f"{told}. {'; '.join(values)}" if values else told


def _span(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{names[0]} to {names[-1]}"


def variables(fields: tuple[FieldPart, ...]) -> list[str]:
    """The values of fields as agents may call them."""
    return [
        "".join(part[:1].upper() + part[1:] for part in word.split("_"))
        for word in unlike((), values_of(fields))
    ]


def usage(name: str, fields: tuple[FieldPart, ...] | None) -> str:
    """A property as agents write it."""
    if fields is None:
        return f"{name}(...)"
    words = variables(fields)
    return f"{name}({', '.join(words)})" if words else name


def parameter_words(artifact: ArtifactPart, part: OperationPart) -> dict[str, str]:
    """What the parameters of an operation take and give, as far as it is known."""
    interfaces = stored_interfaces(artifact.interfaces)
    type_name = part.type_name.text if part.type_name is not None else _likely_type(part, interfaces)
    types = message_types(part.kind, type_name) if type_name else ()
    words = _inputs(part, types, interfaces)
    if len(types) > 1 and all(each.count == 1 for each in part.outputs):
        names = unlike(part.parameters, values_of(part.outputs))
        for field, name in zip(part.outputs, names, strict=True):
            words[name] = word_for_field(field, FieldType(types[1]), None, interfaces)
    return {name: word for name, word in words.items() if word}


def _likely_type(part: OperationPart, interfaces: Interfaces) -> str:
    """The type of a velocity whose type the mapping leaves to the robot; empty for others."""
    if part.kind is OperationKind.PUBLISH and part.values:
        for type_name in VELOCITIES:
            problems: list[Problem] = []
            filler(part.values, type_name, interfaces, problems)
            if not problems:
                return type_name
    return ""


def _inputs(part: OperationPart, types: tuple[str, ...], interfaces: Interfaces) -> dict[str, str]:
    words: dict[str, str] = {}
    if part.duration is not None and part.duration.source is Source.PARAMETER:
        words[part.parameters[part.duration.parameter]] = "number of seconds"
    for value in fitting(part, types[0], interfaces) if types else part.values:
        if value.source in (Source.PARAMETER, Source.ELEMENTS) and value.parameter < len(part.parameters):
            word = word_for_value(value, FieldType(types[0]), interfaces) if types else _of_unit(value)
            words.setdefault(part.parameters[value.parameter], word)
    return words


def _of_unit(value: ValuePart) -> str:
    """What is known without a type: the unit that the mapping says."""
    unit = value.conversion.unit.replace("_", " ")
    return with_unit("number", unit, None) if unit else ""
