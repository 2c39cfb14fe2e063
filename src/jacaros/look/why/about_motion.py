"""Answers about robots: why one stopped, and what led to a command."""

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import takewhile

from jacaros.look.records import records
from jacaros.look.why.about_deeds import explain_outcome
from jacaros.look.why.chains import chain, code_of, events_before, plan_name, shown, world_facts
from jacaros.look.why.deeds import deeds_asked_for
from jacaros.look.why.explanation import Explanation, Fact, seconds
from jacaros.look.why.past import AT_ONCE, ChainLink, Past, TimedRecords, of_agent
from jacaros.look.why.patterns import Question, literal_at

_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?\b")
_TURNING = re.compile(r"angular\.z=-?(?:0\.[1-9]|[1-9])")
_DRIVING = re.compile(r"linear\.[xy]=-?(?:0\.0?[1-9]|[1-9])")
"""Commands that turn or drive, rather than correct a motion of the other kind."""
MOST_FACTS = 8
"""Maximum number of facts in an answer, besides the chain."""
LATEST = 0.7
"""Maximum delay in seconds of a recorded stop after the change of a goal that caused it."""
_INTERRUPTS = re.compile(r"(\.)(?=(?:suspend|drop_\w+|fail_goal|succeed_goal)\b)|(?<=[\[, ])(?=needs\()")
"""Steps that interrupt a robot's motion, and goals that take its wheels from less urgent ones."""


def explain_stop(past: Past, asked: Question) -> Explanation:
    """Explain why a robot stopped: the first stop command after the last motion command."""
    question, robot = asked.written, asked.robot or "the robot"
    commands = _commands(past, asked.robot)
    if not commands:
        return _of_others(past, asked) or _no_command(past, replace(asked, about=""))
    # The numbers of a command to stop are all zero; one without numbers may stop it, too.
    stops = [*takewhile(lambda each: not _moves(each), reversed(commands))]
    if not stops:
        t, last, _ = commands[-1]
        answer = (
            f"no command to stop until {seconds(past.end)}; the last command is `{last.what}` at {seconds(t)}"
        )
        return Explanation(question, answer, t, (*world_facts(past, t, asked.robot),), chain(past, last.id))
    t, number = stops[-1].t, stops[-1].cause.id
    because = chain(past, number)
    links = [each.cause for each in past.chain(number)]
    started = next((each for link in links if (each := past.operations.get(link.id))), None)
    ended = started if started and started.ended is not None and started.ended <= t + LATEST else None
    if past.exit_code is not None and past.end - t <= AT_ONCE and not ended:
        answer = f"{robot} stopped at {seconds(t)}, because the run ended; robots are stopped then"
        return Explanation(question, answer, t, (), because)
    own = {(each.agent, each.intention) for each in links if each.sort == "act"}
    goals = _goals_interrupted(past, t, asked.agent)
    own_goals = [fact for whose, fact in goals if whose in own or not own]
    since = min((fact.t for _, fact in goals if fact.t is not None), default=t)
    handled = events_before(past, since, number, asked.agent)
    why = f": {ended.text} {ended.outcome}" if ended else ""
    if handled and own_goals and not (ended and ended.state == "done"):
        # A paused or cancelled operation publishes its last command for its own plan, or in the turn of the message
        # that made its agent suspend or drop it. The reason is in the plan that did so.
        reason = handled[-1][1]
        first = (fact for fact in because[:2] if fact.kind in ("command", "operation"))
        because = (*first, *own_goals, *_interrupting_step(past, reason, t), *chain(past, reason.id))
        why = f", because of `{shown(reason.trigger)}`"
    facts = (*(fact for fact, _ in handled), *(fact for _, fact in goals), *world_facts(past, t, asked.robot))
    return Explanation(question, f"{robot} stopped at {seconds(t)}{why}", t, facts[:MOST_FACTS], because)


def _of_others(past: Past, asked: Question) -> Explanation | None:
    """Explain the end of the last operation of a robot's artifact, if other nodes send the commands."""
    operations = [each for each in deeds_asked_for(past, asked) if each.kind == "operation"]
    own = [each for each in operations if asked.robot in ("", past.robots_of.get(each.artifact))]
    ended = [each for each in own if each.artifact in past.robots_of and each.ended is not None]
    if not ended:
        return None
    last = max(ended, key=lambda each: each.at)
    found = explain_outcome(past, asked, [last], "why")
    answer = f"no agent sent commands to the wheels; the last operation: {found.answer}"
    return replace(found, answer=answer, because=chain(past, last.link))


