"""Answers about what happened: why, when, how often, whether it was achieved, and what failed."""

from collections.abc import Collection, Sequence
from itertools import islice
from math import isnan, nan

from jacaros.look.records import records
from jacaros.look.why.about_motion import event_fact, events_before, world_facts
from jacaros.look.why.about_now import ending_step, waits_for
from jacaros.look.why.chains import applied, chain, place_of, shown, with_values
from jacaros.look.why.deeds import deeds_asked_for, place_of_deed, places_of
from jacaros.look.why.explanation import Explanation, Fact, earlier, seconds, times
from jacaros.look.why.past import AT_ONCE, CONDITION, OPEN, SUCCEEDED, Deed, Past
from jacaros.look.why.patterns import Question, name_of

MOST = 8
"""Maximum number of earlier occurrences, values or goals in an answer."""

_TEST = "achieves("
"""In the reason for waiting of a goal whose condition is tested."""


def explain_why(past: Past, asked: Question, found: Sequence[Deed]) -> Explanation:
    """Explain why the last of some deeds happened."""
    last = found[-1]
    who = f"{last.agent} " if last.agent else ""
    if last.kind == "world":
        answer = f"{who}{last.text} at {seconds(last.began)}; the world did it, and no cause is recorded"
        return Explanation(asked.written, answer, last.began)
    does = {"goal": "pursued", "operation": "started", "belief": "came to believe", "event": "noticed"}[
        last.kind
    ]
    reason, facts = _reason(past, last)
    end = f"; it {last.outcome}" if last.kind in ("goal", "operation") else ""
    answer = f"{who}{does} `{shown(last.text)}` at {seconds(last.began)}{reason}{end}"
    place = place_of_deed(last.text, places_of(past))
    if place:
        facts.append(Fact("belief", f"the place is `{place}`"))
    return Explanation(
        asked.written,
        answer,
        last.began,
        (*facts, *earlier(each.began for each in found)),
        chain(past, last.link),
    )


def explain_operation(past: Past, asked: Question) -> Explanation:
    """Explain why the last operation began, with the name if one is given."""
    operations = [each for each in deeds_asked_for(past, asked) if each.kind == "operation"]
    found = [each for each in operations if asked.about.partition("(")[0] in each.text]
    if found:
        return explain_why(past, asked, found)
    known = sorted({name_of(each.text) for each in operations})
    facts = (Fact("note", f"known operations: {', '.join(known[:MOST])}"),) if known else ()
    answer = f"no operation{f' `{asked.about}`' if asked.about else ''} began until {seconds(past.end)}"
    return Explanation(asked.written, answer, None, facts)


def _reason(past: Past, deed: Deed) -> tuple[str, list[Fact]]:
    """Return why a deed happened, in words, and the values of the condition that made it happen."""
    links = [each for each in past.chain(deed.link) if each.cause.id != deed.link or deed.kind == "event"]
    waits = _waits(past, deed)
    handled = [(each.t, each.of) for each in links if isinstance(each.of, records.DeliberationRecord)]
    names: list[str] = []
    for t, each in handled:
        # What a goal waited for before the rounds of a loop is not the reason for what a later round does.
        condition = waits.get(each.trigger) if len({*names}) == len(names) else None
        names.append(name_of(each.trigger))
        if condition:
            held = with_values(past, each.agent, condition, deed.began)
            return f" when `{condition}` held", [Fact("belief", held, None, each.agent)]
        if each.trigger[1:2] not in ("!", "?"):
            fact = applied(past, each, t)
            return f" because of `{shown(each.trigger)}`", [] if fact is None else [fact]
    goals = {name_of(each.trigger): each for _, each in reversed(handled)}
    # The first goal of the agent only began the one that the deed belongs to.
    whole = [*goals.values()][1:2] or [*goals.values()]
    own = [
        each
        for _, each in handled[:-1]
        if not place_of(past.plan(each.agent, each.chosen))[0].startswith("$")
    ]
    steps = dict.fromkeys(f"`{shown(each.trigger[1:])}`" for each in (*own[:1], *whole))
    return (f" for {', part of '.join(steps)}" if handled else ""), []


def _waits(past: Past, deed: Deed) -> dict[str, str]:
    """Return the last condition that each goal waited for before a deed, by the goal's event."""
    return {
        f"+{stack[-1].goal}": (wait.waits or "").removeprefix(CONDITION)
        for t, wait in past.waits
        if wait.agent == deed.agent
        and t <= deed.began
        and (stack := wait.stack)
        and _TEST not in (wait.waits or "")
    }


def explain_when(past: Past, asked: Question, found: Sequence[Deed]) -> Explanation:
    """Explain when some deeds happened, and how often."""
    facts = []
    for each in islice(reversed(found), MOST):
        began = f"began at {seconds(each.began)}; it " if each.kind in ("goal", "operation") else ""
        facts.append(Fact(each.kind, f"`{shown(each.text)}` {began}{each.outcome}", each.began, each.agent))
    last, when = found[-1], "last at" if len(found) > 1 else "at"
    answer = f"`{shown(last.text)}` happened {times(len(found))}, {when} {seconds(last.began)}"
    return Explanation(asked.written, answer, last.began, tuple(facts))


