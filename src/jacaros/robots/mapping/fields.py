"""What a mapping file declares about single values, and how it is read: places, names, types, paths, fields and their
conversions. Keys are declared at the fields of the parts, as `jacaros.runtime.files.entries` describes."""

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import reduce
from typing import Annotated, Any, NamedTuple, TypeVar

from jacaros.robots.ros.errors import NameInvalid
from jacaros.robots.ros.names import action_type, message_type, service_type
from jacaros.runtime.files.entries import FieldSpec, values
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.files.yaml import Problem, YamlNode

P = TypeVar("P")


def entry(read: Callable[[YamlNode], object], key: str = "", words: str = "") -> FieldSpec:
    """Return the entry of a key (by default the name of the field) whose value *read* converts, with its documentation."""
    return FieldSpec(words, "", key, lambda node, _: read(node))


def with_entries(part: P, entries: dict[str, YamlNode]) -> P:
    """Return a part with the values of the entries that are declared at its fields."""
    return replace(part, **values(entries, part))  # type: ignore[type-var]


class FilePosition(NamedTuple):
    """A position in the file, counted from 1."""

    line: int
    column: int

    def problem(self, message: str, help: str = "") -> Problem:
        """Make a problem at this position."""
        return Problem(self.line, self.column, message, help)


START = FilePosition(1, 1)
"""The first character of the file."""


@dataclass(frozen=True, slots=True)
class Written:
    """A text and its position."""

    text: str
    place: FilePosition


NOTHING = Written("", START)


def place_of(node: YamlNode) -> FilePosition:
    """Return the position of a value."""
    return FilePosition(node.line, node.column)


def written(node: YamlNode) -> Written:
    """Read a text with its position."""
    return Written(node.text(), place_of(node))


# Paths into messages: ``pose.pose.position.x``, ``ranges[0]``, ``transforms[*].child_frame_id``.

ALL = "*"
"""Stands for all elements of an array."""
HERE = "i"
"""Stands for the index of the current element, where there is one property for each."""

_PART = re.compile(r"(?P<name>[A-Za-z][A-Za-z0-9_]*)(?P<indices>(\[(-?\d+|\*|i)\])*)")
_INDEX = re.compile(r"\[(-?\d+|\*|i)\]")

PathStep = str | int
"""The name of a field, or the index of an element, ``"*"`` or ``"[i]"``."""


class WrongPath(ValueError):
    """Raised for an invalid path, with what to write."""

    def __init__(self, message: str, help: str = "") -> None:
        super().__init__(message)
        self.help = help


@dataclass(frozen=True, slots=True)
class FieldPath:
    """A path.

    Attributes:
        text: as written.
        steps: names, numbers, `ALL` and `HERE`; names have a dot in front so that ``"*"`` is not a name.
        of_message: whether it begins at the message although its neighbours begin at an element.
    """

    text: str
    steps: tuple[PathStep, ...]
    of_message: bool = False

    @property
    def lists(self) -> int:
        """Nesting depth of lists caused by `ALL`."""
        return self.steps.count(ALL)


WHOLE = FieldPath(".", ())


def read_path(text: str) -> FieldPath:
    """Read a path.

    Raises:
        WrongPath: it is invalid.
    """
    of_message = text.startswith("/")
    rest = text.removeprefix("/")
    if rest in (".", ""):
        if not text:
            raise WrongPath("empty path", "write the path of a field, or . for the whole message")
        return FieldPath(text, (), of_message)
    steps: list[PathStep] = []
    for part in rest.split("."):
        found = _PART.fullmatch(part)
        if found is None:
            told = f"`{text}` is not a path: `{part}` is not a field"
            raise WrongPath(told, "write it like pose.position.x or ranges[0]")
        steps.append(f".{found['name']}")
        for index in _INDEX.findall(found["indices"]):
            steps.append(index if index in (ALL, HERE) else int(index))
    return FieldPath(text, tuple(steps), of_message)


def path_of(node: YamlNode, help: str = "") -> FieldPath:
    """Read a path; the whole message after a mistake."""
    if not isinstance(node.value, str):
        text = f"{node.what} must be a path, found {shown(node.value)}"
        node.wrong(text, help or "write the path of a field, as in pose.x")
        return WHOLE
    try:
        return read_path(node.value)
    except WrongPath as error:
        node.wrong(str(error), error.help)
        return WHOLE


