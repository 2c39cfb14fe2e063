"""What a mapping file declares, as plain data with places; nothing here knows yet whether types and fields exist."""

from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path as FilePath
from typing import NamedTuple

from jacaros.artifacts.kit.reading import ReadingPolicy
from jacaros.artifacts.mapping.paths import Path
from jacaros.artifacts.mapping.units import Line
from jacaros.env.resources.resource import Use
from jacaros.ros.parameter import Declaration
from jacaros.ros.qos import QoS
from jacaros.streams.schema import OCCURRENCE, Spec
from jacaros.yaml_nodes import Problem, YamlFileError

ALWAYS = ReadingPolicy()
"""Every change is told."""


class Place(NamedTuple):
    """A place in the file, counted from 1."""

    line: int
    column: int

    def problem(self, message: str, help: str = "") -> Problem:
        """A mistake here."""
        return Problem(self.line, self.column, message, help)


START = Place(1, 1)
"""The first character of the file."""


@dataclass(frozen=True, slots=True)
class Written:
    """A piece of text and its place."""

    text: str
    place: Place


NOTHING = Written("", START)


@dataclass(frozen=True, slots=True)
class Conversion:
    """What becomes of a value on its way between message and agent.

    Attributes:
        kind: ``yaw``, ``pitch``, ``roll``, ``name``, ``atom``, ``object``, ``count``, ``min``, ``max``, ``mean`` or "".
        prefix: with which the constants begin that ``name`` means.
        names: atoms for values.
        unit: the unit for the agent, for the manual; empty when none is said.
        knows_message_unit: the mapping says in which unit messages have it.
        line: of units, scale and offset; None when the number stays as it is.
        digits: decimals; None: as many as there are.
        floor: whole numbers, rounded down instead of to the nearest.
    """

    kind: str = ""
    prefix: str = ""
    names: tuple[tuple[object, str], ...] = ()
    line: Line | None = None
    digits: int | None = None
    unit: str = ""
    knows_message_unit: bool = False
    floor: bool = False


AS_IT_IS = Conversion()
"""No conversion."""


@dataclass(frozen=True, slots=True)
class FieldPart:
    """One entry of ``fields`` of a property: a path, and what becomes of it.

    Attributes:
        shares: where in a list values are taken, 0 to 1; None: not a sample.
        otherwise: in place of numbers that are not finite; None: there is nothing.
        dead_band: of this value; None: that of the property.
        name: for the manual.
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
        """How many values it gives."""
        return 1 if self.shares is None else len(self.shares)


@dataclass(frozen=True, slots=True)
class RangeOfView:
    """What is near enough to be shown.

    Attributes:
        metres: how far it may be.
        distance: path of the distance; empty when positions are given.
        at: paths of the position's coordinates x and y.
        origin: the property whose first values are the place that is counted from; None: the robot itself.
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
        topic: its name; None for feedback.
        type_name: of its messages; None: found at run time.
        fields: None: all of the message.
        each: the array of which each element has a property or signal of its own.
        key: tells which element is which; None: the first field.
        initial: values before the first message; None: there is no property then.
        when_changed: a signal is sent only for other values than before.
        frame: the only frame whose messages are shown; None: any.
        history: seconds for which agents that focus the artifact keep past values.
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
    history: float | None = None


@dataclass(frozen=True, slots=True)
class FramePart:
    """A property from tf.

    Attributes:
        target, source: frames, as written.
        fields: with paths of one step, ``x`` to ``stamp``.
        rate: looks a second.
        oldest: seconds that a transform may be old; None: any.
        history: as of a `TopicPart`.
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
    history: float | None = None


@dataclass(frozen=True, slots=True)
class ParameterPart:
    """A property from a parameter of a node.

    Attributes:
        node: whose it is; empty for our own.
        declaration: of a parameter of our own.
        rate: for middlewares that do not tell of changes.
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
    """A property or signal composed of events of others.

    Attributes:
        spec: the pattern; None after a mistake.
        sources: the properties and signals, as written.
        history: as of a `TopicPart`.
    """

    name: str
    place: Place
    spec: Spec | None
    sources: tuple[Written, ...]
    description: str = ""
    history: float | None = None

    @property
    def signal(self) -> bool:
        """Whether it is a signal."""
        return self.spec is not None and self.spec.gives == OCCURRENCE