def explain_outcome(past: Past, asked: Question, found: Sequence[Deed], ask: str = "did") -> Explanation:
    """Explain how the last of some deeds ended, and unless *ask* is ``why`` or ``why not``, whether it succeeded: the first
    word of the question; ``is`` asks for what lasts.
    """
    last, done = found[-1], [each for each in found[:-1] if each.state in SUCCEEDED]
    if done and ask in ("did", "has", "does") and (last.state in OPEN or _ends_with_run(past, last)):
        newer, last = last, done.pop()
        facts = [Fact("note", f"`{shown(newer.text)}` {_end(past, newer)}")]
    else:
        facts = [Fact("note", line.strip()) for line in last.why.split("\n")[1:]]
    lasts = last.state in ("holds", *OPEN)
    holds = lasts if ask in ("is", "are") else last.state in SUCCEEDED or last.state == "holds"
    robots = {
        past.robots_of.get(each.artifact, "") for each in past.operations.values() if each.agent == last.agent
    }
    misplaced = _misplaced(past, last, robots) if holds else None
    if ask == "why" or last.state == "replaced":
        said = ""
    elif ask == "why not":
        said = "" if not holds else "it believes that it did: " if misplaced else "it did: "
    elif holds:
        said = "it believes so: " if misplaced else "yes: "
    else:
        said = "not yet: " if lasts else "no: "
    who = f" of {last.agent}" if last.agent else ""
    answer = f"{said}`{shown(last.text)}`{who} {_end(past, last)}"
    for _, wait in reversed(past.waits):
        condition = (wait.waits or "").removeprefix(CONDITION)
        if (
            _TEST in condition
            and wait.agent == last.agent
            and wait.stack
            and wait.stack[-1].goal == last.text
        ):
            facts.append(Fact("belief", with_values(past, last.agent, condition, last.at), None, last.agent))
            break
    facts += () if misplaced is None else (misplaced,)
    for robot in robots if last.ended is not None else ():
        facts += world_facts(past, last.at, robot) if robot else ()
    ending = ending_step(past)
    if _ends_with_run(past, last) and ending is not None:
        facts.append(ending)
    elif last.state == "dropped" and not _ends_with_run(past, last):
        facts += (event_fact(past, *each) for each in events_before(past, last.at, 0, last.agent))
    elif lasts or _ends_with_run(past, last):
        facts += waits_for(past, last.agent, last.text)
    if done:
        facts.append(
            Fact("note", f"{done[-1].state} {times(len(done))} before, last at {seconds(done[-1].at)}")
        )
    because = () if holds else chain(past, last.link)
    return Explanation(asked.written, answer, last.at, tuple(facts[:MOST]), because)


def _ends_with_run(past: Past, deed: Deed) -> bool:
    """Return whether the end of the run ended a deed."""
    ended = deed.ended is not None and past.exit_code is not None and past.end - deed.ended <= AT_ONCE
    return ended and (deed.state == "dropped" or deed.why == "cancelled")


def _misplaced(past: Past, deed: Deed, robots: Collection[str]) -> Fact | None:
    """Return where a robot was not, although it believed so when a deed ended."""
    own = (each for each in reversed(past.misplaced) if each[0] <= deed.at and each[1] in robots)
    t, robot, x, y = next(own, (0.0, "", nan, nan))
    if deed.kind not in ("goal", "operation") or isnan(x):
        return None
    return Fact(
        "note", f"{robot} believed to be at ({x:.2f}, {y:.2f}), but was more than 5 cm or 5 degrees away", t
    )


def _end(past: Past, deed: Deed) -> str:
    if deed.kind == "belief":
        return (
            f"holds since {seconds(deed.began)}"
            if deed.ended is None
            else f"held until {seconds(deed.ended)}"
        )
    return deed.outcome + (", when the run ended" if _ends_with_run(past, deed) else "")


def explain_failure(past: Past, asked: Question, found: Sequence[Deed] = ()) -> Explanation:
    """Explain the last failure, or that of some deeds: the first thing that failed, and the goals that failed with it."""
    failed = [
        each
        for each in found or deeds_asked_for(past, asked)
        if each.state in ("failed", "recovered") and each.why and each.why != "cancelled"
    ]
    if not failed:
        ended = "" if past.exit_code is None else f"; the run ended with exit code {past.exit_code}"
        return Explanation(asked.written, f"nothing failed until {seconds(past.end)}{ended}")
    last = max(failed, key=lambda each: each.at)
    together = [each for each in failed if each.agent == last.agent and each.at == last.at]
    first = min(together, key=lambda each: (each.kind != "operation", -each.began))
    goals = [each for each in together if each is not first]
    # After the first line come those with the step and the reason terms; an operation has none.
    lines = next((lines for each in (first, *goals) if (lines := each.why.split("\n")[1:])), [])
    facts = [Fact("note", line.strip()) for line in lines]
    facts += (
        Fact("goal", f"{shown(each.text)} {each.state} at {seconds(each.at)}", None, each.agent)
        for each in goals
    )
    recovered = ", and the agent recovered" if any(each.state == "recovered" for each in goals) else ""
    answer = f"`{shown(first.text)}` {first.outcome}{recovered}"
    return Explanation(asked.written, answer, first.at, tuple(facts[:MOST]), chain(past, first.link))
