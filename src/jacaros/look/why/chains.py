"""Causal chains as lines of an answer: command, operation, step of a plan, event, percept, message; and conditions."""

import re
from collections.abc import Iterator
from typing import Any

from jacaros.look.records import records
from jacaros.look.records.words import named
from jacaros.look.why.explanation import Fact, seconds
from jacaros.look.why.past import AT_ONCE, ChainLink, Past
from jacaros.look.why.patterns import name_of

_Placed = records.PlanRecord | records.CauseRecord | records.BeliefRecord | records.StackedGoal
_OF_PERCEPTS = re.compile(r"\[artifact_id\([^\]]*source\(percept\)[^\]]*\]")

LONGEST_CHAIN = 40
"""Maximum number of links shown. Of a longer chain, those next to the effect and the first one."""

LONGEST_ROUND = 12
"""Maximum number of links of a round of a loop."""
MOST_VALUES = 6
"""Maximum number of beliefs of a condition."""
_NAMES = re.compile(r"[a-z]\w*")
_DEPTH = 3
"""Maximum number of rules that are followed from one to the next."""


def chain(past: Past, number: Any) -> tuple[Fact, ...]:
    """Return the links from one back to the beginning, as facts."""
    links = _without_rounds([_fact(past, link) for link in past.chain(number)])
    if len(links) > LONGEST_CHAIN:
        left = len(links) - LONGEST_CHAIN
        return (*links[: LONGEST_CHAIN - 1], Fact("note", f"{left} more causes"), links[-1])
    return tuple(links)


def _without_rounds(links: list[Fact]) -> list[Fact]:
    """Keep the newest round of each loop, and count the earlier ones."""
    kept: list[Fact] = []
    places = [
        (each.kind, each.agent, each.file, each.line) if each.line else re.sub(r"[-\d.]+", "#", each.text)
        for each in links
    ]
    at = 0
    while at < len(links):
        size, rounds = _loop(places[at:])
        kept += links[at : at + size]
        at += size * rounds
        if rounds > 1:
            since = "" if (t := links[at - 1].t) is None else f", since {seconds(t)}"
            kept.append(Fact("note", f"{rounds - 1} earlier rounds like this{since}"))
    return kept


def _loop(places: list[Any]) -> tuple[int, int]:
    """Return how many links the loop has that *places* begin with, and the number of its rounds; 1 and 1 without one."""
    for size in range(1, LONGEST_ROUND + 1):
        rounds = 1
        while places[:size] == places[size * rounds : size * (rounds + 1)]:
            rounds += 1
        if rounds > 2:
            return size, rounds
    return 1, 1


def _fact(past: Past, link: ChainLink) -> Fact:
    """Return a link as a line of an answer."""
    t, cause, record = link
    agent = cause.agent or ""
    match cause.sort, record:
        case _, records.DeliberationRecord():
            plan = past.plan(agent, record.chosen)
            how = f", handled by {plan_name(plan)}" if plan else ""
            return Fact("event", f"{shown(record.trigger)}{how}", t, agent, *place_of(plan))
        case _, records.MessageRecord():
            told = f"{record.sender} to {record.receiver}: {record.performative} {record.content}"
            return Fact("message", told, t)
        case "act", _:
            plan, file, line = past.plan(agent, cause.plan), *place_of(cause)
            written = source_line(past, file, line)
            step = f"`{written}`" if written else cause.what.removeprefix(f"{agent} ")
            return Fact("act", f"step {step}{f' of {plan_name(plan)}' if plan else ''}", t, agent, file, line)
        case "remote", _:
            what = f"step of its plan for `{shown(cause.what)}`" if cause.what else "a step of its program"
            return Fact("remote", what, t, agent, *place_of(cause))
        case "operation", _:
            known = past.operations.get(cause.id)
            artifact = f" of {cause.artifact}" if cause.artifact else ""
            end = f", {known.outcome}" if known is not None else ""
            return Fact("operation", f"{cause.what}{artifact}{end}", t)
        case "sample", _ if cause.topic and cause.topic not in cause.what:
            return Fact("sample", f"{cause.topic}: {cause.what}", t)
    return Fact(cause.sort, cause.what, t)