class Source(StrEnum):
    """Where a value for a message comes from."""

    CONSTANT = "constant"
    PARAMETER = "parameter"
    NOW = "now"
    ELEMENTS = "elements"


@dataclass(frozen=True, slots=True)
class ValuePart:
    """A value for a field of a message.

    Attributes:
        target: path of the field; empty for the value of a node's parameter.
        source: what it comes from.
        value: of a constant.
        parameter: number of the operation's parameter; within `elements`, that of the element's part, -1 for all of it.
        elements: the values of each message in a list, of which `parameter` gives the elements.
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
    """The field of a response or result that tells whether it went well, and its value then."""

    path: Path
    place: Place
    value: object = True


class OperationKind(StrEnum):
    """What an operation does."""

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
        type_name: None: found at run time, or there is none.
        values: fields of the message, request or goal; the value of a parameter.
        other_values: the same for other versions of the type, tried one after the other when ``values`` does not fit.
        outputs: fields of the response or result that go to output parameters.
        success: None: a field ``success`` if there is one.
        any_success: nothing is looked at.
        duration: seconds of repeated publishing.
        at_end: fields of the last message; None: zero for velocities, else nothing.
        match_timeout: seconds to wait for a subscription before the first message; None: the artifact's option.
        unmatched: ``warn`` or ``fail`` when there is none; None: the artifact's option.
        node: whose parameter is set or given; empty for our own.
        properties: those that are refreshed or read.
        feedback: properties from the feedback.
        code: field of the result that is the Code of ``aborted(Code,Text)``; None: a field ``error_code`` if there is one.
        aborted: fields of the result that follow Code and Text.
        suspend: what a suspended intention means for the goal: ``go_on``, ``cancel``, or ``pause`` by two operations.
        pause, resume: names of these operations.
        uses: resources that it holds meanwhile; empty: those of a motion, if it is one.
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
    suspend: str = "cancel"
    pause: Written = NOTHING
    resume: Written = NOTHING
    node: str = ""
    properties: tuple[Written, ...] = ()
    description: str = ""
    uses: tuple[Use, ...] = ()


@dataclass(frozen=True, slots=True)
class ArtifactPart:
    """One artifact.

    Attributes:
        tf_prefix: None: the namespace.
        connected: whether it is shown that topics are connected; seconds: they are not when no message came for so long.
        topics: properties and signals from topics.
        derived: properties and signals composed of events of others.
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
        """Those from topics."""
        return tuple(part for part in self.topics if not part.signal)

    @property
    def histories(self) -> dict[str, float]:
        """The seconds for which past values of properties are kept, by name."""
        parts: tuple[TopicPart | FramePart | DerivedPart, ...] = (*self.topics, *self.frames, *self.derived)
        return {each.name: each.history for each in parts if each.history is not None}

    @property
    def signals(self) -> tuple[TopicPart, ...]:
        """All signals."""
        return tuple(part for part in self.topics if part.signal)


@dataclass(frozen=True, slots=True)
class MappingFile:
    """A whole file.

    Attributes:
        file: its name, as messages show it.
        text: for excerpts.
        artifacts: by name, in the order of the file.
    """

    file: str
    text: str = field(repr=False)
    artifacts: dict[str, ArtifactPart] = field(default_factory=dict)

    def where(self, place: Place) -> str:
        """A place for a line of the log."""
        return f"{self.file}:{place.line}"


class MappingError(YamlFileError):
    """A wrong mapping file, with all its mistakes."""
