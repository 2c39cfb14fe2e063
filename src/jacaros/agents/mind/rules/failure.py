"""Failure of formulae and of goals: their reasons, and the goal on the stack whose plan handles them.

An exception that no rule of the language foresees, such as a lack of memory, costs an agent one message, event or
intention; it is logged, and the agent continues.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.mind.actions.internal_action import ActionError, WrongArguments
from jacaros.agents.mind.rules import failure_reason, forks, meta_events, supervision
from jacaros.agents.mind.rules.failure_reason import ERROR, ERROR_MSG, FailureReason, Place, goal_text
from jacaros.agents.mind.rules.forks import branch_failed
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import (
    ANNOTATIONS,
    GOAL,
    PLAN,
    SERIAL,
    STEP,
    Frame,
    Intention,
    Posted,
)
from jacaros.agents.mind.state.pending import SUPERVISED, caller_of, supervisions_below
from jacaros.agents.mind.state.plan import Fail, Failure, StepInfo
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import ATOMIC, resolve
from jacaros.agents.terms.text import display, text
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import List, String, Term, Var, atom, functor
from jacaros.runtime.errors import InternalError

_ENV_FAILURE_REASON, _BIND_PARAM_ERROR = functor("env_failure_reason", 1), functor("bind_param_error", 2)

_IDS: dict[type, str] = {
    nodes.Test: "test_goal_failed",
    nodes.If: "constraint_failed",
    nodes.While: "constraint_failed",
    nodes.For: "constraint_failed",
    nodes.ExternalAction: "action_failed",
    nodes.BeliefChange: "belief_revision_failed",
}


def error_terms(error: str, message: str) -> tuple[Term, ...]:
    """``error(Id)`` and ``error_msg("…")``."""
    return ((ERROR, atom(error)), (ERROR_MSG, String(message)))


def output_misfit(output: Term, value: Term) -> tuple[Term, ...]:
    """Return the reason for an external action with an *output* that is already bound to another value.

    This happens, for example, if the same variable is written for two outputs.
    """
    message = f"an output of the action would be {text(value)}, but is {text(output)} already"
    reason = (_BIND_PARAM_ERROR, resolve(output), String(display(value)))
    return (*error_terms("action_failed", message), (_ENV_FAILURE_REASON, reason))


def step_failure(frame: Frame, fault: Exception | None = None) -> FailureReason:
    """Return the reason of a step that failed, or that raised *fault*.

    Raises:
        InternalError: the fault is a defect of JaCaROS.
    """
    info: StepInfo | None = getattr(frame[STEP], "info", None)
    if info is None:
        raise InternalError(f"a step of plan {frame[PLAN]!r} is unknown") from fault
    if fault is not None and fault.__class__ is not Fail:
        return FailureReason(_terms_of(fault, info), frame)
    terms = info.failure
    if terms is None:
        terms = info.failure = error_terms(*_plain_failure(info.node))
    return FailureReason(terms, frame)


_ERRORS = (
    (WrongArguments, "wrong_arguments"),
    (ArithmeticFault, "arithmetic_error"),
    (RecursionError, "too_deep"),
)
"""Exceptions whose text is the message, and their error ids."""


def _terms_of(fault: Exception, info: StepInfo) -> tuple[Term, ...]:
    if isinstance(fault, Failure):
        return (*fault.annotations, *_message_unless_given(fault.annotations, _default_message(fault)))
    if isinstance(fault, Fail):
        return error_terms(*_plain_failure(info.node))
    for kind, error in _ERRORS:
        if isinstance(fault, kind):
            return error_terms(error, str(fault))
    if isinstance(fault, ActionError):
        given = fault.annotations
        known = any(t.__class__ is tuple and t[0] is ERROR for t in given)
        error_term = () if known else ((ERROR, atom("internal_action")),)
        return (*error_term, *given, *_message_unless_given(given, str(fault)))
    if isinstance(fault, MemoryError):
        return error_terms("no_memory", "there is not enough memory")
    if isinstance(fault, InternalError):
        raise fault
    error = "internal_action" if isinstance(info.node, nodes.Constraint) else "unknown"
    return error_terms(error, f"{type(fault).__name__}: {fault}")


_MESSAGES = {
    "body_var_without_value": "a variable that stands for a step has no value",
    "body_var_not_literal": "a variable that stands for a goal or a belief holds something else",
    "body_var_with_op": "a variable behind an operator holds a plan body",
}


def _default_message(fault: Failure) -> str:
    """Return the message of a failure without one."""
    found = (text(term[1]) for term in fault.annotations if term.__class__ is tuple and term[0] is ERROR)
    error = next(found, "unknown")
    return _MESSAGES.get(error, error.replace("_", " "))


def _message_unless_given(given: tuple[Term, ...], message: str) -> tuple[Term, ...]:
    if any(t.__class__ is tuple and t[0] is ERROR_MSG for t in given):
        return ()
    return ((ERROR_MSG, String(message)),)


def _plain_failure(node: nodes.Node) -> tuple[str, str]:
    if isinstance(node, nodes.Constraint):
        if isinstance(node.formula, nodes.InternalAction):
            return "ia_failed", f"internal action {node.formula.name} failed"
        return "constraint_failed", "a constraint does not hold"
    error = _IDS.get(type(node), "unknown")
    return error, {"test_goal_failed": "a test found no answer"}.get(error, error.replace("_", " "))


def no_plan(
    agent: Circumstance, goal: Goal, annotations: EventAnnotations, caller: Frame | None
) -> FailureReason:
    """Return the reason of a goal that has no relevant or no applicable plan."""
    if agent.library.selects[goal[0]] is None:
        error, told = "no_relevant", "no relevant plan"
    elif agent.selections.refused:
        agent.selections.refused = False
        error, told = "no_option", "no option is selected"
    else:
        error, told = "no_applicable", "no applicable plan"

    def terms() -> tuple[Term, ...]:
        return error_terms(error, f"{told} for {goal[0].kind}{goal_text(goal)}")

    # The values of variables are shown as they are now: they are released before a plan may ask.
    at_once = not ATOMIC.issuperset(map(type, goal[1:]))
    return FailureReason(terms() if at_once else terms, Place(caller, unplanned=(goal, annotations)))


_MAY_BE_BOUND = frozenset({Var, tuple, List})


def release_bindings(goal: Goal, serial: int) -> None:
    """Undo the bindings of the variables of a failed goal since it was posted."""
    stack: list[Term] = []
    for argument in goal:
        if argument.__class__ in _MAY_BE_BOUND:
            stack.append(argument)
    while stack:
        term = stack.pop()
        if term.__class__ is Var:
            if term.ref is None:
                continue
            if term.at >= serial:
                term.ref = None
            else:
                stack.append(term.ref)
        elif term.__class__ is tuple:
            stack.extend(a for a in term[1:] if a.__class__ in _MAY_BE_BOUND)
        elif isinstance(term, List) and term.settled != term.size:
            stack.extend(a for a in term.stack[term.settled : term.size] if a.__class__ in _MAY_BE_BOUND)


def handler_event(agent: Circumstance, intention: Intention, reason: FailureReason) -> Posted | int | None:
    """Find the nearest goal down the stack that has a handler, or return None.

    The failed frames stay on the stack under the handler until it ends. A failure inside a handler is passed to the
    goals below the one it handles. A goal with attempts left comes before its handler: the index of its frame is
    returned.
    """
    frames = intention.frames
    found = _handler_index(agent, intention) if frames and frames[-1][PLAN].nested else None
    selects = agent.library.selects
    index, handlers = _goal_below(intention, len(frames), len(intention.handlers))
    while index >= 0:
        frame = frames[index]
        kind = frame[GOAL][0].on_fail
        if (
            index
            and frames[index - 1][GOAL][0] is SUPERVISED
            and supervision.fails(agent, intention, index, reason)
        ):
            del intention.handlers[handlers:]
            release_bindings(frame[GOAL], frame[SERIAL])
            return index
        if index == found or (found is None and kind is not None and selects[kind] is not None):
            goal = frame[GOAL]
            release_bindings(goal, frame[SERIAL])
            # Handlers above it have failed with the goals that they handled.
            intention.handlers[handlers:] = (index,)
            return Posted((goal[0].on_fail, *goal[1:]), reason.for_goal(frame[ANNOTATIONS]))
        index, handlers = _goal_below(intention, index, handlers)
    return None


def has_handler(agent: Circumstance, intention: Intention, above: int) -> bool:
    """Return whether a goal higher on the stack than the frame *above* has a handler that is not already running."""
    found = _handler_index(agent, intention)
    index, handlers = _goal_below(intention, len(intention.frames), len(intention.handlers))
    while found <= above < index:
        if any(each.failed < each.retries for each in supervisions_below(intention, index)):
            return True
        index, handlers = _goal_below(intention, index, handlers)
    return found > above


def handles_own(agent: Circumstance, intention: Intention, kind: Trigger) -> bool:
    """Return whether a goal without a plan has a handler of its own; as in Jason, only the innermost scope counts."""
    scope = next(iter(forks.scopes(intention)), None)
    if scope is None:
        return agent.library.selects[kind] is not None
    return forks.has_inner(agent, scope, kind)


def _goal_below(intention: Intention, index: int, handlers: int) -> tuple[int, int]:
    """Return the index of the next goal down the stack that a running handler is not for, and the handlers below it."""
    index -= 1
    while handlers and index >= 0 and intention.frames[index][GOAL][0].failing:
        handlers -= 1
        index = intention.handlers[handlers] - 1
    return index, handlers


def _handler_index(agent: Circumstance, intention: Intention) -> int:
    """Return the index of the frame whose goal has the handler, or -1.

    As in Jason, each scope is searched for handlers of the whole stack before the scope around it is, and outside the
    innermost scope the bottom goal comes first.
    """
    scoped = False
    for scope in forks.scopes(intention):
        index = _first_handled(intention, scoped, partial(forks.has_inner, agent, scope))
        if index >= 0:
            return index
        scoped = True
    selects = agent.library.selects
    return _first_handled(intention, scoped, lambda kind: selects[kind] is not None)


def _first_handled(intention: Intention, bottom_first: bool, has_plan: Callable[[Trigger], bool]) -> int:
    frames = intention.frames
    index, handlers = _goal_below(intention, len(frames), len(intention.handlers))
    if bottom_first and 0 not in intention.handlers:
        kind = frames[0][GOAL][0].on_fail
        if kind is not None and has_plan(kind):
            return 0
    while index >= 0:
        kind = frames[index][GOAL][0].on_fail
        if kind is not None and has_plan(kind):
            return index
        index, handlers = _goal_below(intention, index, handlers)
    return -1


def told(fault: BaseException) -> str:
    """Describe an exception."""
    message = str(fault)
    return f"{type(fault).__name__}: {message}" if message else type(fault).__name__


def note_lack_of_memory(agent: Circumstance, fault: BaseException) -> None:
    """Report a `MemoryError` to the host, before anything else that needs memory."""
    if isinstance(fault, MemoryError):
        agent.architecture.out_of_memory()


def report_skipped(agent: Circumstance, what: str, fault: Exception) -> None:
    """Report that something was skipped because of an exception."""
    note_lack_of_memory(agent, fault)
    undo(agent.trail, 0)
    agent.architecture.log("error", f"{what} skipped: {told(fault)}")


def drop_after_error(agent: Circumstance, intention: Intention, fault: Exception) -> None:
    """End an intention that cannot continue, without failure events.

    Raises:
        InternalError: that is what *fault* is.
    """
    if isinstance(fault, InternalError):
        raise fault
    note_lack_of_memory(agent, fault)
    undo(agent.trail, 0)
    agent.current = None
    if not intention.dropped:
        agent.architecture.log("error", f"intention {intention.id} dropped: {told(fault)}")
        agent.finish(intention)


# Handle the failure of a goal: its own handler, that of a goal further down, or the end of the intention.


_HAS_FAILURE_PLAN = atom("has_failure_plan")
_Unplanned = tuple[Goal, Any, int]
"""A goal without a frame, its annotations, and the number by which observers know it."""


def unplanned(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations
) -> Posted | None:
    """A goal has no plan: run its own handler, or one further down, or end the intention."""
    trigger = goal[0]
    if trigger.failing:
        _lost_in_handler(agent, intention, goal, annotations)
        return None
    caller = caller_of(intention)
    reason = no_plan(agent, goal, annotations, caller)
    height = len(intention.frames)
    if supervision.fails(agent, intention, height, reason):
        return supervision.try_again(agent, intention, height, goal, annotations, reason.error())
    return fail_goal(agent, intention, goal, annotations, reason)


def has_room(agent: Circumstance, intention: Intention) -> bool:
    """Return whether the plan just put on a full stack may stay: handlers have some extra room."""
    depth = agent.options.goal_depth
    is_handler = intention.frames[-1][GOAL][0].failing
    return is_handler and len(intention.frames) <= depth + depth // 10 + 100


def too_deep(agent: Circumstance, intention: Intention) -> Posted | None:
    """Fail the plan just put on a full stack before its first step."""
    frame = intention.frames.pop()
    goal, annotations = frame[GOAL], frame[ANNOTATIONS]
    release_bindings(goal, frame[SERIAL])
    depth = agent.options.goal_depth
    told = f"more than {depth} plans are on the stack of the intention (option goal_depth)"
    place = Place(caller_of(intention) or frame, unplanned=(goal, annotations))
    reason = FailureReason(error_terms("too_deep", told), place)
    if goal[0].failing:
        # Handlers of handlers without end: no handler is left that could deal with it.
        intention.handlers.clear()
        observe_failed(agent, intention, 1, reason)
        del intention.frames[1:]
    return fail_goal(agent, intention, goal, annotations, reason, frame[SERIAL])


def fail_goal(
    agent: Circumstance,
    intention: Intention,
    goal: Goal,
    annotations: EventAnnotations,
    reason: FailureReason,
    number: int = -1,
) -> Posted | None:
    """A goal without a frame failed: post its handler, or look further down.

    *number* is that of the frame that it had, by which observers know it.
    """
    trigger = goal[0]
    if agent.observers.step is not None:
        agent.observers.step.notes_failure(agent, intention, reason)
    for each in supervisions_below(intention, len(intention.frames)):
        supervision.end(agent, each)
    if number < 0:
        agent.trail.serial += 1
        number = agent.trail.serial
    if trigger.on_fail is not None and handles_own(agent, intention, trigger.on_fail):
        intention.handlers.append(len(intention.frames))
        if agent.features.meta:
            _tell_unplanned(agent, intention, (goal, annotations, number), reason)
            meta_events.observe_goal(agent, intention, goal, number, "executing")
            meta_events.goal_state(agent, goal, annotations, "executing", _HAS_FAILURE_PLAN)
        return Posted((trigger.on_fail, *goal[1:]), reason.for_goal(annotations, number))
    return fail_intention(agent, intention, reason, (goal, annotations, number))


def fail_intention(
    agent: Circumstance,
    intention: Intention,
    reason: FailureReason,
    unplanned: _Unplanned | None = None,
) -> Posted | None:
    """Pass the failure to the nearest handler down the stack; without one the intention ends with a warning.

    *unplanned* is the goal that failed, if it is not on the stack.
    """
    if unplanned is None and agent.observers.step is not None:
        agent.observers.step.notes_failure(agent, intention, reason)
    while intention.forks and not has_handler(agent, intention, intention.forks[-1][0].depth):
        depth = intention.forks[-1][0].depth
        if not branch_failed(agent, intention):
            _tell_unplanned(agent, intention, unplanned, reason, over=True)
            observe_failed(agent, intention, depth + 1, reason)
            agent.finish(intention)
            return None
    posted = handler_event(agent, intention, reason)
    if isinstance(posted, int):
        return _try_again(agent, intention, posted, reason, unplanned)
    if posted is not None:
        if agent.features.meta:
            _tell_unplanned(agent, intention, unplanned, reason, over=True)
            index = intention.handlers[-1]
            observe_failed(agent, intention, index + 1, reason)
            failed = intention.frames[index]
            _tell(agent, intention, failed, reason)
            meta_events.frame_state(agent, intention, failed, "executing", _HAS_FAILURE_PLAN)
        return posted
    goal = None if unplanned is None else unplanned[0]
    if intention.on_failed is not None:
        failure_reason.note_goals(agent, intention, reason, goal)
        function, arguments = intention.on_failed
        function(agent, reason, *arguments)
    else:
        agent.architecture.goal_lost()
        budget = agent.budgets.get(reason.error())
        count = budget.note_loss() if budget is not None else 1
        if count:
            _tell_people(agent, failure_reason.loss(agent, intention, reason, goal), count)
    if agent.features.meta:
        _tell_unplanned(agent, intention, unplanned, reason, over=True)
        _tell_failed(agent, intention, reason)
    agent.finish(intention)
    return None


def _try_again(
    agent: Circumstance, intention: Intention, index: int, reason: FailureReason, unplanned: _Unplanned | None
) -> Posted | None:
    """Try the goal of the frame at *index* again; return None if that happens later."""
    if agent.features.meta:
        _tell_unplanned(agent, intention, unplanned, reason, over=True)
        observe_failed(agent, intention, index, reason)
    frame = intention.frames[index]
    return supervision.try_again(agent, intention, index, frame[GOAL], frame[ANNOTATIONS], reason.error())


def _tell_unplanned(
    agent: Circumstance,
    intention: Intention,
    unplanned: _Unplanned | None,
    reason: FailureReason,
    over: bool = False,
) -> None:
    """Report that a goal without a frame has failed; *over*: none of its own plans handles the failure."""
    if unplanned is None or not agent.features.meta:
        return
    goal, annotations, number = unplanned
    why = failure_reason.why(reason) if agent.observers.goal is not None else ""
    meta_events.observe_goal(agent, intention, goal, number, "failed", why)
    meta_events.goal_state(agent, goal, annotations, "failed", atom(reason.error()))
    if over:
        meta_events.observe_goal(agent, intention, goal, number, "finished")


def _tell_failed(agent: Circumstance, intention: Intention, reason: FailureReason) -> None:
    """Report that all goals of an intention have failed without a handler."""
    observe_failed(agent, intention, 0, reason)
    for frame in reversed(intention.frames):
        if not frame[GOAL][0].failing:
            meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "failed", atom(reason.error()))
            meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "finished")


def observe_failed(
    agent: Circumstance, intention: Intention, first: int, reason: FailureReason | None
) -> None:
    """Report to the observer that the goals of the frames from *first* on failed and are over."""
    if agent.observers.goal is not None:
        why = failure_reason.why(reason) if reason is not None else ""
        for frame in reversed(intention.frames[first:]):
            meta_events.observe(agent, intention, frame, "failed", why)
            meta_events.observe(agent, intention, frame, "finished")


def _tell(agent: Circumstance, intention: Intention, frame: Frame, reason: FailureReason) -> None:
    why = failure_reason.why(reason) if agent.observers.goal is not None else ""
    meta_events.observe(agent, intention, frame, "failed", why)
    meta_events.goal_state(agent, frame[GOAL], frame[ANNOTATIONS], "failed", atom(reason.error()))


def _tell_people(agent: Circumstance, loss: failure_reason.Loss, count: int = 1) -> None:
    """Warn of a lost goal, the *count*-th of its kind."""
    note = f"\n  {count} goals have failed for this reason" if count > 1 else ""
    agent.architecture.log("warning", loss.text() + note)
    if agent.observers.lost is not None:
        agent.observers.lost(loss.told, loss.details, loss.span)


def _lost_in_handler(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations
) -> None:
    reason = annotations if isinstance(annotations, FailureReason) else None
    if intention.on_failed is not None:
        function, arguments = intention.on_failed
        function(agent, reason, *arguments)
    else:
        agent.architecture.goal_lost()
        _tell_people(agent, failure_reason.lost_in_handler(agent, intention, goal, reason))
    number = meta_events.failed_number(annotations)
    if number is not None:
        meta_events.observe_goal(agent, intention, goal, number, "failed")
        meta_events.observe_goal(agent, intention, goal, number, "finished")
    while intention.forks and branch_failed(agent, intention):
        pass  # the others would wait forever for this branch
    observe_failed(agent, intention, meta_events.shared(agent, intention), reason)
    agent.finish(intention)
