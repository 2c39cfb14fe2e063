"""Stop plans in the middle of a step because they must not continue: they clean up, and then fail."""

from jacaros.bdi.explaining.failure_reason import FailureReason
from jacaros.bdi.rules import goal_failure
from jacaros.bdi.rules.clr_int import cut
from jacaros.bdi.rules.supervision import end
from jacaros.bdi.state.belief_base import parts
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import Posted
from jacaros.bdi.state.intention import STEP, Frame, Intention
from jacaros.bdi.state.literals import own_annotations
from jacaros.bdi.state.plan import SUSPENDED
from jacaros.bdi.state.supervision import SUPERVISION, PlanGuard, supervisions_below
from jacaros.bdi.state.triggers import trigger
from jacaros.errors import InternalError
from jacaros.terms.values import functor_of


def interrupt_plan(agent: Circumstance, intention: Intention, index: int, reason: FailureReason) -> None:
    """Stop the plan whose guard is at *index*: its step and the goals that it waits for end."""
    guard: PlanGuard = intention.frames[index][SUPERVISION]
    frame = intention.frames[index + 1]
    interrupted = reason.interrupted(intention.frames[index + 1 :])
    goal_failure.observe_failed(agent, intention, index + 2, interrupted)
    cut_in_queue(agent, intention, index + 2)
    post(agent, intention, begin_clean_up(agent, intention, guard, frame, interrupted))


def begin_clean_up(
    agent: Circumstance, intention: Intention, guard: PlanGuard, frame: Frame, reason: FailureReason
) -> Posted | None:
    """Post the clean-up goal of a plan, after which the plan fails; without one it fails immediately."""
    end(agent, guard)
    symbol = functor_of(guard.cleanup)
    if symbol is None or symbol.kind:
        return goal_failure.fail_intention(agent, intention, reason)
    guard.lost, frame[STEP] = reason, fail_lost
    _, arguments, annotations = parts(guard.cleanup)
    return Posted((trigger("+", "!", symbol), *arguments), own_annotations(annotations))


def fail_lost(agent: Circumstance, frame: Frame) -> object:
    """The step after the clean-up goal of a plan: the plan fails."""
    intention = agent.current
    assert intention is not None
    place = next(at for at, each in enumerate(intention.frames) if each is frame)
    for guard in supervisions_below(intention, place):
        if isinstance(guard, PlanGuard) and guard.lost is not None:
            reason, guard.lost = guard.lost, None
            return goal_failure.fail_intention(agent, intention, reason) or SUSPENDED
    raise InternalError("a plan fails for a reason that it does not have")


def cut_in_queue(agent: Circumstance, intention: Intention, index: int) -> None:
    """Cut the stack of an intention that may be queued; it does not run until it is queued again."""
    cut(agent, intention, index)
    agent.take_out(intention)


def post(agent: Circumstance, intention: Intention, posted: Posted | None) -> None:
    """Queue the continuation of an intention."""
    if posted is not None:
        agent.post((posted.goal, intention, posted.annotations, None))
        agent.architecture.ready()
