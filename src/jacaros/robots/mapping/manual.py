"""Documentation of a mapped artifact for `jacaros describe` and agents; generated on request.

Kind, unit and rounding of values come from the definitions of the messages.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress

from jacaros.robots.mapping.checking import message_types
from jacaros.robots.mapping.decoding import fields_of, owner_of
from jacaros.robots.mapping.encoding import builder, fitting
from jacaros.robots.mapping.fields import (
    ANGLES,
    UNITS,
    Conversion,
    FieldPart,
    FieldPath,
    WrongPath,
    units_of,
    unlike,
    value_names,
)
from jacaros.robots.mapping.file import ArtifactPart, MappingFile
from jacaros.robots.mapping.interfaces import (
    Interfaces,
    chosen,
    constants,
    follow,
    stored_interfaces,
    unit_at,
    words_of,
)
from jacaros.robots.mapping.operations import OperationKind, OperationPart, ValuePart, ValueSource
from jacaros.robots.mapping.properties import TRANSFORM, DerivedPart, ParameterPart, TopicPart
from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.fields import FLOATS, INTEGER_RANGES, FieldType
from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.robots.ros.message import TIMES
from jacaros.robots.ros.parameter import kind_of
from jacaros.robots.streams import OPERATORS, VALUE, ReadingPolicy, Spec
from jacaros.runtime.files.yaml import Problem


class Documentation:
    """The docstring of a mapped artifact, with the usual sections.

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
            ("Signals", [_from_topic(topic, interfaces) for topic in part.signals]),
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
        yield f"{usage(frame.name, frame.fields)}: {_described(told, frame.fields, words)}."
    for parameter in part.parameters:
        yield f"{parameter.name}(Value): {_of_parameter(parameter)}."
    for derived in part.derived:
        if derived.spec is not None:
            yield _derived(derived, derived.spec)
    for operation in part.operations:
        for feedback in operation.feedback:
            told = feedback.description or f"feedback of {operation.name}"
            typed = operation.type_name
            type_name = message_types(operation.kind, typed.text)[2] if typed is not None else ""
            yield _observed(feedback, type_name, told, interfaces)


def _of_parameter(part: ParameterPart) -> str:
    """Describe a parameter, with its type, default and range."""
    declaration = part.declaration
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


def _derived(part: DerivedPart, spec: Spec) -> str:
    shape = OPERATORS[spec.operator]
    told = part.description or f"{shape.meaning}, of {' and '.join(spec.sources)}"
    values = "" if spec.gives != VALUE else "(Values)" if spec.operator == "together" else "(Value)"
    return f"{part.name}{values}: {told.rstrip('.')}."


def _from_topic(topic: TopicPart, interfaces: Interfaces) -> str:
    assert topic.topic is not None
    each = ", one for each element" if topic.each is not None else ""
    type_name = topic.type_name.text if topic.type_name is not None else ""
    of_type = f" ({type_name})" if type_name else ""
    told = topic.description or f"from topic {topic.topic.text}{of_type}{each}{_when(topic.policy)}"
    return _observed(topic, type_name, told.rstrip("."), interfaces)


def _observed(topic: TopicPart, type_name: str, told: str, interfaces: Interfaces) -> str:
    fields, words = topic.fields, []
    if type_name:
        with suppress(WrongPath, UnknownInterface):
            element = _element(topic, FieldType(type_name), interfaces)
            fields = fields_of(topic, element or FieldType(type_name), interfaces)
            words = [word_for_field(each, FieldType(type_name), element, interfaces) for each in fields]
    return f"{usage(topic.name, fields)}: {_described(told, fields or (), words)}."


def _element(topic: TopicPart, message: FieldType, interfaces: Interfaces) -> FieldType | None:
    if topic.each is None:
        return None
    return FieldType(follow(topic.each, message, interfaces.fields).base)


def _when(policy: ReadingPolicy) -> str:
    """Return when it is updated, after a comma."""
    words = [
        "on demand" if policy.on_demand else "",
        f"at most {policy.rate:g} times a second" if policy.rate is not None else "",
        f"removed after {policy.expire:g} s without a message" if policy.expire is not None else "",
    ]
    return "".join(f", {word}" for word in words if word)


def _of_transform(field: FieldPart) -> str:
    unit = field.conversion.unit or units_of(TRANSFORM[field.path.text])[0]
    return with_unit("number", UNITS[unit].words, field.conversion.digits)


def _described(told: str, fields: tuple[FieldPart, ...], words: list[str]) -> str:
    names, place = variables(fields), 0
    values = []
    for field, word in zip(fields, words, strict=False):
        own = names[place : place + field.count]
        place += field.count
        if word:
            span = own[0] if len(own) == 1 else f"{own[0]} to {own[-1]}"
            values.append(f"{span}: {word}")
    told = told.rstrip(".")
    return f"{told}. {'; '.join(values)}" if values else told


def variables(fields: tuple[FieldPart, ...]) -> list[str]:
    """Return variable names for the values of fields."""
    return [
        "".join(part[:1].upper() + part[1:] for part in word.split("_"))
        for word in unlike((), value_names(fields))
    ]


def usage(name: str, fields: tuple[FieldPart, ...] | None) -> str:
    """Return a property in an agent's notation."""
    if fields is None:
        return f"{name}(...)"
    words = variables(fields)
    return f"{name}({', '.join(words)})" if words else name


