"""Supervised goals and plans end or fail; a goal with ``retry`` is tried again."""

from jacaros.asl import nodes
from jacaros.bdi.explaining.failure_reason import FailureReason
from jacaros.bdi.rules import meta_events
from jacaros.bdi.rules.alarms import cancel_alarm, set_alarm
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import Posted
from jacaros.bdi.state.intention import Frame, Intention, NextStep
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.supervision import (
    PAUSE,
    SUPERVISED,
    SUPERVISION,
    GoalSupervision,
    PlanGuard,
    Supervision,
    is_supervision,
    supervisions_below,
)
from jacaros.bdi.state.triggers import Goal
from jacaros.bdi.state.waiting import TimedWait
from jacaros.terms.values import BY_SELF, Functor, Term, atom, functor, structure

ATTEMPTS = functor("attempts", 1)


def _plan(label: Functor) -> Plan:
    """A plan without a body, for the frames between the plans of a goal."""
    node = nodes.Plan(None, nodes.Trigger("+", "!", nodes.Literal(label.name)), None, nodes.Body())
    plan = Plan(node, label)
    plan.nested = True  # it stands between a goal and the plan that posted it
    return plan


_SUPERVISING, _WAITING = _plan(SUPERVISED.functor), _plan(PAUSE)


def supervising(
    agent: Circumstance, supervision: Supervision, behind: NextStep, arguments: tuple[Term, ...] = ()
) -> Frame:
    """Make the frame of a supervision; *behind* is its step when the goal or plan has ended."""
    return [behind, (SUPERVISED,), BY_SELF, agent.trail.serial + 1, _SUPERVISING, supervision, *arguments]


# --- ends --------------------------------------------------------------------------------------------------


def end(agent: Circumstance, supervision: Supervision) -> None:
    """End the supervision of a goal or plan: its deadline and its condition no longer count."""
    if supervision.alarm is not None:
        cancel_alarm(agent, supervision.alarm)
        supervision.alarm = None
    if isinstance(supervision, PlanGuard) and supervision.watch is not None:
        supervision.watch.ended = True
        agent.waits.conditions.remove(supervision.watch)


def end_below(agent: Circumstance, intention: Intention, index: int) -> None:
    """The goal or plan at *index* has ended."""
    for supervision in supervisions_below(intention, index):
        end(agent, supervision)


def end_periods(intention: Intention, index: int) -> None:
    """End the periods of the goal at *index* (or of one about to get a frame there) after the present one."""
    for supervision in supervisions_below(intention, index):
        if isinstance(supervision, GoalSupervision):
            supervision.period = None


def end_above(agent: Circumstance, intention: Intention, index: int) -> None:
    """End the supervisions of the frames from *index* on, except those shared with other branches of a fork."""
    frames = intention.frames
    if any(is_supervision(frame) for frame in frames[index:]):
        for frame in frames[max(index, meta_events.shared(agent, intention)) :]:
            if is_supervision(frame):
                end(agent, frame[SUPERVISION])


def plan_ended(agent: Circumstance, frame: Frame) -> None:
    """The step of a plan's supervision: the plan has ended."""
    end(agent, frame[SUPERVISION])
    frame[0] = None


# --- failures ----------------------------------------------------------------------------------------------


def has_attempt(intention: Intention, index: int) -> bool:
    """Whether the goal at *index* is to be tried again when it fails."""
    return any(map(_has_attempt, supervisions_below(intention, index)))


def _has_attempt(supervision: Supervision) -> bool:
    return isinstance(supervision, GoalSupervision) and supervision.failed < supervision.retries


def fails(agent: Circumstance, intention: Intention, index: int, reason: FailureReason) -> bool:
    """Handle the failure of the goal or plan at *index*; return True if the goal is to be tried again."""
    for supervision in supervisions_below(intention, index):
        if _has_attempt(supervision):
            return True
        end(agent, supervision)
        if isinstance(supervision, GoalSupervision) and supervision.retries:
            reason.add((ATTEMPTS, float(supervision.failed + 1)))
        elif isinstance(supervision, PlanGuard) and supervision.lost is not None:
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
    while not isinstance(supervised := frames[index - 1][SUPERVISION], GoalSupervision):
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
    wait_for(agent, intention, (goal, annotations), delay, post_again, structure("retry", delay * 1000))
    return None


# --- pauses ------------------------------------------------------------------------------------------------


def wait_for(
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
    waiting = TimedWait(intention, reason, None, agent.architecture.now())
    waiting.attach(frame, behind)
    waiting.alarm = set_alarm(agent, delay, _resume, waiting)
    if agent.features.meta:
        meta_events.top_goal_state(agent, intention, "waiting", reason)


def _resume(agent: Circumstance, waiting: TimedWait) -> None:
    agent.end_wait(waiting)


def end_pause(agent: Circumstance) -> Intention:
    """Take the frame of a pause off the stack of the running intention."""
    intention = agent.current
    assert intention is not None
    intention.frames.pop()
    return intention


def post_again(agent: Circumstance, frame: Frame) -> Posted:
    """The step behind a pause between two attempts."""
    end_pause(agent)
    return Posted(frame[1], frame[2])
