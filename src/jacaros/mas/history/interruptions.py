"""Events that interrupted a robot's motion: handled just before it stopped."""

import re
from collections.abc import Iterator

from jacaros.mas.history.chains import place_of, plan_name, shown
from jacaros.mas.history.explanation import Fact, seconds
from jacaros.mas.history.past import Data, Past
from jacaros.mas.history.questions import literal_at

AT_ONCE = 0.2
"""Events and changes of goals within this number of seconds before a stop are reported with it."""
LATEST = 0.7
"""Maximum delay in seconds of a recorded stop: only two commands of an operation are recorded per second."""
_INTERRUPTS = re.compile(r"(\.)(?=(?:suspend|drop_\w+|fail_goal|succeed_goal)\b)|(?<=[\[, ])(?=needs\()")
"""Steps that interrupt a robot's motion, and goals that take its wheels from less urgent ones."""

Command = tuple[float, Data]
"""The time of a published message, and its link."""


def goals_interrupted(past: Past, stop: Command, agent: str = "", only_own: bool = False) -> list[Fact]:
    """Return the goals that were suspended or ended just before a stop, one line for each intention.

    Args:
        past: the records.
        stop: the command.
        agent: only goals of this agent; empty for all.
        only_own: if an action led to the command, only goals of its intention count.
    """
    t, link = stop
    own = {
        (each.get("agent"), each.get("intention"))
        for _, each in past.chain(link["id"])
        if each.get("kind") == "act"
    }
    ended: dict[object, list[tuple[float, Data]]] = {}
    for at, data in past.goals:
        intention = data.get("agent"), data.get("intention")
        over = data.get("state") in ("dropped", "suspended", "failed") and agent in ("", data.get("agent"))
        if over and t - LATEST <= at <= t + AT_ONCE and (intention in own or not (own and only_own)):
            ended.setdefault((*intention, data["state"]), []).append((at, data))
    return [_interrupted(goals) for goals in ended.values()]


def _interrupted(goals: list[tuple[float, Data]]) -> Fact:
    at, data = goals[0]
    count = len(goals) - 1
    more = f" with {count} goal{'s' if count > 1 else ''} above it" if count else ""
    why = f": {data['why']}" if data.get("why") else ""
    told = f"{shown(data['goal'])}{more} {data['state']} at {seconds(at)}{why}"
    return Fact("goal", told, at, str(data["agent"]))


def events_before(past: Past, stop: Command, agent: str = "") -> list[tuple[float, Data]]:
    """Return the belief events that agents handled just before a stop; those of the same message, if there are any."""
    t, link = stop
    events = [
        (at, data)
        for at, data in past.deliberations
        if t - AT_ONCE <= at <= t and data.get("chosen") is not None and _is_of(data, agent)
    ]
    roots = {each["id"] for _, each in past.chain(link["id"])}
    related = [each for each in events if any(other["id"] in roots for _, other in past.chain(each[1]["id"]))]
    return related or events


def _is_of(deliberation: Data, agent: str) -> bool:
    return "!" not in str(deliberation["trigger"])[:2] and agent in ("", deliberation.get("agent"))


def event_fact(past: Past, t: float, deliberation: Data) -> Fact:
    """Return a handled event with its plan."""
    agent = str(deliberation["agent"])
    plan = past.plan(agent, deliberation["chosen"])
    handled = f"{shown(deliberation['trigger'])} handled at {seconds(t)} with {plan_name(plan)}"
    return Fact("event", handled, t, agent, *place_of(plan))


def interrupting_step(past: Past, deliberation: Data) -> Iterator[Fact]:
    """Return the step of a chosen plan that suspends or drops intentions, or takes resources from them, if there is
    exactly one.
    """
    agent = str(deliberation["agent"])
    plan = past.plan(agent, deliberation["chosen"])
    file, first = place_of(plan)
    lines = past.sources.get(file, [])
    numbered = enumerate(lines[first - 1 : int(plan.get("end") or first)], first)
    code = ((number, line.split("//")[0]) for number, line in numbered)
    found = [
        (number, f"{match.group(1) or ''}{literal_at(line, match.end())}")
        for number, line in code
        for match in _INTERRUPTS.finditer(line)
    ]
    if len(found) == 1:
        number, step = found[0]
        what = "step " if step[0] == "." else ""
        yield Fact("act", f"{what}`{step}` of {plan_name(plan)}", None, agent, file, number)
