"""Read the values of fields from messages. Paths, lists and conversions are compiled to functions once per type.
Large values that an agent only passes on are given by reference (`MessageHandle`)."""

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import chain
from typing import Any

from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.mapping.fields import (
    ANGLES,
    LISTS,
    WHOLE,
    Conversion,
    FieldPart,
    FieldPath,
    WrongPath,
    read_path,
)
from jacaros.robots.mapping.interfaces import (
    Getter,
    Interfaces,
    check_unit,
    chosen,
    constants,
    follow,
    getter,
    tried,
)
from jacaros.robots.mapping.properties import TopicPart
from jacaros.robots.plane.pose import pitch_of, roll_of, yaw_of
from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.fields import FLOATS, INTEGER_RANGES, FieldType
from jacaros.robots.ros.message import TIMES, to_seconds
from jacaros.runtime.files.yaml import Problem

QUATERNION = "geometry_msgs/msg/Quaternion"

Read = Callable[[Any, Any, int], tuple[object, ...]]
"""Takes a message, its current element (the message again without ``each``) and the element's index; returns values."""

Convert = Callable[[Any], object]


class Unshowable(Exception):
    """Raised for a message that cannot be shown: a number is not finite, or a list is too short.

    Attributes:
        path: path of the field.
        help: what to write in the mapping.
        functor: functor of the reason for programs.
    """

    def __init__(self, path: str, message: str, help: str, functor: str = "not_finite") -> None:
        super().__init__(message)
        self.path, self.help, self.functor = path, help, functor


def reader(field: FieldPart, message: FieldType, element: FieldType | None, interfaces: Interfaces) -> Read:
    """Return a function that reads the values of *field*.

    Args:
        field: the field.
        message: type of the messages.
        element: type of the elements, with ``each``.
        interfaces: knows the types.

    Raises:
        WrongPath: the path does not exist, or the conversion does not match its type.
        UnknownInterface: a type is unknown.
    """
    from_message = element is None or field.path.of_message
    root = message if element is None or field.path.of_message else element
    decoder = _Decoder(field, root, message, interfaces)
    get, values, path = getter(field.path), decoder.values(), field.path.text
    is_number = decoder.leaf.base in FLOATS and not decoder.levels

    def take(whole: Any, part: Any, place: int) -> tuple[object, ...]:
        try:
            raw = get(whole if from_message else part, place)
        except IndexError:
            if is_number and field.otherwise is not None:
                return values(math.nan, whole)
            help = "read the list, or an element that always exists"
            if is_number:
                help = f'write a replacement: {{path: "{path}", otherwise: 0}}'
            text = f"`{path}` does not exist: the list is shorter"
            raise Unshowable(path, text, help, "no_element") from None
        return values(raw, whole)

    return take


_REDUCE: dict[str, Callable[[list[float]], float]] = {
    "min": min,
    "max": max,
    "mean": lambda numbers: sum(numbers) / len(numbers),
}

ANGLE: dict[str, tuple[Callable[[float, float, float, float], float], str]] = {
    "roll": (roll_of, "x"),
    "pitch": (pitch_of, "y"),
    "yaw": (yaw_of, "z"),
}
"""For each angle the function of a quaternion that gives it, and the axis that it turns about."""

ReadValues = Callable[[Any, Any], tuple[object, ...]]
"""Converts the value at a path; takes the whole message, too, for ``otherwise``."""

Element = Callable[[Any, Any], object]
"""Converts one value; takes the whole message, too."""


