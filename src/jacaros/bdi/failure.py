"""Failure: what becomes of a formula that fails or a goal without plan.  The only place where exceptions of internal
actions become failures of goals."""

from typing import Any

from jacaros.asl import nodes
from jacaros.asl.formatter import format_term
from jacaros.asl.source import Span
from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.event import Posted
from jacaros.bdi.intention import ANNOTATIONS, GOAL, PLAN, SERIAL, STEP, Frame, Intention
from jacaros.bdi.internal_action import ActionError, WrongArguments
from jacaros.bdi.search_budget import SearchLimit
from jacaros.bdi.subplans import handles
from jacaros.compiler.body_compiler import StepInfo
from jacaros.compiler.lowering import lower
from jacaros.compiler.runtime import Fail, Failure, annotations_of_event, literal_of
from jacaros.errors import InternalError
from jacaros.terms.arithmetic import ArithmeticFault
from jacaros.terms.deep import CyclicTerm
from jacaros.terms.order import annotation_set
from jacaros.terms.text import display, text
from jacaros.terms.unifier import resolve
from jacaros.terms.values import Functor, String, Term, Var, atom, functor, functor_of

ERROR, ERROR_MSG = functor("error", 1), functor("error_msg", 1)
CODE, CODE_LINE, CODE_SRC = functor("code", 1), functor("code_line", 1), functor("code_src", 1)
_ENV_FAILURE_REASON, _BIND_PARAM_ERROR = functor("env_failure_reason", 1), functor("bind_param_error", 2)
_REASONS = frozenset({ERROR, ERROR_MSG, CODE, CODE_LINE, CODE_SRC})

_IDS: dict[type, str] = {
    nodes.Test: "test_goal_failed",
    nodes.If: "constraint_failed",
    nodes.While: "constraint_failed",
    nodes.For: "constraint_failed",
    nodes.ExternalAction: "action_failed",
    nodes.BeliefChange: "belief_revision_failed",
}


class FailureReason:
    """The annotations of a failure event; they are put together when a plan first asks for them.

    Attributes:
        terms: ``error(..)``, ``error_msg(..)`` and what else was given.
        goal_annotations: those of the goal that failed.
        code: the formula that failed, as a term, or a function that makes it.
    """

    __slots__ = ("_made", "_place", "goal_annotations", "terms")

    def __init__(self, terms: tuple[Term, ...], place: Any, goal_annotations: Any = ()) -> None:
        self.terms = terms
        self._place = place
        self.goal_annotations = goal_annotations
        self._made: tuple[Term, ...] | None = None

    def with_goal(self, annotations: Any) -> "FailureReason":
        """The same reason, for the failure event of another goal."""
        return FailureReason(self.terms, self._place, annotations)

    def annotations(self) -> tuple[Term, ...]:
        """All annotations, sorted."""
        if self._made is None:
            goal = self.goal_annotations
            own = goal if isinstance(goal, tuple) else goal.annotations() if goal is not None else ()
            self._made = annotation_set((*self.terms, *self._place.annotations(), *own))
        return self._made

    def error(self) -> str:
        """The id of the error, for messages."""
        for term in self.terms:
            if term.__class__ is tuple and term[0] is ERROR:
                return text(term[1])
        return "unknown"

    def message(self) -> str:
        """The text for people, or an empty one."""
        for term in self.terms:
            if term.__class__ is tuple and term[0] is ERROR_MSG:
                return str(term[1])
        return ""

    def where(self) -> str:
        """``file:line``, or an empty text."""
        return str(self._place.where())

    def span(self) -> Span | None:
        """The place of the formula that failed, or of the call of the goal without plan; None when there is none."""
        found: Span | None = self._place.span()
        return found


class _Nowhere:
    def annotations(self) -> tuple[Term, ...]:
        return ()

    def span(self) -> Span | None:
        return None

    def where(self) -> str:
        return ""


class _StepPlace:
    """The formula of a step that failed.  The frame stays as it is: its plan goes no further."""

    __slots__ = ("_frame", "_info", "_slots")

    def __init__(self, frame: Frame, info: StepInfo) -> None:
        self._frame, self._info = frame, info
        self._slots = frame[PLAN].slots

    @property
    def node(self) -> nodes.Node:
        return _failed_formula(self._info.node)

    @property
    def plan(self) -> Any:
        return self._frame[PLAN]

    def annotations(self) -> tuple[Term, ...]:
        node = self.node
        term = lower(node, self._value)
        try:
            term = resolve(term)
        except (ArithmeticFault, CyclicTerm, RecursionError):
            # The formula holds the very expression that has no value: it is shown as it is written.
            term = String(format_term(node)) if isinstance(node, nodes.Term) else String("")
        return _code(term, node.span, self.plan.file)

    def _value(self, name: str) -> Term:
        """The value of a variable, as far as it has one."""
        slot = self._slots.get(name, len(self._frame))
        value = self._frame[slot] if slot < len(self._frame) else None
        return Var(name) if value is None else value

    def span(self) -> Span | None:
        return self.node.span

    def where(self) -> str:
        span = self.node.span
        return f"{span.file.name}:{span.line}" if span is not None else self.plan.file


