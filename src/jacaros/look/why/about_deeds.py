"""Answers about what happened: why, when, how often, whether it was achieved, and what failed."""

from collections.abc import Sequence

from jacaros.look.records import records
from jacaros.look.why.about_now import ending_step, waits_for
from jacaros.look.why.chains import applied, chain, events_before, place_of, shown, with_values, world_facts
from jacaros.look.why.deeds import deeds_asked_for, place_of_deed, places_of
from jacaros.look.why.explanation import Explanation, Fact, earlier, seconds, times
from jacaros.look.why.past import AT_ONCE, OPEN, SUCCEEDED, Deed, Past
from jacaros.look.why.patterns import Question, name_of

MOST = 8
"""Maximum number of earlier occurrences, values or goals in an answer."""
_TEST = "achieves("
"""In the reason for waiting of a goal whose condition is tested."""
_DOES = {"goal": "pursued", "operation": "started", "belief": "came to believe", "event": "noticed"}


def explain_why(past: Past, asked: Question, found: Sequence[Deed]) -> Explanation:
    """Explain why the last of some deeds happened."""
    last = found[-1]
    if last.kind == "world":
        answer = f"{last.agent} {last.text} at {seconds(last.began)}; the records of the world give no cause"
        return Explanation(asked.written, answer, last.began)
    reason, facts = _reason(past, last)
    end = f"; it {last.outcome}" if last.kind in ("goal", "operation") else ""
    what = f"{_DOES[last.kind]} `{shown(last.text)}` at {seconds(last.began)}{reason}{end}"
    if place := place_of_deed(last.text, places_of(past)):
        facts.append(Fact("belief", f"the place is `{place}`"))
    facts += earlier(each.began for each in found)
    answer = f"{last.agent} {what}".lstrip()
    return Explanation(asked.written, answer, last.began, tuple(facts), chain(past, last.link))


def _reason(past: Past, deed: Deed) -> tuple[str, list[Fact]]:
    """Return why a deed happened, in words, and the values of the condition that made it happen."""
    links = [each for each in past.chain(deed.link) if each.cause.id != deed.link or deed.kind == "event"]
    handled = [(each.t, each.of) for each in links if isinstance(each.of, records.DeliberationRecord)]
    # The last condition that each goal waited for before the deed, by the goal's event.
    waits = {
        f"+{goal}": condition
        for t, agent, goal, condition in past.waits
        if agent == deed.agent and t <= deed.began and _TEST not in condition
    }
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
    # The first goal of the agent only began the one that the deed belongs to.
    goals = [*{name_of(each.trigger): each for _, each in reversed(handled)}.values()]
    plans = [(each, past.plan(each.agent, each.chosen)) for _, each in handled[:-1]]
    own = [each for each, plan in plans if not place_of(plan)[0].startswith("$")]
    steps = dict.fromkeys(f"`{shown(each.trigger[1:])}`" for each in (*own[:1], *(goals[1:2] or goals)))
    return (f" for {', part of '.join(steps)}" if handled else ""), []


def explain_when(past: Past, asked: Question, found: Sequence[Deed]) -> Explanation:
    """Explain when some deeds happened, and how often."""
    facts = []
    for each in found[: -MOST - 1 : -1]:
        began = f"began at {seconds(each.began)}; it " if each.kind in ("goal", "operation") else ""
        facts.append(Fact(each.kind, f"`{shown(each.text)}` {began}{each.outcome}", each.began, each.agent))
    last, when = found[-1], "last at" if len(found) > 1 else "at"
    what = shown(last.text) if len({each.text for each in found}) == 1 else name_of(last.text)
    answer = f"`{what}` happened {times(len(found))}, {when} {seconds(last.began)}"
    return Explanation(asked.written, answer, last.began, tuple(facts))


