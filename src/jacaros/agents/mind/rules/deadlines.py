"""Goals and plans that do not go on for ever: deadlines, attempts and periods of goals, deadlines and conditions of plans.

Two things interrupt them: ``within(Ms)`` of a goal or plan passes, or ``while(Condition)`` of a plan no longer holds. A
goal then fails. A plan stops in the middle of its step, pursues its clean-up goal, and fails.

One deadline applies to all attempts of a goal together. With ``every``, the goal is posted again in each period, and
deadline and attempts apply to each period.
"""

from math import ceil, floor

from jacaros.agents.language.lowering import Variables, lower
from jacaros.agents.mind.rules import failure, meta_events
from jacaros.agents.mind.rules.achieving import both, clean_up, log_fault
from jacaros.agents.mind.rules.body_steps import interpreted
from jacaros.agents.mind.rules.clr_int import cut_out, pop_finished
from jacaros.agents.mind.rules.failure import error_terms, fail_intention, step_failure, told
from jacaros.agents.mind.rules.failure_reason import ERROR, ERROR_MSG, FailureReason, nowhere
from jacaros.agents.mind.rules.pending import cancel, is_true, now, set_alarm, watch
from jacaros.agents.mind.rules.supervision import end, pause, post_again, supervising
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import (
    ANNOTATIONS,
    FIRST_SLOT,
    GOAL,
    PLAN,
    SERIAL,
    STEP,
    Event,
    Frame,
    Intention,
    Posted,
    variables_of,
)
from jacaros.agents.mind.state.pending import (
    CONDITION,
    SUPERVISION,
    WRITTEN,
    AnswerWait,
    CoroutineWait,
    Pending,
    Supervision,
    Waiting,
    is_action,
    is_pause,
    is_supervision,
)
from jacaros.agents.mind.state.plan import ACHIEVES, SUSPENDED, Failure
from jacaros.agents.mind.state.triggers import (
    EventAnnotations,
    Goal,
    apart,
    literal_of,
)
from jacaros.agents.terms.substitution import rename, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    BY_SELF,
    LOGIC,
    Functor,
    String,
    Term,
    atom,
    bare,
    functor,
    structure,
)
from jacaros.runtime.files.texts import is_worth_a_line

WITHIN, HARD_DEADLINE, EVERY = functor("within", 1), functor("hard_deadline", 1), functor("every", 1)
RETRY, RETRY_AFTER = functor("retry", 1), functor("retry", 2)
ACTING: frozenset[Functor] = frozenset({WITHIN, HARD_DEADLINE, EVERY, RETRY, RETRY_AFTER})
"""The annotations of goals that have an effect, and numbers."""
_NOT = functor("not", 1, kind=LOGIC)
_EXACT = 1e-5
"""Tolerance for inaccurate clocks, in seconds."""


# --- goals -------------------------------------------------------------------------------------------------


def supervision_of(goal: Goal, annotations: tuple[Term, ...]) -> Supervision | None:
    """Return the supervision of a goal, or None if its annotations ask for none. Invalid annotations have no effect."""
    found = Supervision(goal[0])
    conditions = []
    for inner in map(bare, annotations):
        if inner.__class__ is not tuple:
            continue
        if inner[0] in ACTING and all(number.__class__ is float for number in inner[1:]):
            _take(found, inner[0], inner[1:])
        elif inner[0].name == ACHIEVES and 1 <= inner[0].arity <= 2:
            conditions.append(list(inner[1:]))
    found.achieves, found.settle = both(conditions)
    acts = found.within is not None or found.retries or found.period is not None or conditions
    return found if acts and goal[0].kind == "!" else None


def _take(supervision: Supervision, word: Functor, numbers: tuple[float, ...]) -> None:
    seconds = numbers[-1] / 1000
    if word is WITHIN or word is HARD_DEADLINE:
        if supervision.within is None or seconds < supervision.within:
            supervision.within, supervision.hard = seconds, word is HARD_DEADLINE
    elif word is EVERY:
        if seconds > 0:
            supervision.period = seconds
    elif numbers[0] >= 1 and numbers[0].is_integer():
        supervision.retries = int(numbers[0])
        supervision.back_off = max(0.0, seconds) if word is RETRY_AFTER else 0.0


def supervised(
    agent: Circumstance, intention: Intention | None, goal: Goal, annotations: tuple[Term, ...]
) -> Goal:
    """Return a goal to post, supervised on the stack of its intention as its annotations say."""
    supervision = supervision_of(goal, annotations)
    if supervision is None or intention is None:
        return goal
    supervision.began = now(agent)
    intention.frames.append(supervising(agent, supervision, _ended, annotations, goal[1:]))
    return _begin(agent, intention.frames[-1], goal)


