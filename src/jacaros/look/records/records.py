"""The schema of records: every kind that a run writes, its fields and their types.

Writers create these structs, readers decode into them, and ``docs/reference/recordings.md`` and the live page get their
tables from here: the docstring of a kind is its row in the reference.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, ClassVar

from msgspec import Meta, Struct, ValidationError, convert, defstruct, field, to_builtins

from jacaros.robots.world.data.ground_truth import FIELDS

VERSION = 2
"""Version of the written format; known records of newer versions are read, too."""

Data = Mapping[str, Any]
"""The data of an event as plain JSON data."""
Record = tuple[float, str, Data]
"""``t`` in seconds since the run began, the kind of the event and its data."""
FiniteNumber = Annotated[float, Meta(gt=-1e15, lt=1e15)]
"""A number that pages and pictures can scale."""
Id = int | str | None
Maybe = str | None
"""A text that may be missing."""

# ---- lines of a recording, told apart by their field ``kind``


class RecordingLine(Struct, tag_field="kind", tag=lambda name: name.removesuffix("Line").lower()):
    """A line of a recording."""


class WorldLine(RecordingLine, kw_only=True, omit_defaults=True):
    """The drawing of the world, see `WorldDescription.drawing`; *part* counts the files of a long recording."""

    version: int = 1
    part: int = 1
    world: dict[str, Any]


class Frame(RecordingLine):
    """The robots at a time, each a `jacaros.robots.world.ground_truth.RobotState`."""

    t: FiniteNumber
    robots: Sequence[Any]


class TextLine(RecordingLine):
    """A line of an agent's output."""

    t: FiniteNumber
    agent: str
    text: str


class EventLine(RecordingLine):
    """An event of a kind that `EVENTS` describes."""

    t: FiniteNumber
    event: str
    data: Data


AnyLine = WorldLine | Frame | TextLine | EventLine


# ---- data of events


