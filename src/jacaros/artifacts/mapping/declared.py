"""The content of a mapping file, as plain data with positions. Whether types and fields exist is not known here."""

import re
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path as FilePath
from typing import Literal, NamedTuple

from jacaros.artifacts.streams import ReadingPolicy, Spec
from jacaros.files.yaml import Problem, YamlFileError
from jacaros.ros.parameter import Declaration
from jacaros.ros.qos import QoS

ALWAYS = ReadingPolicy()
"""Every change is published."""


class Place(NamedTuple):
    """A position in the file, counted from 1."""

    line: int
    column: int

    def problem(self, message: str, help: str = "") -> Problem:
        """Make a problem at this position."""
        return Problem(self.line, self.column, message, help)


START = Place(1, 1)
"""The first character of the file."""


@dataclass(frozen=True, slots=True)
class Written:
    """A text and its position."""

    text: str
    place: Place


NOTHING = Written("", START)

# Paths into messages: ``pose.pose.position.x``, ``ranges[0]``, ``transforms[*].child_frame_id``.

ALL = "*"
"""Stands for all elements of an array."""
HERE = "i"
"""Stands for the index of the current element, where there is one property for each."""

_PART = re.compile(r"(?P<name>[A-Za-z][A-Za-z0-9_]*)(?P<indices>(\[(-?\d+|\*|i)\])*)")
_INDEX = re.compile(r"\[(-?\d+|\*|i)\]")

Step = str | int
"""The name of a field, or the index of an element, ``"*"`` or ``"[i]"``."""


class WrongPath(ValueError):
    """Raised for an invalid path, with what to write."""

    def __init__(self, message: str, help: str = "") -> None:
        super().__init__(message)
        self.help = help


@dataclass(frozen=True, slots=True)
class Path:
    """A path.

    Attributes:
        text: as written.
        steps: names, numbers, `ALL` and `HERE`; names have a dot in front so that ``"*"`` is not a name.
        of_message: whether it begins at the message although its neighbours begin at an element.
    """

    text: str
    steps: tuple[Step, ...]
    of_message: bool = False

    @property
    def lists(self) -> int:
        """Nesting depth of lists caused by `ALL`."""
        return self.steps.count(ALL)


WHOLE = Path(".", ())


def read_path(text: str) -> Path:
    """Read a path.

    Raises:
        WrongPath: it is invalid.
    """
    of_message = text.startswith("/")
    rest = text.removeprefix("/")
    if rest in (".", ""):
        if not text:
            raise WrongPath("empty path", "write the path of a field, or . for the whole message")
        return Path(text, (), of_message)
    steps: list[Step] = []
    for part in rest.split("."):
        found = _PART.fullmatch(part)
        if found is None:
            raise WrongPath(
                f"`{text}` is not a path: `{part}` is not a field",
                "write it like pose.position.x or ranges[0]",
            )
        steps.append(f".{found['name']}")
        for index in _INDEX.findall(found["indices"]):
            steps.append(index if index in (ALL, HERE) else int(index))
    return Path(text, tuple(steps), of_message)


@dataclass(frozen=True, slots=True)
class Line:
    """``factor * value + shift``, from the message's number to the agent's."""

    factor: float = 1.0
    shift: float = 0.0

    def there(self, value: float) -> float:
        """Convert to the agent's number."""
        return self.factor * value + self.shift

    def back(self, value: float) -> float:
        """Convert to the message's number."""
        return (value - self.shift) / self.factor

    def then(self, other: "Line") -> "Line":
        """Return this conversion followed by *other*."""
        return Line(self.factor * other.factor, self.shift * other.factor + other.shift)


@dataclass(frozen=True, slots=True)
class Conversion:
    """The conversion of a value between message and agent.

    Attributes:
        kind: ``yaw``, ``pitch``, ``roll``, ``name``, ``atom``, ``object``, ``count``, ``min``, ``max``, ``mean`` or
            "".
        prefix: prefix of the constants for ``name``.
        names: atoms for values.
        unit: the agent's unit, for the manual; empty if none is given.
        knows_message_unit: whether the mapping gives the unit of the message.
        line: the linear conversion of units, scale and offset; None if the number stays unchanged.
        digits: decimals; None: all.
        floor: integers, rounded down instead of to the nearest.
    """

    kind: str = ""
    prefix: str = ""
    names: tuple[tuple[object, str], ...] = ()
    line: Line | None = None
    digits: int | None = None
    unit: str = ""
    knows_message_unit: bool = False
    floor: bool = False

    @property
    def needs_number(self) -> bool:
        """Whether only a number can be converted."""
        return self.line is not None or self.digits is not None


AS_IT_IS = Conversion()
"""No conversion."""


