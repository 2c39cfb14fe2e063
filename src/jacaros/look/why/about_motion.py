"""Answers about robots: why one stopped, and what led to a command or an operation."""

import re
from collections.abc import Iterator
from dataclasses import replace

from jacaros.look.records import records
from jacaros.look.why.chains import chain, place_of, plan_name, shown
from jacaros.look.why.explanation import Explanation, Fact, seconds
from jacaros.look.why.past import AT_ONCE, ChainLink, Past, TimedRecords
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
    question, agent, robot = asked.written, asked.agent, asked.robot
    commands = _commands(past, robot)
    if not commands:
        return _by_operation(past, asked) or _no_command(past, replace(asked, about=""))
    stop = _stop_of(commands)
    if stop is None:
        t, last, _ = commands[-1]
        answer = (
            f"no command to stop until {seconds(past.end)}; the last command is `{last.what}` at {seconds(t)}"
        )
        return Explanation(question, answer, t, tuple(world_facts(past, t, robot)), chain(past, last.id))
    t, number = stop.t, stop.cause.id
    because = chain(past, number)
    ended = [*_ended_operation(past, t, number)]
    if past.exit_code is not None and past.end - t <= AT_ONCE and not ended:
        answer = (
            f"{robot or 'the robot'} stopped at {seconds(t)}, because the run ended; robots are stopped then"
        )
        return Explanation(question, answer, t, (), because)
    goals = _goals_interrupted(past, t, number, agent)
    own_goals = _goals_interrupted(past, t, number, agent, only_own=True)
    since = min((each.t for each in goals if each.t is not None), default=t)
    handled = events_before(past, since, number, agent)
    events = (event_fact(past, *each) for each in handled)
    facts = [*events, *goals, *world_facts(past, t, robot)]
    why = f": {ended[0].text}" if ended else ""
    if handled and own_goals and " was done at " not in why:
        # A paused or cancelled operation publishes its last command for its own plan, or in the turn of the message
        # that made its agent suspend or drop it. The reason is in the plan that did so.
        reason = handled[-1][1]
        own = (fact for fact in because[:2] if fact.kind in ("command", "operation"))
        because = (*own, *own_goals, *_interrupting_step(past, reason), *chain(past, reason.id))
        why = f", because of `{shown(reason.trigger)}`"
    answer = f"{robot or 'the robot'} stopped at {seconds(t)}{why}"
    return Explanation(question, answer, t, tuple(facts[:MOST_FACTS]), because)


def _by_operation(past: Past, asked: Question) -> Explanation | None:
    """Explain the end of the last operation of a robot's artifact, if other nodes send the commands."""
    ended = [
        (each.ended, number, each)
        for number, each in past.operations.items()
        if each.ended is not None and _drives(past, each.artifact, asked.robot)
    ]
    if not ended:
        return None
    t, number, last = max(ended, key=lambda each: each[:2])
    goals = _goals_interrupted(past, t, number, asked.agent, only_own=True)
    events = (
        [event_fact(past, *each) for each in events_before(past, t, number, asked.agent)] if goals else []
    )
    what = f"{last.text} of {last.artifact} {last.outcome}"
    answer = f"no agent sent commands to the wheels; the last operation: {what}"
    return Explanation(asked.written, answer, t, (*events, *goals)[:MOST_FACTS], chain(past, number))


def _drives(past: Past, artifact: str, robot: str) -> bool:
    whose = past.robots_of.get(artifact)
    return whose is not None and robot in ("", whose)


def explain_command(past: Past, asked: Question) -> Explanation:
    """Explain the last command, on the topic if one is given."""
    found = [each for each in _commands(past, asked.robot) if asked.about in each.cause.what]
    return _of_command(past, asked, found)


def explain_drive(past: Past, asked: Question) -> Explanation:
    """Explain the last command to move, or the last operation of a robot that other nodes drive."""
    return _of_motion(past, asked, _DRIVING)


def explain_turn(past: Past, asked: Question) -> Explanation:
    """Explain the last command to turn, or the last operation of a robot that other nodes drive."""
    return _of_motion(past, asked, _TURNING)


def _of_motion(past: Past, asked: Question, motion: re.Pattern[str]) -> Explanation:
    commands = _commands(past, asked.robot)
    found = [each for each in commands if motion.search(each.cause.what)]
    explanation = None if commands else _by_operation(past, asked)
    return explanation or _of_command(past, asked, found or [each for each in commands if _moves(each)])


def _of_command(past: Past, asked: Question, commands: list[ChainLink]) -> Explanation:
    if not commands:
        return _no_command(past, asked)
    t, cause, _ = commands[-1]
    started = next((each for each in past.chain(cause.id) if each.cause.sort == "operation"), None)
    operation = past.operations.get(started.cause.id) if started is not None else None
    whose = f", for `{operation.text}`" if operation is not None else ""
    return Explanation(asked.written, f"`{cause.what}` at {seconds(t)}{whose}", t, (), chain(past, cause.id))


def _moves(command: ChainLink) -> bool:
    what = command.cause.what.removeprefix(command.cause.topic or "")
    return any(float(number) != 0.0 for number in _NUMBER.findall(what))