class _Decoder:
    """The conversion of the values of one field.

    Args:
        field: the field.
        root: type at which its path begins.
        message: type of the messages.
        interfaces: knows the types.

    Attributes:
        leaf: the type at the path.
        levels: nesting depth of the lists there.
    """

    def __init__(self, field: FieldPart, root: FieldType, message: FieldType, interfaces: Interfaces) -> None:
        self._field, self._conversion, self._path = field, field.conversion, field.path.text
        self._root, self._message, self._interfaces = root, message, interfaces
        self.leaf = follow(field.path, root, interfaces.fields)
        self.levels = field.path.lists + self.leaf.array
        check_unit(field.conversion, field.path, root, interfaces)

    def values(self) -> ReadValues:
        """Return the conversion of the value at the path."""
        kind, shares = self._conversion.kind, self._field.shares
        if kind == "object":
            type_name = str(self.leaf)
            return lambda raw, _: (MessageHandle(raw, type_name),)
        single = FieldType(self.leaf.base)
        if shares is not None or kind in LISTS:
            if self.levels != 1:
                what = "sample" if shares is not None else f"as: {kind}"
                text = f"`{what}` is for lists, but `{self._path}` is {self.leaf}"
                raise WrongPath(text, "name a field that is a list")
            return self._sample(single, shares) if shares is not None else self._reduced(single, kind)
        base = self._element(single)
        if self.levels == 0:
            return lambda raw, whole: (base(raw, whole),)

        def lists(raw: Any, whole: Any, deep: int) -> object:
            if deep == 1:
                return [base(each, whole) for each in _items(raw)]
            return [lists(each, whole, deep - 1) for each in raw]

        return lambda raw, whole: (lists(raw, whole, self.levels),)

    def _sample(self, single: FieldType, shares: tuple[float, ...]) -> ReadValues:
        element, path = self._element(single), self._path

        def sample(raw: Any, whole: Any) -> tuple[object, ...]:
            if not len(raw):
                help = "a sample needs a list with elements"
                raise Unshowable(path, f"`{path}` is empty", help, "no_element")
            return tuple([element(raw[place], whole) for place in _places(len(raw), shares)])

        return sample

    def _reduced(self, single: FieldType, kind: str) -> ReadValues:
        if kind == "count":
            self._check(FieldType("int32"))
            convert = converted(self._conversion)
            return lambda raw, _: (convert(len(raw)),)
        if single.base not in FLOATS and single.base not in INTEGER_RANGES:
            raise WrongPath(f"`as: {kind}` is for lists of numbers, but `{self._path}` is of {single}")
        element = self._element(FieldType("float64") if single.base in INTEGER_RANGES else single)
        reduce = _REDUCE[kind]

        def reduced(raw: Any, whole: Any) -> tuple[object, ...]:
            finite = [value for value in _items(raw) if math.isfinite(value)]
            return (element(reduce(finite) if finite else math.nan, whole),)

        return reduced

    def _element(self, single: FieldType) -> Element:
        kind = self._conversion.kind
        self._check(single)
        after, fallback = converted(self._conversion), self._otherwise()
        if kind in ANGLE:
            angle = ANGLE[kind][0]

            def heading(raw: Any, whole: Any) -> object:
                value = angle(raw.x, raw.y, raw.z, raw.w)
                return after(value) if math.isfinite(value) else fallback(value, whole)

            return heading
        if kind == "name":
            named = self._named()
            return lambda raw, _: after(named(raw))
        if kind == "atom":
            return lambda raw, _: after(Atom(raw))
        if single.base in FLOATS:

            def number(raw: Any, whole: Any) -> object:
                value = float(raw)
                return after(value) if math.isfinite(value) else fallback(value, whole)

            return number
        base = _plain(self._path, single, self._interfaces)
        return lambda raw, _: after(base(raw))

    def _check(self, single: FieldType) -> None:
        kind, path = self._conversion.kind, self._path
        if kind not in LISTS:
            check_conversion(
                self._conversion, path, single, "is for quaternions", "name a field that is a number"
            )
        if kind == "atom" and single.base != "string":
            raise WrongPath(f"`as: atom` is for strings, but `{path}` is {single}", "leave `as` out")
        if self._field.otherwise is not None and single.base not in FLOATS and kind not in ANGLES:
            text = f"`otherwise` is for floating-point numbers, but `{path}` is {single}"
            raise WrongPath(text, "leave it out")

    def _otherwise(self) -> Callable[[float, Any], object]:
        otherwise, path = self._field.otherwise, self._path
        if otherwise is None:

            def refuse(value: float, _: Any) -> object:
                help = f"write a replacement: {{path: {path}, otherwise: 0}}"
                raise Unshowable(path, f"`{path}` is {value:g}", help)

            return refuse
        if not isinstance(otherwise, FieldPath):
            whole = float(otherwise).is_integer() and self._conversion.digits == 0
            figure = int(otherwise) if whole else otherwise
            return lambda value, _: figure
        leaf = follow(otherwise, self._message, self._interfaces.fields)
        if leaf.array or not (leaf.base in FLOATS or leaf.base in INTEGER_RANGES):
            raise WrongPath(f"`otherwise` must be a number, but `{otherwise.text}` is {leaf}")
        get, nearest = getter(otherwise), getter(self._nearest(otherwise))
        after = converted(dataclasses.replace(self._conversion, names=()))

        def from_message(value: float, whole: Any) -> object:
            instead = float((nearest if value == -math.inf else get)(whole, 0))
            if not math.isfinite(instead):
                text = f"`{path}` is {value:g}, and so is `{otherwise.text}`"
                raise Unshowable(path, text, "write a number for `otherwise`")
            return after(instead)

        return from_message

    def _nearest(self, otherwise: FieldPath) -> FieldPath:
        """Return the replacement for minus infinity: an echo too close to measure (REP 117) is not one beyond
        ``range_max``."""
        if not otherwise.text.endswith("range_max"):
            return otherwise
        nearest = read_path(otherwise.text.removesuffix("range_max") + "range_min")
        try:
            follow(nearest, self._message, self._interfaces.fields)
        except WrongPath:
            return otherwise
        return nearest

    def _named(self) -> Convert:
        owner, last = owner_of(self._field.path, self._root, self._interfaces)
        meant = chosen(constants(self._interfaces, owner), last)
        if not meant:
            raise WrongPath(f"{owner} has no constant", "write names: {0: ...}")
        names: dict[object, Atom] = {}
        for name, value in meant.items():
            plain = octet(value)
            if plain in names:
                raise WrongPath(
                    f"{owner}: the constants `{names[plain]}` and `{name}` have the same value {plain}",
                    f"write names: {{{plain}: {name}}}",
                )
            names[plain] = Atom(name)
        return lambda raw: names.get(value := octet(raw), value)


