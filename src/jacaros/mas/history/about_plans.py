"""Answers about plans: why one was chosen, or not."""

from collections.abc import Iterator
from pathlib import PurePath

from jacaros.errors import UsageError
from jacaros.mas.history.about_events import explain_event
from jacaros.mas.history.chains import chain, is_written, place_of, plan_name, plan_text, shown
from jacaros.mas.history.explanation import Explanation, Fact, seconds
from jacaros.mas.history.past import Data, Past, of_agent

MOST_NAMES = 8
"""Maximum number of plans that the error for an unknown one lists."""
CHOSEN, REFUSED, UNTRIED = "chosen", "refused", "untried"


def explain_plan(past: Past, question: str, about: str, agent: str = "") -> Explanation:
    """Explain when a plan was chosen, and why it was not.

    Args:
        past: the records.
        question: as it was asked.
        about: ``@label``, ``file.asl:line`` or the trigger of the plan.
        agent: agent of the plan. Default: the first agent that has it.

    Raises:
        UsageError: the plan does not exist.
    """
    found = _find(past, about, agent)
    if len({plan["id"] for _, plan in found}) > 1:
        return explain_event(past, question, str(found[0][1]["trigger"]), agent)
    name, plan, considered = max(
        ((name, plan, _considered(past, name, plan)) for name, plan in found),
        key=lambda each: each[2][-1][0] if each[2] else -1.0,
    )
    file, line = place_of(plan)
    what = f"{plan_name(plan)} of {name} ({file}:{line})"
    if not considered:
        never = explain_event(past, question, str(plan["trigger"]), name)
        reason = Fact("note", never.answer)
        return Explanation(
            question, f"{what} was never considered", None, (reason, *never.facts), never.because
        )
    t, data, how = considered[-1]
    answer = f"{what} {_what_happened(how)} for `{shown(data['trigger'])}` at {seconds(t)}"
    facts = (*_reasons(past, name, data, plan, how), *_counts(considered))
    return Explanation(question, answer, t, facts, chain(past, data["id"]))


def _considered(past: Past, agent: str, plan: Data) -> list[tuple[float, Data, str]]:
    """Return the events that a plan was relevant for, each with how the plan was treated."""
    return [
        (t, data, how) for t, data in of_agent(past.deliberations, agent) for how in _parts(data, plan["id"])
    ]


def _what_happened(how: str) -> str:
    return {CHOSEN: "was chosen", REFUSED: "did not apply"}.get(how, "was not tried")


def _parts(deliberation: Data, number: object) -> Iterator[str]:
    """Return how a plan was treated when an event was handled."""
    if deliberation.get("chosen") == number:
        yield CHOSEN
    elif any(option.get("plan") == number for option in deliberation.get("options") or ()):
        yield REFUSED
    elif number in (deliberation.get("untried") or ()):
        yield UNTRIED


def _reasons(past: Past, agent: str, deliberation: Data, plan: Data, how: str) -> Iterator[Fact]:
    if how == REFUSED:
        options = deliberation.get("options") or ()
        why = next(str(option.get("why") or "") for option in options if option.get("plan") == plan["id"])
        yield Fact("plan", why or "applicable, but another plan was selected")
    if how == CHOSEN:
        for option in deliberation.get("options") or ():
            yield _other(past.plan(agent, option.get("plan")), f"does not apply: {option.get('why') or ''}")
    else:
        chosen = past.plan(agent, deliberation.get("chosen"))
        if chosen:
            yield _other(chosen, "was chosen")


def _other(plan: Data, what: str) -> Fact:
    return Fact("plan", f"`{plan_text(plan)}` {what.removesuffix(': ')}", None, "", *place_of(plan))


def _counts(considered: list[tuple[float, Data, str]]) -> Iterator[Fact]:
    counts = {how: sum(each[2] == how for each in considered) for how in (CHOSEN, REFUSED, UNTRIED)}
    told = ", ".join(
        f"{'not tried' if how == UNTRIED else how} {_times(count)}" for how, count in counts.items()
    )
    yield Fact("note", f"until then {told}")


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"


def _find(past: Past, about: str, agent: str) -> list[tuple[str, Data]]:
    """Return the plans that *about* may mean, each with its agent; at least one."""
    plans = list(past.plans(agent))
    for is_it in (_has_label, _is_at, _has_trigger):
        found = [each for each in plans if is_it(each[1], about)]
        if found:
            return found
    names = sorted(
        {plan_name(plan) if is_written(str(plan.get("label") or "")) else _at(plan) for _, plan in plans}
    )
    more = ", ..." if len(names) > MOST_NAMES else ""
    listed = f"known plans: {', '.join(names[:MOST_NAMES])}{more}" if names else "the recording has no plans"
    raise UsageError(f"error: unknown plan: `{about}`\n  = help: {listed}")


def _at(plan: Data) -> str:
    file, line = place_of(plan)
    return f"{PurePath(file).name}:{line}"


def _has_label(plan: Data, about: str) -> bool:
    return str(plan.get("label") or "").partition("[")[0] == about.removeprefix("@")


def _is_at(plan: Data, about: str) -> bool:
    """Return whether a location is in a plan. The file may be named without its folders."""
    file, _, line = about.rpartition(":")
    if not line.isdigit() or not file:
        return False
    first = int(plan.get("line") or 0)
    own = PurePath(str(plan.get("file") or ""))
    same = own.parts[-len(PurePath(file).parts) :] == PurePath(file).parts
    return same and first <= int(line) <= int(plan.get("end") or first)


def _has_trigger(plan: Data, about: str) -> bool:
    trigger, wanted = str(plan.get("trigger", "")), about.strip()
    return wanted in (trigger, trigger.removeprefix("+"), trigger.partition("(")[0]) or (
        trigger.partition("(")[0] == f"+{wanted}"
    )
