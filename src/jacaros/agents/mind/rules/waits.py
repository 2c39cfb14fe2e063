"""What follows when a wait ends, or its intention is dropped, suspended or resumed: one function each."""

from jacaros.agents.mind.rules import meta_events
from jacaros.agents.mind.rules.clr_int import pop_finished
from jacaros.agents.mind.rules.failure import error_terms, fail_intention, step_failure, told
from jacaros.agents.mind.rules.pending import cancel, now
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import STEP
from jacaros.agents.mind.state.pending import AnswerWait, CoroutineWait, Waiting, is_action
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.values import Term, atom, functor

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
        frame[STEP] = waiting.next_step
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
    agent.post_for(intention, fail_intention(agent, intention, reason))


# --- dropped, suspended, resumed ---------------------------------------------------------------------------


def drop(agent: Circumstance, waiting: Waiting) -> None:
    """End the wait of an intention that is gone."""
    if not waiting.ended:
        waiting.ended = True
        forget(agent, waiting)


def forget(agent: Circumstance, waiting: Waiting) -> None:
    """Cancel what the wait has started."""
    for each in waiting.pending:
        cancel(agent, each)
    if waiting.act is not None and agent.waits.acts.pop(waiting.act, None) is not None:
        agent.architecture.cancel_act(waiting.act)
    elif isinstance(waiting, AnswerWait):
        for message_id in waiting.ids:
            if agent.waits.questions.pop(message_id, None) is not None:
                agent.waits.abandoned.add(message_id)
    elif isinstance(waiting, CoroutineWait):
        waiting.task.cancel()


def resume(agent: Circumstance, waiting: Waiting) -> None:
    """Handle the resumption of the intention."""
    if waiting.ended:
        # The end of an external action is handled in the next cycle, as usual; that of a wait has been handled.
        (announce_end if is_action(waiting.reason) else _take_up_end)(agent, waiting)
        return
    if waiting.act is not None:
        agent.architecture.resume_act(waiting.act)
    if agent.features.meta:
        meta_events.top_goal_state(agent, waiting.intention, "waiting", waiting.reason)


# --- times, events and conditions --------------------------------------------------------------------------


def come_true(agent: Circumstance, waiting: Waiting) -> None:
    """End a wait successfully."""
    forget(agent, waiting)
    if waiting.elapsed is not None and waiting.began is not None:
        agent.context.unify(waiting.elapsed, float(round((now(agent) - waiting.began) * 1000)))
        del agent.trail[:]
    succeed(agent, waiting)


def see_condition(agent: Circumstance, fault: Exception | None, waiting: Waiting) -> None:
    """End a wait whose condition holds, or cannot be evaluated."""
    if fault is None:
        come_true(agent, waiting)
    else:
        forget(agent, waiting)
        fail(agent, waiting, told(fault))


def time_out(agent: Circumstance, waiting: Waiting) -> None:
    """End a wait whose time is over."""
    if waiting.elapsed is not None:
        come_true(agent, waiting)
    else:
        forget(agent, waiting)
        fail(agent, waiting, "the wait is over without what it waited for", (ERROR, atom("wait_timeout")))
