"""Build messages from the values of agents: the reverse of `decoding`."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from jacaros.artifacts.env.values import Atom, Structure, text
from jacaros.robots.mapping.decoding import ANGLE, MessageHandle, check_conversion, octet, owner_of
from jacaros.robots.mapping.fields import ANGLES, WrongPath
from jacaros.robots.mapping.interfaces import Interfaces, check_unit, chosen, constants, follow, tried
from jacaros.robots.mapping.operations import ALL_OF_IT, OperationPart, ValuePart, ValueSource
from jacaros.robots.ros.errors import MessageMismatch
from jacaros.robots.ros.fields import DURATION, INTEGER_RANGES, FieldType
from jacaros.robots.ros.message import TIMES, single_value
from jacaros.runtime.files.yaml import Problem

Fill = Callable[[Sequence[object], float], dict[str, Any]]
"""Takes the arguments of an operation and the time; returns the fields of a message as nested mappings.

Raises `WrongValue`.
"""


class WrongValue(ValueError):
    """Raised for an argument that does not match its field.

    Attributes:
        field: path of the field.
    """

    def __init__(self, message: str, field: str) -> None:
        super().__init__(message)
        self.field = field


Give = Callable[[Sequence[object], float], Any]
"""Returns one value."""


Adapt = Callable[[str, object], object]
"""Changes a constant, given the name of its field, such as a frame name."""


def unchanged(field: str, value: object) -> object:
    """Return the constant."""
    return value


def builder(
    values: Sequence[ValuePart],
    type_name: str,
    interfaces: Interfaces,
    problems: list[Problem],
    adapt: Adapt = unchanged,
) -> Fill | None:
    """Return a function that builds the fields of a message.

    Args:
        values: the values that the mapping declares.
        type_name: message type.
        interfaces: knows the types.
        problems: receives mistakes; the result is then None.
        adapt: changes constants, given the name of the field, such as frame names.
    """
    before = len(problems)
    gives = [
        (part, tried(part.place, problems, _Encoder.give_of, part, type_name, interfaces, problems, adapt))
        for part in values
    ]
    made = [(part, give) for part, give in gives if give is not None]
    problems += _gaps(values)
    if len(problems) > before:
        return None

    def fill(arguments: Sequence[object], now: float) -> dict[str, Any]:
        found: dict[Any, Any] = {}
        for part, give in made:
            _put(found, part, give(arguments, now))
        return {name: _lists(value) for name, value in found.items()}

    return fill


def fitting(part: OperationPart, type_name: str, interfaces: Interfaces) -> tuple[ValuePart, ...]:
    """Return the fields of an operation that match a version of the type; the first ones if none do."""
    for values in (part.values, *part.other_values) if part.other_values else ():
        problems: list[Problem] = []
        builder(values, type_name, interfaces, problems)
        if not problems:
            return values
    return part.values


def _put(into: dict[Any, Any], part: ValuePart, value: Any) -> None:
    steps = [step[1:] if isinstance(step, str) else step for step in part.target.steps]
    for step in steps[:-1]:
        into = into.setdefault(step, {})
    into[steps[-1]] = value


def _lists(value: Any) -> Any:
    """Convert mappings whose keys are indices of elements to lists."""
    if not isinstance(value, dict):
        return value
    if value and all(isinstance(key, int) for key in value):
        return [_lists(value[key]) for key in sorted(value)]
    return {key: _lists(each) for key, each in value.items()}


def _gaps(values: Sequence[ValuePart]) -> list[Problem]:
    """Return the elements of a list that are missing, and fields that are given twice."""
    found: list[Problem] = []
    numbers: dict[tuple[Any, ...], set[int]] = {}
    for part in values:
        for depth, step in enumerate(part.target.steps):
            if isinstance(step, int):
                numbers.setdefault(part.target.steps[:depth], set()).add(step)
    whole = {part.target.steps: part for part in values}
    for part in values:
        above = (whole.get(part.target.steps[:depth]) for depth in range(1, len(part.target.steps)))
        for other in filter(None, above):
            told = f"`{part.target.text}` is part of `{other.target.text}` on line {other.place.line}"
            found.append(part.place.problem(told, "leave one of them out"))
        for depth, step in enumerate(part.target.steps):
            if isinstance(step, int) and not 0 <= step < len(numbers[part.target.steps[:depth]]):
                told = f"`{part.target.text}`: earlier elements are missing"
                found.append(part.place.problem(told, "begin with [0]"))
    return found


class _Encoder:
    """The conversion of one value to its field.

    Args:
        part: the value.
        type_name: message type.
        interfaces: knows the types.
    """

    def __init__(self, part: ValuePart, type_name: str, interfaces: Interfaces) -> None:
        self._part, self._interfaces, self._path = part, interfaces, part.target.text
        self._root = FieldType(type_name)
        self._leaf = follow(part.target, self._root, interfaces.fields)
        self._owner, self._last = owner_of(part.target, self._root, interfaces)

    @classmethod
    def give_of(
        cls, part: ValuePart, type_name: str, interfaces: Interfaces, problems: list[Problem], adapt: Adapt
    ) -> Give:
        """Return the function that gives the value of a field, for `builder`."""
        return cls(part, type_name, interfaces).give(problems, adapt)

    def give(self, problems: list[Problem], adapt: Adapt) -> Give:
        """Return the function that gives the value; parameters as for `builder`."""
        part, leaf, path = self._part, self._leaf, self._path
        if part.source is ValueSource.ELEMENTS:
            return self._each(problems, adapt)
        check_conversion(part.conversion, path, leaf, "makes a quaternion", "leave it out")
        check_unit(part.conversion, part.target, self._root, self._interfaces)
        convert = self._converter()
        if part.source is ValueSource.NOW:
            if leaf.base not in TIMES or leaf.array:
                raise WrongPath(f"`now` is a time, but `{path}` is {leaf}", "write another value")
            return lambda arguments, now: now
        if part.source is ValueSource.CONSTANT:
            value = self._constant(adapt(self._last, part.value), convert)
            return lambda arguments, now: value
        number = part.parameter

        def of_parameter(arguments: Sequence[object], now: float) -> Any:
            if number == ALL_OF_IT:
                given: object = arguments[0] if len(arguments) == 1 else list(arguments)
            elif number < len(arguments):
                given = arguments[number]
            else:
                told = f"`{path}` is part {number + 1} of an element, but the element has {len(arguments)}"
                raise WrongValue(told, path)
            try:
                return convert(given)
            except (TypeError, ValueError) as error:
                told = f"`{path}` ({leaf}) cannot be {text(given, quoted=True)}: {error}"
                raise WrongValue(told, path) from None

        return of_parameter

    def _constant(self, value: object, convert: Callable[[Any], Any]) -> Any:
        """Convert a constant to the type of the field, and try it on a message."""
        path, leaf, owner = self._path, self._leaf, self._owner
        named = leaf.base in INTEGER_RANGES or leaf.base == "bool"
        if isinstance(value, str) and named and not self._part.conversion.kind:
            known = constants(self._interfaces, owner)
            if value not in known:
                plain = "write true or false" if leaf.base == "bool" else "write a number"
                help = f"its constants: {', '.join(known)}" if known else f"{plain}, or a parameter: $name"
                raise WrongPath(f"`{path}` is {leaf}, but {value!r} is not a constant of {owner}", help)
            return octet(known[value])
        try:
            converted = convert(value)
        except (TypeError, ValueError) as error:
            told = f"`{path}` ({leaf}) cannot be {value!r}: {error}"
            raise WrongPath(told, "write another value") from None
        last = self._part.target.steps[-1]
        try:
            if isinstance(last, str):
                self._interfaces.message(owner, **{last[1:]: converted})
            elif not leaf.is_message:
                single_value(leaf, converted)
        except (MessageMismatch, TypeError, ValueError) as error:
            told = str(error) if isinstance(error, MessageMismatch) else f"`{path}` is {leaf}, but {error}"
            raise WrongPath(told, "write another value, or a parameter: $name") from None
        return converted

    def _converter(self) -> Callable[[Any], Any]:
        leaf, conversion, interfaces = self._leaf, self._part.conversion, self._interfaces
        steps: list[Callable[[Any], Any]] = []
        words: dict[str, Any] = {str(name): value for value, name in conversion.names}
        if (line := conversion.line) is not None:
            steps.append(
                lambda value: (
                    [line.back(_number(each)) for each in value] if leaf.array else line.back(_number(value))
                )
            )
        if conversion.kind in ANGLES:
            axis = ANGLE[conversion.kind][1]
            steps.append(
                lambda value: {axis: math.sin(_number(value) / 2), "w": math.cos(_number(value) / 2)}
            )
        if conversion.kind == "name":
            meant = chosen(constants(interfaces, self._owner), self._last)
            if not meant:
                told = f"{self._owner} has no constants for `{self._last}`"
                raise WrongPath(told, "write names: {0: ...}")
            words |= {name: octet(value) for name, value in meant.items()}
        if DURATION in (leaf.base, self._owner) and not leaf.array:  # as a whole, or its seconds
            steps.append(_not_negative)

        def convert(value: Any) -> Any:
            # A name stands for the message's value, which has the message's unit.
            if words and isinstance(value, str):
                return for_field(_word(value, words), leaf, interfaces)
            for step in steps:
                value = step(value)
            return for_field(value, leaf, interfaces)

        return convert

    def _each(self, problems: list[Problem], adapt: Adapt) -> Give:
        """Return a function that builds a list of messages from a list of structures, lists or single values."""
        path, leaf, number = self._path, self._leaf, self._part.parameter
        if not leaf.array or not leaf.is_message:
            raise WrongPath(f"`each` fills a list of messages, but `{path}` is {leaf}", "write a value")
        fill = builder(self._part.elements, leaf.base, self._interfaces, problems, adapt)

        def of_elements(arguments: Sequence[object], now: float) -> Any:
            given = arguments[number]
            if isinstance(given, str) or not isinstance(given, list | tuple):
                raise WrongValue(f"`{path}`: expected a list, found {text(given, quoted=True)}", path)
            assert fill is not None
            return [fill(_parts(each), now) for each in given]

        return of_elements


def _not_negative(value: Any) -> Any:
    if isinstance(value, int | float) and value < 0:
        raise ValueError("expected a duration that is not negative")
    return value


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError("expected a number")
    return float(value)


def _word(value: str, known: dict[str, Any]) -> Any:
    found = known.get(str(value), known.get(str(value).lower()))
    if found is None:
        raise ValueError(f"expected one of {', '.join(known)}")
    return found


def for_field(value: Any, leaf: FieldType, interfaces: Interfaces) -> Any:
    """Convert a value of an agent to the type of a field: structures and lists stand for messages, in the order of
    their fields."""
    if isinstance(value, MessageHandle):
        return value.value
    if leaf.array:
        if isinstance(value, str) or not isinstance(value, list | tuple):
            return value
        return [for_field(each, FieldType(leaf.base), interfaces) for each in value]
    if leaf.is_message and leaf.base not in TIMES:
        return _message(value, leaf.base, interfaces)
    return str(value) if isinstance(value, Atom) else value


def _message(value: Any, type_name: str, interfaces: Interfaces) -> Any:
    parts = value.arguments if isinstance(value, Structure) else value
    if not isinstance(parts, list | tuple):
        return value
    known = interfaces.fields(type_name)
    if len(parts) != len(known):
        raise ValueError(f"{type_name} has {len(known)} fields: {', '.join(known)}")
    return {
        name: for_field(part, kind, interfaces)
        for (name, kind), part in zip(known.items(), parts, strict=True)
    }


def _parts(element: object) -> Sequence[object]:
    if isinstance(element, Structure):
        return element.arguments
    return element if isinstance(element, list | tuple) else (element,)