def explain_command(past: Past, asked: Question) -> Explanation:
    """Explain the last command, on the topic if one is given."""
    found = [each for each in _commands(past, asked.robot) if asked.about in each.cause.what]
    return _of_command(past, asked, found)


def _of_command(past: Past, asked: Question, found: list[ChainLink]) -> Explanation:
    if not found:
        return _no_command(past, asked)
    t, cause, _ = found[-1]
    links = (past.operations.get(each.cause.id) for each in past.chain(cause.id))
    whose = next((f", for `{each.text}`" for each in links if each is not None), "")
    return Explanation(asked.written, f"`{cause.what}` at {seconds(t)}{whose}", t, (), chain(past, cause.id))


def explain_drive(past: Past, asked: Question) -> Explanation:
    """Explain the last command to move, or the last operation of a robot that other nodes drive."""
    return _of_motion(past, asked, _DRIVING)


def explain_turn(past: Past, asked: Question) -> Explanation:
    """Explain the last command to turn, or the last operation of a robot that other nodes drive."""
    return _of_motion(past, asked, _TURNING)


def _of_motion(past: Past, asked: Question, motion: re.Pattern[str]) -> Explanation:
    commands = _commands(past, asked.robot)
    fitting = [each for each in commands if motion.search(each.cause.what)]
    found = fitting or [each for each in commands if _moves(each)]
    explanation = None if commands else _of_others(past, asked)
    return explanation or _of_command(past, replace(asked, about=""), found)


def _moves(command: ChainLink) -> bool:
    what = command.cause.what.removeprefix(command.cause.topic or "")
    return any(float(number) != 0.0 for number in _NUMBER.findall(what))


def _commands(past: Past, robot: str) -> list[ChainLink]:
    found = [each for each in past.links.values() if each.cause.sort == "command"]
    own = [each for each in found if not robot or _is_of(past, each, robot)]
    return sorted(own, key=lambda each: (each.t, each.cause.id))


def _is_of(past: Past, link: ChainLink, robot: str) -> bool:
    """Return whether a command is for a robot, by its topic or by the artifact that drives the robot."""
    artifacts = (each.cause.artifact or "" for each in past.chain(link.cause.id))
    named = re.split(r"\W+", link.cause.topic or link.cause.what)
    return robot in named or any(past.robots_of.get(each) == robot for each in artifacts)


def _no_command(past: Past, asked: Question) -> Explanation:
    what = f" on `{asked.about}`" if asked.about else ""
    whose = f" for {asked.robot}" if asked.robot else ""
    answer = f"no command{what}{whose} that an agent caused was recorded until {seconds(past.end)}"
    return Explanation(asked.written, answer, None, (*world_facts(past, past.end, asked.robot),))


# ---- events that interrupted a motion


def _goals_interrupted(past: Past, t: float, agent: str) -> list[tuple[tuple[str, object], Fact]]:
    """Return the goals of an agent, or of all (``""``), that were suspended or ended just before a stop: a line for each
    intention, with its agent and number.
    """
    ended: dict[tuple[str, object, str], TimedRecords[records.GoalRecord]] = {}
    for at, data in of_agent(past.goals, agent):
        if data.state in ("dropped", "suspended", "failed") and t - LATEST <= at <= t + AT_ONCE:
            ended.setdefault((data.agent, data.intention, data.state), []).append((at, data))
    return [(key[:2], _interrupted(goals)) for key, goals in ended.items()]


def _interrupted(goals: TimedRecords[records.GoalRecord]) -> Fact:
    at, data = goals[0]
    count = len(goals) - 1
    more = f" with {count} goal{'s' if count > 1 else ''} above it" if count else ""
    why = f": {data.why}" if data.why else ""
    return Fact("goal", f"{shown(data.goal)}{more} {data.state} at {seconds(at)}{why}", at, data.agent)


def _interrupting_step(past: Past, reason: records.DeliberationRecord, t: float) -> Iterator[Fact]:
    """Return the step that suspends or drops intentions, or takes resources from them, in the plan for an event or for the
    goals that followed from it until *t*, if there is exactly one.
    """
    until = [data for at, data in past.deliberations if at <= t]
    followed = [each for each in until if reason.id in {link.cause.id for link in past.chain(each.id)}]
    found = []
    for plan in {
        id(plan): plan for each in followed if (plan := past.plan(each.agent, each.chosen))
    }.values():
        for number, line in code_of(past, plan):
            for match in _INTERRUPTS.finditer(line):
                step = f"{match.group(1) or ''}{literal_at(line, match.end())}"
                what = f"{'step ' if match.group(1) else ''}`{step}` of {plan_name(plan)}"
                found.append(Fact("act", what, None, reason.agent, plan.file or "", number))
    if len(found) == 1:
        yield from found
