"""Goals leave the stack: finished plans (rule ClrInt), those whose goal condition holds, and those cut from outside."""

from jacaros.agents.mind.rules import failure, meta_events
from jacaros.agents.mind.rules.achieving import fail_unachieved, is_achieved, is_settling, untested
from jacaros.agents.mind.rules.forks import leave
from jacaros.agents.mind.rules.supervision import end_above
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import (
    ANNOTATIONS,
    EVENT_INTENTION,
    GOAL,
    PLAN,
    STEP,
    Event,
    Frame,
    Intention,
)
from jacaros.agents.mind.state.pending import GOAL_CONDITION, Waiting
from jacaros.agents.mind.state.plan import SUSPENDED
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import undo
from jacaros.runtime.errors import InternalError


def pop_finished(agent: Circumstance, intention: Intention) -> bool:
    """Rule ClrInt: take finished plans off the stack; False when the intention goes no further now."""
    frames, handlers = intention.frames, intention.handlers
    while frames:
        frame = frames[-1]
        if frame[STEP] is not None:
            return True
        if frame[PLAN].special and frame[PLAN].goal_condition is not None and not _is_achieved(agent, frame):
            Waiting(intention, GOAL_CONDITION).attach(frame, None)
            return False
        if agent.features.ends and not _leaves(agent, intention, frame):
            return frame[STEP] is not None
        if handlers and frame[GOAL][0].failing:
            del frames[handlers.pop() :]
        else:
            frames.pop()
        if agent.atomic is intention and not intention.is_atomic():
            agent.atomic_over = True
    agent.finish(intention)
    return False


def _leaves(agent: Circumstance, intention: Intention, frame: Frame) -> bool:
    """Return whether a plan that has ended has achieved what it was to achieve; report then that its goal is over."""
    if not is_achieved(agent, intention):
        return False
    state, handlers = "achieved", intention.handlers
    if handlers and frame[GOAL][0].failing:
        state, frame = "recovered", intention.frames[handlers[-1]]
    if agent.features.meta and frame[GOAL][0].kind:
        meta_events.observe(agent, intention, frame, state)
        meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "achieved")
        meta_events.frame_state(agent, intention, frame, "finished")
    return True


def end_achieved_goals(agent: Circumstance) -> None:
    """Goals whose goal condition holds are achieved, whatever their plans are at."""
    for number, intention in sorted(agent.conditioned.items()):
        if all(frame[PLAN].goal_condition is None for frame in intention.frames):
            agent.conditioned.pop(number, None)
        for index, frame in enumerate(intention.frames):
            if (
                frame[PLAN].goal_condition is not None
                and frame[STEP] not in (_end_early, fail_unachieved)
                and not is_settling(intention, frame)
                and _is_achieved(agent, frame)
            ):
                queued = intention in agent.intentions
                achieve(agent, intention, index)
                if intention.frames:
                    queued = queued or not pop_finished(agent, intention)
                else:
                    agent.finish(intention)
                    queued = True
                if not queued:
                    agent.make_ready(intention)
                break


def _is_achieved(agent: Circumstance, frame: Frame) -> bool:
    """Return whether the goal condition of a frame holds. If it cannot be evaluated, it does not; this is logged once."""
    achieved = frame[PLAN].goal_condition
    if achieved is None:
        return False
    try:
        return bool(achieved(agent, frame))
    except InternalError:
        raise
    except Exception as fault:
        undo(agent.trail, 0)
        if frame[PLAN] not in agent.library.blamed:
            agent.library.blamed.add(frame[PLAN])
            failure.report_skipped(agent, f"goal condition of plan {text(frame[PLAN].label)}", fault)
        return False


def pending_event(agent: Circumstance, intention: Intention) -> Event | None:
    """The event of the queue that an intention waits for, if any."""
    return next(
        (e for e in (*agent.events, *agent.waits.suspended_events) if e[EVENT_INTENTION] is intention), None
    )


def remove_event(agent: Circumstance, event: Event) -> None:
    kept = [e for e in agent.events if e is not event]
    agent.events.clear()
    agent.events.extend(kept)
    agent.waits.suspended_events = [e for e in agent.waits.suspended_events if e is not event]


def cut(agent: Circumstance, intention: Intention, index: int) -> None:
    """Take the frame at *index* and all above off the stack, and whatever the intention waits for."""
    if intention.waiting is not None:
        waiting, intention.waiting = intention.waiting, None
        agent.drop_wait(waiting)
    event = pending_event(agent, intention)
    if event is not None:
        remove_event(agent, event)
    intention.suspended = None
    leave(agent, intention, index)
    end_above(agent, intention, index)
    del intention.frames[index:]
    while intention.handlers and intention.handlers[-1] >= index:
        intention.handlers.pop()
    if agent.atomic is intention and not intention.is_atomic():
        agent.atomic, agent.atomic_over = None, False


def cut_out(agent: Circumstance, intention: Intention, index: int) -> None:
    """Cut a stack whose intention may be queued; it does not run until it is queued again."""
    cut(agent, intention, index)
    agent.take_out(intention)


def achieve(agent: Circumstance, intention: Intention, index: int) -> None:
    """Cut a stack at a goal that ends as achieved; the goals that served it are dropped.

    If it is tested, its plan stays until that has been done.
    """
    is_over = index in intention.handlers or next(untested(intention, index), None) is None
    first = index if is_over else index + 1
    if agent.features.meta:
        for place, frame in reversed(list(enumerate(intention.frames))[first:]):
            state = "achieved" if place == index else "dropped"
            tell = meta_events.observe if frame[GOAL][0].failing else meta_events.frame_state
            tell(agent, intention, frame, state)
            tell(agent, intention, frame, "finished")
    cut(agent, intention, first)
    if not is_over:
        leave(agent, intention, index)
        intention.frames[index][STEP] = _end_early


def _end_early(agent: Circumstance, frame: Frame) -> object:
    """The step of a plan that has ended before its last step: its goal is achieved if the tests say so."""
    intention = agent.current
    assert intention is not None
    if is_achieved(agent, intention):
        frame[STEP] = None
        achieve(agent, intention, len(intention.frames) - 1)
    return None if intention.waiting is None else SUSPENDED
