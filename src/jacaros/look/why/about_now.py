"""Answers about the present: what agents wait for, why nothing happens, and why the run ended."""

from collections.abc import Iterator
from itertools import islice

from jacaros.look.records import records
from jacaros.look.why.chains import applied, chain, place_of, shown, source_line, with_values
from jacaros.look.why.deeds import deeds_asked_for
from jacaros.look.why.explanation import Explanation, Fact, seconds
from jacaros.look.why.past import CONDITION, Past, TimedRecords, of_agent
from jacaros.look.why.patterns import Question

MOST_GOALS = 5
"""Maximum number of goals of a stack in an answer."""
MOST_INTENTIONS = 20
"""Maximum number of intentions in an answer."""
_END = ".stopMAS"
_PAST = {"runs": "ran", "is": "was", "waits": "waited"}


def explain_now(past: Past, asked: Question) -> Explanation:
    """Explain what happens at the end of the records: what each open intention waits for, or why the run ended."""
    agent = asked.agent
    found = of_agent([*past.intentions.values()], agent)
    main = max(found, key=_importance, default=None)
    last = next(reversed(of_agent(past.deliberations, agent)), None)
    facts = [] if main is not None else [*_lost(past, asked)]
    ending = ending_step(past)
    handled = past.links[main[1].cause] if main is not None and main[1].cause in past.links else None
    if ending is not None and handled is not None and isinstance(handled.of, records.DeliberationRecord):
        facts += filter(None, [applied(past, handled.of, handled.t)])
    else:
        facts += islice(_intentions(past, found), MOST_INTENTIONS)
        facts += () if main is None else _awaited(past, main[1])
    if past.exit_code is None and last is not None and last[1].chosen is None:
        told = f"the last event `{shown(last[1].trigger)}` had no applicable plan"
        facts.append(Fact("event", told, last[0], last[1].agent))
    link = main[1].cause if main is not None else last and last[1].id
    answer = _now(past, asked, main, last, ending)
    return Explanation(asked.written, answer, past.end, tuple(facts), chain(past, link))


def _importance(timed: tuple[float, records.IntentionRecord]) -> tuple[int, int, float]:
    """Rank an intention: one with the wheels before those that it keeps from them, and conditions last of the urgent."""
    data = timed[1]
    waits = data.waits or ""
    kept = data.state == "suspended" or waits.startswith("the resource")
    return 0 if kept else 1 if waits.startswith(CONDITION) else 2, data.urgency or 0, timed[0]


def _now(
    past: Past,
    asked: Question,
    main: tuple[float, records.IntentionRecord] | None,
    last: tuple[float, records.DeliberationRecord] | None,
    ending: Fact | None,
) -> str:
    now, agent = seconds(past.end), asked.agent
    ended = "" if past.exit_code is None else f"the run ended at {now} with exit code {past.exit_code}"
    if ended and ending is not None:
        return f"{ended}, because {ending.agent} ran {ending.text} ({ending.place})"
    if not ended and past.debug is not None and past.debug.state == "paused":
        return f"the run is paused: {past.debug.why or 'on request'}"
    if main is not None:
        t, data = main
        verb, _, rest = f"{_state(data)} since {_since(t, data)}{_goal_of(data)}".partition(" ")
        return (
            f"{ended}; until then, {data.agent} {_PAST[verb]} {rest}"
            if ended
            else f"{data.agent} {verb} {rest}"
        )
    if ended:
        return ended
    when = "" if last is None else f"; the last event was `{shown(last[1].trigger)}` at {seconds(last[0])}"
    who = f"{agent} has neither a goal nor" if agent else "no agent has a goal or"
    return f"{who} an event at {now}{when}"


def ending_step(past: Past) -> Fact | None:
    """Return the step that ended the run; None without one."""
    if past.exit_code is None:
        return None
    return next((fact for _, data in past.intentions.values() if (fact := _ending_step(past, data))), None)


def _ending_step(past: Past, data: records.IntentionRecord) -> Fact | None:
    top = data.stack[-1] if data.stack else None
    plan = past.plan(data.agent, top.plan) if top else None
    if data.state != "runs" or plan is None or top is None:
        return None
    file, first = place_of(plan)
    for line in range(first, (plan.end or first) + 1):
        step = source_line(past, file, line)
        if _END in step:
            return Fact(
                "act",
                f"`{step[step.index(_END) :]}` for `{shown(top.goal)}`",
                None,
                data.agent,
                file,
                line,
            )
    return None


def waits_for(past: Past, agent: str, goal: str) -> Iterator[Fact]:
    """Return what the intention of a goal waits for at the end of the records, with the values of a condition."""
    for t, data in of_agent([*past.intentions.values()], agent):
        if any(each.goal == goal for each in data.stack or ()):
            yield from _intentions(past, [(t, data)])
            yield from _awaited(past, data)


def _awaited(past: Past, data: records.IntentionRecord) -> Iterator[Fact]:
    waits = data.waits or ""
    if waits.startswith(CONDITION):
        values = with_values(past, data.agent, waits.removeprefix(CONDITION), past.end)
        yield Fact("belief", f"{values}", None, data.agent)


def _goal_text(data: records.IntentionRecord) -> str:
    goals = [shown(each.goal) for each in data.stack or ()]
    if len(goals) > MOST_GOALS:
        goals = [*goals[:2], "...", *goals[-2:]]
    return " > ".join(goals)


def _goal_of(data: records.IntentionRecord) -> str:
    return f", for `{shown(data.stack[-1].goal)}`" if data.stack else ""


def _since(t: float, data: records.IntentionRecord) -> str:
    return seconds(t if data.since is None else data.since)


def _intentions(past: Past, found: TimedRecords[records.IntentionRecord]) -> Iterator[Fact]:
    for t, data in found:
        top = data.stack[-1] if data.stack else None
        file, line = place_of(top)
        step = (top.step if top else "") or source_line(past, file, line)
        pursued = f", {_goal_text(data)}," if data.stack else ""
        told = f"intention {data.id}{pursued} {_state(data)} since {_since(t, data)}"
        yield Fact("intention", f"{told}{f', in `{step}`' if step else ''}", t, data.agent, file, line)


def _state(data: records.IntentionRecord) -> str:
    if data.state == "runs":
        return "runs"
    if data.state == "suspended":
        return f"is suspended{f': {data.reason},' if data.reason else ''}"
    waits = (data.waits or "").removeprefix("for ")
    return f"waits for {waits}" if waits else "waits"


def _lost(past: Past, asked: Question) -> Iterator[Fact]:
    """Return the last failure of a goal that was not recovered."""
    deeds = deeds_asked_for(past, asked)
    failed = [each for each in deeds if each.kind == "goal" and each.state == "failed" and each.why]
    for each in failed[-1:]:
        yield Fact("goal", f"{shown(each.text)} {each.outcome}", each.ended, each.agent)
