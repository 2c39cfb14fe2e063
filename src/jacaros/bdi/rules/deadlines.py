"""Deadlines of goals and plans: ``within(Ms)``, and ``hard_deadline(Ms)`` of goals."""

from jacaros.bdi.explaining.failure_reason import ERROR, ERROR_MSG, FailureReason, nowhere
from jacaros.bdi.rules import goal_failure
from jacaros.bdi.rules.alarms import set_alarm
from jacaros.bdi.rules.failure import release_bindings
from jacaros.bdi.rules.interrupted_plans import cut_in_queue, interrupt_plan, post
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import ANNOTATIONS, GOAL, SERIAL, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.supervision import (
    SUPERVISION,
    GoalSupervision,
    Supervision,
    is_pause,
    is_supervision,
    place_of,
)
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.text import text
from jacaros.terms.values import String, Term, atom, structure


def set_deadline(
    agent: Circumstance, supervision: Supervision, seconds: float, reason: tuple[Term, ...]
) -> None:
    """Make the goal or plan fail with *reason* if it does not end in time."""
    alarm = supervision.alarm = set_alarm(agent, max(0.0, seconds), _pass)
    alarm.arguments = (supervision, alarm.number, reason)


def deadline_terms(seconds: float, hard: bool = False) -> tuple[Term, ...]:
    """Return the reason terms of a missed deadline."""
    if hard:
        return (ERROR, atom("deadline_reached")), (ERROR_MSG, String("the goal was not achieved in time"))
    milliseconds = seconds * 1000
    message = f"not achieved within {text(milliseconds)} ms"
    return (ERROR, atom("deadline")), (ERROR_MSG, String(message)), structure("deadline", milliseconds)


def _pass(agent: Circumstance, supervision: Supervision, number: int, reason: tuple[Term, ...]) -> None:
    agent.do_soon(_fail_late, supervision, number, reason)
    agent.architecture.ready()


def _fail_late(agent: Circumstance, supervision: Supervision, number: int, reason: tuple[Term, ...]) -> None:
    if supervision.alarm is None or supervision.alarm.number != number:
        return  # it has ended, or begun anew
    supervision.alarm = None
    for intention in list(agent.alive.values()):
        index = None if intention.dropped else place_of(intention, supervision)
        if index is None:
            continue
        if isinstance(supervision, GoalSupervision):
            _fail_goal(agent, intention, index, nowhere(*reason))
        elif index + 1 < len(intention.frames):
            interrupt_plan(agent, intention, index, nowhere(*reason))


def _fail_goal(agent: Circumstance, intention: Intention, index: int, reason: FailureReason) -> None:
    """Fail the supervised goal at *index*, whatever its plans are doing; it is not tried again."""
    frame = intention.frames[index]
    supervised: GoalSupervision = frame[SUPERVISION]
    goal: Goal = (supervised.kind, *frame[SUPERVISION + 1 :])
    annotations: EventAnnotations = frame[ANNOTATIONS]
    number = -1
    frames = intention.frames
    place = next((at for at in range(index + 1, len(frames)) if not is_supervision(frames[at])), None)
    if place is not None:
        goal, annotations = frames[place][GOAL], frames[place][ANNOTATIONS]
        number = -1 if is_pause(frames[place]) else frames[place][SERIAL]
        reason = reason.interrupted(frames[place:])
        goal_failure.observe_failed(agent, intention, place + 1, reason)
    release_bindings(goal, frame[SERIAL])
    cut_in_queue(agent, intention, index + 1)
    post(agent, intention, goal_failure.fail_goal(agent, intention, goal, annotations, reason, number))