def _commands(past: Past, robot: str) -> list[ChainLink]:
    found = [
        each for each in past.links.values() if each.cause.sort == "command" and _is_of(past, each, robot)
    ]
    return sorted(found, key=lambda each: (each.t, each.cause.id))


def _is_of(past: Past, link: ChainLink, robot: str) -> bool:
    """Return whether a command is for a robot, by its topic or by the artifact that drives the robot."""
    if not robot or robot in re.split(r"\W+", link.cause.topic or link.cause.what):
        return True
    return any(past.robots_of.get(each.cause.artifact or "") == robot for each in past.chain(link.cause.id))


def _stop_of(commands: list[ChainLink]) -> ChainLink | None:
    """Return the first stop command after the last motion command; None if the last command is a motion."""
    stop: ChainLink | None = None
    for each in reversed(commands):
        # All of its numbers are zero; one without numbers may stop it, too.
        if _moves(each):
            break
        stop = each
    return stop


def _ended_operation(past: Past, t: float, command: int) -> Iterator[Fact]:
    """Return how the operation that published a command at *t* ended, if it ended then."""
    for _, link, _ in past.chain(command):
        operation = past.operations.get(link.id)
        if operation is not None and operation.ended is not None and operation.ended <= t + LATEST:
            what = f"{operation.text} {operation.outcome}"
            yield Fact("operation", what, operation.ended)
            return


def world_facts(past: Past, t: float, robot: str) -> Iterator[Fact]:
    """Return what the world did to the robot at that time."""
    for at, event, whose in past.world:
        if abs(at - t) <= AT_ONCE and robot in ("", whose):
            yield Fact("note", f"{whose}: {event} at {seconds(at)}", at)


def _no_command(past: Past, asked: Question) -> Explanation:
    what = f" on `{asked.about}`" if asked.about else ""
    whose = f" for {asked.robot}" if asked.robot else ""
    answer = f"no command{what}{whose} that an agent caused was recorded until {seconds(past.end)}"
    return Explanation(asked.written, answer, None, tuple(world_facts(past, past.end, asked.robot)))


# ---- events that interrupted a motion


def _goals_interrupted(past: Past, t: float, link: int, agent: str, only_own: bool = False) -> list[Fact]:
    """Return the goals that were suspended or ended just before a stop, one line for each intention.

    Args:
        past: the records.
        t, link: time of the stop, and number of its command or operation.
        agent: only goals of this agent; empty for all.
        only_own: if an action led to the command, only goals of its intention count.
    """
    acts = (each.cause for each in past.chain(link) if each.cause.sort == "act")
    own = {(each.agent, each.intention) for each in acts}
    ended: dict[object, TimedRecords[records.GoalRecord]] = {}
    for at, data in past.goals:
        intention = data.agent, data.intention
        over = data.state in ("dropped", "suspended", "failed") and agent in ("", data.agent)
        if over and t - LATEST <= at <= t + AT_ONCE and (intention in own or not (own and only_own)):
            ended.setdefault((*intention, data.state), []).append((at, data))
    return [_interrupted(goals) for goals in ended.values()]


def _interrupted(goals: TimedRecords[records.GoalRecord]) -> Fact:
    at, data = goals[0]
    count = len(goals) - 1
    more = f" with {count} goal{'s' if count > 1 else ''} above it" if count else ""
    why = f": {data.why}" if data.why else ""
    return Fact("goal", f"{shown(data.goal)}{more} {data.state} at {seconds(at)}{why}", at, data.agent)


def events_before(past: Past, t: float, link: int, agent: str) -> TimedRecords[records.DeliberationRecord]:
    """Return the belief events that agents handled just before a stop; those of the same message, if there are any."""
    events = [
        (at, data)
        for at, data in past.deliberations
        if t - AT_ONCE <= at <= t
        and data.chosen is not None
        and "!" not in data.trigger[:2]
        and agent in ("", data.agent)
    ]
    roots = {each.cause.id for each in past.chain(link)}
    related = [each for each in events if any(other.cause.id in roots for other in past.chain(each[1].id))]
    return related or events


def event_fact(past: Past, t: float, deliberation: records.DeliberationRecord) -> Fact:
    """Return a handled event with its plan."""
    plan = past.plan(deliberation.agent, deliberation.chosen)
    name = plan_name(plan) if plan else "`?`"
    handled = f"{shown(deliberation.trigger)} handled at {seconds(t)} with {name}"
    return Fact("event", handled, t, deliberation.agent, *place_of(plan))


def _interrupting_step(past: Past, deliberation: records.DeliberationRecord) -> Iterator[Fact]:
    """Return the step of a chosen plan that suspends or drops intentions, or takes resources from them, if there is
    exactly one.
    """
    plan = past.plan(deliberation.agent, deliberation.chosen)
    if plan is None:
        return
    file, first = place_of(plan)
    lines = past.sources.get(file, [])
    numbered = enumerate(lines[first - 1 : plan.end or first], first)
    code = ((number, line.split("//")[0]) for number, line in numbered)
    found = [
        (number, f"{match.group(1) or ''}{literal_at(line, match.end())}")
        for number, line in code
        for match in _INTERRUPTS.finditer(line)
    ]
    if len(found) == 1:
        number, step = found[0]
        what = "step " if step[0] == "." else ""
        yield Fact("act", f"{what}`{step}` of {plan_name(plan)}", None, deliberation.agent, file, number)