class EventRecord(Struct, omit_defaults=True):
    """The data of an event; its ``kind`` is the name of the class without ``Record``."""

    kind: ClassVar[str]

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls.kind = cls.__name__.removesuffix("Record").lower()

    def plain(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return to_builtins(self)  # type: ignore[no-any-return]


RecordSink = Callable[[EventRecord], None]
"""Takes the events of a run."""


class RunRecord(EventRecord, omit_defaults=False):
    """once, at the start: `name`; `clock` (`real`, `fast`, `ros`); `ros` (`memory`, `ros1`, ...); `seed`; `jacaros`, the
    version
    """

    name: Maybe = None
    clock: Maybe = None
    ros: Maybe = None
    seed: int | None = None
    jacaros: Maybe = None


class SourceRecord(EventRecord):
    """`file`, `text`: a file of AgentSpeak; once, and again after a reload"""

    file: str
    text: str


class LogRecord(EventRecord):
    """`level` (`info`, `warning`, `error`), `text`"""

    level: str
    text: str


class MemberRecord(EventRecord):
    """of a fleet: `member`, a system; `state` (`self`: the recorded system; `joined`; `lost`: it does not answer; `left`);
    `agents` and `workspaces`, lists of names; `delay` there and back and `offset` by which its clock is ahead, in seconds;
    `page`: the address of its live page, without the token. Repeated when something of it has changed
    """

    member: str
    state: str
    agents: Sequence[str] = ()
    workspaces: Sequence[str] = ()
    delay: float | None = None
    offset: float = 0.0
    page: str = ""


class EndedRecord(EventRecord):
    """`code`: the exit code"""

    code: int | None = None


class AgentRecord(EventRecord):
    """`agent`; `what` (`asl`, `python`); `state` (`began`, `ended`)"""

    agent: str
    state: str
    what: Maybe = None


class PlanRecord(Struct):
    """A plan of a program."""

    id: Id
    trigger: str
    label: Maybe = None
    context: Maybe = None
    file: Maybe = None
    line: int | None = None
    end: int | None = None


class ThresholdRecord(Struct, omit_defaults=True):
    """A comparison of a belief's argument with a number, or with the argument of another belief."""

    belief: str
    argument: int
    operator: str
    value: float | None = None
    other: Maybe = None
    other_argument: int = 0
    plan: Id = None
    rule: Maybe = None


class ProgramRecord(EventRecord):
    """`agent`; `plans`: a list of `id`, `label`, `trigger`, `context` (text, empty without one), `file`, `line`, `end`
    (last line); `rules`: a list of texts; `thresholds`: a list of comparisons in conditions: `belief`, its name;
    `argument`, counted from 0; `operator`; `value`, a number, or `other` and `other_argument` (0 if missing), a belief;
    `plan`, an `id`, or `rule`, a name. Repeated when its plans change
    """

    agent: str
    plans: Sequence[PlanRecord] | None
    rules: Sequence[str] | None = None
    thresholds: Sequence[ThresholdRecord] = ()


class BeliefRecord(EventRecord):
    """`agent`; `op` (`+`, `-`); `belief`, with its annotations, as text; `cause`, or `intention`, `file` and `line` of the
    step that changed it; neither for an initial belief
    """

    agent: str
    op: str
    belief: str
    cause: int | None = None
    intention: Id = None
    file: Maybe = None
    line: int | None = None


class GoalRecord(EventRecord):
    """`agent`; `goal`; `state`: `pursued`, `suspended`, `resumed`, `achieved`, `failed`, `recovered`, `dropped` or
    `replaced` (by a tail call); `id` tells goals apart; `intention`; for a failure, `why`, in lines
    """

    agent: str
    goal: str
    state: str
    id: Id = None
    intention: Id = None
    why: Maybe = None


class OptionRecord(Struct):
    """A relevant plan that came before the chosen one, and why it did not apply."""

    plan: Id
    why: Maybe = None


class DeliberationRecord(EventRecord, omit_defaults=False):
    """of a goal, or of an event that has a plan: `id`, also that of its link; `parent`; `agent`; `trigger`, such as
    `+battery(12)` or `+!go(dock)`, as text; `intention` (null for an external event); `chosen`: the plan, or null;
    `options`: a list of `plan` and `why`, for each relevant plan that came before the chosen one: why its context does not
    hold, such as ``stops at `B > L` with B=12, L=20`` (`""`: it is applicable, too; a busy agent examines ten plans per
    second and omits the others); `untried`: the plans after the chosen one
    """

    id: int
    agent: str
    trigger: str
    parent: int | None = None
    intention: Id = None
    chosen: Id = None
    options: Sequence[OptionRecord] | None = None
    untried: Sequence[Id] | None = None


class StackedGoal(Struct):
    """A goal on a stack, with the current step of its plan."""

    goal: str
    plan: Id = None
    file: Maybe = None
    line: int | None = None
    step: Maybe = None


class IntentionRecord(EventRecord):
    """`agent`; `id`; `state` (`runs`, `waits`, `suspended`, `over`); `stack`: the goals from the bottom up, each with
    `goal`, `plan`, `file`, `line`, `step` (text of the current step); `waits`: the reason for waiting, in words; `since`;
    `reason` of the suspension; `urgency`; `cause`. At most ten times per second, and only for lasting intentions
    """

    agent: str
    id: Id
    state: str
    stack: Sequence[StackedGoal] | None = None
    waits: Maybe = None
    since: float | None = None
    reason: Maybe = None
    urgency: int | None = None
    cause: int | None = None


class MessageRecord(EventRecord, omit_defaults=False):
    """`id`, also that of its link; `from`, `to`, `performative`, `content`; `reply_to`: the `id` of the question that it
    answers, or null; `state` (`sent`, `read`); `cause` of the sending
    """

    id: Id
    sender: str = field(name="from")
    receiver: str = field(name="to")
    performative: str
    content: str
    reply_to: Id = None
    state: Maybe = None
    cause: int | None = None


class ArtifactRecord(EventRecord, omit_defaults=False):
    """`artifact`, its path; `type`; `state` (`made`, `disposed`); `robot`: the robot that it drives or senses, or null"""

    artifact: str
    type: Maybe = None
    state: Maybe = None
    robot: Maybe = None


class FocusRecord(EventRecord):
    """`agent`, `artifact`, `on`"""

    agent: str
    artifact: str
    on: bool


class PropertyRecord(EventRecord, omit_defaults=False):
    """`artifact`, `name`, `key` (tells properties of one name apart), `values` (a list; null when the property is removed),
    `cause`. At most two values per second for a property that changes continuously
    """

    artifact: str
    name: str
    key: Id = None
    values: Sequence[Any] | None = None
    cause: int | None = None


class SignalRecord(EventRecord, omit_defaults=False):
    """`artifact`, `signal` as text, `cause`"""

    artifact: str
    signal: str
    cause: int | None = None


class OperationRecord(EventRecord):
    """`id`; `artifact`; `operation` as text; `agent`; `state` (`began`, `done`, `failed`); `reason` of a failure
    (`cancelled` when its intention was dropped), and `term`, the plans' `env_failure_reason`; `outputs`: the values of its
    output parameters when it is done, as texts; `cause`
    """

    id: int
    artifact: str
    operation: str
    state: str
    agent: Maybe = None
    cause: int | None = None
    reason: Maybe = None
    term: Maybe = None
    outputs: Sequence[Maybe] | None = None


class ResourceRecord(EventRecord, omit_defaults=False):
    """`resource`; `holder`: the plan or operation that has it now, such as `[robot] !go(dock)`, or null when it is free"""

    resource: str
    holder: Maybe = None


class CauseRecord(EventRecord):
    """`id`, `parent`, `kind`, `what`, `at` (seconds), and if known, `agent`, `intention`, `plan`, `file`, `line`,
    `artifact`, `topic`
    """

    id: int
    sort: str = field(name="kind")
    what: str
    parent: int | None = None
    at: float | None = None
    agent: Maybe = None
    intention: Id = None
    plan: Id = None
    file: Maybe = None
    line: int | None = None
    artifact: Maybe = None
    topic: Maybe = None


class LaserRecord(EventRecord):
    """`robot`; `from`, `step` (radians, from the robot's heading); `ranges` in centimetres, integers, 0 for no echo"""

    robot: str
    first: float = field(name="from")
    step: float
    ranges: Sequence[int]


class PathRecord(EventRecord):
    """`robot`, `points`: the planned path, empty if none"""

    robot: str
    points: Sequence[tuple[FiniteNumber, FiniteNumber]]


class BelievedRecord(EventRecord, omit_defaults=False):
    """`robot`, `x`, `y`, `yaw`: the pose from localisation. In the embedded world only while it is more than 5 cm or 5
    degrees off, then once with null
    """

    robot: str
    x: FiniteNumber | None = None
    y: FiniteNumber | None = None
    yaw: FiniteNumber | None = None


class TopicRecord(Struct):
    """A topic of the graph."""

    name: str
    type: str
    publishers: int
    subscribers: int
    ours: str
    rate: float


class GraphRecord(EventRecord):
    """`node`; `topics`: a list of `name`, `type`, `publishers`, `subscribers`, `ours` (used by the run: `in`, `out`, or
    `""`), and for these `rate` in Hz
    """

    node: str
    topics: Sequence[TopicRecord]


class DebugRecord(EventRecord):
    """`state` (`paused`, `running`), `why` (such as `breakpoint patrol.asl:14`), `speed` (0 for the virtual clock),
    `cannot`: a list of things that a pause does not stop; `agent`, `intention`, `file` and `line` of the step before which
    an agent is held (`""` and 0 if none), or the `event`; `breakpoints`, a list of `line`, `plan`, `event` or `condition`
    with their parameters
    """

    state: str
    why: Maybe = None
    speed: float | None = None
    cannot: Sequence[str] | None = None
    agent: Maybe = None
    event: Maybe = None
    file: Maybe = None
    line: int | None = None
    intention: Id = None
    breakpoints: Sequence[dict[str, Any]] | None = None


class InterventionRecord(EventRecord):
    """`what`: your change from the page, as text"""

    what: str


_OF_WORLD: Mapping[str, Any] = {
    **dict.fromkeys(("x", "y", "yaw", "radius", "vx", "vy", "level", "grams", "percent"), FiniteNumber),
    **dict.fromkeys(
        ("dock", "door", "object", "obstacle", "person", "room", "dirt", "task", "fault", "state"), str
    ),
    "path": Sequence[tuple[FiniteNumber, FiniteNumber]],
}
"""Types of the data of the world's events; of others, any."""
EVENTS: Mapping[str, type[Struct]] = {
    **{each.kind: each for each in EventRecord.__subclasses__()},
    **{
        kind: defstruct(kind, [(name, _OF_WORLD.get(name, Any)) for name in names])
        for kind, names in FIELDS.items()
    },
}
"""The kinds of events, those of the world included."""


def decoded(kind: str, data: object) -> Any:
    """Return the data of an event as a struct; None for an unknown kind.

    Raises:
        ValidationError: a field is missing, or has another type.
    """
    known = EVENTS.get(kind)
    return None if known is None else convert(data, known)


def is_well_formed(kind: str, data: object) -> bool:
    """Return whether an event has the fields that its kind needs. Events of other kinds need only be mappings."""
    try:
        return decoded(kind, data) is not None or isinstance(data, Mapping)
    except ValidationError:
        return False
