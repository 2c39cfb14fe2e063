"""Check a mapping against the definitions of its message types, and prepare its operations for them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from jacaros.artifacts.env.values import plain
from jacaros.robots.mapping.decoding import Read, extractor, reader
from jacaros.robots.mapping.encoding import Adapt, Fill, builder, fitting, unchanged
from jacaros.robots.mapping.fields import FieldPart, Written, read_path
from jacaros.robots.mapping.file import ArtifactPart, MappingError, MappingFile
from jacaros.robots.mapping.interfaces import Interfaces, getter, known_types, tried
from jacaros.robots.mapping.operations import OperationKind, OperationPart, Success
from jacaros.robots.mapping.properties import TopicPart
from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.fields import FieldType
from jacaros.robots.ros.guarded import VELOCITIES
from jacaros.robots.ros.names import feedback_type, goal_type, request_type, response_type, result_type
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.files.yaml import Problem

UNCERTAIN = "is not known here"
"""Part of the message for types that only the robot's middleware may know."""


def check_mapping(mapping: MappingFile, interfaces: Interfaces) -> None:
    """Check a whole file.

    Raises:
        MappingError: with all mistakes.
    """
    problems = [problem for part in mapping.artifacts.values() for problem in type_problems(part, interfaces)]
    if problems:
        raise MappingError(mapping.file, mapping.text, problems)


def type_problems(part: ArtifactPart, interfaces: Interfaces) -> list[Problem]:
    """Return the mistakes that appear when an artifact is compared with the message types that it names."""
    problems: list[Problem] = []
    for topic in part.topics:
        if topic.type_name is not None and known(topic.type_name, topic.type_name.text, interfaces, problems):
            check_topic(topic, topic.type_name.text, interfaces, problems)
    for operation in part.operations:
        if operation.type_name is not None:
            _check_operation(operation, operation.type_name, interfaces, problems)
    return problems


def known(written: Written, needed: str, interfaces: Interfaces, problems: list[Problem]) -> bool:
    """Return whether a type is known; report it if not."""
    try:
        interfaces.fields(needed)
    except UnknownInterface as error:
        others = known_types(written.text.split("/")[1])
        # A type that comes with JaCaROS, but not with the robot's middleware, is not misspelt.
        help = str(error) if written.text in others else suggestion(written.text, others, str(error), 2)
        problems.append(written.place.problem(f"the type `{written.text}` {UNCERTAIN}", help))
        return False
    return True


def check_topic(topic: TopicPart, type_name: str, interfaces: Interfaces, problems: list[Problem]) -> None:
    """Check a property or signal against a type."""
    extractor(topic, type_name, interfaces, problems)
    band, count = topic.policy.dead_band, len(interfaces.fields(type_name))
    if (
        topic.fields is None and isinstance(band, tuple) and len(band) != count
    ):  # else the reader has reported it
        text = f"`dead_band` has {len(band)} values, but {type_name} has {count} fields"
        problems.append(topic.place.problem(text))


def _check_operation(
    operation: OperationPart, written: Written, interfaces: Interfaces, problems: list[Problem]
) -> None:
    types = message_types(operation.kind, written.text)
    if known(written, types[0], interfaces, problems):
        codec(operation, written.text, interfaces, problems)
        for feedback in operation.feedback:
            check_topic(feedback, types[2], interfaces, problems)


def message_types(kind: OperationKind, type_name: str) -> tuple[str, ...]:
    """Return the types of what is sent, of the final answer, and of feedback."""
    if kind is OperationKind.SERVICE:
        return request_type(type_name), response_type(type_name)
    if kind is OperationKind.ACTION:
        return goal_type(type_name), result_type(type_name), feedback_type(type_name)
    return (type_name,)


@dataclass(frozen=True, slots=True)
class Codec:
    """How an operation builds its message, and reads the answer.

    Attributes:
        fill: builds the message, request or goal.
        end: builds the message that stops a robot; None: this is not a velocity.
        outputs: read the output parameters from the response or result.
        succeeded: returns whether an answer shows success.
    """

    fill: Fill
    end: Fill | None
    outputs: tuple[Read, ...] = ()
    succeeded: Callable[[Any], bool] = lambda answer: True


def codec(
    part: OperationPart,
    type_name: str,
    interfaces: Interfaces,
    problems: list[Problem],
    adapt: Adapt = unchanged,
) -> Codec | None:
    """Prepare an operation for a type.

    Args:
        part: the operation.
        type_name: type of its topic, service or action.
        interfaces: knows the types.
        problems: receives mistakes; the result is then None.
        adapt: as for `builder`.
    """
    before, types = len(problems), message_types(part.kind, type_name)
    values = fitting(part, types[0], interfaces)
    fill, end = builder(values, types[0], interfaces, problems, adapt), None
    if fill is not None and types[0] in VELOCITIES:  # a robot always ends with zero
        stamps = [each for each in values if ".header" in each.target.steps]
        end = builder(stamps, types[0], interfaces, problems, adapt)
    if not types[1:]:
        return Codec(fill, end) if fill is not None and len(problems) == before else None

    def read(field: FieldPart) -> Read | None:
        return tried(field.place, problems, reader, field, FieldType(types[1]), None, interfaces)

    outputs, success = [read(each) for each in part.outputs], part.success
    if success is not None:
        read(FieldPart(success.path, success.place))
    if fill is None or len(problems) > before:
        return None
    if success is None and not part.any_success and "success" in interfaces.fields(types[1]):
        success = Success(read_path("success"), part.place)
    return Codec(fill, end, tuple(filter(None, outputs)), _succeeded(success))


def _succeeded(success: Success | None) -> Callable[[Any], bool]:
    if success is None:
        return lambda answer: True
    get, value = getter(success.path), success.value
    return lambda answer: bool(plain(get(answer, 0)) == value)