@dataclass(frozen=True, slots=True)
class FieldPart:
    """One entry of ``fields`` of a property: a path and a conversion.

    Attributes:
        shares: positions in a list at which values are sampled, 0 to 1; None: not a sample.
        otherwise: replacement for numbers that are not finite; None: none.
        dead_band: dead band of this value; None: that of the property.
        name: name for the manual.
    """

    path: Path
    place: Place
    conversion: Conversion = AS_IT_IS
    shares: tuple[float, ...] | None = None
    otherwise: float | Path | None = None
    dead_band: float | None = None
    name: str = ""

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


@dataclass(frozen=True, slots=True)
class RangeOfView:
    """The range within which elements are shown.

    Attributes:
        metres: maximum distance.
        distance: path of the distance; empty if positions are given.
        at: paths of the position's coordinates x and y.
        origin: the property whose first values are the origin; None: the robot itself.
    """

    metres: float
    place: Place
    distance: Path | None = None
    at: tuple[Path, ...] = ()
    origin: Written | None = None


@dataclass(frozen=True, slots=True)
class TopicPart:
    """A property or signal from a topic, or from the feedback of an action.

    Attributes:
        topic: name of the topic; None for feedback.
        type_name: message type; None: found at run time.
        fields: None: the whole message.
        each: the array whose elements each have a property or signal.
        key: identifies an element; None: the first field.
        initial: values before the first message; None: no property until then.
        when_changed: send a signal only if its values differ from the previous ones.
        frame: the only frame whose messages are shown; None: any.
    """

    name: str
    place: Place
    topic: Written | None
    type_name: Written | None = None
    fields: tuple[FieldPart, ...] | None = None
    each: Path | None = None
    each_place: Place = START
    key: FieldPart | None = None
    annotations: tuple[FieldPart, ...] = ()
    initial: tuple[object, ...] | None = None
    qos: QoS | None = None
    policy: ReadingPolicy = ALWAYS
    view: RangeOfView | None = None
    when_changed: bool = False
    frame: Written | None = None
    signal: bool = False
    description: str = ""


@dataclass(frozen=True, slots=True)
class FramePart:
    """A property from tf.

    Attributes:
        target, source: frames, as written.
        fields: have paths of one step, ``x`` to ``stamp``.
        rate: look-ups per second.
        oldest: maximum age of a transform, in seconds; None: any.
    """

    name: str
    place: Place
    target: str
    source: str
    fields: tuple[FieldPart, ...]
    annotations: tuple[FieldPart, ...] = ()
    rate: float = 10.0
    oldest: float | None = None
    policy: ReadingPolicy = ALWAYS
    description: str = ""


@dataclass(frozen=True, slots=True)
class ParameterPart:
    """A property from a parameter of a node.

    Attributes:
        node: the node; empty for our own.
        declaration: declaration of a parameter of our own.
        rate: polling rate for middlewares that do not report changes.
    """

    name: str
    place: Place
    node: str
    parameter: str
    declaration: Declaration | None = None
    field: FieldPart | None = None
    rate: float = 1.0
    policy: ReadingPolicy = ALWAYS
    description: str = ""


@dataclass(frozen=True, slots=True)
class DerivedPart:
    """A property derived from events of others.

    Attributes:
        spec: the pattern; None after a mistake.
        sources: the properties and signals, as written.
    """

    name: str
    place: Place
    spec: Spec | None
    sources: tuple[Written, ...]
    description: str = ""


class Source(StrEnum):
    """The source of a value for a message."""

    CONSTANT = "constant"
    PARAMETER = "parameter"
    NOW = "now"
    ELEMENTS = "elements"


@dataclass(frozen=True, slots=True)
class ValuePart:
    """A value for a field of a message.

    Attributes:
        target: path of the field; empty for the value of a node's parameter.
        source: kind of the source.
        value: value of a constant.
        parameter: number of the operation's parameter; within `elements`, number of the element's part, -1 for the
            whole element.
        elements: the values of each message in a list whose elements come from `parameter`.
    """

    target: Path
    place: Place
    source: Source = Source.CONSTANT
    value: object = None
    parameter: int = 0
    conversion: Conversion = AS_IT_IS
    elements: "tuple[ValuePart, ...]" = ()


@dataclass(frozen=True, slots=True)
class Success:
    """The field of a response or result that shows success, and its value then."""

    path: Path
    place: Place
    value: object = True


class OperationKind(StrEnum):
    """The kind of an operation."""

    PUBLISH = "publish"
    SERVICE = "service"
    ACTION = "action"
    SET = "set_parameter"
    GET = "get_parameter"
    REFRESH = "refresh"
    READ = "read"