@lru_cache(64)
def _places(count: int, shares: tuple[float, ...]) -> tuple[int, ...]:
    """Return the indices of the sampled elements; the others are never read."""
    return tuple(round(share * (count - 1)) for share in shares)


def _items(raw: Any) -> Any:
    """Return the elements as plain Python values: those of numpy are many times slower."""
    return raw.tolist() if hasattr(raw, "tolist") else raw


def is_number(kind: FieldType) -> bool:
    """Return whether a type is a number or a time."""
    return kind.base in FLOATS or kind.base in INTEGER_RANGES or kind.base in TIMES


def check_conversion(conversion: Conversion, path: str, kind: FieldType, angles: str, help: str) -> None:
    """Reject an angle of what is not a quaternion, impossible names, and units and rounding of what is not a number.

    Args:
        conversion: of a value, in either direction.
        path: of the value.
        kind: its type.
        angles: what the message says about angles.
        help: what to write in place of units and rounding.

    Raises:
        WrongPath: the conversion does not match the type.
    """
    if conversion.kind in ANGLES:
        if kind.base != QUATERNION or kind.array:
            raise WrongPath(
                f"`as: {conversion.kind}` {angles}, but `{path}` is {kind}",
                "name the field that is a geometry_msgs/msg/Quaternion, such as pose.pose.orientation",
            )
        return
    check_names(conversion, path, kind.base)
    for key, given in (
        ("unit, scale or offset", conversion.line),
        ("round", conversion.digits),
        ("least", conversion.least),
    ):
        if given is not None and not is_number(kind):
            raise WrongPath(f"{key} needs a number, but `{path}` is {kind}", help)


def check_names(conversion: Conversion, path: str, base: str) -> None:
    """Reject names for values that the field cannot have.

    Raises:
        WrongPath: one of the values is impossible.
    """
    wanted = _NAMED.get(base) or ((int,) if base in INTEGER_RANGES else None)
    for value, name in conversion.names:
        if wanted is not None and (
            not isinstance(value, wanted) or isinstance(value, bool) != (base == "bool")
        ):
            help = f"write names: {{true: {name}}}" if base == "bool" else f"write values of {base}"
            raise WrongPath(f"`names` has {value!r}, but `{path}` is {base}", help)
        low, high = INTEGER_RANGES.get(base, (-math.inf, math.inf))
        if isinstance(value, int) and not low <= value <= high:
            text = f"`names` has {value}, but `{path}` is {base}"
            raise WrongPath(text, f"write values from {low} to {high}")