def explain_outcome(past: Past, asked: Question, found: Sequence[Deed], ask: str = "did") -> Explanation:
    """Explain how the last of some deeds ended, and unless *ask* is ``why`` or ``why not``, whether it succeeded: the first
    word of the question; ``is`` asks for what lasts.
    """
    last, done = found[-1], [each for each in found[:-1] if each.state in SUCCEEDED]
    facts = [Fact("note", line.strip()) for line in last.why.split("\n")[1:]]
    if done and ask in ("did", "has", "does") and (last.state in OPEN or _ends_with_run(past, last)):
        newer, last = last, done.pop()
        facts = [Fact("note", f"`{shown(newer.text)}` {_end(past, newer)}")]
    lasts = last.state in ("holds", *OPEN)
    holds = lasts if ask in ("is", "are") else last.state in SUCCEEDED or last.state == "holds"
    own = (each.artifact for each in past.operations.values() if each.agent == last.agent)
    robots = {past.robots_of.get(artifact, "") for artifact in own} - {""}
    misplaced = (each for each in reversed(past.misplaced) if each[0] <= last.at and each[1] in robots)
    t, robot, where = next(misplaced, (0.0, "", ""))
    is_wrong = holds and last.kind in ("goal", "operation") and bool(where)
    ends_with_run, ending = _ends_with_run(past, last), ending_step(past)
    said = ""
    if ask == "did" and ends_with_run and past.exit_code == 0 and _is_step_of(ending, last):
        said = "it ended the run with exit code 0: "  # its program calls that done
    elif ask != "why" and last.state != "replaced":
        yes = "it believes so: " if is_wrong else "it did: " if ask == "why not" else "yes: "
        no = "" if ask == "why not" else "not yet: " if lasts else "no: "
        said = yes if holds else no
    who = f" of {last.agent}" if last.agent else ""
    for _, agent, goal, condition in reversed(past.waits):
        if _TEST in condition and (agent, goal) == (last.agent, last.text):
            facts.append(Fact("belief", with_values(past, agent, condition, last.at), None, agent))
            break
    if is_wrong:
        far = f"{robot} believed to be at {where}, but was more than 5 cm or 5 degrees away"
        facts.append(Fact("note", far, t))
    for robot in robots if last.ended is not None else ():
        facts += world_facts(past, last.at, robot)
    if ends_with_run and ending is not None:
        facts.append(ending)
    elif lasts or ends_with_run:
        facts += waits_for(past, last.agent, last.text)
    elif last.state == "dropped" or last.why == "cancelled":
        facts += (fact for fact, _ in events_before(past, last.at, last.link, last.agent))
    if done:
        before = f"{done[-1].state} {times(len(done))} before, last at {seconds(done[-1].at)}"
        facts.append(Fact("note", before))
    because = () if holds else chain(past, last.link)
    answer = f"{said}`{shown(last.text)}`{who} {_end(past, last)}"
    return Explanation(asked.written, answer, last.at, tuple(facts[:MOST]), because)


def _ends_with_run(past: Past, deed: Deed) -> bool:
    """Return whether the end of the run ended a deed."""
    ended = deed.ended is not None and past.exit_code is not None and past.end - deed.ended <= AT_ONCE
    return ended and (deed.state == "dropped" or deed.why == "cancelled")


def _is_step_of(step: Fact | None, deed: Deed) -> bool:
    return step is not None and step.agent == deed.agent and step.text.endswith(f"`{shown(deed.text)}`")


def _end(past: Past, deed: Deed) -> str:
    if deed.kind == "belief":
        return (
            f"holds since {seconds(deed.began)}"
            if deed.ended is None
            else f"held until {seconds(deed.ended)}"
        )
    return deed.outcome + (", when the run ended" if _ends_with_run(past, deed) else "")


def explain_failure(past: Past, asked: Question) -> Explanation:
    """Explain the last failure: the first thing that failed, and the goals that failed with it."""
    deeds = deeds_asked_for(past, asked)
    failed = [each for each in deeds if each.state in ("failed", "recovered") and each.why != "cancelled"]
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
    for each in goals:
        told = f"{shown(each.text)} {each.state} at {seconds(each.at)}"
        facts.append(Fact("goal", told, None, each.agent))
    recovered = ", and the agent recovered" if any(each.state == "recovered" for each in goals) else ""
    answer = f"`{shown(first.text)}` {first.outcome}{recovered}"
    return Explanation(asked.written, answer, first.at, tuple(facts[:MOST]), chain(past, first.link))
