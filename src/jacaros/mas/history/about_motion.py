"""Answers about robots: why one stopped, and what led to a command or an operation."""

import re
from collections.abc import Iterator

from jacaros.mas.history.chains import chain
from jacaros.mas.history.explanation import Explanation, Fact, seconds
from jacaros.mas.history.interruptions import (
    AT_ONCE,
    Command,
    event_fact,
    events_before,
    goals_interrupted,
    interrupting_step,
)
from jacaros.mas.history.past import Data, Past

_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?\b")
MOST_FACTS = 8
"""Maximum number of facts in an answer, besides the chain."""


def explain_stop(past: Past, question: str, agent: str = "", robot: str = "") -> Explanation:
    """Explain why a robot stopped: the first stop command after the last motion command."""
    commands = _commands(past, robot)
    if not commands:
        return _by_operation(past, question, agent, robot) or _no_command(past, question, robot)
    stop = _stop_of(commands)
    if stop is None:
        t, last = commands[-1]
        answer = f"no command to stop until {seconds(past.end)}; the last command is `{last['what']}` at {seconds(t)}"
        return Explanation(question, answer, t, tuple(_world(past, t, robot)), chain(past, last["id"]))
    t, link = stop
    answer = f"{robot or 'the robot'} stopped at {seconds(t)}: `{link['what']}`"
    if past.exit_code is not None and past.end - t <= AT_ONCE:
        ended = Fact("note", f"the run ended at {seconds(past.end)}; robots are stopped then", past.end)
        return Explanation(question, answer, t, (ended,), chain(past, link["id"]))
    goals, own_goals = (
        goals_interrupted(past, stop, agent),
        goals_interrupted(past, stop, agent, only_own=True),
    )
    since = min((each.t for each in goals if each.t is not None), default=t)
    handled = events_before(past, (since, link), agent)
    events = (event_fact(past, *each) for each in handled)
    facts = [*_ended_operation(past, t, link), *events, *goals, *_world(past, t, robot)]
    because = chain(past, link["id"])
    if handled and own_goals:
        # A paused or cancelled operation publishes its last command for its own plan, or in the turn of the message
        # that made its agent suspend or drop it. The reason is in the plan that did so.
        own = (fact for fact in because[:2] if fact.kind in ("command", "operation"))
        because = (
            *own,
            *own_goals,
            *interrupting_step(past, handled[-1][1]),
            *chain(past, handled[-1][1]["id"]),
        )
    return Explanation(question, answer, t, tuple(facts[:MOST_FACTS]), because)


def _by_operation(past: Past, question: str, agent: str, robot: str) -> Explanation | None:
    """Explain the end of the last operation of a robot's artifact, if other nodes send the commands."""
    ended = [
        (each.ended, number, each)
        for number, each in past.operations.items()
        if each.ended is not None and _drives(past, str(each.data["artifact"]), robot)
    ]
    if not ended:
        return None
    t, number, last = max(ended, key=lambda each: each[:2])
    reason = f": {last.reason}" if last.reason else ""
    what = f"{last.data['operation']} of {last.data['artifact']} {last.outcome} at {seconds(t)}{reason}"
    stop = t, {"id": number, "parent": 0}
    goals = goals_interrupted(past, stop, agent, only_own=True)
    events = [event_fact(past, *each) for each in events_before(past, stop, agent)] if goals else []
    answer = f"no agent sent commands to the wheels; the last operation: {what}"
    return Explanation(question, answer, t, (*events, *goals)[:MOST_FACTS], chain(past, number))


def _drives(past: Past, artifact: str, robot: str) -> bool:
    whose = past.artifacts.get(artifact, {}).get("robot")
    return whose is not None and robot in ("", whose)