_NAMED: dict[str, tuple[type, ...]] = {
    "bool": (bool,),
    "string": (str,),
    **dict.fromkeys(FLOATS, (int, float)),
}


_ALMOST = 1e-6
"""A difference this small to an integer is a rounding error, also of 32-bit numbers: 100 times 0.57 is 56.999…"""


def _rounding(digits: int, floor: bool) -> Convert:
    if floor:
        return lambda value: math.floor(value + _ALMOST)
    return round if digits == 0 else (lambda value: round(value, digits))


def converted(conversion: Conversion) -> Convert:
    """Return the conversion after the path: names, or else units and rounding."""
    steps: list[Convert] = []
    if (line := conversion.line) is not None:
        steps.append(line.there)
    if conversion.least is not None:
        steps.append(partial(max, conversion.least))
    if (digits := conversion.digits) is not None:
        steps.append(_rounding(digits, conversion.floor))
    number = _in_turn(steps)
    if not conversion.names and conversion.kind != "name":
        return number
    known = {value: Atom(name) for value, name in conversion.names}

    def named(value: Any) -> object:
        found = known.get(value, value)
        return found if isinstance(found, Atom) else number(found)

    return named


def _in_turn(steps: list[Convert]) -> Convert:
    if len(steps) < 2:
        return steps[0] if steps else lambda value: value
    first, second = steps[0], _in_turn(steps[1:])
    return lambda value: second(first(value))


def owner_of(path: FieldPath, root: FieldType, interfaces: Interfaces) -> tuple[str, str]:
    """Return the message type that contains a path's last field, and the name of that field."""
    names = [place for place, step in enumerate(path.steps) if isinstance(step, str) and step.startswith(".")]
    if not names:
        raise WrongPath(f"`{path.text}` is not a field, so it has no constants", "name a field")
    last = path.steps[names[-1]]
    assert isinstance(last, str)
    above = FieldPath(path.text, path.steps[: names[-1]], path.of_message)
    return follow(above, root, interfaces.fields).base, last[1:]


def octet(raw: Any) -> Any:
    return raw[0] if isinstance(raw, bytes) and len(raw) == 1 else raw


def _plain(path: str, single: FieldType, interfaces: Interfaces) -> Convert:
    """Return the conversion of a type for agents: numbers, texts, seconds, structures for messages."""
    if single.base in TIMES:
        return to_seconds
    if single.is_message:
        return _structure(path, single.base, interfaces)
    if single.base == "byte":
        return lambda raw: int(octet(raw))
    if single.base in FLOATS:
        return lambda raw: _finite(path, float(raw))
    if single.base == "bool":
        return bool
    return str if single.base == "string" else int


def _finite(path: str, value: float) -> float:
    if math.isfinite(value):
        return value
    raise Unshowable(
        path, f"`{path}` is {value:g}", "name single fields, each with a replacement: otherwise: 0"
    )


def _structure(path: str, type_name: str, interfaces: Interfaces) -> Convert:
    """Convert a message to a structure: ``geometry_msgs/msg/Point`` is ``point(X,Y,Z)``."""
    name = type_name.rpartition("/")[2]
    functor = name[:1].lower() + name[1:]
    parts = [
        (field, _whole(f"{path}.{field}".removeprefix(".."), kind, interfaces))
        for field, kind in interfaces.fields(type_name).items()
    ]
    if not parts:
        return lambda raw: Atom(functor)
    return lambda raw: Structure(functor, tuple([convert(getattr(raw, field)) for field, convert in parts]))


def _whole(path: str, kind: FieldType, interfaces: Interfaces) -> Convert:
    single = _plain(path, FieldType(kind.base), interfaces)
    return (lambda raw: [single(each) for each in _items(raw)]) if kind.array else single


