"""Answers about events, goals, plans and beliefs: how they were handled, and why."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import PurePath

from jacaros.look.records import records
from jacaros.look.why.chains import chain, code_of, place_of, plan_name, plan_text, shown, source_line, where
from jacaros.look.why.deeds import deeds_asked_for, is_named, stems
from jacaros.look.why.explanation import Explanation, Fact, earlier, seconds, times
from jacaros.look.why.past import Deed, Past, of_agent
from jacaros.look.why.patterns import Question, QuestionPattern, name_of
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
        return _unhandled(past, asked, pattern)
    t, last = found[-1]
    agent, trigger, plan = last.agent, shown(last.trigger), past.plan(last.agent, last.chosen)
    if last.chosen is None:
        relevant = "applicable" if last.options or unexamined(past, last) else "relevant"
        answer = f"{agent} has no {relevant} plan for `{trigger}` at {seconds(t)}"
    else:
        named = f"{plan_name(plan)} ({where(plan)})" if plan else "a plan that it no longer has"
        answer = f"{agent} handled `{trigger}` at {seconds(t)} with {named}"
    facts = [*candidates(past, last)]
    for each in deeds_asked_for(past, asked):
        if (each.kind, each.agent, f"+{each.text}") == ("goal", agent, last.trigger) and each.at >= t:
            facts.append(Fact("goal", f"{shown(each.text)} {each.outcome}"))
            facts += (Fact("note", line.strip()) for line in each.why.split("\n")[1:])
            break
    facts += earlier(at for at, _ in found)
    return Explanation(asked.written, answer, t, tuple(facts), chain(past, last.id))


def unexamined(past: Past, deliberation: records.DeliberationRecord) -> list[records.PlanRecord]:
    """Return the plans for an event that a busy agent did not record."""
    if deliberation.chosen is not None:
        return []
    named, event = {option.plan for option in deliberation.options or ()}, deliberation.trigger
    plans = (plan for _, plan in past.plans(deliberation.agent) if plan.id not in named)
    found = []
    for plan in plans:
        with suppress(UsageError):  # a truncated trigger
            if name_of(plan.trigger) == name_of(event) and QuestionPattern(plan.trigger).fits(event):
                found.append(plan)
    return found


def candidates(past: Past, deliberation: records.DeliberationRecord) -> Iterator[Fact]:
    """Return the relevant plans of an event in order, each with the reason why it was not chosen."""
    agent, options, chosen = deliberation.agent, deliberation.options or (), deliberation.chosen
    unknown = REFUSED if chosen is None else "applicable too, but another plan was selected"
    treated = [(past.plan(agent, option.plan), option.why or unknown) for option in options[:MOST]]
    for plan in unexamined(past, deliberation)[:MOST]:
        busy = "did not apply; not examined, because the agent was busy"
        treated.append((plan, "its annotations do not match" if "[" in plan.trigger else busy))
    if past.plan(agent, chosen):
        treated.append((past.plan(agent, chosen), CHOSEN))
    later = "not tried, because the chosen plan comes before it"
    treated += ((past.plan(agent, number), later) for number in (deliberation.untried or ())[:MOST])
    for each, what in treated:
        yield Fact("plan", f"`{plan_text(each)}`: {what}", None, "", *place_of(each))
    if len(options) > MOST:
        yield Fact("note", f"{len(options) - MOST} more plans do not apply")


def _unhandled(past: Past, asked: Question, pattern: QuestionPattern) -> Explanation:
    """Explain an event that no plan is for, a goal of an agent in Python, or what never happened."""
    for t, data in reversed(of_agent(past.beliefs, asked.agent) if not pattern.kind else []):
        event = f"{data.op}{data.belief}"
        if pattern.fits(event):
            answer = f"{data.agent} has no relevant plan for `{shown(event)}` at {seconds(t)}"
            facts = tuple(_near_plans(past, pattern, data.agent))
            return Explanation(asked.written, answer, t, facts, chain(past, data.cause))
    for each in reversed(deeds_asked_for(past, asked) if pattern.kind == "!" else []):
        if each.kind == "goal" and pattern.fits(each.text):
            return Explanation(asked.written, f"{each.agent}: {each.text} {each.outcome}", each.began)
    return _never(past, asked, pattern, f"{'goal' if pattern.kind else 'event'} `{asked.about}` happened")


def _never(past: Past, asked: Question, pattern: QuestionPattern, what: str) -> Explanation:
    """Explain that something never happened: what else its name may mean, and the plans for it."""
    agent, name = asked.agent, pattern.name
    who = f" in {agent}" if agent else ""
    rules = [rule for rules in past.rules.values() for rule in rules if name_of(rule) == name]
    facts = [Fact("note", f"rules conclude it, and cause no events: {rule}") for rule in rules[:MOST]]
    facts += _near_plans(past, pattern, agent)
    occurred = [data.trigger for _, data in past.deliberations] + [data.belief for _, data in past.beliefs]
    names = {*map(name_of, occurred), *(name_of(plan.trigger) for _, plan in past.plans())} - {"", name}
    seen = ", ".join(sorted({f"`{shown(each)}`" for each in occurred if name_of(each) == name})[:MOST])
    notes = suggestion(name, sorted(names)), f"recorded with this name: {seen}" if seen else ""
    facts += (Fact("note", each) for each in notes if each)
    return Explanation(asked.written, f"no {what}{who} until {seconds(past.end)}", None, tuple(facts))


def _near_plans(past: Past, pattern: QuestionPattern, agent: str) -> Iterator[Fact]:
    """Return the plans with the name of an event that do not handle it."""
    for name, plan in past.plans(agent):
        if name_of(plan.trigger) == pattern.name:
            how = "waits for it" if pattern.fits(plan.trigger) else "does not match: another trigger"
            yield Fact("plan", f"`{plan_text(plan)}` {how}", None, name, *place_of(plan))


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
    treated = [(name, plan, _considered(past, name, plan)) for name, plan in found]
    name, plan, considered = max(treated, key=lambda each: each[2][-1][0] if each[2] else -1.0)
    what = f"{plan_name(plan)} of {name} ({where(plan)})"
    if not considered:
        never = explain_event(past, replace(asked, about=plan.trigger, agent=name))
        facts = Fact("note", never.answer), *never.facts
        return Explanation(asked.written, f"{what} was never considered", None, facts, never.because)
    t, data, how = considered[-1]
    answer = f"{what} {how if how == REFUSED else f'was {how}'} for `{shown(data.trigger)}` at {seconds(t)}"
    hows = [how for *_, how in considered]
    told = ", ".join(f"{word} {times(hows.count(how))}" for how, word in _COUNTED.items())
    facts = (*candidates(past, data), Fact("note", f"until then {told}"))
    return Explanation(asked.written, answer, t, facts, chain(past, data.id))


_COUNTED = {CHOSEN: "chosen", REFUSED: "refused", UNTRIED: "not tried"}


def _considered(
    past: Past, agent: str, plan: records.PlanRecord
) -> list[tuple[float, records.DeliberationRecord, str]]:
    """Return the events that a plan was relevant for, each with how the plan was treated."""
    found = []
    for t, data in of_agent(past.deliberations, agent):
        refused = any(option.plan == plan.id for option in data.options or ())
        untried = UNTRIED if plan.id in (data.untried or ()) else ""
        if how := CHOSEN if data.chosen == plan.id else REFUSED if refused else untried:
            found.append((t, data, how))
    return found


def _find(past: Past, about: str, agent: str) -> list[tuple[str, records.PlanRecord]]:
    """Return the plans that *about* may mean, each with its agent; at least one."""
    plans, name = list(past.plans(agent)), about.removeprefix("@").strip()
    checks: tuple[Callable[[records.PlanRecord], bool], ...] = (
        lambda plan: (plan.label or "").partition("[")[0] == name,
        lambda plan: _is_at(plan, about),
        lambda plan: name in (plan.trigger, plan.trigger.removeprefix("+")),
        lambda plan: name.removeprefix("+") == plan.trigger.partition("(")[0].removeprefix("+"),
    )
    for is_it in checks:
        if found := [each for each in plans if is_it(each[1])]:
            return found
    names = ((plan_name(plan), PurePath(where(plan)).name) for _, plan in plans)
    places = sorted({label if label[0] == "@" else place for label, place in names})
    known = ", ".join([*places[:MOST], *(["..."] if len(places) > MOST else ())])
    listed = f"known plans: {known}" if known else "the recording has no plans"
    raise UsageError(f"error: unknown plan: `{about}`\n  = help: {listed}")


def _is_at(plan: records.PlanRecord, about: str) -> bool:
    """Return whether a location is in a plan. The file may be named without its folders."""
    file, _, line = about.rpartition(":")
    own, first = place_of(plan)
    is_there = line.isdigit() and first <= int(line) <= (plan.end or first)
    return is_there and bool(file) and PurePath(own).match(file)


def plan_about(past: Past, words: list[str], agent: str) -> str | None:
    """Return the place of the plan that words describe, by its trigger, label, context and steps; None if no plan fits. A
    plan of a library must have its name from them.
    """
    found = []
    for name, plan in past.plans(agent) if words else ():
        code = " ".join(line for _, line in code_of(past, plan))
        named, is_own = is_named(Deed("goal", plan.trigger, 0.0), words), where(plan)[0] != "$"
        if {*words} <= {*stems(f"{plan.label} {plan_text(plan)} {code}")} and (named or is_own):
            found.append((named, bool(_considered(past, name, plan)), -len(code), where(plan)))
    return max(found)[-1] if found else None


# ---- beliefs


def explain_belief(past: Past, asked: Question) -> Explanation:
    """Explain the last change of a belief, such as ``battery(_)``."""
    pattern = QuestionPattern(asked.about)
    changes = [each for each in of_agent(past.beliefs, asked.agent) if pattern.fits_literal(each[1].belief)]
    if not changes:
        return _never(past, asked, pattern, f"belief `{pattern.written}` was recorded")
    t, last = changes[-1]
    does = "came to believe" if last.op == "+" else "stopped believing"
    answer = f"{last.agent} {does} `{shown(last.belief)}` at {seconds(t)}"
    file, line = place_of(last)
    step = f"the step `{source_line(past, file, line)}` of intention {last.intention} did it"
    facts = [Fact("act", step, t, "", file, line)] if file else []
    if not file and not last.cause:
        facts.append(Fact("note", "it is an initial belief, or was added from outside of the plans"))
    for at, data in reversed(changes[:-1][-MOST_CHANGES:]):
        before = f"before: {data.op}{shown(data.belief)} at {seconds(at)}"
        facts.append(Fact("belief", before, at, data.agent))
    return Explanation(asked.written, answer, t, tuple(facts), chain(past, last.cause))