def parameter_words(artifact: ArtifactPart, part: OperationPart) -> dict[str, str]:
    """Describe the parameters of an operation as far as they are known."""
    interfaces = stored_interfaces(artifact.interfaces)
    type_name = part.type_name.text if part.type_name is not None else _likely_type(part, interfaces)
    types = message_types(part.kind, type_name) if type_name else ()
    words = _inputs(part, types, interfaces)
    if len(types) > 1 and all(each.count == 1 for each in part.outputs):
        names = unlike(part.parameters, value_names(part.outputs))
        for field, name in zip(part.outputs, names, strict=True):
            words[name] = word_for_field(field, FieldType(types[1]), None, interfaces)
    return {name: word for name, word in words.items() if word}


def _likely_type(part: OperationPart, interfaces: Interfaces) -> str:
    """Return the type of a velocity whose type the mapping omits; empty for others."""
    if part.kind is OperationKind.PUBLISH and part.values:
        for type_name in VELOCITIES:
            problems: list[Problem] = []
            builder(part.values, type_name, interfaces, problems)
            if not problems:
                return type_name
    return ""


def _inputs(part: OperationPart, types: tuple[str, ...], interfaces: Interfaces) -> dict[str, str]:
    words: dict[str, str] = {}
    if part.duration is not None and part.duration.source is ValueSource.PARAMETER:
        words[part.parameters[part.duration.parameter]] = "number of seconds"
    for value in fitting(part, types[0], interfaces) if types else part.values:
        if value.source in (ValueSource.PARAMETER, ValueSource.ELEMENTS) and value.parameter < len(
            part.parameters
        ):
            word = word_for_value(value, FieldType(types[0]), interfaces) if types else _of_unit(value)
            words.setdefault(part.parameters[value.parameter], word)
    return words


def _of_unit(value: ValuePart) -> str:
    """Return what is known without a type: the unit in the mapping."""
    unit = value.conversion.unit
    return with_unit("number", UNITS[unit].words, None) if unit else ""


_FEW = 8
"""Number of constants that are listed."""


def word_for_field(
    field: FieldPart, message: FieldType, element: FieldType | None, interfaces: Interfaces
) -> str:
    """Describe what an agent gets from a field: ``number in metres, 2 decimals``; empty if unknown."""
    root = message if element is None or field.path.of_message else element
    try:
        leaf = follow(field.path, root, interfaces.fields)
        if field.conversion.kind == "object":
            return f"a reference to {leaf}"
        word = _converted(field.conversion, field.path, leaf, root, interfaces)
    except (WrongPath, UnknownInterface):
        return ""
    whole = field.shares is not None or field.conversion.kind in ("count", "min", "max", "mean")
    levels = 0 if whole else field.path.lists + leaf.array
    return "list of " * levels + word


def word_for_value(part: ValuePart, message: FieldType, interfaces: Interfaces) -> str:
    """Describe what an agent provides for a field of a message; empty if unknown."""
    try:
        leaf = follow(part.target, message, interfaces.fields)
        if part.source is ValueSource.ELEMENTS:
            return _elements(part, FieldType(leaf.base), interfaces)
        word = _converted(part.conversion, part.target, leaf, message, interfaces)
    except (WrongPath, UnknownInterface):
        return ""
    return "list of " * leaf.array + word


def _elements(part: ValuePart, element: FieldType, interfaces: Interfaces) -> str:
    """Describe a list that fills a list of messages, by the parts of its elements."""
    given = {each.parameter: each for each in part.elements if each.source is ValueSource.PARAMETER}
    words = [word_for_value(each, element, interfaces) or "a value" for _, each in sorted(given.items())]
    return f"list, of each element: {'; '.join(words)}" if words else "list"


def _converted(
    conversion: Conversion, path: FieldPath, leaf: FieldType, root: FieldType, interfaces: Interfaces
) -> str:
    kind = conversion.kind
    if conversion.names:
        return _names([name for _, name in conversion.names])
    if kind == "name":
        owner, last = owner_of(path, root, interfaces)
        return _names(list(chosen(constants(interfaces, owner), last)))
    if kind == "atom":
        return "atom"
    if kind == "count":
        return "whole number"
    unit = "radians" if kind in ANGLES else words_of(unit_at(path, root, interfaces))
    return _kind(leaf.base, conversion, "number" if kind in (*ANGLES, "mean") else "", unit)


def _kind(base: str, conversion: Conversion, kind: str, unit: str) -> str:
    """Describe a plain value, with its unit and decimals."""
    if base in TIMES:
        kind, unit = "number", "seconds"
    if not kind:
        if base == "bool":
            return "true or false"
        if base == "string":
            return "text"
        if base in INTEGER_RANGES:
            kind = "number" if conversion.line is not None else "whole number"
        elif base in FLOATS:
            kind = "number"
        else:
            return base.rpartition("/")[2]
    return with_unit(kind, _shown_unit(conversion, unit), conversion.digits)


def with_unit(kind: str, unit: str, digits: int | None) -> str:
    """Describe a number: ``number in metres, 2 decimals``, ``whole number in percent``, ``number from 0 to 1``."""
    if digits == 0:
        kind = "whole number"
    told = f" from {unit}" if unit[:1].isdigit() else f" in {unit}" if unit else ""
    return f"{kind}{told}" + (f", {digits} decimal{'s' if digits > 1 else ''}" if digits else "")


def _shown_unit(conversion: Conversion, unit: str) -> str:
    """Return the agent's unit: that of the mapping, or else that of the message, unless the mapping scales it."""
    if conversion.unit:
        per_second = unit == "radians per second" and conversion.unit == "degrees"
        return "degrees per second" if per_second else UNITS[conversion.unit].words
    return unit if conversion.line is None else ""


def _names(names: Sequence[str]) -> str:
    return f"one of {_listed(names)}"


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words[:_FEW]) + (", ..." if len(words) > _FEW else "")
