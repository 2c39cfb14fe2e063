"""Numbers of a recording over time, by name: of beliefs, observable properties and robots."""

import dataclasses
import math
import re
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from heapq import merge
from itertools import count, zip_longest
from typing import NamedTuple

from jacaros.look.records.recording import Recording
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line, printable, suggestion

Values = Sequence[float | None] | None
"""The arguments of a belief or the values of a property, with None for texts; None when it is removed."""
_BELIEF = re.compile(r"(~?[a-z]\w*)\(")
_ARGUMENT = re.compile(r"""(?:[^,()\[\]{}"]|"(?:[^"\\]|\\.)*"|[([{][^()\[\]{}]*[)\]}])+""")
_NAME = re.compile(r"(?:(?P<owner>[^:]+):)?(?P<name>[^:]+?)(?:\.(?P<field>\w+))?")
_COORDINATES = {"x": "1", "y": "2", "yaw": "3"}
ROBOT_FIELDS = {"x": "m", "y": "m", "yaw": "°", "battery": "%", "speed": "m/s", "laser": "m"}
"""Fields of robots, with their units; ``laser`` is the distance of the nearest echo."""
_UNITS = {"battery": "%"}
"""Units of beliefs and properties that many programs share."""
_MOST_NAMES = 30


class Sample(NamedTuple):
    """The values of a name at a time; *source* is ``belief``, ``property`` or ``robot``."""

    t: float
    source: str
    owner: str
    name: str
    values: Values


@dataclasses.dataclass
class Series:
    """A number over time.

    Attributes:
        source: ``belief``, ``property`` or ``robot``.
        owner: agent, artifact or robot.
        name: name of the belief, property or robot.
        field: number of the argument from 1, or field of the robot.
        points: time and value; NaN where the value ends.
    """

    source: str
    owner: str
    name: str
    field: str
    points: list[tuple[float, float]] = dataclasses.field(default_factory=list)

    @property
    def is_stepped(self) -> bool:
        """Whether the value holds until the next one; a robot moves between two."""
        return self.source != "robot" or self.field == "speed"

    @property
    def unit(self) -> str:
        """The unit, if it is known."""
        return ROBOT_FIELDS[self.field] if self.source == "robot" else _UNITS.get(self.name, "")

    @property
    def changes(self) -> bool:
        """Whether it has several values."""
        return len({value for _, value in self.points if not math.isnan(value)}) > 1

    def between(self, start: float, end: float) -> "Series":
        """Return the part from *start* to *end*, beginning with the value at *start*."""
        first = max(0, bisect_right(self.points, (start, math.inf)) - 1)
        kept = [(max(t, start), value) for t, value in self.points[first:] if t <= end]
        return dataclasses.replace(self, points=kept)


def samples(recording: Recording) -> Iterator[Sample]:
    """Yield all numbers of a recording in the order of time."""
    return merge(_of_events(recording), _of_frames(recording), key=lambda each: each.t)


def _of_events(recording: Recording) -> Iterator[Sample]:
    for t, kind, data in recording.events:
        if kind == "belief":
            yield from _of_belief(t, data["agent"], data["op"], data["belief"])
        elif kind == "property":
            values = data["values"] and [_number(each) for each in data["values"]]
            yield Sample(t, "property", data["artifact"].rpartition("/")[2], data["name"], values)
        elif kind == "laser":
            nearest = min(filter(None, data["ranges"]), default=None)
            values = [*[None] * (len(ROBOT_FIELDS) - 1), nearest and nearest / 100.0]
            yield Sample(t, "robot", data["robot"], data["robot"], values)


def _of_belief(t: float, agent: str, op: str, text: str) -> Iterator[Sample]:
    found = _BELIEF.match(text)
    if found is not None:
        yield Sample(t, "belief", agent, found[1], _arguments(text, found.end()) if op == "+" else None)


def _arguments(text: str, at: int) -> list[float | None]:
    plain = text[at : text.find(")", at)]
    if not any(sign in plain for sign in '"([{'):  # the common case
        return [_number_of(each) for each in plain.split(",")]
    arguments: list[float | None] = []
    while found := _ARGUMENT.match(text, at):
        arguments.append(_number_of(found[0]))
        at = found.end() + 1
        if text[at - 1 : at] != ",":
            break
    return arguments


