"""Answers about the last change of a belief."""

from collections.abc import Iterator
from typing import Any

from jacaros.files.texts import suggestion
from jacaros.mas.history.chains import chain, shown, source_line
from jacaros.mas.history.explanation import Explanation, Fact, seconds
from jacaros.mas.history.past import Data, Past, of_agent
from jacaros.mas.history.patterns import Pattern, name_of

MOST_CHANGES = 5
"""Number of earlier changes that an answer lists."""


def explain_belief(past: Past, question: str, about: str, agent: str = "") -> Explanation:
    """Explain the last change of a belief, such as ``battery(_)``."""
    pattern = Pattern(about)
    changes = [
        each for each in of_agent(past.beliefs, agent) if pattern.fits_literal(str(each[1].get("belief", "")))
    ]
    if not changes:
        return _unknown(past, question, pattern, agent)
    t, last = changes[-1]
    does = "came to believe" if last.get("op") == "+" else "stopped believing"
    answer = f"{last['agent']} {does} `{shown(last['belief'])}` at {seconds(t)}"
    facts = (*_step(past, t, last), *_before(changes))
    return Explanation(question, answer, t, facts, chain(past, last.get("cause") or 0))


def _step(past: Past, t: float, change: Data) -> Iterator[Fact]:
    """Return the step of a plan that changed a belief."""
    file, line = str(change.get("file") or ""), int(change.get("line") or 0)
    if file:
        written = source_line(past, file, line)
        step = f"the step `{written}`" if written else "a step"
        number = change.get("intention")
        yield Fact("act", f"{step}{f' of intention {number}' if number else ''} did it", t, "", file, line)
    elif not change.get("cause"):
        yield Fact("note", "it is an initial belief, or was added from outside of the plans")


def _before(changes: list[tuple[float, Data]]) -> Iterator[Fact]:
    for t, data in reversed(changes[:-1][-MOST_CHANGES:]):
        yield Fact(
            "belief", f"before: {data.get('op')}{shown(data.get('belief'))} at {seconds(t)}", t, data["agent"]
        )
    left = len(changes) - 1 - MOST_CHANGES
    if left > 0:
        yield Fact("note", f"{left} more changes before")


def _unknown(past: Past, question: str, pattern: Pattern, agent: str) -> Explanation:
    who = agent or "no agent"
    verb = "never believed" if agent else "ever believed"
    answer = f"{who} {verb} `{pattern.written}` until {seconds(past.end)}"
    return Explanation(question, answer, None, tuple(_meant(past, pattern)))


def _meant(past: Past, pattern: Pattern) -> Iterator[Fact]:
    rule = next(
        (rule for rules in past.rules.values() for rule in rules if name_of(rule) == pattern.name), None
    )
    if rule is not None:
        yield Fact("note", f"it is the conclusion of a rule: {rule}")
    same = [str(data["belief"]) for _, data in past.beliefs if name_of(str(data["belief"])) == pattern.name]
    if same:
        yield Fact("note", f"there was `{shown(same[-1])}`")
        return
    names: set[Any] = {name_of(str(data["belief"])) for _, data in past.beliefs}
    help = suggestion(pattern.name, sorted(names))
    if help:
        yield Fact("note", help)
