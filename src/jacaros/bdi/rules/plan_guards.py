"""Plans with guards in their labels: ``@p[while(Condition), within(Ms), cleanup(Goal)]``.

The condition is watched like that of a ``.wait``. When it no longer holds, the plan stops in the middle of its step, its
clean-up goal is pursued, and then the plan fails.
"""

from jacaros.asl.lowering import Names, lower
from jacaros.bdi.explaining.failure_reason import ERROR, ERROR_MSG, FailureReason, nowhere
from jacaros.bdi.rules import failure
from jacaros.bdi.rules.body_steps import interpreted
from jacaros.bdi.rules.deadlines import deadline_terms, set_deadline
from jacaros.bdi.rules.interrupted_plans import begin_clean_up, interrupt_plan
from jacaros.bdi.rules.supervision import plan_ended, supervising
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.condition_waits import ConditionWatch, asked_by
from jacaros.bdi.state.intention import FIRST_SLOT, PLAN, STEP, Frame, Intention
from jacaros.bdi.state.plan import SUSPENDED
from jacaros.bdi.state.supervision import SUPERVISION, PlanGuard, is_supervision
from jacaros.errors import InternalError
from jacaros.terms.substitution import rename, resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import undo
from jacaros.terms.values import String, Term, atom, structure


def begin_guarded(agent: Circumstance, frame: Frame) -> object:
    """The step before the first one of a plan with guards: start its condition and its deadline."""
    intention = agent.current
    assert intention is not None
    plan = frame[PLAN]
    if plan.first is None:  # the mind was stored before the plan had begun
        interpreted(plan)
        frame.extend([None] * (FIRST_SLOT + plan.size - len(frame)))
    frame[STEP] = plan.first
    words = _words(frame)
    guard = PlanGuard(words.get("cleanup"))
    intention.frames.insert(len(intention.frames) - 1, supervising(agent, guard, plan_ended))
    within = words.get("within")
    if isinstance(within, float):
        set_deadline(agent, guard, within / 1000, deadline_terms(within / 1000))
    condition = words.get("while")
    if condition is None:
        return None
    if not _holds(agent, condition):
        return begin_clean_up(agent, intention, guard, frame, _lost(condition)) or SUSPENDED
    guard.watch = ConditionWatch(condition, asked_by(condition, agent.beliefs, agent.engine.actions))
    agent.waits.conditions.add(guard.watch)
    agent.incoming.called = True
    return None


def _words(frame: Frame) -> dict[str, Term]:
    """Return the guards of a plan, with the values of its variables when it begins."""
    slots = frame[PLAN].slots
    names = Names((name, frame[slot]) for name, slot in slots.items() if frame[slot] is not None)
    return {
        node.functor: rename(resolve(lower(node.arguments[0], names.__getitem__)))
        for node in frame[PLAN].guards
    }


def _holds(agent: Circumstance, condition: Term) -> bool:
    """Return whether a condition holds now, without leaving bindings. One that cannot be evaluated does not hold."""
    try:
        return bool(agent.context.succeeds(condition))
    except InternalError:
        raise
    except Exception as fault:
        undo(agent.trail, 0)  # its text would evaluate what is bound, and fail again
        agent.architecture.log(
            "error", f"cannot evaluate the condition {text(condition)}: {failure.told(fault)}"
        )
        return False
    finally:
        undo(agent.trail, 0)


def _lost(condition: Term) -> FailureReason:
    message = f"the condition {text(condition)} of the plan no longer holds"
    return nowhere(
        (ERROR, atom("condition_lost")),
        (ERROR_MSG, String(message)),
        structure("condition_lost", condition),
    )


def check(agent: Circumstance, watch: ConditionWatch) -> None:
    """Check the condition of a plan after a change of beliefs."""
    if watch.ended or _holds(agent, watch.condition):
        return
    reason = _lost(watch.condition)
    for intention in list(agent.alive.values()):
        index = None if intention.dropped else _place(intention, watch)
        if index is not None and index + 1 < len(intention.frames):
            interrupt_plan(agent, intention, index, reason)


def _place(intention: Intention, watch: ConditionWatch) -> int | None:
    for index, frame in enumerate(intention.frames):
        if is_supervision(frame):
            guard = frame[SUPERVISION]
            if isinstance(guard, PlanGuard) and guard.watch is watch:
                return index
    return None
