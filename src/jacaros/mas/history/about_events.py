"""Answers about events and goals: how they were handled, and why."""

from collections.abc import Iterator

from jacaros.errors import UsageError
from jacaros.files.texts import suggestion
from jacaros.mas.history.chains import chain, place_of, plan_name, plan_text, shown
from jacaros.mas.history.explanation import Explanation, Fact, seconds
from jacaros.mas.history.past import Data, Past, of_agent
from jacaros.mas.history.patterns import Pattern, name_of, unsigned

MOST_PLANS = 8
"""Maximum number of plans in an answer."""


def explain_event(past: Past, question: str, about: str, agent: str = "") -> Explanation:
    """Explain the last event that matches *about*, such as ``+alarm(_)`` or ``!go(dock)``."""
    pattern = Pattern(about)
    found = [
        each for each in of_agent(past.deliberations, agent) if pattern.fits(str(each[1].get("trigger", "")))
    ]
    if not found:
        return _never(past, question, about, pattern, agent)
    t, last = found[-1]
    facts = [*candidates(past, last), *_outcome(past, t, last), *_earlier(len(found))]
    return Explanation(question, _headline(past, t, last), t, tuple(facts), chain(past, last["id"]))


def explain_deliberation(past: Past, question: str, t: float, deliberation: Data) -> Explanation:
    """Explain one handled event."""
    facts = tuple(candidates(past, deliberation))
    return Explanation(question, _headline(past, t, deliberation), t, facts, chain(past, deliberation["id"]))


def _headline(past: Past, t: float, deliberation: Data) -> str:
    agent, trigger = deliberation["agent"], shown(deliberation["trigger"])
    plan = past.plan(agent, deliberation.get("chosen"))
    if plan:
        file, line = place_of(plan)
        return f"{agent} handled `{trigger}` at {seconds(t)} with {plan_name(plan)} ({file}:{line})"
    if deliberation.get("chosen") is not None:
        return f"{agent} handled `{trigger}` at {seconds(t)} with a plan that it no longer has"
    relevant = "applicable" if deliberation.get("options") or unexamined(past, deliberation) else "relevant"
    return f"{agent} has no {relevant} plan for `{trigger}` at {seconds(t)}"


def unexamined(past: Past, deliberation: Data) -> list[Data]:
    """Return the plans for an event that a busy agent did not record."""
    agent, trigger = str(deliberation["agent"]), str(deliberation["trigger"])
    if deliberation.get("chosen") is not None:
        return []
    named = {option.get("plan") for option in deliberation.get("options") or ()}
    plans = (plan for _, plan in past.plans(agent) if plan.get("id") not in named)
    return [plan for plan in plans if _is_for(str(plan.get("trigger", "")), trigger)]


def _is_for(trigger: str, event: str) -> bool:
    if name_of(trigger) != name_of(event):
        return False
    try:
        return Pattern(trigger).fits(event)
    except UsageError:
        return False


def candidates(past: Past, deliberation: Data) -> Iterator[Fact]:
    """Return the relevant plans of an event in order, each with the reason why it was not chosen."""
    agent = str(deliberation["agent"])
    options = list(deliberation.get("options") or ())
    unknown = (
        "did not apply"
        if deliberation.get("chosen") is None
        else "applicable too, but another plan was selected"
    )
    for option in options[:MOST_PLANS]:
        yield _candidate(past.plan(agent, option.get("plan")), str(option.get("why") or "") or unknown)
    for plan in unexamined(past, deliberation)[:MOST_PLANS]:
        is_annotated = "[" in str(plan.get("trigger", ""))
        why = (
            "its annotations do not match"
            if is_annotated
            else "did not apply; not examined, because the agent was busy"
        )
        yield _candidate(plan, why)
    chosen = past.plan(agent, deliberation.get("chosen"))
    if chosen:
        yield _candidate(chosen, "chosen")
    for number in list(deliberation.get("untried") or ())[:MOST_PLANS]:
        yield _candidate(past.plan(agent, number), "not tried, because the chosen plan comes before it")
    left = len(options) - MOST_PLANS
    if left > 0:
        yield Fact("note", f"{left} more plans do not apply")


def _candidate(plan: Data, what: str) -> Fact:
    return Fact("plan", f"`{plan_text(plan)}`: {what}", None, "", *place_of(plan))


