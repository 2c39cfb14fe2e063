"""Handle the failure of a goal: its own handler, that of a goal further down, or the end of the intention."""

from typing import Any

from jacaros.agents.mind.explaining import lost_goals
from jacaros.agents.mind.explaining.failure_reason import FailureReason
from jacaros.agents.mind.rules import failure, meta_events, supervision
from jacaros.agents.mind.rules.forks import branch_failed
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import ANNOTATIONS, GOAL, SERIAL, Frame, Intention, Posted
from jacaros.agents.mind.state.pending import caller_of, supervisions_below
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal
from jacaros.agents.terms.values import atom

_HAS_FAILURE_PLAN = atom("has_failure_plan")
_Unplanned = tuple[Goal, Any, int]
"""A goal without a frame, its annotations, and the number by which observers know it."""


def unplanned(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations
) -> Posted | None:
    """A goal has no plan: run its own handler, or one further down, or end the intention."""
    trigger = goal[0]
    if trigger.failing:
        _lost_in_handler(agent, intention, goal, annotations)
        return None
    caller = caller_of(intention)
    reason = failure.no_plan(agent, goal, annotations, caller)
    height = len(intention.frames)
    if supervision.fails(agent, intention, height, reason):
        return supervision.try_again(agent, intention, height, goal, annotations, reason.error())
    return fail_goal(agent, intention, goal, annotations, reason)


def has_room(agent: Circumstance, intention: Intention) -> bool:
    """Return whether the plan just put on a full stack may stay: handlers have some extra room."""
    depth = agent.options.goal_depth
    is_handler = intention.frames[-1][GOAL][0].failing
    return is_handler and len(intention.frames) <= depth + depth // 10 + 100


def too_deep(agent: Circumstance, intention: Intention) -> Posted | None:
    """Fail the plan just put on a full stack before its first step."""
    frame = intention.frames.pop()
    goal, annotations = frame[GOAL], frame[ANNOTATIONS]
    failure.release_bindings(goal, frame[SERIAL])
    reason = failure.too_deep(goal, annotations, caller_of(intention) or frame, agent.options.goal_depth)
    if goal[0].failing:
        # Handlers of handlers without end: no handler is left that could deal with it.
        intention.handlers.clear()
        observe_failed(agent, intention, 1, reason)
        del intention.frames[1:]
    return fail_goal(agent, intention, goal, annotations, reason, frame[SERIAL])


def fail_goal(
    agent: Circumstance,
    intention: Intention,
    goal: Goal,
    annotations: EventAnnotations,
    reason: FailureReason,
    number: int = -1,
) -> Posted | None:
    """A goal without a frame failed: post its handler, or look further down.

    *number* is that of the frame that it had, by which observers know it.
    """
    trigger = goal[0]
    for each in supervisions_below(intention, len(intention.frames)):
        supervision.end(agent, each)
    if number < 0:
        agent.trail.serial += 1
        number = agent.trail.serial
    if trigger.on_fail is not None and failure.handles_own(agent, intention, trigger.on_fail):
        intention.handlers.append(len(intention.frames))
        if agent.features.meta:
            _tell_unplanned(agent, intention, (goal, annotations, number), reason)
            meta_events.observe_goal(agent, intention, goal, number, "executing")
            meta_events.goal_state(agent, goal, annotations, "executing", _HAS_FAILURE_PLAN)
        return Posted((trigger.on_fail, *goal[1:]), reason.for_goal(annotations, number))
    return fail_intention(agent, intention, reason, (goal, annotations, number))