def adopt(agent: Circumstance, event: Event) -> None:
    """Post the event of a new goal, which has an intention of its own."""
    goal, _, annotations, cause = event
    if annotations is not BY_SELF and isinstance(annotations, tuple) and supervision_of(goal, annotations):
        if len(agent.alive) >= agent.options.intention_limit:
            agent.budgets["intention_limit"].refuse(len(agent.alive))
            return
        intention = Intention(agent, cause)
        event = (supervised(agent, intention, goal, annotations), intention, annotations, None)
    meta_events.post_new_goal(agent, event)


def _begin(agent: Circumstance, holder: Frame, goal: Goal) -> Goal:
    """Begin the goal or one period; return the goal to post, with new variables in each period."""
    supervision: Supervision = holder[SUPERVISION]
    supervision.failed = 0
    if supervision.within is not None:
        _set_deadline(agent, supervision, supervision.within)
    if supervision.period is None:
        return goal
    *posted, holder[CONDITION] = apart((*goal, holder[WRITTEN]))
    return tuple(posted)


def _ended(agent: Circumstance, frame: Frame) -> object:
    """The step of a supervision's frame: the plan has ended, or the goal was achieved or a plan handled its failure."""
    supervision: Supervision = frame[SUPERVISION]
    end(agent, supervision)
    if supervision.period is None or agent.current is None:
        frame[STEP] = None
        return None
    time = now(agent)
    _, goal, annotations = _goal_of(frame)
    following = ceil((time - supervision.began - _EXACT) / supervision.period)
    _skip_to(agent, supervision, following - 1, goal, annotations)
    due = supervision.began + (supervision.number + 1) * supervision.period
    reason = structure("every", supervision.period * 1000)
    pause(agent, agent.current, (goal, annotations), max(0.0, due - time), _next_period, reason)
    return SUSPENDED


def _next_period(agent: Circumstance, frame: Frame) -> Posted:
    """The step behind the pause between two periods."""
    posted = post_again(agent, frame)
    assert agent.current is not None
    holder = agent.current.frames[-1]
    supervision: Supervision = holder[SUPERVISION]
    assert supervision.period is not None
    passed = floor((now(agent) - supervision.began + _EXACT) / supervision.period)
    # The intention may have been suspended, or the mind stored, when the period began.
    _skip_to(agent, supervision, passed - 1, posted.goal, posted.annotations)
    supervision.number += 1
    return Posted(_begin(agent, holder, posted.goal), posted.annotations)


def _skip_to(
    agent: Circumstance, supervision: Supervision, number: int, goal: Goal, annotations: EventAnnotations
) -> None:
    """Report that the periods up to *number* have been missed: raise events for plans, and warn."""
    missed = number - supervision.number
    if missed <= 0 or supervision.period is None:
        return
    supervision.number = number
    supervision.missed += missed
    meta_events.goal_state(
        agent, goal, annotations, "missed", atom("overrun"), structure("periods", float(missed))
    )
    if is_worth_a_line(supervision.missed, missed):
        count = "a period" if supervision.missed == 1 else f"{supervision.missed} periods"
        shown, period = text(literal_of(goal, ())), text(supervision.period * 1000)
        told = f"goal !{shown} has missed {count} of {period} ms: it takes longer"
        agent.architecture.log("warning", told)


# --- plans -------------------------------------------------------------------------------------------------


def begin_guarded(agent: Circumstance, frame: Frame) -> object:
    """The step before the first one of a plan with guards: start its condition and its deadline."""
    intention, plan = agent.current, frame[PLAN]
    assert intention is not None
    if plan.first is None:  # the mind was stored before the plan had begun
        interpreted(plan)
        frame.extend([None] * (FIRST_SLOT + plan.size - len(frame)))
    frame[STEP] = plan.first
    guards = _guards(frame)
    supervision = Supervision()
    supervision.cleanup, supervision.achieves = guards.get("cleanup"), guards.get(ACHIEVES)
    intention.frames.insert(len(intention.frames) - 1, supervising(agent, supervision, _ended))
    within, condition = guards.get("within"), guards.get("while")
    if isinstance(within, float):
        _set_deadline(agent, supervision, within / 1000)
    if condition is None:
        return None
    lost, fault = is_true(agent, (_NOT, condition))
    if lost:
        log_fault(agent, fault, condition)
        return clean_up(agent, intention, supervision, frame, nowhere(*_lost(condition))) or SUSPENDED
    supervision.pending.append(
        watch(agent, (_NOT, condition), _lose, supervision, supervision.pending, condition)
    )
    return None