def shown(value: Any) -> str:
    """Format a value of a file for a message."""
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list):
        return "a list"
    return "nothing" if value is None else repr(value)


def each_of(node: YamlNode) -> list[YamlNode]:
    """Return the items of a list; a single one needs no brackets."""
    return list(node.sequence()) if isinstance(node.value, list) else [node]


# Conversions.

ANGLES = ("yaw", "pitch", "roll")
LISTS = ("count", "min", "max", "mean")
KINDS = (*ANGLES, "name", "atom", "object", *LISTS)
CONVERSION = ("as", "names", "unit", "scale", "offset")
DOWN = "down"
"""Value of ``round: down``, the next lower integer, so that a battery at 99.7 % does not count as full."""
FIELD = ("path", *CONVERSION, "sample", "round", "least", "otherwise", "name")


@dataclass(frozen=True, slots=True)
class LinearConversion:
    """``factor * value + shift``, from the message's number to the agent's."""

    factor: float = 1.0
    shift: float = 0.0

    def there(self, value: float) -> float:
        """Convert to the agent's number."""
        return self.factor * value + self.shift

    def back(self, value: float) -> float:
        """Convert to the message's number."""
        return (value - self.shift) / self.factor

    def then(self, other: "LinearConversion") -> "LinearConversion":
        """Return this conversion followed by *other*."""
        return LinearConversion(self.factor * other.factor, self.shift * other.factor + other.shift)


@dataclass(frozen=True, slots=True)
class ConvertedUnit:
    """A unit of messages, of agents, or of both.

    Attributes:
        symbol: as in tables and messages; empty for numbers without a unit.
        words: its name in texts.
        kind: what it measures; empty for units that are not converted.
        size: factor to the usual unit of its kind; 0: only messages have it.
        zero: its zero in the usual unit.
        key: its name in mapping files; empty: its words, with underscores.
    """

    symbol: str
    words: str
    kind: str = ""
    size: float = 0.0
    zero: float = 0.0
    key: str = ""


_UNITS = (
    ConvertedUnit("", ""),
    ConvertedUnit("rad", "radians", "angle", 1.0),
    ConvertedUnit("degrees", "degrees", "angle", 3.141592653589793 / 180.0),
    ConvertedUnit("rad/s", "radians per second", "angle"),
    ConvertedUnit("rad/s²", "radians per second squared"),
    ConvertedUnit("m", "metres", "length", 1.0),
    ConvertedUnit("cm", "centimetres", "length", 0.01),
    ConvertedUnit("mm", "millimetres", "length", 0.001),
    ConvertedUnit("m/s", "metres per second", "speed", 1.0),
    ConvertedUnit("km/h", "kilometres per hour", "speed", 1.0 / 3.6),
    ConvertedUnit("m/s²", "metres per second squared"),
    ConvertedUnit("s", "seconds", "time", 1.0),
    ConvertedUnit("ms", "milliseconds", "time", 0.001),
    ConvertedUnit("min", "minutes", "time", 60.0),
    ConvertedUnit("°C", "degrees Celsius", "temperature", 1.0, key="celsius"),
    ConvertedUnit("K", "kelvin", "temperature", 1.0, -273.15),
    ConvertedUnit("0 to 1", "0 to 1", "share", 1.0, key="share"),
    ConvertedUnit("%", "percent", "share", 0.01),
    ConvertedUnit("N", "newtons"),
    ConvertedUnit("N m", "newton metres"),
    ConvertedUnit("V", "volts"),
    ConvertedUnit("A", "amperes"),
    ConvertedUnit("Ah", "ampere hours"),
    ConvertedUnit("T", "teslas"),
    ConvertedUnit("Pa", "pascals"),
    ConvertedUnit("lx", "lux"),
)
"""All units; the first of a kind is the usual one in messages."""
UNITS = {each.key or each.words.replace(" ", "_"): each for each in _UNITS if each.size}
"""The units that agents can have, by their names in mapping files."""
SYMBOLS = {each.symbol: each for each in _UNITS}
"""The units of messages, by their symbols."""


