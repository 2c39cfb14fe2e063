"""Causal chains as lines of an answer: command, operation, step of a plan, event, percept, message."""

import re
from collections.abc import Iterator
from typing import Any

from jacaros.mas.history.explanation import Fact
from jacaros.mas.history.past import Data, Past
from jacaros.mas.history.words import named

_OF_PERCEPTS = re.compile(r"\[artifact_id\([^\]]*source\(percept\)[^\]]*\]")

LONGEST_CHAIN = 40
"""Maximum number of links shown. Of a longer chain, those next to the effect and the first one."""

LONGEST_ROUND = 12
"""Maximum number of links of a round of a loop."""


def chain(past: Past, number: Any) -> tuple[Fact, ...]:
    """Return the links from one back to the beginning, as facts."""
    links = _without_rounds([fact for t, data in past.chain(number) for fact in _facts(past, t, data)])
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
            kept.append(Fact("note", f"{rounds - 1} earlier rounds like this", links[at - 1].t))
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


def _facts(past: Past, t: float, link: Data) -> Iterator[Fact]:
    kind = str(link.get("kind", ""))
    make = _MAKERS.get(kind)
    yield make(past, t, link) if make is not None else Fact(kind, str(link.get("what", "")), t)


def _event(past: Past, t: float, link: Data) -> Fact:
    agent = str(link.get("agent", ""))
    plan = past.plan(agent, link.get("chosen"))
    how = f", handled by {plan_name(plan)}" if plan else ""
    return Fact(
        "event", f"{shown(link.get('trigger', link.get('what', '')))}{how}", t, agent, *place_of(plan)
    )


def _act(past: Past, t: float, link: Data) -> Fact:
    agent, file, line = str(link.get("agent", "")), str(link.get("file") or ""), int(link.get("line") or 0)
    what = str(link.get("what", "")).removeprefix(f"{agent} ")
    plan = past.plan(agent, link.get("plan"))
    written = source_line(past, file, line)
    step = f"step `{written}`" if written else f"step {what}"
    return Fact("act", f"{step}{f' of {plan_name(plan)}' if plan else ''}", t, agent, file, line)


def _operation(past: Past, t: float, link: Data) -> Fact:
    known = past.operations.get(link.get("id"))
    artifact = f" of {link['artifact']}" if link.get("artifact") else ""
    return Fact("operation", f"{link.get('what', '')}{artifact}{'' if known is None else _end(known)}", t)


def _end(operation: Any) -> str:
    if operation.ended is None:
        return ", still running"
    reason = f": {operation.reason}" if operation.reason else ""
    return f", {operation.outcome} at {operation.ended:.3f} s{reason}"


def _sample(_past: Past, t: float, link: Data) -> Fact:
    what, topic = str(link.get("what", "")), str(link.get("topic") or "")
    told = what if topic in what else f"{topic}: {what}"
    return Fact("sample", told, t)


def _message(_past: Past, t: float, link: Data) -> Fact:
    if "performative" not in link:
        return Fact("message", str(link.get("what", "")), t)
    return Fact("message", message_text(link), t)


_MAKERS = {
    "event": _event,
    "act": _act,
    "operation": _operation,
    "sample": _sample,
    "message": _message,
}


def message_text(message: Data) -> str:
    """Return a message between agents as text."""
    return f"{message['from']} to {message['to']}: {message['performative']} {message['content']}"


def plan_name(plan: Data) -> str:
    """Return a plan as text: label, or trigger, with its context."""
    label = str(plan.get("label") or "")
    return f"@{label}" if is_written(label) else f"`{plan_text(plan)}`"


def is_written(label: str) -> bool:
    """Return whether a label is from the program. Others are generated."""
    return bool(label) and not label.startswith("p__")


def plan_text(plan: Data) -> str:
    """Return trigger and context of a plan."""
    context = plan.get("context")
    return shown(f"{plan.get('trigger', '?')}{f' : {context}' if context else ''}")


def shown(text: Any) -> str:
    """Return a recorded text with `_` for unnamed variables, and without the annotations that all percepts have."""
    return _OF_PERCEPTS.sub("[source(percept)]", named(str(text)))


def place_of(plan: Data) -> tuple[str, int]:
    """Return file and line of a plan."""
    return str(plan.get("file") or ""), int(plan.get("line") or 0)


def source_line(past: Past, file: str, line: int) -> str:
    """Return the code of a line of a program, without surrounding punctuation; empty if it is unknown."""
    lines = past.sources.get(file, [])
    if not 0 < line <= len(lines):
        return ""
    code = lines[line - 1].partition("//")[0].strip()
    return code.removeprefix("<-").strip().rstrip(";.")