def _guards(frame: Frame) -> dict[str, Term]:
    """Return the guards of a plan, with the values of its variables when it begins."""
    names = Variables(variables_of(frame))
    return {
        node.functor: rename(resolve(lower(node.arguments[0], names.__getitem__)))
        for node in frame[PLAN].guards
    }


def _lose(
    agent: Circumstance,
    fault: Exception | None,
    supervision: Supervision,
    pending: list[Pending],
    condition: Term,
) -> None:
    """Interrupt a plan whose condition no longer holds. One that cannot be evaluated does not hold."""
    log_fault(agent, fault, condition)
    _interrupt(agent, supervision, pending, _lost(condition))


def _lost(condition: Term) -> tuple[Term, ...]:
    """Return the reason terms of a plan whose condition no longer holds."""
    message = f"the condition {text(condition)} of the plan no longer holds"
    lost = structure("condition_lost", condition)
    return (ERROR, atom("condition_lost")), (ERROR_MSG, String(message)), lost


# --- interruptions -----------------------------------------------------------------------------------------


def _set_deadline(agent: Circumstance, supervision: Supervision, seconds: float) -> None:
    """Interrupt the goal or plan if it does not end in time."""
    pending = supervision.pending
    pending.append(
        set_alarm(agent, max(0.0, seconds), _pass, supervision, pending, _late(supervision, seconds))
    )


def _late(supervision: Supervision, seconds: float) -> tuple[Term, ...]:
    """Return the reason terms of a missed deadline."""
    if supervision.hard:
        return (ERROR, atom("deadline_reached")), (ERROR_MSG, String("the goal was not achieved in time"))
    milliseconds = seconds * 1000
    message = f"not achieved within {text(milliseconds)} ms"
    return (ERROR, atom("deadline")), (ERROR_MSG, String(message)), structure("deadline", milliseconds)


def _pass(
    agent: Circumstance, supervision: Supervision, pending: list[Pending], reason: tuple[Term, ...]
) -> None:
    agent.do_soon(_interrupt, supervision, pending, reason)
    agent.architecture.ready()


def _interrupt(
    agent: Circumstance, supervision: Supervision, pending: list[Pending], reason: tuple[Term, ...]
) -> None:
    """Interrupt the goal or plan in all its intentions, unless it has ended, or begun anew, since the call was made."""
    if supervision.pending is not pending:
        return
    end(agent, supervision)
    for intention in list(agent.alive.values()):
        for index, frame in enumerate(intention.frames):
            if is_supervision(frame) and frame[SUPERVISION] is supervision:
                _stop(agent, intention, index, nowhere(*reason))
                break


def _stop(agent: Circumstance, intention: Intention, index: int, reason: FailureReason) -> None:
    """Stop the goal or plan above the frame at *index*, whatever it is doing; a goal is not tried again."""
    frames, holder = intention.frames, intention.frames[index]
    place = index + 1
    while place < len(frames) and is_supervision(frames[place]):
        place += 1
    stopped = frames[place:]
    if stopped:
        reason = reason.interrupted(stopped)
        failure.observe_failed(agent, intention, place + 1, reason)
    if holder[SUPERVISION].kind is not None:
        number, goal, annotations = _goal_of(stopped[0] if stopped else holder)
        failure.release_bindings(goal, holder[SERIAL])
        cut_out(agent, intention, index + 1)
        agent.post_for(intention, failure.fail_goal(agent, intention, goal, annotations, reason, number))
    elif stopped:
        cut_out(agent, intention, place + 1)
        agent.post_for(intention, clean_up(agent, intention, holder[SUPERVISION], stopped[0], reason))


def _goal_of(frame: Frame) -> tuple[int, Goal, tuple[Term, ...]]:
    """Return the number by which observers know a supervised goal (-1 if it has no plan), and the goal, of a frame."""
    if not is_supervision(frame):
        return -1 if is_pause(frame) else frame[SERIAL], frame[GOAL], frame[ANNOTATIONS]
    return -1, (frame[SUPERVISION].kind, *frame[WRITTEN + 1 :]), frame[ANNOTATIONS]


# What follows when a wait ends, or its intention is dropped, suspended or resumed: one function each.

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
