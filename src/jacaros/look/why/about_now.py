"""Answers about the present: what agents wait for, why nothing happens, and why the run ended."""

from collections.abc import Iterator
from itertools import islice

from jacaros.look.records import records
from jacaros.look.why.chains import applied, chain, code_of, place_of, shown, source_line, with_values
from jacaros.look.why.deeds import deeds_asked_for
from jacaros.look.why.explanation import Explanation, Fact, seconds
from jacaros.look.why.past import Past, TimedRecords, awaited, of_agent
from jacaros.look.why.patterns import Question

MOST_GOALS = 5
"""Maximum number of goals of a stack in an answer."""
MOST_INTENTIONS = 20
"""Maximum number of intentions in an answer."""
_END = ".stopMAS"
_PAST = {"runs": "ran", "is": "was", "waits": "waited"}


def explain_now(past: Past, asked: Question) -> Explanation:
    """Explain what happens at the end of the records: what each open intention waits for, or why the run ended."""
    agent, now = asked.agent, seconds(past.end)
    found = of_agent([*past.intentions.values()], agent)
    main = max(found, key=_importance, default=None)
    last = next(reversed(of_agent(past.deliberations, agent)), None)
    ended = "" if past.exit_code is None else f"the run ended at {now} with exit code {past.exit_code}"
    ending, facts = ending_step(past), [*islice(_intentions(past, found), MOST_INTENTIONS)]
    if main is None:
        goals = (each for each in deeds_asked_for(past, asked) if each.kind == "goal")
        lost = [each for each in goals if each.state == "failed"]
        facts = [Fact("goal", f"{shown(each.text)} {each.outcome}", None, each.agent) for each in lost[-1:]]
    if ending is not None:
        answer = f"{ended}, because {ending.agent} ran {ending.text} ({ending.place})"
        handled = None if main is None else past.links.get(main[1].cause)
        if handled is not None and isinstance(handled.of, records.DeliberationRecord):
            facts = [*filter(None, [applied(past, handled.of, handled.t)])]
    elif not ended and past.debug is not None and past.debug.state == "paused":
        answer = f"the run is paused: {past.debug.why or 'on request'}"
    elif main is not None:
        verb, _, rest = _state(*main).partition(" ")
        goal = f", for `{shown(main[1].stack[-1].goal)}`" if main[1].stack else ""
        answer = f"{ended}; until then, " if ended else ""
        answer += f"{main[1].agent} {_PAST[verb] if ended else verb} {rest}{goal}"
    else:
        who = f"{agent} has neither a goal nor" if agent else "no agent has a goal or"
        when = (
            "" if last is None else f"; the last event was `{shown(last[1].trigger)}` at {seconds(last[0])}"
        )
        answer = ended or f"{who} an event at {now}{when}"
    if not ended and last is not None and last[1].chosen is None:
        told = f"the last event `{shown(last[1].trigger)}` had no applicable plan"
        facts.append(Fact("event", told, last[0], last[1].agent))
    link = main[1].cause if main is not None else last and last[1].id
    return Explanation(asked.written, answer, past.end, tuple(facts), chain(past, link))


def _importance(timed: tuple[float, records.IntentionRecord]) -> tuple[int, int, float]:
    """Rank an intention: one with the wheels before those that it keeps from them, and conditions last of the urgent."""
    data = timed[1]
    kept = data.state == "suspended" or (data.waits or "").startswith("the resource")
    return 0 if kept else 1 if awaited(data) else 2, data.urgency or 0, timed[0]


def ending_step(past: Past) -> Fact | None:
    """Return the step that ended the run; None without one."""
    for _, data in past.intentions.values() if past.exit_code is not None else ():
        top = data.stack[-1] if data.stack else None
        plan = past.plan(data.agent, top.plan) if top and data.state == "runs" else None
        for line, code in code_of(past, plan):
            _, found, step = code.partition(_END)
            if found and top and plan:
                told = f"`{_END}{step}` for `{shown(top.goal)}`"
                return Fact("act", told, None, data.agent, plan.file or "", line)
    return None


def waits_for(past: Past, agent: str, goal: str) -> Iterator[Fact]:
    """Return what the intention of a goal waits for at the end of the records, with the values of a condition."""
    found = of_agent([*past.intentions.values()], agent)
    return _intentions(past, [each for each in found if any(at.goal == goal for at in each[1].stack or ())])


def _intentions(past: Past, found: TimedRecords[records.IntentionRecord]) -> Iterator[Fact]:
    for t, data in found:
        top = data.stack[-1] if data.stack else None
        file, line = place_of(top)
        step = (top.step if top else "") or source_line(past, file, line)
        goals = [shown(each.goal) for each in data.stack or ()]
        if len(goals) > MOST_GOALS:
            goals = [*goals[:2], "...", *goals[-2:]]
        pursued = f", {' > '.join(goals)}," if goals else ""
        told = f"intention {data.id}{pursued} {_state(t, data)}"
        yield Fact("intention", f"{told}{f', in `{step}`' if step else ''}", t, data.agent, file, line)
        if condition := awaited(data):
            yield Fact("belief", with_values(past, data.agent, condition, past.end), None, data.agent)


def _state(t: float, data: records.IntentionRecord) -> str:
    waits = (data.waits or "").removeprefix("for ")
    state = f"waits for {waits}" if waits else "waits"
    if data.state == "runs":
        state = "runs"
    elif data.state == "suspended":
        state = f"is suspended{f': {data.reason},' if data.reason else ''}"
    return f"{state} since {seconds(t if data.since is None else data.since)}"