def fail_intention(
    agent: Circumstance,
    intention: Intention,
    reason: FailureReason,
    unplanned: _Unplanned | None = None,
) -> Posted | None:
    """Pass the failure to the nearest handler down the stack; without one the intention ends with a warning.

    *unplanned* is the goal that failed, if it is not on the stack.
    """
    while intention.forks and not failure.has_handler(agent, intention, intention.forks[-1][0].depth):
        depth = intention.forks[-1][0].depth
        if not branch_failed(agent, intention):
            _tell_unplanned(agent, intention, unplanned, reason, over=True)
            observe_failed(agent, intention, depth + 1, reason)
            agent.finish(intention)
            return None
    posted = failure.handler_event(agent, intention, reason)
    if isinstance(posted, int):
        return _try_again(agent, intention, posted, reason, unplanned)
    if posted is not None:
        if agent.features.meta:
            _tell_unplanned(agent, intention, unplanned, reason, over=True)
            index = intention.handlers[-1]
            observe_failed(agent, intention, index + 1, reason)
            failed = intention.frames[index]
            _tell(agent, intention, failed, reason)
            meta_events.frame_state(agent, intention, failed, "executing", _HAS_FAILURE_PLAN)
        return posted
    goal = None if unplanned is None else unplanned[0]
    if intention.on_failed is not None:
        lost_goals.note_goals(agent, intention, reason, goal)
        function, arguments = intention.on_failed
        function(agent, reason, *arguments)
    else:
        agent.architecture.goal_lost()
        budget = agent.budgets.get(reason.error())
        count = budget.note_loss() if budget is not None else 1
        if count:
            _tell_people(agent, lost_goals.loss(agent, intention, reason, goal), count)
    if agent.features.meta:
        _tell_unplanned(agent, intention, unplanned, reason, over=True)
        _tell_failed(agent, intention, reason)
    agent.finish(intention)
    return None


def _try_again(
    agent: Circumstance, intention: Intention, index: int, reason: FailureReason, unplanned: _Unplanned | None
) -> Posted | None:
    """Try the goal of the frame at *index* again; return None if that happens later."""
    if agent.features.meta:
        _tell_unplanned(agent, intention, unplanned, reason, over=True)
        observe_failed(agent, intention, index, reason)
    frame = intention.frames[index]
    return supervision.try_again(agent, intention, index, frame[GOAL], frame[ANNOTATIONS], reason.error())


def _tell_unplanned(
    agent: Circumstance,
    intention: Intention,
    unplanned: _Unplanned | None,
    reason: FailureReason,
    over: bool = False,
) -> None:
    """Report that a goal without a frame has failed; *over*: none of its own plans handles the failure."""
    if unplanned is None or not agent.features.meta:
        return
    goal, annotations, number = unplanned
    why = lost_goals.why(reason) if agent.observers.goal is not None else ""
    meta_events.observe_goal(agent, intention, goal, number, "failed", why)
    meta_events.goal_state(agent, goal, annotations, "failed", atom(reason.error()))
    if over:
        meta_events.observe_goal(agent, intention, goal, number, "finished")


def _tell_failed(agent: Circumstance, intention: Intention, reason: FailureReason) -> None:
    """Report that all goals of an intention have failed without a handler."""
    observe_failed(agent, intention, 0, reason)
    for frame in reversed(intention.frames):
        if not frame[GOAL][0].failing:
            meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "failed", atom(reason.error()))
            meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "finished")


def observe_failed(
    agent: Circumstance, intention: Intention, first: int, reason: FailureReason | None
) -> None:
    """Report to the observer that the goals of the frames from *first* on failed and are over."""
    if agent.observers.goal is not None:
        why = lost_goals.why(reason) if reason is not None else ""
        for frame in reversed(intention.frames[first:]):
            meta_events.observe(agent, intention, frame, "failed", why)
            meta_events.observe(agent, intention, frame, "finished")


def _tell(agent: Circumstance, intention: Intention, frame: Frame, reason: FailureReason) -> None:
    why = lost_goals.why(reason) if agent.observers.goal is not None else ""
    meta_events.observe(agent, intention, frame, "failed", why)
    meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "failed", atom(reason.error()))


def _tell_people(agent: Circumstance, loss: lost_goals.Loss, count: int = 1) -> None:
    """Warn of a lost goal, the *count*-th of its kind."""
    note = f"\n  {count} goals have failed for this reason" if count > 1 else ""
    agent.architecture.log("warning", loss.text() + note)
    if agent.observers.lost is not None:
        agent.observers.lost(loss.told, loss.details, loss.span)


def _lost_in_handler(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations
) -> None:
    reason = annotations if isinstance(annotations, FailureReason) else None
    if intention.on_failed is not None:
        function, arguments = intention.on_failed
        function(agent, reason, *arguments)
    else:
        agent.architecture.goal_lost()
        _tell_people(agent, lost_goals.lost_in_handler(agent, intention, goal, reason))
    number = meta_events.failed_number(annotations)
    if number is not None:
        meta_events.observe_goal(agent, intention, goal, number, "failed")
        meta_events.observe_goal(agent, intention, goal, number, "finished")
    while intention.forks and branch_failed(agent, intention):
        pass  # the others would wait forever for this branch
    observe_failed(agent, intention, meta_events.shared(agent, intention), reason)
    agent.finish(intention)