def _number_of(text: str) -> float | None:
    try:
        return _number(float(text)) if text[:1] in "-.0123456789" else None
    except ValueError:
        return None


def _number(value: object) -> float | None:
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    return None


def _of_frames(recording: Recording) -> Iterator[Sample]:
    for frame, after in zip_longest(recording.frames, recording.frames[1:]):
        for index, (name, robot) in enumerate(zip(recording.robots, frame.robots, strict=False)):
            speed = 0.0
            if after is not None and after.t > frame.t:
                there = after.robots[index]
                speed = math.hypot(there.x - robot.x, there.y - robot.y) / (after.t - frame.t)
            numbers = [robot.x, robot.y, math.degrees(robot.yaw), robot.battery, speed]
            yield Sample(frame.t, "robot", name, name, numbers)


def all_series(recording: Recording) -> list[Series]:
    """Return all numbers.

    Beliefs of which an agent has several at a time, such as the places of a map, are not one number over time.
    """
    found: dict[tuple[str, str, str], _Fields] = {}
    for t, source, owner, name, values in samples(recording):
        key = source, owner, name
        fields = found.get(key) or found.setdefault(key, _Fields(*key))
        if source == "belief":
            fields.held = max(0, fields.held + (1 if values is not None else -1))
            fields.is_many = fields.is_many or fields.held > 1
        fields.take(t, values)
    return [series for each in found.values() if not each.is_many for series in each.series.values()]


class _Fields:
    """The series of one name; *held* beliefs of it are there now."""

    def __init__(self, source: str, owner: str, name: str) -> None:
        self._key = source, owner, name
        self.series: dict[str, Series] = {}
        self.held = 0
        self.is_many = False

    def take(self, t: float, values: Values) -> None:
        if values is None:
            for series in self.series.values():
                series.points.append((t, math.nan))
        fields = ROBOT_FIELDS if self._key[0] == "robot" else map(str, count(1))
        for field, value in zip(fields, values or (), strict=False):
            if value is None:
                continue
            series = self.series.get(field) or self.series.setdefault(field, Series(*self._key, field))
            points = series.points
            if points and points[-1][0] == t and math.isnan(points[-1][1]):
                points.pop()  # a removal at the same time was one half of a change
            points.append((t, value))


def named(known: Sequence[Series], name: str) -> list[Series]:
    """Return the series that a name means: ``[OWNER:]NAME[.FIELD]``.

    Without an owner these are the beliefs of all agents; the properties of all artifacts if no agent has such a belief.
    Without a field it is the first number.

    Raises:
        UsageError: the name is unknown.
    """
    parts = _NAME.fullmatch(name)
    if parts is not None:
        owned = [each for each in known if parts["owner"] in (None, each.owner)]
        for source in ("belief", "property", "robot"):
            meant = [each for each in owned if (each.source, each.name) == (source, parts["name"])]
            found = _with_field(meant, parts["field"])
            if found:
                return found
    names = [*_short_names(each for each in known if each.changes)]
    near = suggestion(name, names)
    listed = ", ".join(names[:_MOST_NAMES]) + (", ..." if len(names) > _MOST_NAMES else "")
    help = f"{near and near + ' '}series of this recording: {listed or 'none'}"
    raise UsageError(f"error: unknown series: `{printable(name)}`\n{help_line(help)}")


def _short_names(known: Iterable[Series]) -> dict[str, None]:
    """Return the names without owners, and those of single numbers without fields."""
    names = dict.fromkeys((each.source == "robot", each.name, each.field) for each in known)
    numbers = Counter(name for _, name, _ in names)
    return dict.fromkeys(name if numbers[name] == 1 else f"{name}.{field}" for _, name, field in names)


def _with_field(found: Iterable[Series], field: str | None) -> list[Series]:
    """Return the series with the field; without one, the first of each owner."""
    if field is not None:
        return [each for each in found if each.field in (field, _COORDINATES.get(field))]
    first: dict[str, Series] = {}
    for each in found:
        first.setdefault(each.owner, each)
    return [*first.values()]