def _outcome(past: Past, t: float, deliberation: Data) -> Iterator[Fact]:
    """Return the outcome of the goal of an event."""
    goal = unsigned(str(deliberation["trigger"]))
    if not goal.startswith("!"):
        return
    for later, data in past.goals:
        same = data.get("agent") == deliberation["agent"] and data.get("goal") == goal
        if same and later >= t and data.get("state") not in ("pursued", "suspended", "resumed"):
            why = f": {data['why']}" if data.get("why") else ""
            yield Fact("goal", f"{goal} {data['state']} at {seconds(later)}{why}")
            return


def _earlier(count: int) -> Iterator[Fact]:
    if count > 1:
        times = "once" if count == 2 else f"{count - 1} times"
        yield Fact("note", f"it happened {times} before; ask with --at T")


def _never(past: Past, question: str, about: str, pattern: Pattern, agent: str) -> Explanation:
    what = "goal" if pattern.kind else "event"
    changed = [] if pattern.kind else _changes(past, pattern, agent)
    if changed:
        t, data = changed[-1]
        answer = (
            f"{data['agent']} has no relevant plan for `{data['op']}{shown(data['belief'])}` at {seconds(t)}"
        )
        cause = chain(past, data.get("cause") or 0)
        return Explanation(question, answer, t, tuple(_near_plans(past, pattern, str(data["agent"]))), cause)
    told = [each for each in past.goals if pattern.kind == "!" and pattern.fits(str(each[1].get("goal", "")))]
    if told:
        return _of_goal(question, *told[-1])
    answer = f"no {what} `{about}` happened{f' in {agent}' if agent else ''} until {seconds(past.end)}"
    return Explanation(question, answer, None, tuple(_hints(past, pattern, agent)))


def _of_goal(question: str, t: float, data: Data) -> Explanation:
    why = f": {data['why']}" if data.get("why") else ""
    return Explanation(question, f"{data['agent']}: {data['goal']} {data['state']} at {seconds(t)}{why}", t)


def _changes(past: Past, pattern: Pattern, agent: str) -> list[tuple[float, Data]]:
    return [
        each
        for each in of_agent(past.beliefs, agent)
        if pattern.fits(f"{each[1].get('op', '+')}{each[1].get('belief', '')}")
    ]


def _hints(past: Past, pattern: Pattern, agent: str) -> Iterator[Fact]:
    """Suggest what an event that never happened may mean, and which plans would handle it."""
    rule = next(
        (rule for rules in past.rules.values() for rule in rules if name_of(rule) == pattern.name), None
    )
    if rule is not None and not pattern.kind:
        yield Fact("note", f"`{pattern.name}` is the conclusion of a rule; rules cause no events")
    yield from _near_plans(past, pattern, agent)
    help = suggestion(pattern.name, sorted(known_names(past) - {pattern.name}))
    if help:
        yield Fact("note", help)
    seen = sorted({shown(data.get("trigger")) for _, data in past.deliberations if _is_near(data, pattern)})
    if seen:
        yield Fact("note", f"events with this name: {', '.join(f'`{each}`' for each in seen[:MOST_PLANS])}")


def _is_near(data: Data, pattern: Pattern) -> bool:
    return name_of(str(data.get("trigger", ""))) == pattern.name


def _near_plans(past: Past, pattern: Pattern, agent: str) -> Iterator[Fact]:
    """Return the plans with the name of an event that do not handle it."""
    for name, plan in past.plans(agent):
        trigger = str(plan.get("trigger", ""))
        if name_of(trigger) == pattern.name:
            how = "waits for it" if pattern.fits(trigger) else "does not match: another trigger"
            yield Fact("plan", f"`{plan_text(plan)}` {how}", None, name, *place_of(plan))


def known_names(past: Past) -> set[str]:
    """Return the names of all events, goals and beliefs that occurred or that plans handle."""
    names = {name_of(str(data.get("trigger", ""))) for _, data in past.deliberations}
    names |= {name_of(str(data.get("belief", ""))) for _, data in past.beliefs}
    names |= {name_of(str(data.get("goal", ""))) for _, data in past.goals}
    names |= {name_of(str(plan.get("trigger", ""))) for _, plan in past.plans()}
    return names - {""}
