"""What becomes of a goal that failed: its own handler, that of a goal further down, or the end of the intention."""

from typing import Any

from jacaros.bdi import failure, lost_goals, meta_events, subplans
from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.event import Posted
from jacaros.bdi.failure_reason import FailureReason
from jacaros.bdi.forks import branch_failed
from jacaros.bdi.intention import ANNOTATIONS, GOAL, SERIAL, Intention
from jacaros.terms.values import atom

_HAS_FAILURE_PLAN = atom("has_failure_plan")


def unplanned(
    agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any
) -> Posted | None:
    """A goal has no plan: its own handler, or one further down, or the end of the intention."""
    trigger = goal[0]
    if trigger.failing:
        _lost_in_handler(agent, intention, goal, annotations)
        return None
    caller = intention.frames[-1] if intention.frames else None
    reason = failure.no_plan(agent, goal, annotations, caller)
    return fail_goal(agent, intention, goal, annotations, reason)


def has_room(agent: Circumstance, intention: Intention) -> bool:
    """Whether the plan just put on a full stack may stay: handlers have some room of their own, to deal with that."""
    depth = agent.goal_depth
    is_handler = intention.frames[-1][GOAL][0].failing
    return is_handler and len(intention.frames) <= depth + depth // 10 + 100


def too_deep(agent: Circumstance, intention: Intention) -> Posted | None:
    """The plan just put on a full stack fails before its first step."""
    frame = intention.frames.pop()
    goal, annotations = frame[GOAL], frame[ANNOTATIONS]
    failure.release_bindings(goal, frame[SERIAL])
    reason = failure.too_deep(goal, annotations, intention.frames[-1], agent.goal_depth)
    if goal[0].failing:
        # Handlers of handlers without end: nobody is left who could deal with it.
        intention.handlers.clear()
        del intention.frames[1:]
    return fail_goal(agent, intention, goal, annotations, reason)


def fail_goal(
    agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any, reason: FailureReason
) -> Posted | None:
    """A goal that has no frame failed: post its handler, or look further down."""
    trigger = goal[0]
    if trigger.on_fail is not None and subplans.handles(
        agent, intention, len(intention.frames), trigger.on_fail
    ):
        intention.handlers.append(len(intention.frames))
        if agent.meta:
            _tell(agent, goal, annotations, reason)
            meta_events.goal_state(agent, goal, annotations, "executing", _HAS_FAILURE_PLAN)
        return Posted((trigger.on_fail, *goal[1:]), reason.with_goal(annotations))
    return fail_intention(agent, intention, reason, goal, annotations)


def fail_intention(
    agent: Circumstance,
    intention: Intention,
    reason: FailureReason,
    goal: tuple[Any, ...] | None = None,
    annotations: Any = (),
) -> Posted | None:
    """The nearest handler down the stack takes over; without one the intention ends with a warning.

    *goal* and *annotations* are those that failed, when they are not on the stack.
    """
    while intention.forks and not failure.has_handler(agent, intention, intention.forks[-1][0].depth):
        if not branch_failed(agent, intention):
            if agent.meta and goal is not None:
                _tell(agent, goal, annotations, reason)
            agent.finish(intention)
            return None
    posted = failure.handler_event(agent, intention, reason)
    if posted is not None:
        if agent.meta:
            if goal is not None:
                _tell(agent, goal, annotations, reason)
            _observe_inner(agent, intention, reason)
            failed = intention.frames[intention.handlers[-1]]
            _tell(agent, failed[GOAL], failed[2], reason)
            meta_events.goal_state(agent, failed[GOAL], failed[2], "executing", _HAS_FAILURE_PLAN)
        return posted
    if intention.on_failed is not None:
        lost_goals.note_goals(agent, intention, reason, goal)
        intention.on_failed(reason)
    else:
        agent.architecture.goal_lost()
        budget = agent.budgets.get(reason.error())
        count = budget.note_loss() if budget is not None else 1
        if count:
            _tell_people(agent, lost_goals.loss(agent, intention, reason, goal), count)
    if agent.meta:
        if goal is not None:
            _tell(agent, goal, annotations, reason)
        _tell_failed(agent, intention, reason)
    agent.finish(intention)
    return None


def _tell_failed(agent: Circumstance, intention: Intention, reason: FailureReason) -> None:
    """All goals of an intention that nobody saved have failed, and are over."""
    for frame in reversed(intention.frames):
        if not frame[GOAL][0].failing:
            _tell(agent, frame[GOAL], frame[2], reason)
            meta_events.goal_state(agent, frame[GOAL], frame[2], "finished")


def _observe_inner(agent: Circumstance, intention: Intention, reason: FailureReason) -> None:
    """Report the goals that served the one whose failure is now handled: they failed with it."""
    if agent.goal_observer is None:
        return
    why = lost_goals.why(reason)
    for frame in reversed(intention.frames[intention.handlers[-1] + 1 :]):
        if not frame[GOAL][0].failing:
            meta_events.observe(agent, frame[GOAL], "failed", why)
            meta_events.observe(agent, frame[GOAL], "finished")


def _tell(agent: Circumstance, goal: tuple[Any, ...], annotations: Any, reason: FailureReason) -> None:
    why = lost_goals.why(reason) if agent.goal_observer is not None else ""
    meta_events.goal_state(agent, goal, annotations, "failed", atom(reason.error()), why)


def _tell_people(agent: Circumstance, loss: lost_goals.Loss, count: int = 1) -> None:
    """Warn of a lost goal, the *count*-th of its kind."""
    note = f"\n  {count} goals have failed for this reason" if count > 1 else ""
    agent.architecture.log("warning", loss.text() + note)
    if agent.probe is not None:
        agent.probe.lost(loss.told, loss.details, loss.span)


def _lost_in_handler(
    agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any
) -> None:
    reason = annotations if isinstance(annotations, FailureReason) else None
    if intention.on_failed is not None:
        intention.on_failed(reason)
    else:
        agent.architecture.goal_lost()
        _tell_people(agent, lost_goals.lost_in_handler(agent, intention, goal, reason))
    agent.finish(intention)