def _failed_formula(node: nodes.Node) -> nodes.Node:
    """What ``code(..)`` shows of a step: the formula, without the operator of a test."""
    if isinstance(node, nodes.Test):
        return node.formula
    if isinstance(node, nodes.Constraint):
        return node.formula
    if isinstance(node, nodes.ExternalAction):
        return node.action
    if isinstance(node, (nodes.If, nodes.While, nodes.For)):
        return node.condition
    if isinstance(node, nodes.Achieve):
        return node.goal
    if isinstance(node, nodes.BeliefChange):
        return node.operand
    return node


class _GoalPlace:
    """A goal without plan: ``code`` is the goal, the line is that of the call."""

    def __init__(self, goal: tuple[Any, ...], annotations: Any, caller: Frame | None) -> None:
        self.goal, self.goal_annotations = goal, annotations
        self.caller = caller

    def annotations(self) -> tuple[Term, ...]:
        # A goal that was posted again by its handler has the reasons of its last failure: they would double each time.
        shown = tuple(a for a in annotations_of_event(self.goal_annotations) if functor_of(a) not in _REASONS)
        try:
            term = resolve(literal_of(self.goal, shown))
        except (ArithmeticFault, CyclicTerm):
            term = String(goal_text(self.goal))
        span, file = self._call()
        return _code(term, span, file)

    def span(self) -> Span | None:
        return self._call()[0]

    def _call(self) -> tuple[Span | None, str]:
        if self.caller is None:
            return None, ""
        return place_of_call(self.caller, self.goal[0].functor), self.caller[PLAN].file

    def where(self) -> str:
        span, file = self._call()
        return f"{file}:{span.line}" if span is not None else file


def place_of_call(caller: Frame, symbol: Functor | None) -> Span | None:
    """Where the plan of a frame called the goal that it now waits for; *symbol* is the functor of the goal.

    Steps do not know the ones before them.  Several may come before the present one, as at the ends of two branches:
    those that call a goal of that functor are taken first.
    """
    plan = caller[PLAN]
    following = caller[STEP].__name__ if caller[STEP] is not None else "None"
    steps: dict[str, StepInfo] = getattr(caller[STEP], "steps", plan.steps)
    calls = [
        info.node
        for info in steps.values()
        if isinstance(info.node, (nodes.Achieve, nodes.Test)) and info.next == following
    ]
    for node in calls:
        goal = node.goal if isinstance(node, nodes.Achieve) else node.formula
        if (
            symbol is not None
            and isinstance(goal, nodes.Literal)
            and (goal.functor, len(goal.arguments)) == (symbol.name, symbol.arity)
        ):
            return node.span
    return calls[0].span if calls else plan.node.span


def _code(term: Term, span: Any, file: str) -> tuple[Term, ...]:
    found: list[Term] = [(CODE, term)]
    if file:
        found.append((CODE_SRC, String(f"file:{file}")))
    if span is not None:
        found.append((CODE_LINE, float(span.line)))
    return tuple(found)


def error_terms(error: str, message: str) -> tuple[Term, ...]:
    """``error(Id)`` and ``error_msg("…")``."""
    return ((ERROR, atom(error)), (ERROR_MSG, String(message)))


def output_misfit(output: Term, value: Term) -> tuple[Term, ...]:
    """The reason of an external action whose *output* has another value than the one that it gave, as where the same
    variable is written for two outputs."""
    message = f"an output of the action would be {text(value)}, but is {text(output)} already"
    reason = (_BIND_PARAM_ERROR, resolve(output), String(display(value)))
    return (*error_terms("action_failed", message), (_ENV_FAILURE_REASON, reason))


def step_failure(frame: Frame, fault: Exception) -> FailureReason:
    """The reason of a step that raised *fault*.

    Raises:
        InternalError: when the fault is a defect of ours.
    """
    info: StepInfo | None = getattr(frame[STEP], "info", None)
    if info is None:
        raise InternalError(f"a step of plan {frame[PLAN]!r} is unknown") from fault
    if fault.__class__ is not Fail:
        return FailureReason(_terms_of(fault, info), _StepPlace(frame, info))
    terms = info.failure
    if terms is None:
        terms = info.failure = error_terms(*_plain_failure(info.node))
    return FailureReason(terms, _StepPlace(frame, info))


