"""What follows when a wait ends, or its intention is dropped, suspended or resumed: one function each."""

from jacaros.bdi.rules import failure, meta_events, plan_guards
from jacaros.bdi.rules.alarms import cancel_alarm
from jacaros.bdi.rules.clr_int import pop_finished
from jacaros.bdi.rules.failure import error_terms, step_failure
from jacaros.bdi.rules.goal_failure import fail_intention
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.condition_waits import ConditionObserver, ConditionWait, ConditionWatch
from jacaros.bdi.state.event import EVENT_GOAL, Event, event_literal
from jacaros.bdi.state.plan import Failure
from jacaros.bdi.state.waiting import (
    ActWait,
    AnswerWait,
    CoroutineWait,
    EventWait,
    TimedWait,
    Waiting,
    is_action,
)
from jacaros.errors import InternalError
from jacaros.terms.substitution import rename
from jacaros.terms.unifier import undo, unify
from jacaros.terms.values import Term, atom, functor

ERROR = functor("error", 1)

# --- ends --------------------------------------------------------------------------------------------------


def succeed(agent: Circumstance, waiting: Waiting) -> None:
    """Let the step succeed: the intention continues in the next cycle."""
    if not waiting.ended:
        waiting.ended = True
        announce_end(agent, waiting)


def fail(agent: Circumstance, waiting: Waiting, message: str, *annotations: Term) -> None:
    """Let the step fail; *annotations* may contain an ``error(..)``."""
    if not waiting.ended:
        waiting.failure = (message, annotations)
        succeed(agent, waiting)


def announce_end(agent: Circumstance, waiting: Waiting) -> None:
    """Let the intention continue in the next cycle, if the step has already been suspended."""
    if waiting.frame is not None:
        agent.do_soon(_take_up_end, waiting)
        agent.architecture.ready()


def _take_up_end(agent: Circumstance, waiting: Waiting) -> None:
    intention = waiting.intention
    # Success and failure alike come after ``.resume``.
    if intention.waiting is waiting and intention.suspended is None:
        intention.waiting = None
        _continue(agent, waiting)


def _continue(agent: Circumstance, waiting: Waiting) -> None:
    """Continue the intention after the step, or with the failure of the step."""
    intention, frame = waiting.intention, waiting.frame
    assert frame is not None
    if waiting.failure is None:
        frame[0] = waiting.next_step
        if agent.features.meta:
            meta_events.top_goal_state(agent, intention, "executing")
        if pop_finished(agent, intention):
            agent.make_ready(intention)
        return
    message, annotations = waiting.failure
    given = {t[0] for t in annotations if t.__class__ is tuple}
    defaults = error_terms("internal_action", message) if message else error_terms("internal_action", "")[:1]
    annotations = (*(term for term in defaults if term[0] not in given), *annotations)
    reason = step_failure(frame, Failure(*annotations))
    posted = fail_intention(agent, intention, reason)
    if posted is not None:
        agent.post((posted.goal, intention, posted.annotations, None))


# --- dropped, suspended, resumed ---------------------------------------------------------------------------


def drop(agent: Circumstance, waiting: Waiting) -> None:
    """End the wait of an intention that is gone."""
    if not waiting.ended:
        waiting.ended = True
        forget(agent, waiting)


def forget(agent: Circumstance, waiting: Waiting) -> None:
    """Cancel what the wait has started."""
    if waiting.alarm is not None:
        cancel_alarm(agent, waiting.alarm)
    if isinstance(waiting, ActWait):
        if agent.waits.acts.pop(waiting.number, None) is not None:
            agent.architecture.cancel_act(waiting.number)
    elif isinstance(waiting, EventWait):
        agent.waits.events.remove(waiting)
    elif isinstance(waiting, ConditionWait):
        agent.waits.conditions.remove(waiting)
    elif isinstance(waiting, AnswerWait):
        for message_id in waiting.ids:
            if agent.waits.questions.pop(message_id, None) is not None:
                agent.waits.abandoned.add(message_id)
    elif isinstance(waiting, CoroutineWait):
        waiting.task.cancel()


def suspend(agent: Circumstance, waiting: Waiting) -> None:
    """Handle the suspension of the intention: an external action may pause; others continue, and their end is held back."""
    if isinstance(waiting, ActWait):
        agent.architecture.suspend_act(waiting.number)


def resume(agent: Circumstance, waiting: Waiting) -> None:
    """Handle the resumption of the intention."""
    if waiting.ended:
        # The end of an external action is handled in the next cycle, as usual; that of a wait has been handled.
        (announce_end if is_action(waiting.reason) else _take_up_end)(agent, waiting)
        return
    if isinstance(waiting, ActWait):
        agent.architecture.resume_act(waiting.number)
    if agent.features.meta:
        meta_events.top_goal_state(agent, waiting.intention, "waiting", waiting.reason)


# --- times, events and conditions --------------------------------------------------------------------------


def come_true(agent: Circumstance, waiting: TimedWait) -> None:
    """End a wait successfully."""
    forget(agent, waiting)
    if waiting.elapsed is not None:
        # A clock may be set back meanwhile.
        seconds = max(0.0, agent.architecture.now() - waiting.began)
        agent.context.unify(waiting.elapsed, float(round(seconds * 1000)))
        del agent.trail[:]
    succeed(agent, waiting)


def time_out(agent: Circumstance, waiting: TimedWait) -> None:
    """End a wait whose time is over."""
    if waiting.elapsed is not None:
        come_true(agent, waiting)
    else:
        forget(agent, waiting)
        fail(agent, waiting, "the wait is over without what it waited for", (ERROR, atom("wait_timeout")))


def notify_event_waits(agent: Circumstance, event: Event) -> None:
    """Resume the intentions that wait for this event."""
    for wait in agent.waits.events.candidates(event[EVENT_GOAL][0]):
        mark = len(agent.trail)
        if unify(wait.pattern, rename(event_literal(event)), agent.trail):
            # The bindings of the wait are permanent, whatever the search for the event's plan undoes.
            del agent.trail[mark:]
            come_true(agent, wait)
        else:
            undo(agent.trail, mark)


def check_conditions(agent: Circumstance) -> None:
    """Resume the intentions whose awaited condition now holds."""
    for wait in agent.waits.conditions.take_due():
        if wait.ended:
            agent.waits.conditions.remove(wait)
            continue
        if isinstance(wait, ConditionWatch):
            plan_guards.check(agent, wait)
            continue
        try:
            held = wait.holds() if isinstance(wait, ConditionObserver) else _holds(agent, wait)
        except InternalError:
            raise
        except Exception as fault:
            undo(agent.trail, 0)
            agent.waits.conditions.remove(wait)
            if isinstance(wait, ConditionObserver):
                wait.fail(failure.told(fault))
            else:
                forget(agent, wait)
                fail(agent, wait, failure.told(fault))
        else:
            if held:
                agent.waits.conditions.remove(wait)
                if isinstance(wait, ConditionObserver):
                    wait.resume()
                else:
                    come_true(agent, wait)


def _holds(agent: Circumstance, wait: ConditionWait) -> bool:
    """Return whether an awaited condition holds now, binding its variables."""
    if not agent.context.succeeds(wait.formula):
        return False
    del agent.trail[:]
    return True
