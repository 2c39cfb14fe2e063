"""Why a goal failed: the annotations of its failure event, and the description in logs."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Span
from jacaros.agents.language.lowering import format_term, lower
from jacaros.agents.mind.state.intention import GOAL, PLAN, STEP, Frame
from jacaros.agents.mind.state.plan import StepInfo
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, annotations_of_event, literal_of
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.values import Functor, String, Term, Var, functor, functor_of

# Steps of plans as text, with the values of their variables.


def step_text(node: nodes.Node, term: Term) -> str:
    """Return a step as text, with the values of its variables; *term* is its formula."""
    shown = str(term) if term.__class__ is String else text(term)
    if isinstance(node, nodes.Test):
        return f"?{shown}"
    if isinstance(node, nodes.BeliefChange):
        return f"{node.operator}{shown}"
    if isinstance(node, nodes.Achieve):
        return f"!{shown}"
    if isinstance(node, (nodes.If, nodes.While)):
        return f"{'if' if isinstance(node, nodes.If) else 'while'} ({unbracketed(shown)})"
    return unbracketed(shown)


def unbracketed(shown: str) -> str:
    """Return an operator's term without the brackets around it."""
    if not (shown.startswith("(") and shown.endswith(")")):
        return shown
    depth = 0
    for position, character in enumerate(shown):
        depth += (character == "(") - (character == ")")
        if not depth:
            return shown[1:-1] if position == len(shown) - 1 else shown
    return shown


ERROR, ERROR_MSG = functor("error", 1), functor("error_msg", 1)
CODE, CODE_LINE, CODE_SRC = functor("code", 1), functor("code_line", 1), functor("code_src", 1)
UNNAMED = Var("_")
_Terms = tuple[Term, ...]
_REASONS = frozenset({ERROR, ERROR_MSG, CODE, CODE_LINE, CODE_SRC})


@dataclass(slots=True, eq=False, repr=False)
class FailureReason:
    """The annotations of a failure event, composed when a plan first asks for them.

    The first two arguments are ``error(..)``, ``error_msg(..)`` and other given terms, or a function that returns them; and
    the place, or the frame whose step failed, which is kept as it is: its plan does not continue.

    Attributes:
        goal_annotations: those of the goal whose failure event it is for; None before there is one.
        goal_number: the number by which observers know that goal, if it had no plan and so no frame on the stack.
        goals: the goals of the lost intention as text, the one that failed first; recorded when it ends.
        candidates: for a goal without applicable plan, its plans and where their contexts fail, as lines for the log;
            recorded at the same time.
    """

    _terms: _Terms | Callable[[], _Terms]
    _at: "Place | Frame"
    goal_annotations: EventAnnotations | None = None
    goal_number: int | None = None
    goals: tuple[str, ...] = ()
    candidates: tuple[str, ...] = ()
    _made: _Terms | None = None

    def for_goal(self, annotations: EventAnnotations, number: int | None = None) -> "FailureReason":
        """Return the reason for the failure event of a goal: this object, unless it already belongs to another goal."""
        if self.goal_annotations is None:
            self.goal_annotations = annotations
            self.goal_number = number
            return self
        return FailureReason(self._terms, self._at, annotations, number)

    @property
    def place(self) -> "Place":
        """Return where the goal failed."""
        if isinstance(self._at, list):
            self._at = Place(self._at, self._at[STEP].info)
        return self._at

    @property
    def terms(self) -> _Terms:
        """Return ``error(..)``, ``error_msg(..)`` and other given terms."""
        if not isinstance(self._terms, tuple):
            self._terms = self._terms()
        return self._terms

    def add(self, *terms: Term) -> None:
        """Add terms: for plans of the goals further down, and for logs."""
        self._terms, self._made = (*self.terms, *terms), None

    def annotations(self) -> tuple[Term, ...]:
        """Return all annotations, sorted."""
        if self._made is None:
            goal = self.goal_annotations
            own = goal if isinstance(goal, tuple) else goal.annotations() if goal is not None else ()
            self._made = annotation_set((*self.terms, *self.place.annotations(), *own))
        return self._made

    def error(self) -> str:
        """Return the id of the error, for messages."""
        return self.known_error() or "unknown"

    def known_error(self) -> str:
        """Return the id of the error, or an empty string: failures by ``.fail_goal`` have none."""
        return next((text(value) for value in self._values(ERROR)), "")

    def message(self) -> str:
        """Return the message, or an empty string."""
        return next((str(value) for value in self._values(ERROR_MSG)), self.place.told)

    def _values(self, symbol: Functor) -> Iterator[Term]:
        return (term[1] for term in self.terms if term.__class__ is tuple and term[0] is symbol)

    def others(self) -> list[Term]:
        """Return the terms other than ``error`` and ``error_msg``, such as ``env_failure_reason(..)``."""
        return [t for t in self.terms if not (t.__class__ is tuple and t[0] in (ERROR, ERROR_MSG))]

    def interrupted(self, frames: list[Frame]) -> "FailureReason":
        """Return the reason for goals that were ended from outside: *frames* served them, the last one was running."""
        inner = tuple(frame[GOAL] for frame in reversed(frames[1:]))
        info: StepInfo | None = getattr(frames[-1][STEP], "info", None)
        frame = None if info is None else frames[-1]
        place = Place(frame, info, told=self.place.told, inner_goals=inner, for_plans=False)
        return FailureReason(self.terms, place, self.goal_annotations)


