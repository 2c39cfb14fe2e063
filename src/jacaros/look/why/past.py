"""The records of a run until a moment, indexed by what they concern."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeVar

from msgspec import ValidationError

from jacaros.look.records import records
from jacaros.look.records.records import Data, EventRecord, decoded
from jacaros.look.why.explanation import seconds
from jacaros.robots.world.data.ground_truth import FIELDS

T = TypeVar("T", bound=Any)
Happened = tuple[float, str, Data | EventRecord | None]
"""``t``, the kind of an event and its data, plain or decoded; None for those that are not needed."""
UNASKED = frozenset({"laser", "path", "property", "graph"})
"""Kinds of events that no question needs."""
TimedRecords = list[tuple[float, T]]
"""Records with their times, the oldest first."""
AT_ONCE = 0.2
"""Seconds within which events and changes count as simultaneous."""

CONDITION = "the condition "
"""Beginning of the recorded reason for waiting for a condition."""


class ChainLink(NamedTuple):
    """A link of a causal chain: its time, its record of a cause, and for an event or a message its own record."""

    t: float
    cause: records.CauseRecord
    of: records.DeliberationRecord | records.MessageRecord | None = None


SUCCEEDED = ("achieved", "done", "happened")
OPEN = ("pursued", "suspended", "began")


class Deed(NamedTuple):
    """Something that happened.

    Attributes:
        kind: ``operation``, ``goal``, ``event``, ``belief`` or ``world``.
        text: as recorded, such as ``driveTo(1,1)``.
        began, ended: seconds; *ended* is None while it lasts.
        state: its newest recorded state; ``cancelled`` for an operation whose intention was dropped.
        why: the reason of a failure, in lines.
        link: number of its link in causal chains, if it has one.
        artifact, end: artifact of an operation, and the record of its end.
    """

    kind: str
    text: str
    began: float
    agent: str = ""
    state: str = "happened"
    ended: float | None = None
    why: str = ""
    link: Any = None
    artifact: str = ""
    end: records.OperationRecord | None = None

    @property
    def at(self) -> float:
        """When it ended, or if it lasts, when it began."""
        return self.began if self.ended is None else self.ended

    @property
    def outcome(self) -> str:
        """How and when it ended, as text."""
        if self.state in OPEN:
            return "is suspended" if self.state == "suspended" else "has not ended"
        if self.ended is None:
            return f"happened at {seconds(self.began)}"
        why = self.why.partition("\n")[0]
        if why == "cancelled":
            return f"was cancelled at {seconds(self.ended)}"
        how = {
            "failed": "failed",
            "recovered": "failed and recovered",
            "replaced": "was replaced by its last step",
        }.get(self.state, f"was {self.state}")
        return f"{how} at {seconds(self.ended)}{f': {why}' if why else ''}"


@dataclass
class Past:
    """The records of a run until a moment.

    Attributes:
        end: seconds of the last record.
        links: the links of causal chains by id.
        deliberations, beliefs, goals: with their times, the oldest first.
        programs: the plans of each agent by id, as in the newest ``program``.
        rules: the rules of each agent as text.
        intentions: the newest record of each, by agent and id.
        waits: goals that began to wait for a condition, as (t, agent, goal, condition).
        operations: by id.
        agents: their newest state by name.
        began: when each agent began, in seconds.
        robots_of: the robots that artifacts drive or sense, by path.
        sources: texts of the programs by file.
        world: events of robots and the world, as (t, event, robot), the oldest first.
        robots: names of robots that appear in records.
        ros: the ROS graph of the run.
        debug: the newest record of the debugger.
        misplaced: where robots in the embedded world wrongly believed to be, as (t, robot, place); no place if right.
        exit_code: exit code of the run; None if it had not ended.
    """

    end: float = 0.0
    links: dict[Any, ChainLink] = field(default_factory=dict)
    deliberations: TimedRecords[records.DeliberationRecord] = field(default_factory=list)
    beliefs: TimedRecords[records.BeliefRecord] = field(default_factory=list)
    goals: TimedRecords[records.GoalRecord] = field(default_factory=list)
    programs: dict[str, dict[Any, records.PlanRecord]] = field(default_factory=dict)
    rules: dict[str, list[str]] = field(default_factory=dict)
    intentions: dict[tuple[str, Any], tuple[float, records.IntentionRecord]] = field(default_factory=dict)
    waits: list[tuple[float, str, str, str]] = field(default_factory=list)
    operations: dict[Any, Deed] = field(default_factory=dict)
    agents: dict[str, tuple[float, str]] = field(default_factory=dict)
    began: dict[str, float] = field(default_factory=dict)
    robots_of: dict[str, str] = field(default_factory=dict)
    sources: dict[str, list[str]] = field(default_factory=dict)
    world: list[tuple[float, str, str]] = field(default_factory=list)
    robots: set[str] = field(default_factory=set)
    misplaced: list[tuple[float, str, str]] = field(default_factory=list)
    ros: str = ""
    debug: records.DebugRecord | None = None
    exit_code: int | None = None

    @classmethod
    def of(cls, happened: Iterable[Happened], until: float | None = None) -> "Past":
        """Read records. Those after *until* (seconds), of unknown kinds or malformed are skipped."""
        past = cls()
        for t, event, data in happened:
            if until is not None and t > until:
                continue
            past.end = max(past.end, t)
            if isinstance(data, EventRecord):
                past._take(t, data)
                continue
            if not isinstance(data, Mapping):
                continue
            try:
                past._take(t, None if event in FIELDS else decoded(event, data))
            except ValidationError:
                continue
            if isinstance(robot := data.get("robot"), str) and event not in _WITH_ROBOT:
                past.world.append((t, event, robot))
                past.robots.add(robot)
        return past

    def _take(self, t: float, data: Any) -> None:
        match data:
            case records.BeliefRecord():  # most records are of this kind
                self.beliefs.append((t, data))
            case records.CauseRecord():
                known = self.links.get(data.id)
                at = t if data.at is None else data.at
                # The record of a deliberation or an operation has more details than its link.
                self.links[data.id] = ChainLink(at, data) if known is None else known._replace(t=at)
            case records.DeliberationRecord():
                self.deliberations.append((t, data))
                cause = _cause(data.id, "event", data.trigger, data.parent, data.agent)
                known = self.links.get(data.id)
                self.links[data.id] = ChainLink(t if known is None else known.t, cause, data)
            case records.OperationRecord():
                self._take_operation(t, data)
            case records.MessageRecord(id=int(number)) if number not in self.links:
                self.links[number] = ChainLink(t, _cause(number, "message", data.content, data.cause), data)
            case records.RunRecord():
                self.ros = data.ros or ""
            case records.BelievedRecord() if self.ros == "memory":
                is_right = data.x is None or data.y is None
                where = "" if is_right else f"({data.x:.2f}, {data.y:.2f})"
                self.misplaced.append((t, data.robot, where))
            case _:
                self._take_state(t, data)

    def _take_state(self, t: float, data: Any) -> None:
        match data:
            case records.ProgramRecord():
                self.programs[data.agent] = {each.id: each for each in data.plans or ()}
                self.rules[data.agent] = list(data.rules or ())
            case records.IntentionRecord(state="over"):
                self.intentions.pop((data.agent, data.id), None)
            case records.IntentionRecord():
                self.intentions[data.agent, data.id] = t, data
                if data.stack and (condition := awaited(data)):
                    self.waits.append((t, data.agent, data.stack[-1].goal, condition))
            case records.AgentRecord():
                self.agents[data.agent] = t, data.state
                self.began.setdefault(data.agent, t)
                if data.state == "ended":
                    self.intentions = {
                        at: each for at, each in self.intentions.items() if at[0] != data.agent
                    }
            case records.SourceRecord():
                self.sources[data.file] = data.text.split("\n")
            case records.ArtifactRecord(robot=str(robot)):  # the record of a disposed artifact has no robot
                self.robots_of[data.artifact] = robot
                self.robots.add(robot)
            case records.DebugRecord():
                self.debug = data
            case records.EndedRecord():
                self.exit_code = data.code
            case records.GoalRecord():
                self.goals.append((t, data))

    def _take_operation(self, t: float, data: records.OperationRecord) -> None:
        deed = Deed(
            "operation", data.operation, t, data.agent or "", "began", None, "", data.id, data.artifact
        )
        if data.state != "began":
            known = self.operations.get(data.id, deed)
            deed = known._replace(state=data.state, ended=t, why=data.reason or "", end=data)
        elif data.id not in self.links:
            cause = _cause(data.id, "operation", data.operation, data.cause, data.agent)
            cause.artifact = data.artifact
            self.links[data.id] = ChainLink(t, cause)
        self.operations[data.id] = deed

    def plan(self, agent: str | None, plan: Any) -> records.PlanRecord | None:
        """Return a plan of an agent; None if it is unknown."""
        return self.programs.get(agent or "", {}).get(plan)

    def plans(self, agent: str = "") -> Iterator[tuple[str, records.PlanRecord]]:
        """Iterate over all plans with their agents, or the plans of *agent*."""
        for name, plans in self.programs.items():
            if agent in ("", name):
                for each in plans.values():
                    yield name, each

    def chain(self, number: Any) -> Iterator[ChainLink]:
        """Iterate over the links from one back to the beginning of its chain."""
        seen = set()
        while number in self.links and number not in seen:
            seen.add(number)
            yield self.links[number]
            number = self.links[number].cause.parent


def of_agent(timed: TimedRecords[T], agent: str) -> TimedRecords[T]:
    """Return the records of one agent; all if *agent* is empty."""
    return [each for each in timed if agent in ("", each[1].agent)]


def _cause(
    number: Any, sort: str, what: str, parent: int | None, agent: str | None = None
) -> records.CauseRecord:
    return records.CauseRecord(number, sort, what, parent or 0, agent=agent)


def awaited(data: records.IntentionRecord) -> str:
    """Return the condition that an intention waits for; empty if it waits for anything else."""
    return data.waits.removeprefix(CONDITION) if data.waits and data.waits.startswith(CONDITION) else ""


_WITH_ROBOT = frozenset({"laser", "path", "believed", "artifact"})
"""Records that name a robot but are not events."""