def units_of(*kinds: str) -> list[str]:
    """Return the units of some kinds; the first of a kind is the usual one in messages."""
    return [name for name, each in UNITS.items() if each.kind in kinds]


def conversion(of_message: str, of_agent: str) -> LinearConversion:
    """Return the conversion from one unit to another of the same kind."""
    here, there = UNITS[of_message], UNITS[of_agent]
    return LinearConversion(here.size / there.size, (here.zero - there.zero) / there.size)


@dataclass(frozen=True, slots=True)
class Conversion:
    """The conversion of a value between message and agent.

    Attributes:
        kind: ``yaw``, ``pitch``, ``roll``, ``name``, ``atom``, ``object``, ``count``, ``min``, ``max``, ``mean`` or
            "".
        names: atoms for values.
        unit: the agent's unit, for the manual; empty if none is given.
        line: the linear conversion of units, scale and offset; None if the number stays unchanged.
        digits: decimals; None: all.
        floor: integers, rounded down instead of to the nearest.
        least: replaces smaller numbers of the agent.
    """

    kind: str = ""
    names: tuple[tuple[object, str], ...] = ()
    line: LinearConversion | None = None
    digits: int | None = None
    unit: str = ""
    floor: bool = False
    least: float | None = None

    @property
    def needs_number(self) -> bool:
        """Whether only a number can be converted."""
        return (self.line, self.digits, self.least) != (None, None, None)


AS_IT_IS = Conversion()
"""No conversion."""


def _shares(node: YamlNode) -> tuple[float, ...]:
    if isinstance(node.value, list):
        found = tuple(item.number(0.0, 1.0) for item in node.sequence())
        if not found:
            node.wrong("`sample` is empty", "write the number of elements, or their positions: [0, 0.5, 1]")
        return found or (0.0,)
    count = node.whole(1, 1)
    return tuple(place / (count - 1) for place in range(count)) if count > 1 else (0.0,)


def _otherwise(node: YamlNode) -> float | FieldPath:
    if isinstance(node.value, str):
        return path_of(node)
    return node.number()


@dataclass(frozen=True, slots=True)
class FieldPart:
    """One entry of ``fields`` of a property: a path and a conversion.

    Attributes:
        shares: positions in a list at which values are sampled, 0 to 1; None: not a sample.
        otherwise: replacement for numbers that are not finite; None: none.
        name: name for the manual.
    """

    path: FieldPath
    place: FilePosition
    conversion: Conversion = AS_IT_IS
    shares: Annotated[tuple[float, ...] | None, entry(_shares, "sample")] = None
    otherwise: Annotated[float | FieldPath | None, entry(_otherwise)] = None
    name: Annotated[str, entry(YamlNode.text)] = ""

    @property
    def count(self) -> int:
        """Number of values that the field yields."""
        return 1 if self.shares is None else len(self.shares)


def value_names(fields: tuple[FieldPart, ...]) -> list[str]:
    """Return a word for each value of the fields."""
    return [
        field.name or "value" if field.shares is None else f"{field.name}{place + 1}"
        for field in fields
        for place in range(field.count)
    ]


def unlike(taken: tuple[str, ...], names: list[str]) -> list[str]:
    """Return the same names, with numbers appended to duplicates."""
    seen, found = set(taken), []
    for name in names:
        plain = "".join(c if c.isalnum() or c == "_" else "_" for c in name)
        wanted, number = plain, 2
        while wanted in seen or not wanted.isidentifier():
            wanted, number = f"{plain}{number}" if plain.isidentifier() else f"value{number}", number + 1
        seen.add(wanted)
        found.append(wanted)
    return found


def read_fields(node: YamlNode) -> tuple[FieldPart, ...]:
    """Read a list of fields."""
    return tuple(map(read_field, each_of(node)))


