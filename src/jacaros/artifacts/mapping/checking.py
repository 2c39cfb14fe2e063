"""Check a mapping against the definitions of its message types."""

from collections.abc import Callable
from typing import Any

from jacaros.artifacts.mapping.decoding import extractor, reader
from jacaros.artifacts.mapping.encoding import builder, fitting
from jacaros.artifacts.mapping.fields import FieldPart, Place, Written, WrongPath
from jacaros.artifacts.mapping.file import ArtifactPart, MappingError, MappingFile
from jacaros.artifacts.mapping.interfaces import Interfaces
from jacaros.artifacts.mapping.operations import OperationKind, OperationPart
from jacaros.artifacts.mapping.properties import TopicPart
from jacaros.files.texts import suggestion
from jacaros.files.yaml import Problem
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.fields import FieldType
from jacaros.ros.names import feedback_type, goal_type, request_type, response_type, result_type

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
        problems.append(
            written.place.problem(f"the type `{written.text}` {UNCERTAIN}", _cure(written.text, error))
        )
        return False
    return True


def _cure(type_name: str, error: UnknownInterface) -> str:
    from jacaros.artifacts.mapping.interfaces import known_types  # here: only needed after a mistake

    return suggestion(type_name, known_types(type_name.split("/")[1]), str(error), 2)


def check_topic(topic: TopicPart, type_name: str, interfaces: Interfaces, problems: list[Problem]) -> None:
    """Check a property or signal against a type."""
    extractor(topic, type_name, interfaces, problems)
    if topic.initial is not None or topic.policy.dead_band:
        _check_counts(topic, type_name, interfaces, problems)


def _check_counts(topic: TopicPart, type_name: str, interfaces: Interfaces, problems: list[Problem]) -> None:
    if topic.fields is not None:
        return  # the reader has reported it
    count = len(interfaces.fields(type_name))
    band = topic.policy.dead_band
    for what, given in (("initial", topic.initial), ("dead_band", band if isinstance(band, tuple) else None)):
        if given is not None and len(given) != count:
            problems.append(
                topic.place.problem(f"`{what}` has {len(given)} values, but {type_name} has {count} fields")
            )


def _check_operation(
    operation: OperationPart, written: Written, interfaces: Interfaces, problems: list[Problem]
) -> None:
    types = message_types(operation.kind, written.text)
    if not known(written, types[0], interfaces, problems):
        return
    builder(fitting(operation, types[0], interfaces), types[0], interfaces, problems)
    if operation.at_end is not None:
        builder(operation.at_end, types[0], interfaces, problems)
    if types[1:]:
        check_answer(operation, types[1], interfaces, problems)
    for feedback in operation.feedback:
        check_topic(feedback, types[2], interfaces, problems)


def message_types(kind: OperationKind, type_name: str) -> tuple[str, ...]:
    """Return the types of what is sent, of the final answer, and of feedback."""
    if kind is OperationKind.SERVICE:
        return request_type(type_name), response_type(type_name)
    if kind is OperationKind.ACTION:
        return goal_type(type_name), result_type(type_name), feedback_type(type_name)
    return (type_name,)


def check_answer(
    operation: OperationPart, type_name: str, interfaces: Interfaces, problems: list[Problem]
) -> None:
    """Check outputs, success and error fields against a response or result."""
    code = () if operation.code is None else (operation.code,)
    for field in (*operation.outputs, *code, *operation.aborted):
        _tried(
            field.place, lambda field=field: reader(field, FieldType(type_name), None, interfaces), problems
        )
    success = operation.success
    if success is not None:
        field = FieldPart(success.path, success.place)
        _tried(success.place, lambda: reader(field, FieldType(type_name), None, interfaces), problems)


def _tried(place: Place, make: Callable[..., Any], problems: list[Problem]) -> None:
    try:
        make()
    except (WrongPath, UnknownInterface) as error:
        problems.append(place.problem(str(error), getattr(error, "help", "")))
