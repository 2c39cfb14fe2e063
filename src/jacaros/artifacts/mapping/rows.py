"""From a message to properties or signals: one row of values, or one for each element of an array."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.mapping.declared import (
    WHOLE,
    FieldPart,
    Path,
    RangeOfView,
    TopicPart,
    Written,
    WrongPath,
    read_path,
)
from jacaros.artifacts.mapping.decoding import Read, reader
from jacaros.artifacts.mapping.interfaces import Interfaces
from jacaros.artifacts.mapping.paths import Getter, follow, getter
from jacaros.files.yaml import Problem
from jacaros.ros.errors import UnknownInterface
from jacaros.ros.fields import FLOATS, INTEGER_RANGES, FieldType


@dataclass(frozen=True, slots=True)
class Row:
    """The values of one property or signal.

    Attributes:
        key: identifies an element; None if there is one row.
        values: in the order of the fields.
        annotations: annotations of the belief.
        place: position of the element, for the range of view.
    """

    key: object
    values: tuple[object, ...]
    annotations: tuple[object, ...] = ()
    place: tuple[float, float] = (0.0, 0.0)


FRAME = read_path("header.frame_id")
"""Path of the frame of a message."""

Extract = Callable[[Any], list[Row]]
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
    maker = _Maker(part, type_name, interfaces, problems)
    made = maker.make()
    return made if maker.good else None


class _Maker:
    def __init__(
        self, part: TopicPart, type_name: str, interfaces: Interfaces, problems: list[Problem]
    ) -> None:
        self.part, self.interfaces, self.problems = part, interfaces, problems
        self.message = FieldType(type_name)
        self.element = self._element()
        self.good = True

    def _element(self) -> FieldType | None:
        each = self.part.each
        if each is None:
            return None
        try:
            leaf = follow(each, self.message, self.interfaces.fields)
        except (WrongPath, UnknownInterface) as error:
            self.wrong(self.part.each_place, error)
            return FieldType(self.message.base)
        if not leaf.array or each.lists:
            self.wrong(self.part.each_place, WrongPath(f"`each` is for arrays, but `{each.text}` is {leaf}"))
        return FieldType(leaf.base)

    def wrong(self, place: Any, error: Exception) -> None:
        """Report a mistake."""
        self.good = False
        self.problems.append(place.problem(str(error), getattr(error, "help", "")))

    def make(self) -> Extract:
        """Return the function; unusable after a mistake."""
        before = len(self.problems)
        if self.part.frame is not None:
            self._require_frame(self.part.frame)
        fields = self._fields()
        takes = [take for field in fields if (take := self._reader(field)) is not None]
        notes = [
            (field.name, take) for field in self.part.annotations if (take := self._reader(field)) is not None
        ]
        view = self._view() if self.part.view is not None else None
        key = self._key(fields)
        self.good = len(self.problems) == before and self.good
        if self.part.each is None:
            return self._single(takes, notes, view)
        return self._several(getter(self.part.each), takes, notes, view, key)

    def _require_frame(self, frame: Written) -> None:
        try:
            follow(FRAME, self.message, self.interfaces.fields)
        except (WrongPath, UnknownInterface):
            text = f"`frame` is for messages with a header, but {self.message} has none"
            self.wrong(frame.place, WrongPath(text, "leave it out"))

    def _fields(self) -> Sequence[FieldPart]:
        try:
            return fields_of(self.part, self.element or self.message, self.interfaces)
        except UnknownInterface as error:
            self.wrong(self.part.place, error)
            return ()

    def _reader(self, field: FieldPart) -> Read | None:
        try:
            return reader(field, self.message, self.element, self.interfaces)
        except (WrongPath, UnknownInterface) as error:
            self.wrong(field.place, error)
            return None

    def _key(self, fields: Sequence[FieldPart]) -> Read | None:
        if self.part.each is None:
            return None
        field = self.part.key or (fields[0] if fields else None)
        return self._reader(field) if field is not None else None

    def _view(self) -> Callable[[Any, Any, int], tuple[float, float] | None]:
        """Return a function that gives the position of an element; None if it is certainly out of view."""
        view = self.part.view
        assert view is not None
        if view.distance is not None:
            far = self._number(view.distance, view)
            return lambda whole, part, i: (0.0, 0.0) if far(whole, part, i) <= view.metres else None
        if len(view.at) != 2:  # the reader has reported it
            return lambda whole, part, i: None
        across, along = (self._number(path, view) for path in view.at)
        return lambda whole, part, i: (across(whole, part, i), along(whole, part, i))

    def _number(self, path: Path, view: RangeOfView) -> Callable[[Any, Any, int], float]:
        root = self.message if self.element is None or path.of_message else self.element
        try:
            leaf = follow(path, root, self.interfaces.fields)
            if leaf.array or path.lists or leaf.base not in (*FLOATS, *INTEGER_RANGES):
                raise WrongPath(f"`range_of_view` needs numbers, but `{path.text}` is {leaf}")
        except (WrongPath, UnknownInterface) as error:
            self.wrong(view.place, error)
        get: Getter = getter(path)
        from_message = self.element is None or path.of_message

        def number(whole: Any, part: Any, i: int) -> float:
            try:
                return float(get(whole if from_message else part, i))
            except IndexError:  # no element there, so none is near
                return math.nan

        return number

    def _single(self, takes: list[Read], notes: list[tuple[str, Read]], view: Any) -> Extract:
        def rows(message: Any) -> list[Row]:
            place = view(message, message, 0) if view is not None else (0.0, 0.0)
            if place is None or not all(map(math.isfinite, place)):
                return []
            return [Row(None, _values(takes, message, message, 0), _noted(notes, message, message, 0), place)]

        return rows

    def _several(
        self, get: Getter, takes: list[Read], notes: list[tuple[str, Read]], view: Any, key: Read | None
    ) -> Extract:
        def rows(message: Any) -> list[Row]:
            found = []
            for place, element in enumerate(get(message, 0)):
                at = view(message, element, place) if view is not None else (0.0, 0.0)
                if at is None or not all(map(math.isfinite, at)):
                    continue
                values = _values(takes, message, element, place)
                told = _noted(notes, message, element, place)
                found.append(Row(_hashable(key(message, element, place)) if key else place, values, told, at))
            return found

        return rows


def _values(takes: list[Read], message: Any, element: Any, place: int) -> tuple[object, ...]:
    if len(takes) == 1:
        return takes[0](message, element, place)
    return tuple([value for take in takes for value in take(message, element, place)])


def _noted(notes: list[tuple[str, Read]], message: Any, element: Any, place: int) -> tuple[object, ...]:
    if not notes:
        return ()
    return tuple([Structure(name, tuple(take(message, element, place))) for name, take in notes])


def _hashable(key: tuple[object, ...]) -> object:
    """Return a hashable key: one that contains lists is converted to text."""
    try:
        hash(key)
    except TypeError:
        return str(key)
    return key