def read_field(node: YamlNode) -> FieldPart:
    """Read one field."""
    place = place_of(node)
    if not isinstance(node.value, dict):
        path = path_of(node, "write a path, or a mapping such as {path: pose.orientation, as: yaw}")
        return FieldPart(path, place, name=_name(path))
    if node.value and not any(key in FIELD for key in node.value):
        text = f"{node.what} has no `path`, and `{next(iter(node.value))}` is not a key"
        node.wrong(text, "write a list of paths, or of mappings such as {path: pose.position.x, name: x}")
        return FieldPart(WHOLE, place)
    entries = node.mapping(*FIELD, required=("path",))
    path = path_of(entries["path"]) if "path" in entries else WHOLE
    part = FieldPart(path, place, read_conversion(entries), name=_name(path, entries))
    return with_entries(part, entries)


def _name(path: FieldPath, entries: dict[str, YamlNode] | None = None) -> str:
    """Return a word for a value, for the manual."""
    kind = entries["as"].value if entries is not None and "as" in entries else ""
    if kind in (*ANGLES, "count", "object"):
        return str(kind)
    names = [step[1:] for step in path.steps if isinstance(step, str) and step.startswith(".")]
    return names[-1] if names else "value"


def read_conversion(entries: dict[str, YamlNode]) -> Conversion:
    """Read the keys that fields of properties and values of operations share."""
    kind = entries["as"].choice(*KINDS) if "as" in entries else ""
    digits, unit = entries.get("round"), entries.get("unit")
    return Conversion(
        kind,
        _names(entries["names"]) if "names" in entries else (),
        _line(entries, kind),
        _digits(digits) if digits is not None else None,
        str(unit.value) if unit is not None and isinstance(unit.value, str) and unit.value in UNITS else "",
        digits is not None and digits.value == DOWN,
        entries["least"].number() if "least" in entries else None,
    )


def _digits(node: YamlNode) -> int:
    return 0 if node.value == DOWN else node.whole(0, 0)


def _names(node: YamlNode) -> tuple[tuple[object, str], ...]:
    found = []
    for key, value in node.entries():
        if not isinstance(value.value, str):
            text = f"the name of {key.value!r} must be a word, found {shown(value.value)}"
            value.wrong(text, "write a word")
            continue
        found.append((key.value, str(value.value)))
    return tuple(found)


def _line(entries: dict[str, YamlNode], kind: str) -> LinearConversion | None:
    steps = [
        _units(entries, kind),
        LinearConversion(_factor(entries["scale"])) if "scale" in entries else None,
        LinearConversion(1.0, entries["offset"].number()) if "offset" in entries else None,
    ]
    there = [step for step in steps if step is not None]
    return reduce(LinearConversion.then, there) if there else None


def _factor(node: YamlNode) -> float:
    factor = node.number(default=1.0)
    if factor == 0.0:
        node.wrong("`scale` is 0, which removes the value", "write another number")
        return 1.0
    return factor


def _units(entries: dict[str, YamlNode], kind: str) -> LinearConversion | None:
    if "unit" not in entries or (wanted := _unit(entries["unit"])) is None:
        return None
    asked = UNITS[wanted].kind
    if kind in ANGLES and asked != "angle":
        text = f"`as: {kind}` makes an angle, but {wanted} is a unit of {asked}"
        entries["unit"].wrong(text, f"units of angle are {', '.join(units_of('angle'))}")
        return None
    return conversion(units_of(asked)[0], wanted)


def _unit(node: YamlNode) -> str | None:
    if isinstance(node.value, str) and node.value in UNITS:
        return str(node.value)
    meant, listed = suggestion(str(node.value), UNITS), ", ".join(UNITS)
    help = f"{meant} Units: {listed}" if meant else f"units: {listed}"
    node.wrong(f"unknown unit {shown(node.value)}", help)
    return None


def constant(node: YamlNode, expected: str = "a number, a text or a list", help: str = "") -> object:
    """Read a constant: a number, truth value, text, or a list of them."""
    value = node.value
    if isinstance(value, list):
        return [constant(item, expected, help) for item in node.sequence()]
    if isinstance(value, bool):
        return value
    for kind in (int, float, str):
        if isinstance(value, kind):
            return kind(value)
    node.wrong(f"{node.what} must be {expected}, found {shown(value)}", help)
    return 0


# Names and types.

UNNAMED = "unnamed"
"""Replaces an invalid name."""

