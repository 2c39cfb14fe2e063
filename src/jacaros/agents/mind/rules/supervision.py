"""Supervised goals and plans end or fail; a goal with ``retry`` is tried again."""

from jacaros.agents.mind.rules import meta_events
from jacaros.agents.mind.rules.failure_reason import FailureReason
from jacaros.agents.mind.rules.pending import cancel, now, set_alarm
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import ANNOTATIONS, GOAL, Frame, Intention, NextStep, Posted
from jacaros.agents.mind.state.pending import (
    PAUSE,
    SUPERVISED,
    SUPERVISION,
    Supervision,
    Waiting,
    is_supervision,
    supervisions_below,
)
from jacaros.agents.mind.state.plan import hidden_plan
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal
from jacaros.agents.terms.values import BY_SELF, Term, atom, functor, structure

ATTEMPTS = functor("attempts", 1)


_SUPERVISING, _WAITING = hidden_plan(SUPERVISED.functor), hidden_plan(PAUSE)
_SUPERVISING.nested = _WAITING.nested = True  # they stand between a goal and the plan that posted it


def supervising(
    agent: Circumstance,
    supervision: Supervision,
    behind: NextStep,
    annotations: EventAnnotations = BY_SELF,
    arguments: tuple[Term, ...] = (),
) -> Frame:
    """Make the frame of a supervision; *behind* is its step when the goal or plan has ended."""
    written = supervision.achieves
    agent.features.ends = agent.features.ends or written is not None
    holder = [behind, (SUPERVISED,), annotations, agent.trail.serial + 1, _SUPERVISING]
    return [*holder, supervision, written, written, *arguments]


def end(agent: Circumstance, supervision: Supervision) -> None:
    """End the supervision of a goal or plan: its deadline and its condition no longer count."""
    pending, supervision.pending = supervision.pending, []
    for each in pending:
        cancel(agent, each)


def end_above(agent: Circumstance, intention: Intention, index: int) -> None:
    """End the supervisions of the frames from *index* on, except those shared with other branches of a fork."""
    frames = intention.frames
    if any(is_supervision(frame) for frame in frames[index:]):
        for frame in frames[max(index, meta_events.shared(agent, intention)) :]:
            if is_supervision(frame):
                end(agent, frame[SUPERVISION])


def fails(agent: Circumstance, intention: Intention, index: int, reason: FailureReason) -> bool:
    """Handle the failure of the goal or plan at *index*; return True if the goal is to be tried again."""
    for supervision in supervisions_below(intention, index):
        if supervision.failed < supervision.retries:
            return True
        end(agent, supervision)
        if supervision.retries:
            reason.add((ATTEMPTS, float(supervision.failed + 1)))
        if supervision.lost is not None:
            reason.add(*supervision.lost.others())
    return False


def try_again(
    agent: Circumstance,
    intention: Intention,
    index: int,
    goal: Goal,
    annotations: EventAnnotations,
    error: str,
) -> Posted | None:
    """Drop the plan at *index* and post its goal again; return None if it is posted later."""
    frames = intention.frames
    while not (supervised := frames[index - 1][SUPERVISION]).retries:
        index -= 1
    end_above(agent, intention, index)
    del frames[index:]
    if agent.atomic is intention and not intention.is_atomic():
        agent.atomic, agent.atomic_over = None, False
    supervised.failed += 1
    if agent.features.meta:
        meta_events.goal_state(agent, goal, annotations, "retried", atom(error))
    delay = supervised.back_off * 2.0 ** (supervised.failed - 1)
    if delay <= 0:
        return Posted(goal, annotations)
    pause(agent, intention, (goal, annotations), delay, post_again, structure("retry", delay * 1000))
    return None


def post_again(agent: Circumstance, frame: Frame) -> Posted:
    """The step behind a pause: post the goal."""
    assert agent.current is not None
    agent.current.frames.pop()
    return Posted(frame[GOAL], frame[ANNOTATIONS])


def pause(
    agent: Circumstance,
    intention: Intention,
    posted: tuple[Goal, EventAnnotations],
    delay: float,
    behind: NextStep,
    reason: Term,
) -> None:
    """Pause a goal for *delay* seconds, during which it stays a goal of the intention; *behind* is the step that
    follows.
    """
    agent.trail.serial += 1
    frame: Frame = [behind, *posted, agent.trail.serial, _WAITING]
    intention.frames.append(frame)
    waiting = Waiting(intention, reason, began=now(agent))
    waiting.attach(frame, behind)
    waiting.pending.append(set_alarm(agent, delay, _resume, waiting))
    if agent.features.meta:
        meta_events.top_goal_state(agent, intention, "waiting", reason)


def _resume(agent: Circumstance, waiting: Waiting) -> None:
    agent.end_wait(waiting)