def explain_command(past: Past, question: str, about: str = "", robot: str = "") -> Explanation:
    """Explain the last command, on the topic *about* if given."""
    commands = [each for each in _commands(past, robot) if about in str(each[1].get("what", ""))]
    if not commands:
        return _no_command(past, question, robot, about)
    t, link = commands[-1]
    return Explanation(question, f"`{link['what']}` at {seconds(t)}", t, (), chain(past, link["id"]))


def explain_operation(past: Past, question: str, about: str = "", agent: str = "") -> Explanation:
    """Explain the last operation, with the name *about* if given."""
    found = [
        (number, each)
        for number, each in past.operations.items()
        if about.partition("(")[0] in str(each.data.get("operation", ""))
        and agent in ("", each.data.get("agent"))
    ]
    if not found:
        named = f" `{about}`" if about else ""
        names = sorted(
            {str(each.data.get("operation", "")).partition("(")[0] for each in past.operations.values()}
        )
        known = (Fact("note", f"known operations: {', '.join(names[:MOST_FACTS])}"),) if names else ()
        return Explanation(question, f"no operation{named} began until {seconds(past.end)}", None, known)
    number, last = found[-1]
    end = f", {last.outcome} at {seconds(last.ended)}" if last.ended is not None else ", still running"
    reason = f": {last.reason}" if last.reason else ""
    answer = (
        f"{last.data['operation']} of {last.data['artifact']} began at {seconds(last.began)}{end}{reason}"
    )
    return Explanation(question, answer, last.began, (), chain(past, number))


def _commands(past: Past, robot: str) -> list[Command]:
    found = [
        each
        for each in past.links.values()
        if each[1].get("kind") == "command" and _is_of(past, each[1], robot)
    ]
    return sorted(found, key=lambda each: (each[0], each[1]["id"]))


def _is_of(past: Past, link: Data, robot: str) -> bool:
    """Return whether a command is for a robot, by its topic or by the artifact that drives the robot."""
    if not robot or robot in re.split(r"\W+", str(link.get("topic") or link.get("what", ""))):
        return True
    artifacts = {str(each.get("artifact") or "") for _, each in past.chain(link["id"])}
    return any(past.artifacts.get(each, {}).get("robot") == robot for each in artifacts)


def _stop_of(commands: list[Command]) -> Command | None:
    """Return the first stop command after the last motion command; None if the last command is a motion."""
    stop: Command | None = None
    for each in reversed(commands):
        if not _stands(each[1]):
            break
        stop = each
    return stop


def _stands(link: Data) -> bool:
    """Return whether a command stops the robot: all of its numbers are zero. One without numbers may."""
    what = str(link.get("what", "")).removeprefix(str(link.get("topic") or ""))
    return all(float(number) == 0.0 for number in _NUMBER.findall(what))


def _ended_operation(past: Past, t: float, command: Data) -> Iterator[Fact]:
    """Return how the operation that published a command at *t* ended, if it ended then."""
    for _, link in past.chain(command["id"]):
        operation = past.operations.get(link["id"])
        if operation is not None and operation.ended is not None and operation.ended <= t + AT_ONCE:
            reason = f": {operation.reason}" if operation.reason else ""
            what = f"{operation.data['operation']} {operation.outcome}{reason}"
            yield Fact("operation", f"{what} at {seconds(operation.ended)}", operation.ended)
            return


def _world(past: Past, t: float, robot: str) -> Iterator[Fact]:
    """Return what the world did to the robot at that time."""
    for at, event, data in past.world:
        if abs(at - t) <= AT_ONCE and robot in ("", data.get("robot")):
            yield Fact("note", f"{data.get('robot')}: {event} at {seconds(at)}", at)


def _no_command(past: Past, question: str, robot: str, about: str = "") -> Explanation:
    what = f" on `{about}`" if about else ""
    whose = f" for {robot}" if robot else ""
    answer = f"no command{what}{whose} that an agent caused was recorded until {seconds(past.end)}"
    return Explanation(question, answer, None, tuple(_world(past, past.end, robot)))