@dataclass(frozen=True, slots=True)
class OperationPart:
    """An operation.

    Attributes:
        parameters: names of the inputs.
        target: topic, service, action or parameter of a node.
        type_name: None: found at run time, or not needed.
        values: fields of the message, request or goal; the value of a parameter.
        other_values: alternatives for other versions of the type, tried in turn if ``values`` does not match.
        outputs: fields of the response or result for the output parameters.
        success: None: a field ``success`` if there is one.
        any_success: success is not checked.
        duration: seconds of repeated publishing.
        at_end: fields of the last message; None: zero for velocities, else no message.
        match_timeout: seconds to wait for a subscriber before the first message; None: the artifact's option.
        unmatched: ``warn`` or ``fail`` without a subscriber; None: the artifact's option.
        node: the node whose parameter is set or read; empty for our own.
        properties: properties that are refreshed or read.
        feedback: properties from the feedback.
        code: field of the result that is the Code of ``aborted(Code,Text)``; None: a field ``error_code`` if there is
            one.
        aborted: fields of the result that follow Code and Text.
        suspend: effect of suspending the intention on the goal: ``go_on``, ``cancel``, or ``pause`` by two
            operations.
        pause, resume: names of these operations.
        uses: resources that it holds while it runs; empty: those of a motion, if it is one.
    """

    name: str
    place: Place
    kind: OperationKind
    parameters: tuple[str, ...] = ()
    target: Written = NOTHING
    type_name: Written | None = None
    values: tuple[ValuePart, ...] = ()
    other_values: tuple[tuple[ValuePart, ...], ...] = ()
    outputs: tuple[FieldPart, ...] = ()
    success: Success | None = None
    any_success: bool = False
    qos: QoS | None = None
    rate: float | None = None
    duration: ValuePart | None = None
    at_end: tuple[ValuePart, ...] | None = None
    match_timeout: float | None = None
    unmatched: str | None = None
    timeout: float | None = None
    feedback: tuple[TopicPart, ...] = ()
    code: FieldPart | None = None
    aborted: tuple[FieldPart, ...] = ()
    suspend: Literal["go_on", "cancel", "pause"] = "cancel"
    pause: Written = NOTHING
    resume: Written = NOTHING
    node: str = ""
    properties: tuple[Written, ...] = ()
    description: str = ""
    uses: tuple[str, ...] = ()

    @property
    def is_switch(self) -> bool:
        """Whether it can pause and resume goals of others: it sends a request and ends."""
        if self.kind is OperationKind.PUBLISH:
            return self.rate is None
        return self.kind in (OperationKind.SERVICE, OperationKind.SET)


@dataclass(frozen=True, slots=True)
class ArtifactPart:
    """One artifact.

    Attributes:
        tf_prefix: None: the namespace.
        connected: whether to show that topics are connected; a number: seconds without a message after which they are
            not.
        topics: properties and signals from topics.
        derived: properties derived from events of others.
        interfaces: folders with definitions of types.
    """

    name: str
    place: Place
    description: str = ""
    namespace: str = ""
    tf_prefix: str | None = None
    connected: bool | float = False
    topics: tuple[TopicPart, ...] = ()
    frames: tuple[FramePart, ...] = ()
    parameters: tuple[ParameterPart, ...] = ()
    operations: tuple[OperationPart, ...] = ()
    interfaces: tuple[FilePath, ...] = ()
    derived: tuple[DerivedPart, ...] = ()

    @property
    def properties(self) -> tuple[TopicPart, ...]:
        """Properties from topics."""
        return tuple(part for part in self.topics if not part.signal)

    @property
    def signals(self) -> tuple[TopicPart, ...]:
        """All signals."""
        return tuple(part for part in self.topics if part.signal)

    def arity(self, operation: OperationPart) -> int:
        """Return the number of arguments of an operation, including outputs."""
        return len(operation.parameters) + len(self.output_names(operation))

    def output_names(self, operation: OperationPart) -> list[str]:
        """Return names for the output parameters of an operation."""
        if operation.kind is not OperationKind.READ:
            return value_names(operation.outputs)
        wanted = operation.properties[0].text if operation.properties else ""
        fields = {each.name: each.fields or () for each in self.properties}
        fields |= {each.name: each.fields for each in self.frames}
        return value_names(fields.get(wanted, ()))


@dataclass(frozen=True, slots=True)
class MappingFile:
    """A complete file.

    Attributes:
        file: its name, as shown in messages.
        text: its text, for excerpts.
        artifacts: by name, in the order of the file.
    """

    file: str
    text: str = field(repr=False)
    artifacts: dict[str, ArtifactPart] = field(default_factory=dict)

    def where(self, place: Place) -> str:
        """Format a position for the log."""
        return f"{self.file}:{place.line}"


class MappingError(YamlFileError):
    """Raised for a mapping file with mistakes; holds all of them."""
