"""Answers about events, goals, plans and beliefs: how they were handled, and why."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import PurePath

from jacaros.look.records import records
from jacaros.look.why.chains import chain, is_written, place_of, plan_name, plan_text, shown, source_line
from jacaros.look.why.explanation import Explanation, Fact, seconds
from jacaros.look.why.past import Past, TimedRecords, of_agent
from jacaros.look.why.patterns import Question, QuestionPattern, name_of, unsigned
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import suggestion

MOST = 8
"""Maximum number of plans in an answer or an error."""
MOST_CHANGES = 5
"""Number of earlier changes of a belief that an answer lists."""
CHOSEN, REFUSED, UNTRIED = "chosen", "did not apply", "not tried"


def explain_event(past: Past, asked: Question) -> Explanation:
    """Explain the last event that matches the subject, such as ``+alarm(_)`` or ``!go(dock)``."""
    pattern = QuestionPattern(asked.about)
    found = [each for each in of_agent(past.deliberations, asked.agent) if pattern.fits(each[1].trigger)]
    if not found:
        return _never(past, asked, pattern)
    t, last = found[-1]
    facts = [*candidates(past, last), *_outcome(past, t, last)]
    if len(found) > 1:
        facts.append(Fact("note", f"it happened {_times(len(found) - 1)} before; ask with --at T"))
    return Explanation(asked.written, _headline(past, t, last), t, tuple(facts), chain(past, last.id))


def explain_deliberation(
    past: Past, question: str, t: float, deliberation: records.DeliberationRecord
) -> Explanation:
    """Explain one handled event."""
    facts = tuple(candidates(past, deliberation))
    return Explanation(question, _headline(past, t, deliberation), t, facts, chain(past, deliberation.id))


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"


def _headline(past: Past, t: float, deliberation: records.DeliberationRecord) -> str:
    agent, trigger = deliberation.agent, shown(deliberation.trigger)
    plan = past.plan(agent, deliberation.chosen)
    if plan:
        file, line = place_of(plan)
        return f"{agent} handled `{trigger}` at {seconds(t)} with {plan_name(plan)} ({file}:{line})"
    if deliberation.chosen is not None:
        return f"{agent} handled `{trigger}` at {seconds(t)} with a plan that it no longer has"
    relevant = "applicable" if deliberation.options or unexamined(past, deliberation) else "relevant"
    return f"{agent} has no {relevant} plan for `{trigger}` at {seconds(t)}"


def unexamined(past: Past, deliberation: records.DeliberationRecord) -> list[records.PlanRecord]:
    """Return the plans for an event that a busy agent did not record."""
    if deliberation.chosen is not None:
        return []
    named = {option.plan for option in deliberation.options or ()}
    plans = (plan for _, plan in past.plans(deliberation.agent) if plan.id not in named)
    return [plan for plan in plans if _is_for(plan.trigger, deliberation.trigger)]


def _is_for(trigger: str, event: str) -> bool:
    if name_of(trigger) != name_of(event):
        return False
    try:
        return QuestionPattern(trigger).fits(event)
    except UsageError:
        return False


def candidates(past: Past, deliberation: records.DeliberationRecord) -> Iterator[Fact]:
    """Return the relevant plans of an event in order, each with the reason why it was not chosen."""
    agent, options = deliberation.agent, deliberation.options or ()
    unknown = "did not apply" if deliberation.chosen is None else _SELECTED
    for option in options[:MOST]:
        yield _candidate(past.plan(agent, option.plan), option.why or unknown)
    for plan in unexamined(past, deliberation)[:MOST]:
        is_annotated = "[" in plan.trigger
        busy = "did not apply; not examined, because the agent was busy"
        yield _candidate(plan, "its annotations do not match" if is_annotated else busy)
    chosen = past.plan(agent, deliberation.chosen)
    if chosen:
        yield _candidate(chosen, "chosen")
    for number in (deliberation.untried or ())[:MOST]:
        yield _candidate(past.plan(agent, number), "not tried, because the chosen plan comes before it")
    if len(options) > MOST:
        yield Fact("note", f"{len(options) - MOST} more plans do not apply")


_SELECTED = "applicable too, but another plan was selected"


def _candidate(plan: records.PlanRecord | None, what: str) -> Fact:
    return Fact("plan", f"`{plan_text(plan)}`: {what}", None, "", *place_of(plan))


def _outcome(past: Past, t: float, deliberation: records.DeliberationRecord) -> Iterator[Fact]:
    goal = unsigned(deliberation.trigger)
    for later, data in past.goals if goal.startswith("!") else ():
        same = data.agent == deliberation.agent and data.goal == goal
        if same and later >= t and data.state not in ("pursued", "suspended", "resumed"):
            yield Fact("goal", goal_text(later, data))
            return


def goal_text(t: float, goal: records.GoalRecord) -> str:
    """Return a change of a goal as text."""
    return f"{goal.goal} {goal.state} at {seconds(t)}{f': {goal.why}' if goal.why else ''}"


def _never(past: Past, asked: Question, pattern: QuestionPattern) -> Explanation:
    agent = asked.agent
    if not pattern.kind:
        changes = (
            each
            for each in reversed(of_agent(past.beliefs, agent))
            if pattern.fits(f"{each[1].op}{each[1].belief}")
        )
        for t, data in changes:
            answer = f"{data.agent} has no relevant plan for `{data.op}{shown(data.belief)}` at {seconds(t)}"
            facts = tuple(_near_plans(past, pattern, data.agent))
            return Explanation(asked.written, answer, t, facts, chain(past, data.cause))
    for t, goal in reversed(past.goals if pattern.kind == "!" else ()):
        if pattern.fits(goal.goal):
            return Explanation(asked.written, f"{goal.agent}: {goal_text(t, goal)}", t)
    what, who = "goal" if pattern.kind else "event", f" in {agent}" if agent else ""
    answer = f"no {what} `{asked.about}` happened{who} until {seconds(past.end)}"
    return Explanation(asked.written, answer, None, tuple(_hints(past, pattern, agent)))


def _rule(past: Past, name: str) -> str | None:
    return next((rule for rules in past.rules.values() for rule in rules if name_of(rule) == name), None)


def _hints(past: Past, pattern: QuestionPattern, agent: str) -> Iterator[Fact]:
    """Suggest what an event that never happened may mean, and which plans would handle it."""
    if not pattern.kind and _rule(past, pattern.name) is not None:
        yield Fact("note", f"`{pattern.name}` is the conclusion of a rule; rules cause no events")
    yield from _near_plans(past, pattern, agent)
    help = suggestion(pattern.name, sorted(known_names(past) - {pattern.name}))
    if help:
        yield Fact("note", help)
    near = (data.trigger for _, data in past.deliberations if name_of(data.trigger) == pattern.name)
    seen = sorted(set(map(shown, near)))
    if seen:
        yield Fact("note", f"events with this name: {', '.join(f'`{each}`' for each in seen[:MOST])}")


def _near_plans(past: Past, pattern: QuestionPattern, agent: str) -> Iterator[Fact]:
    """Return the plans with the name of an event that do not handle it."""
    for name, plan in past.plans(agent):
        if name_of(plan.trigger) == pattern.name:
            how = "waits for it" if pattern.fits(plan.trigger) else "does not match: another trigger"
            yield Fact("plan", f"`{plan_text(plan)}` {how}", None, name, *place_of(plan))


def known_names(past: Past) -> set[str]:
    """Return the names of all events, goals and beliefs that occurred or that plans handle."""
    found = [data.trigger for _, data in past.deliberations]
    found += [data.belief for _, data in past.beliefs]
    found += [data.goal for _, data in past.goals]
    found += [plan.trigger for _, plan in past.plans()]
    return set(map(name_of, found)) - {""}


# ---- plans


def explain_plan(past: Past, asked: Question) -> Explanation:
    """Explain when a plan was chosen, and why it was not. It is asked for as ``@label``, ``file.asl:line`` or its trigger;
    of several agents that have it, the one that considered it last.

    Raises:
        UsageError: the plan does not exist.
    """
    found = _find(past, asked.about, asked.agent)
    if len({plan.id for _, plan in found}) > 1:
        return explain_event(past, replace(asked, about=found[0][1].trigger))
    name, plan, considered = max(
        ((name, plan, _considered(past, name, plan)) for name, plan in found),
        key=lambda each: each[2][-1][0] if each[2] else -1.0,
    )
    file, line = place_of(plan)
    what = f"{plan_name(plan)} of {name} ({file}:{line})"
    if not considered:
        never = explain_event(past, replace(asked, about=plan.trigger, agent=name))
        facts = Fact("note", never.answer), *never.facts
        return Explanation(asked.written, f"{what} was never considered", None, facts, never.because)
    t, data, how = considered[-1]
    answer = f"{what} {how if how == REFUSED else f'was {how}'} for `{shown(data.trigger)}` at {seconds(t)}"
    counts = {each: sum(treated == each for *_, treated in considered) for each in _COUNTED}
    told = ", ".join(f"{_COUNTED[each]} {_times(count)}" for each, count in counts.items())
    facts = (*_reasons(past, name, data, plan, how), Fact("note", f"until then {told}"))
    return Explanation(asked.written, answer, t, facts, chain(past, data.id))


_COUNTED = {CHOSEN: "chosen", REFUSED: "refused", UNTRIED: "not tried"}


def _considered(
    past: Past, agent: str, plan: records.PlanRecord
) -> list[tuple[float, records.DeliberationRecord, str]]:
    """Return the events that a plan was relevant for, each with how the plan was treated."""
    found = []
    for t, data in of_agent(past.deliberations, agent):
        if data.chosen == plan.id:
            found.append((t, data, CHOSEN))
        elif any(option.plan == plan.id for option in data.options or ()):
            found.append((t, data, REFUSED))
        elif plan.id in (data.untried or ()):
            found.append((t, data, UNTRIED))
    return found


def _reasons(
    past: Past, agent: str, deliberation: records.DeliberationRecord, plan: records.PlanRecord, how: str
) -> Iterator[Fact]:
    options = deliberation.options or ()
    if how == REFUSED:
        why = next(option.why for option in options if option.plan == plan.id)
        yield Fact("plan", why or "applicable, but another plan was selected")
    others = [(option.plan, f"does not apply: {option.why or ''}") for option in options]
    for number, what in others if how == CHOSEN else [(deliberation.chosen, "was chosen")]:
        other = past.plan(agent, number)
        if other or how == CHOSEN:
            told = f"`{plan_text(other)}` {what.removesuffix(': ')}"
            yield Fact("plan", told, None, "", *place_of(other))


def _find(past: Past, about: str, agent: str) -> list[tuple[str, records.PlanRecord]]:
    """Return the plans that *about* may mean, each with its agent; at least one."""
    plans = list(past.plans(agent))
    for is_it in (_has_label, _is_at, _has_trigger):
        found = [each for each in plans if is_it(each[1], about)]
        if found:
            return found
    names = sorted(
        {
            plan_name(plan)
            if is_written(plan.label)
            else f"{PurePath(plan.file or '').name}:{plan.line or 0}"
            for _, plan in plans
        }
    )
    more = ", ..." if len(names) > MOST else ""
    listed = f"known plans: {', '.join(names[:MOST])}{more}" if names else "the recording has no plans"
    raise UsageError(f"error: unknown plan: `{about}`\n  = help: {listed}")


def _has_label(plan: records.PlanRecord, about: str) -> bool:
    return (plan.label or "").partition("[")[0] == about.removeprefix("@")


def _is_at(plan: records.PlanRecord, about: str) -> bool:
    """Return whether a location is in a plan. The file may be named without its folders."""
    file, _, line = about.rpartition(":")
    if not line.isdigit() or not file:
        return False
    own, first = place_of(plan)
    same = PurePath(own).parts[-len(PurePath(file).parts) :] == PurePath(file).parts
    return same and first <= int(line) <= (plan.end or first)


def _has_trigger(plan: records.PlanRecord, about: str) -> bool:
    trigger, wanted = plan.trigger, about.strip()
    name = trigger.partition("(")[0]
    return wanted in (trigger, trigger.removeprefix("+"), name) or name == f"+{wanted}"


# ---- beliefs


def explain_belief(past: Past, asked: Question) -> Explanation:
    """Explain the last change of a belief, such as ``battery(_)``."""
    pattern, agent = QuestionPattern(asked.about), asked.agent
    changes = [each for each in of_agent(past.beliefs, agent) if pattern.fits_literal(each[1].belief)]
    if not changes:
        verb = f"{agent} never believed" if agent else "no agent ever believed"
        answer = f"{verb} `{pattern.written}` until {seconds(past.end)}"
        return Explanation(asked.written, answer, None, tuple(_meant(past, pattern)))
    t, last = changes[-1]
    does = "came to believe" if last.op == "+" else "stopped believing"
    answer = f"{last.agent} {does} `{shown(last.belief)}` at {seconds(t)}"
    facts = (*_changing_step(past, t, last), *_before(changes))
    return Explanation(asked.written, answer, t, facts, chain(past, last.cause))


def _changing_step(past: Past, t: float, change: records.BeliefRecord) -> Iterator[Fact]:
    file, line = place_of(change)
    if file:
        written = source_line(past, file, line)
        step = f"the step `{written}`" if written else "a step"
        whose = f" of intention {change.intention}" if change.intention else ""
        yield Fact("act", f"{step}{whose} did it", t, "", file, line)
    elif not change.cause:
        yield Fact("note", "it is an initial belief, or was added from outside of the plans")


def _before(changes: TimedRecords[records.BeliefRecord]) -> Iterator[Fact]:
    for t, data in reversed(changes[:-1][-MOST_CHANGES:]):
        yield Fact("belief", f"before: {data.op}{shown(data.belief)} at {seconds(t)}", t, data.agent)
    left = len(changes) - 1 - MOST_CHANGES
    if left > 0:
        yield Fact("note", f"{left} more changes before")


def _meant(past: Past, pattern: QuestionPattern) -> Iterator[Fact]:
    rule = _rule(past, pattern.name)
    if rule is not None:
        yield Fact("note", f"it is the conclusion of a rule: {rule}")
    same = [data.belief for _, data in past.beliefs if name_of(data.belief) == pattern.name]
    if same:
        yield Fact("note", f"there was `{shown(same[-1])}`")
        return
    help = suggestion(pattern.name, sorted({name_of(data.belief) for _, data in past.beliefs}))
    if help:
        yield Fact("note", help)