@dataclass(slots=True, eq=False)
class Place:
    """Where a goal failed: at the formula of a step, at the call of a goal without plan, or nowhere.

    Attributes:
        frame: of the step, or of the plan that called the goal; None if something from outside ended the goal.
        info: of the step.
        unplanned: the goal that no plan fits and its annotations; None if that is not the reason.
        told: describes what ended the goal, in place of an ``error_msg``.
        inner_goals: the goals of the step that are no longer on the stack.
        for_plans: whether failure events show the place, too.
    """

    frame: Frame | None = None
    info: StepInfo | None = None
    unplanned: tuple[Goal, EventAnnotations] | None = None
    told: str = ""
    inner_goals: tuple[Goal, ...] = ()
    for_plans: bool = True

    def annotations(self) -> tuple[Term, ...]:
        """Return ``code(..)`` with its source."""
        if self.unplanned is not None:
            term = _shown_call(*self.unplanned)
        elif self.info is not None and self.for_plans:
            term = self._resolved(lower(_failed_formula(self.info.node), self._value))
        else:
            return ()
        return (CODE, term), *code_place(self.span(), "" if self.frame is None else self.frame[PLAN].file)

    def step(self) -> str:
        """Return the step that failed, with the values of its variables; empty if a goal without plan is the reason."""
        if self.info is None:
            return ""
        formula = _failed_formula(self.info.node)
        term = lower(formula, lambda name: UNNAMED if name[0] == "_" else self._value(name))
        return step_text(self.info.node, self._resolved(excerpt(term)))

    def _resolved(self, term: Term) -> Term:
        """Return the formula, with the values of its variables."""
        assert self.info is not None
        formula = _failed_formula(self.info.node)
        try:
            return resolve(term)
        except (ArithmeticFault, RecursionError):
            # The formula contains the very expression that has no value: show it as written.
            return String(format_term(formula)) if isinstance(formula, nodes.Term) else String("")

    def _value(self, name: str) -> Term:
        """Return the value of a variable, as far as it is bound."""
        assert self.frame is not None
        slot = self.frame[PLAN].slots.get(name, len(self.frame))
        value = self.frame[slot] if slot < len(self.frame) else None
        return Var(name) if value is None else value

    def span(self) -> Span | None:
        """Return the place of the formula that failed, or of the call of the goal without plan, if there is one."""
        if self.info is not None:
            return _failed_formula(self.info.node).span
        if self.frame is None or self.unplanned is None:
            return None
        return place_of_call(self.frame, self.unplanned[0][0].functor)

    def where(self) -> str:
        """Return ``file:line``, or an empty string."""
        if self.frame is None:
            return ""
        span = self.span()
        return self.frame[PLAN].file if span is None else f"{span.file.name}:{span.line}"


def _shown_call(goal: Goal, annotations: EventAnnotations) -> Term:
    """Return a goal without plan as a term.

    A goal that its handler posted again has the reasons of its last failure: they would double each time.
    """
    shown = tuple(a for a in annotations_of_event(annotations) if functor_of(a) not in _REASONS)
    try:
        return resolve(literal_of(goal, shown))
    except (ArithmeticFault, RecursionError):
        return String(goal_text(goal))


def _failed_formula(node: nodes.Node) -> nodes.Node:
    """Return what ``code(..)`` shows of a step: the formula, without the operator of a test."""
    if isinstance(node, nodes.Test | nodes.Constraint):
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


def place_of_call(caller: Frame, symbol: Functor | None) -> Span | None:
    """Return where the plan of a frame called the goal that it waits for; *symbol* is the functor of the goal.

    Steps do not know the steps before them. Several may precede the present one, as at the ends of two branches: those
    that call a goal of that functor are preferred.
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


def code_place(span: Span | None, file: str) -> tuple[Term, ...]:
    """Return ``code_src`` and ``code_line`` of a place in a program, as far as they are known."""
    source = ((CODE_SRC, String(f"file:{file}")),) if file else ()
    return source if span is None else (*source, (CODE_LINE, float(span.line)))


def goal_text(goal: Goal) -> str:
    """Return a goal as text; one whose arguments have no value (``g(1 div 0)``) by its name."""
    try:
        return text(literal_of(goal, ()))
    except (ArithmeticFault, RecursionError):
        return f"{goal[0].functor.name}(...)"


def shown_goal(goal: Goal) -> str:
    """Return the beginning of a goal or another event, with its signs: ``!go(home)``, ``-!go(home)``, ``+low(9)``."""
    trigger = goal[0]
    sign = "" if trigger.operator == "+" and trigger.kind else trigger.operator
    try:
        told = text(excerpt(literal_of(goal, ())))
    except (ArithmeticFault, RecursionError):
        told = f"{trigger.functor.name}(...)"
    return f"{sign}{trigger.kind}{told}"


def nowhere(*terms: Term, told: str = "") -> FailureReason:
    """Return a reason without a formula, as for ``.fail_goal``; *told* is its description in logs."""
    return FailureReason(terms, Place(told=told))