RESERVED = ("true", "false", "not", "div", "mod", "if", "else", "elif", "for", "while")
"""Words with another meaning in agent programs."""

_BELIEF = re.compile(r"[a-z][A-Za-z0-9_]*")
_ROS = re.compile(r"[~/]?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")
_GLUED = re.compile(r"([a-z_]+):(\S+)")
_TYPE = re.compile(r"[a-z]\w*/(msg/)?[A-Z]\w*")
NAMESPACE = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*/?")
_KINDS: dict[str, tuple[Callable[[str], str], str, str]] = {
    "msg": (message_type, "messages", "nav_msgs/msg/Odometry"),
    "srv": (service_type, "a service", "std_srvs/srv/Trigger"),
    "action": (action_type, "an action", "nav2_msgs/action/NavigateToPose"),
}
"""Kinds of types: how one is read, what it is the type of, and an example."""


def belief_name(node: YamlNode) -> str:
    """Read the name of a property, signal or operation."""
    if not isinstance(node.value, str) or not _BELIEF.fullmatch(node.value):
        if isinstance(node.value, bool):
            text = f"{str(node.value).lower()} is not a valid name in agent programs"
            node.wrong(text, "write another name")
            return UNNAMED
        near = re.sub(r"\W", "_", str(node.value)).lstrip("_0123456789")
        help = f"write {near[0].lower()}{near[1:]}" if near else "begin with a lower-case letter"
        node.wrong(f"{shown(node.value)} is not a valid name in agent programs", help)
        return UNNAMED
    if node.value in RESERVED:
        text = f"`{node.value}` is a reserved word in agent programs"
        node.wrong(text, f"write {node.value}_value or another name")
        return UNNAMED
    return str(node.value)


def ros_name(node: YamlNode) -> Written:
    """Read the name of a topic, service, action or node."""
    value = node.value
    if not isinstance(value, str) or not _ROS.fullmatch(value):
        glued = _GLUED.fullmatch(value) if isinstance(value, str) else None
        help = f"write a space after the colon: {glued[1]}: {glued[2]}" if glued else ""
        node.wrong(f"{shown(value)} is not a ROS name", help or "write it like cmd_vel or /robot/cmd_vel")
        return Written("unnamed", place_of(node))
    return Written(str(value), place_of(node))


def read_namespace(node: YamlNode) -> str:
    """Read a namespace; empty if none exists."""
    value = node.value
    if value in (None, "", "/"):
        return ""
    if not isinstance(value, str) or not NAMESPACE.fullmatch(value):
        node.wrong(f"{shown(value)} is not a ROS namespace", "write it like r1 or fleet/r1")
        return ""
    return str(value).strip("/")


def type_of(kind: str) -> FieldSpec:
    """Return the entry of a type; *kind* is ``msg``, ``srv`` or ``action``."""
    return entry(lambda node: type_written(node, kind), "type")


def type_written(node: YamlNode, kind: str) -> Written | None:
    """Read a type in full form. None after a mistake."""
    full = _full_type(node.value, kind)
    if full is None:
        node.wrong(*_wrong_type(node.value, kind))
        return None
    return Written(full, place_of(node))


def _full_type(value: object, kind: str) -> str | None:
    try:
        full = _KINDS[kind][0](value) if isinstance(value, str) else None
    except NameInvalid:
        return None
    return full if full is not None and full.split("/")[1] == kind else None


def _wrong_type(value: object, kind: str) -> tuple[str, str]:
    _, of, example = _KINDS[kind]
    for other, (_, of_other, _) in _KINDS.items():
        if other != kind and isinstance(value, str) and value.count("/") == 2 and _full_type(value, other):
            return f"{value} is the type of {of_other}, not of {of}", f"write a type such as {example}"
    slashed = value.replace(".", "/").replace("::", "/") if isinstance(value, str) else ""
    near = slashed if slashed and _full_type(slashed, kind) else f"it like {example}"
    return f"{shown(value)} is not a type of {of}", f"write {near}"


def is_type(value: object) -> bool:
    """Return whether a value has the form of a message type, and not that of a usual topic."""
    return isinstance(value, str) and _TYPE.fullmatch(value) is not None
