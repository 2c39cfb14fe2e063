"""Answers about what agents wait for, and why nothing happens."""

from collections.abc import Iterator
from itertools import islice

from jacaros.look.records import records
from jacaros.look.why.about_events import goal_text
from jacaros.look.why.chains import chain, place_of, shown, source_line
from jacaros.look.why.explanation import Explanation, Fact, seconds
from jacaros.look.why.past import Past, TimedRecords, of_agent
from jacaros.look.why.patterns import Question

MOST_GOALS = 5
"""Maximum number of goals of a stack in an answer."""
MOST_INTENTIONS = 20
"""Maximum number of intentions in an answer."""


def explain_waiting(past: Past, asked: Question) -> Explanation:
    """Explain what each intention waits for."""
    question, agent = asked.written, asked.agent
    found = _open(past, agent)
    waiting = sum(data.state != "runs" for _, data in found)
    who = agent or "all agents"
    if not found:
        return Explanation(question, f"no intention of {who} is open at {seconds(past.end)}", past.end)
    answer = f"{waiting} of {len(found)} intentions of {who} wait at {seconds(past.end)}"
    facts = tuple(islice(_intentions(past, found), MOST_INTENTIONS))
    return Explanation(question, answer, past.end, facts)


def _open(past: Past, agent: str) -> TimedRecords[records.IntentionRecord]:
    return of_agent([*past.intentions.values()], agent)


def _intentions(past: Past, found: TimedRecords[records.IntentionRecord]) -> Iterator[Fact]:
    for t, data in found:
        stack = data.stack or ()
        top = stack[-1] if stack else None
        file, line = place_of(top)
        step = (top.step if top else "") or source_line(past, file, line)
        goals = [shown(each.goal) for each in stack]
        if len(goals) > MOST_GOALS:
            goals = [*goals[:2], "...", *goals[-2:]]
        pursued = f", {' > '.join(goals)}," if goals else ""
        time = t if data.since is None else data.since
        told = f"intention {data.id}{pursued} {_state(data)} since {seconds(time)}"
        yield Fact("intention", f"{told}{f', in `{step}`' if step else ''}", time, data.agent, file, line)


def _state(data: records.IntentionRecord) -> str:
    if data.state == "runs":
        return "runs"
    if data.state == "suspended":
        return f"is suspended{f': {data.reason},' if data.reason else ''}"
    waits = (data.waits or "").removeprefix("for ")
    return f"waits for {waits}" if waits else "waits"


def explain_idleness(past: Past, asked: Question) -> Explanation:
    """Explain why nothing happens: the run has ended or is paused, goals were lost, or everything waits."""
    agent = asked.agent
    last = next(reversed(of_agent(past.deliberations, agent)), None)
    found = _open(past, agent)
    facts = [
        *_ends(past, agent),
        *_lost(past, agent),
        *islice(_intentions(past, found), MOST_INTENTIONS),
    ]
    if last is not None and last[1].chosen is None:
        told = f"the last event `{shown(last[1].trigger)}` had no applicable plan"
        facts.append(Fact("event", told, last[0], last[1].agent))
    because = () if last is None else chain(past, last[1].id)
    return Explanation(asked.written, _why_idle(past, agent, found, last), past.end, tuple(facts), because)


def _why_idle(
    past: Past,
    agent: str,
    found: TimedRecords[records.IntentionRecord],
    last: tuple[float, records.DeliberationRecord] | None,
) -> str:
    now = seconds(past.end)
    if past.exit_code is not None:
        return f"the run ended at {now} with exit code {past.exit_code}"
    if past.debug is not None and past.debug.state == "paused":
        return f"the run is paused: {past.debug.why or 'on request'}"
    running = sum(data.state == "runs" for _, data in found)
    if running:
        return f"the run is active: {running} intentions run at {now}"
    if found:
        return f"every open intention of {agent or 'all agents'} waits at {now}"
    when = "" if last is None else f"; the last event was `{shown(last[1].trigger)}` at {seconds(last[0])}"
    who = f"{agent} has neither a goal nor" if agent else "no agent has a goal or"
    return f"{who} an event at {now}{when}"


def _ends(past: Past, agent: str) -> Iterator[Fact]:
    for name, (t, state) in past.agents.items():
        if state == "ended" and agent in ("", name):
            yield Fact("note", f"ended at {seconds(t)}", t, name)


def _lost(past: Past, agent: str) -> Iterator[Fact]:
    """Return the last failure of each agent that was not recovered."""
    lost: dict[object, tuple[float, records.GoalRecord]] = {}
    for t, data in of_agent(past.goals, agent):
        if data.state == "failed":
            lost[data.agent, data.id] = t, data
        else:
            lost.pop((data.agent, data.id), None)
    newest = {data.agent: (t, data) for t, data in lost.values()}
    for name, (t, data) in newest.items():
        yield Fact("goal", goal_text(t, data), t, name)