class MessageHandle:
    """An image, a cloud, a map: a message, or a part of one, that agents receive as an opaque reference.

    Internal actions and operations in Python receive the handle itself and read `value`; nothing is copied.

    Attributes:
        value: the message or array, as the middleware delivered it; read-only by convention.
        type_name: type of the message, or of its content: ``sensor_msgs/msg/Image``, ``uint8[]``.
    """

    __slots__ = ("type_name", "value")

    def __init__(self, value: Any, type_name: str) -> None:
        self.value, self.type_name = value, type_name

    def __repr__(self) -> str:
        return f"<{self.type_name}>"


# From a message to properties or signals: one row of values, or one for each element of an array.


@dataclass(frozen=True, slots=True)
class ValueRow:
    """The values of one property or signal.

    Attributes:
        key: identifies an element; None if there is one row.
        values: in the order of the fields.
    """

    key: object
    values: tuple[object, ...]


FRAME = read_path("header.frame_id")
"""Path of the frame of a message."""

Extract = Callable[[Any], list[ValueRow]]
"""Takes a message; raises `Unshowable`."""


def fields_of(part: TopicPart, root: FieldType, interfaces: Interfaces) -> tuple[FieldPart, ...]:
    """Return the fields of a property or signal: those of the mapping, or else the whole message or element *root*.

    Raises:
        UnknownInterface: its type is unknown.
    """
    if part.fields is not None:
        return part.fields
    if not root.is_message:
        return (FieldPart(WHOLE, part.place, name="value"),)
    names = interfaces.fields(root.base)
    return tuple(FieldPart(read_path(name), part.place, name=name) for name in names)


def extractor(
    part: TopicPart, type_name: str, interfaces: Interfaces, problems: list[Problem]
) -> Extract | None:
    """Return a function that reads the rows of a property or signal from messages.

    Args:
        part: the property or signal.
        type_name: message type.
        interfaces: knows the types.
        problems: receives mistakes; the result is then None.
    """
    before = len(problems)
    made = _Maker(part, type_name, interfaces, problems).make()
    return made if len(problems) == before else None


class _Maker:
    def __init__(
        self, part: TopicPart, type_name: str, interfaces: Interfaces, problems: list[Problem]
    ) -> None:
        self.part, self.interfaces, self.problems = part, interfaces, problems
        self.message = FieldType(type_name)
        self.element: FieldType | None = None

    def make(self) -> Extract:
        """Return the function; unusable after a mistake."""
        part, problems = self.part, self.problems
        if part.each is not None:
            self.element = tried(part.each_place, problems, self._element) or self.message
        if part.frame is not None:
            tried(part.frame.place, problems, self._require_frame)
        root = self.element or self.message
        fields = tried(part.place, problems, fields_of, part, root, self.interfaces) or ()
        takes = [take for field in fields if (take := self._reader(field)) is not None]
        if part.each is None:
            return _single(takes)
        return _several(getter(part.each), takes)

    def _element(self) -> FieldType:
        each = self.part.each
        assert each is not None
        leaf = follow(each, self.message, self.interfaces.fields)
        if not leaf.array or each.lists:
            raise WrongPath(f"`each` is for arrays, but `{each.text}` is {leaf}")
        return FieldType(leaf.base)

    def _require_frame(self) -> None:
        try:
            follow(FRAME, self.message, self.interfaces.fields)
        except (WrongPath, UnknownInterface):
            text = f"`frame` is for messages with a header, but {self.message} has none"
            raise WrongPath(text, "leave it out") from None

    def _reader(self, field: FieldPart) -> Read | None:
        return tried(field.place, self.problems, reader, field, self.message, self.element, self.interfaces)


def _single(takes: list[Read]) -> Extract:
    if len(takes) == 1:
        return lambda message: [ValueRow(None, takes[0](message, message, 0))]
    return lambda message: [
        ValueRow(None, tuple(chain.from_iterable([take(message, message, 0) for take in takes])))
    ]


def _several(get: Getter, takes: list[Read]) -> Extract:
    def rows(message: Any) -> list[ValueRow]:
        found = []
        for place, element in enumerate(get(message, 0)):
            parts = [take(message, element, place) for take in takes]
            found.append(ValueRow(_hashable(parts[0]) if parts else place, tuple(chain.from_iterable(parts))))
        return found

    return rows


def _hashable(key: tuple[object, ...]) -> object:
    """Return a hashable key: one that contains lists is converted to text."""
    try:
        hash(key)
    except TypeError:
        return str(key)
    return key
