"""The records of a run until a moment, indexed by what they concern."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from jacaros.mas.history.well_formed import is_well_formed

Data = Mapping[str, Any]
"""The data of a record, see docs/reference/recordings.md."""
Record = tuple[float, str, Data]
"""``t`` in seconds since the run began, the event and its data."""


@dataclass(frozen=True, slots=True)
class Operation:
    """An operation of an artifact, and how it ended.

    Attributes:
        data: data of its beginning.
        began, ended: seconds; *ended* is None while it runs.
        outcome: ``done``, ``failed``, or empty while it runs.
        reason: reason of its failure.
        last: data of its end; empty while it runs.
    """

    data: Data
    began: float
    ended: float | None = None
    outcome: str = ""
    reason: str = ""
    last: Data = field(default_factory=dict)


@dataclass
class Past:
    """The records of a run until a moment.

    Attributes:
        end: seconds of the last record.
        links: causes by id: ``cause`` records, and deliberations, operations and messages under their own ids.
        deliberations, beliefs, goals, messages, properties: (t, data), the oldest first.
        programs: the plans of each agent by id, as in the newest ``program``.
        rules: the rules of each agent as text.
        intentions: the newest record of each, by agent and id.
        operations: by id.
        agents: their newest state by name.
        began: when each agent began, in seconds.
        artifacts: the newest record of each by path.
        sources: texts of the programs by file.
        world: events of robots and the world, as (t, event, data), the oldest first.
        robots: names of robots that appear in records.
        debug: the newest record of the debugger.
        exit_code: exit code of the run; None if it had not ended.
    """

    end: float = 0.0
    links: dict[int, tuple[float, Data]] = field(default_factory=dict)
    deliberations: list[tuple[float, Data]] = field(default_factory=list)
    beliefs: list[tuple[float, Data]] = field(default_factory=list)
    goals: list[tuple[float, Data]] = field(default_factory=list)
    messages: list[tuple[float, Data]] = field(default_factory=list)
    properties: list[tuple[float, Data]] = field(default_factory=list)
    programs: dict[str, dict[Any, Data]] = field(default_factory=dict)
    rules: dict[str, list[str]] = field(default_factory=dict)
    intentions: dict[tuple[str, Any], tuple[float, Data]] = field(default_factory=dict)
    operations: dict[Any, Operation] = field(default_factory=dict)
    agents: dict[str, tuple[float, str]] = field(default_factory=dict)
    began: dict[str, float] = field(default_factory=dict)
    artifacts: dict[str, Data] = field(default_factory=dict)
    sources: dict[str, list[str]] = field(default_factory=dict)
    world: list[Record] = field(default_factory=list)
    robots: set[str] = field(default_factory=set)
    debug: Data = field(default_factory=dict)
    exit_code: int | None = None

    @classmethod
    def of(cls, records: Iterable[Record], until: float | None = None) -> "Past":
        """Read records. Those after *until* (seconds), of unknown kinds or malformed are skipped."""
        past = cls()
        for t, event, data in records:
            if until is not None and t > until:
                continue
            past.end = max(past.end, t)
            if event in _SEEN_OFTEN or not is_well_formed(event, data):
                continue
            take = _TAKERS.get(event)
            if take is not None:
                take(past, t, data)
            elif isinstance(data.get("robot"), str):
                past.world.append((t, event, data))
                past.robots.add(data["robot"])
        return past

    def plan(self, agent: str, plan: Any) -> Data:
        """Return a plan of an agent; empty if it is unknown."""
        return self.programs.get(agent, {}).get(plan, {})

    def plans(self, agent: str = "") -> Iterator[tuple[str, Data]]:
        """Iterate over all plans with their agents, or the plans of *agent*."""
        for name, plans in self.programs.items():
            if agent in ("", name):
                for each in plans.values():
                    yield name, each

    def chain(self, number: Any) -> Iterator[tuple[float, Data]]:
        """Iterate over the links from one back to the beginning of its chain."""
        seen = set()
        while number in self.links and number not in seen:
            seen.add(number)
            yield self.links[number]
            number = self.links[number][1].get("parent", 0)


def of_agent(records: Iterable[tuple[float, Data]], agent: str) -> Iterator[tuple[float, Data]]:
    """Return the records of one agent; all if *agent* is empty."""
    return (each for each in records if agent in ("", each[1].get("agent")))


def _take_cause(past: Past, t: float, data: Data) -> None:
    known = past.links.get(data["id"])
    at = t if data.get("at") is None else data["at"]
    # The record of a deliberation or an operation has more details than its link.
    past.links[data["id"]] = (at, data) if known is None else (at, {**data, **known[1]})


def _take_deliberation(past: Past, t: float, data: Data) -> None:
    past.deliberations.append((t, data))
    known = past.links.get(data["id"])
    told = {**(known[1] if known is not None else {}), **data, "kind": "event", "what": data["trigger"]}
    past.links[data["id"]] = (known[0] if known is not None else t, told)


def _take_operation(past: Past, t: float, data: Data) -> None:
    number, state = data["id"], data.get("state")
    if state == "began":
        past.operations[number] = Operation(data, t)
        if number not in past.links:
            parent = data.get("cause") or 0
            past.links[number] = t, {**data, "parent": parent, "kind": "operation", "what": data["operation"]}
        return
    known = past.operations.get(number, Operation(data, t))
    reason = str(data.get("reason") or "")
    past.operations[number] = Operation(known.data, known.began, t, str(state), reason, data)


def _take_program(past: Past, _: float, data: Data) -> None:
    past.programs[data["agent"]] = {each["id"]: each for each in data["plans"] or ()}
    past.rules[data["agent"]] = list(data.get("rules") or ())


def _take_intention(past: Past, t: float, data: Data) -> None:
    key = data["agent"], data["id"]
    if data.get("state") == "over":
        past.intentions.pop(key, None)
    else:
        past.intentions[key] = t, data


def _take_agent(past: Past, t: float, data: Data) -> None:
    past.agents[data["agent"]] = t, data["state"]
    past.began.setdefault(data["agent"], t)
    if data["state"] == "ended":
        for key in [key for key in past.intentions if key[0] == data["agent"]]:
            del past.intentions[key]


def _take_source(past: Past, _: float, data: Data) -> None:
    past.sources[data["file"]] = str(data["text"]).split("\n")


def _take_artifact(past: Past, _: float, data: Data) -> None:
    # The record of a disposed artifact has no robot.
    robot = data.get("robot") or past.artifacts.get(data["artifact"], {}).get("robot")
    past.artifacts[data["artifact"]] = {**data, "robot": robot}
    if robot:
        past.robots.add(robot)


def _take_debug(past: Past, _: float, data: Data) -> None:
    past.debug = data


def _take_end(past: Past, _: float, data: Data) -> None:
    past.exit_code = data.get("code")


def _take_message(past: Past, t: float, data: Data) -> None:
    past.messages.append((t, data))
    if isinstance(data.get("id"), int) and data["id"] not in past.links:
        past.links[data["id"]] = t, {**data, "kind": "message", "parent": data.get("cause") or 0}


_TAKERS: dict[str, Callable[[Past, float, Data], None]] = {
    "cause": _take_cause,
    "deliberation": _take_deliberation,
    "operation": _take_operation,
    "program": _take_program,
    "intention": _take_intention,
    "agent": _take_agent,
    "source": _take_source,
    "artifact": _take_artifact,
    "debug": _take_debug,
    "ended": _take_end,
    "message": _take_message,
    "belief": lambda past, t, data: past.beliefs.append((t, data)),
    "goal": lambda past, t, data: past.goals.append((t, data)),
    "property": lambda past, t, data: past.properties.append((t, data)),
}
_SEEN_OFTEN = frozenset({"laser", "path", "believed"})
"""Records that name a robot but are not events."""