def _terms_of(fault: Exception, info: StepInfo) -> tuple[Term, ...]:
    node = info.node
    if isinstance(fault, Failure):
        return (*fault.annotations, *_message_unless_given(fault.annotations, _default_message(fault)))
    if isinstance(fault, Fail):
        return error_terms(*_plain_failure(node))
    if isinstance(fault, WrongArguments):
        return error_terms("wrong_arguments", str(fault))
    if isinstance(fault, ActionError):
        given = fault.annotations
        known = any(t.__class__ is tuple and t[0] is ERROR for t in given)
        error = () if known else ((ERROR, atom("internal_action")),)
        return (*error, *given, *_message_unless_given(given, str(fault)))
    if isinstance(fault, ArithmeticFault):
        return error_terms("arithmetic_error", str(fault))
    if isinstance(fault, SearchLimit):
        return error_terms("search_limit", str(fault))
    if isinstance(fault, RecursionError):
        return error_terms("too_deep", str(fault))
    if isinstance(fault, CyclicTerm):
        return error_terms("cyclic_term", str(fault))
    if isinstance(fault, MemoryError):
        return error_terms("no_memory", "there is not enough memory")
    if isinstance(fault, InternalError):
        raise fault
    kind = "internal_action" if isinstance(node, nodes.Constraint) else "unknown"
    return error_terms(kind, f"{type(fault).__name__}: {fault}")


_MESSAGES = {
    "body_var_without_value": "a variable that stands for a step has no value",
    "body_var_not_literal": "a variable that stands for a goal or a belief holds something else",
    "body_var_with_op": "a variable behind an operator holds a plan body",
}


def _default_message(fault: Failure) -> str:
    """What people are told of a failure whose cause gives no words."""
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


def goal_text(goal: tuple[Any, ...]) -> str:
    """A goal for people; one whose arguments have no value (``g(1 div 0)``) by its name."""
    try:
        return text(literal_of(goal, ()))
    except (ArithmeticFault, CyclicTerm):
        return f"{goal[0].functor.name}(...)"


def no_plan(
    agent: Circumstance, goal: tuple[Any, ...], annotations: Any, caller: Frame | None
) -> FailureReason:
    """The reason of a goal that has no relevant or no applicable plan."""
    relevant = agent.selects[goal[0]] is not None
    shown = goal[0].kind + goal_text(goal)
    if relevant and agent.refused_options:
        agent.refused_options = False
        terms = error_terms("no_option", f"no option is selected for {shown}")
    elif relevant:
        terms = error_terms("no_applicable", f"no applicable plan for {shown}")
    else:
        terms = error_terms("no_relevant", f"no relevant plan for {shown}")
    return FailureReason(terms, _GoalPlace(goal, annotations, caller))


def too_deep(goal: tuple[Any, ...], annotations: Any, caller: Frame, depth: int) -> FailureReason:
    """The reason of a goal whose plan finds no room on the stack of its intention."""
    message = f"more than {depth} plans are on the stack of the intention (option goal_depth)"
    return FailureReason(error_terms("too_deep", message), _GoalPlace(goal, annotations, caller))


def release_bindings(goal: tuple[Any, ...], serial: int) -> None:
    """Give the variables of a failed goal back as they were when it was posted."""
    stack = [a for a in goal[1:] if a.__class__ is Var or a.__class__ is tuple]
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
            stack.extend(a for a in term[1:] if a.__class__ is Var or a.__class__ is tuple)


def handler_event(agent: Circumstance, intention: Intention, reason: FailureReason) -> Posted | None:
    """Find the nearest goal down the stack that has a handler; None when there is none.

    The failed frames stay on the stack under the handler until it ends.  A failure inside a handler goes on to the goals
    below the one it handles.
    """
    frames = intention.frames
    handlers = len(intention.handlers)
    index = len(frames) - 1
    while index >= 0:
        frame = frames[index]
        trigger = frame[GOAL][0]
        if trigger.failing:
            handlers -= 1
            index = intention.handlers[handlers] - 1
            continue
        kind = trigger.on_fail
        if kind is not None and (agent.selects[kind] is not None or handles(agent, intention, index, kind)):
            event = reason.with_goal(frame[ANNOTATIONS])
            release_bindings(frame[GOAL], frame[SERIAL])
            intention.handlers.append(index)
            return Posted((kind, *frame[GOAL][1:]), event)
        index -= 1
    return None


def has_handler(agent: Circumstance, intention: Intention, above: int) -> bool:
    """Whether a goal higher on the stack than the frame *above* has a handler that is not already at work."""
    handlers = len(intention.handlers)
    index = len(intention.frames) - 1
    while index > above:
        trigger = intention.frames[index][GOAL][0]
        if trigger.failing:
            handlers -= 1
            index = intention.handlers[handlers] - 1
            continue
        if trigger.on_fail is not None and handles(agent, intention, index, trigger.on_fail):
            return True
        index -= 1
    return False


def nowhere(*terms: Term) -> FailureReason:
    """A reason without a formula, as ``.fail_goal`` gives it."""
    return FailureReason(terms, _Nowhere())