def plan_name(plan: records.PlanRecord) -> str:
    """Return a plan as text: label, or trigger, with its context."""
    return f"@{plan.label}" if is_written(plan.label) else f"`{plan_text(plan)}`"


def is_written(label: str | None) -> bool:
    """Return whether a label is from the program. Others are generated."""
    return bool(label) and not str(label).startswith("p__")


def plan_text(plan: records.PlanRecord | None) -> str:
    """Return trigger and context of a plan."""
    if plan is None:
        return "?"
    return shown(f"{plan.trigger}{f' : {plan.context}' if plan.context else ''}")


def shown(text: object) -> str:
    """Return a recorded text with `_` for unnamed variables, and without the annotations that all percepts have."""
    return _OF_PERCEPTS.sub("[source(percept)]", named(str(text)))


def place_of(record: _Placed | None) -> tuple[str, int]:
    """Return the file and line that a record names; empty and 0 without one."""
    return ("", 0) if record is None else (record.file or "", record.line or 0)


def where(plan: records.PlanRecord) -> str:
    """Return the file and line of a plan."""
    return f"{plan.file or ''}:{plan.line or 0}"


def source_line(past: Past, file: str, line: int) -> str:
    """Return the code of a line of a program, without surrounding punctuation; empty if it is unknown."""
    lines = past.sources.get(file, [])
    if not 0 < line <= len(lines):
        return ""
    code = lines[line - 1].partition("//")[0].strip()
    return code.removeprefix("<-").strip().rstrip(";.")


def code_of(past: Past, plan: records.PlanRecord | None) -> list[tuple[int, str]]:
    """Return the numbered lines of a plan."""
    file, first = place_of(plan)
    last = (plan.end if plan else None) or first
    return [(line, source_line(past, file, line)) for line in range(first, last + 1)]


def with_values(past: Past, agent: str, condition: str, t: float, told: str = "") -> str:
    """Return a condition, or the text *told* for it, with the beliefs that it and its rules are about, as of *t*."""
    names, rules = set(_NAMES.findall(condition)), past.rules.get(agent, [])
    for _ in range(_DEPTH):
        bodies = [rule.partition(":-")[2] for rule in rules if name_of(rule) in names]
        names.update(name for body in bodies for name in _NAMES.findall(body))
    held: dict[str, None] = {}
    for at, change in past.beliefs:
        if at <= t and change.agent == agent and name_of(change.belief) in names:
            held.pop(change.belief, None)
            if change.op == "+":
                held[change.belief] = None
    values = ", ".join(shown(belief).partition("[")[0] for belief in [*held][-MOST_VALUES:])
    return f"{told or f'`{condition}`'}{f' with {values}' if values else ''}"


def applied(past: Past, handled: records.DeliberationRecord, t: float) -> Fact | None:
    """Return why the plan for an event applied; None if it has no context."""
    plan = past.plan(handled.agent, handled.chosen)
    if plan is None or not plan.context:
        return None
    text = with_values(past, handled.agent, plan.context, t, f"`{plan_text(plan)}` applied")
    return Fact("plan", text, t, handled.agent, *place_of(plan))


# ---- around a moment


def events_before(
    past: Past, t: float, link: Any, agent: str
) -> list[tuple[Fact, records.DeliberationRecord]]:
    """Return the belief events that agents handled just before a moment; those of the same message as *link*, if there are
    any.
    """
    found = []
    for at, data in past.deliberations:
        plan = past.plan(data.agent, data.chosen)
        if t - AT_ONCE <= at <= t and plan and "!" not in data.trigger[:2] and agent in ("", data.agent):
            handled = f"{shown(data.trigger)} handled at {seconds(at)} with {plan_name(plan)}"
            found.append((Fact("event", handled, at, data.agent, *place_of(plan)), data))
    roots = {each.cause.id for each in past.chain(link)}
    related = [each for each in found if any(other.cause.id in roots for other in past.chain(each[1].id))]
    return related or found


def world_facts(past: Past, t: float, robot: str) -> Iterator[Fact]:
    """Return what the world did to a robot, or any (``""``), around a moment."""
    for at, event, whose in past.world:
        if abs(at - t) <= AT_ONCE and robot in ("", whose):
            yield Fact("note", f"{whose}: {event} at {seconds(at)}", at)
