"""Why a goal failed: the annotations of its failure event, and the description in logs."""

from collections.abc import Callable, Generator, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from itertools import islice
from typing import NamedTuple, cast

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Span
from jacaros.agents.language.lowering import Variables, format_term, lower
from jacaros.agents.language.nodes import names_in, operands
from jacaros.agents.mind.rules.context import Impure, ReadOnly, reading
from jacaros.agents.mind.rules.unmet import unmet
from jacaros.agents.mind.state.budget import SearchLimit
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import GOAL, PLAN, STEP, Frame, Intention
from jacaros.agents.mind.state.plan import Plan, StepInfo
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, annotations_of_event, literal_of
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Functor, String, Term, Var, deref, functor, functor_of

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
    """Where a goal failed: at the formula of a step, at the call of a goal without plan, at the end of a plan, or nowhere.

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
            term = self._resolved(lower(_failed_formula(self.info.node), self.value))
        else:
            return ()
        return (CODE, term), *code_place(self.span(), "" if self.frame is None else self.frame[PLAN].file)

    def step(self) -> str:
        """Return the step that failed, with the values of its variables; empty if a goal without plan is the reason."""
        if self.info is None:
            return ""
        formula = _failed_formula(self.info.node)
        term = lower(formula, lambda name: UNNAMED if name[0] == "_" else self.value(name))
        return step_text(self.info.node, self._resolved(excerpt(term)))

    def _resolved(self, term: Term) -> Term:
        assert self.info is not None
        formula = _failed_formula(self.info.node)
        try:
            return resolve(term)
        except (ArithmeticFault, RecursionError):
            # The formula contains the very expression that has no value: show it as written.
            return String(format_term(formula)) if isinstance(formula, nodes.Term) else String("")

    def value(self, name: str) -> Term:
        """Return the value of a variable, as far as it is bound."""
        assert self.frame is not None
        slot = self.frame[PLAN].slots.get(name, len(self.frame))
        value = self.frame[slot] if slot < len(self.frame) else None
        return Var(name) if value is None else value

    def span(self) -> Span | None:
        """Return the place of the formula that failed, the call of the goal without plan, or the plan; if there is one."""
        if self.info is not None:
            return _failed_formula(self.info.node).span
        if self.frame is None:
            return None
        if self.unplanned is None:
            return cast("Plan", self.frame[PLAN]).node.span
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


# Describe goals that failed, and plans that were not selected: where, at which step, for which goals, and why.

# Where the context of a plan fails: its first failing conjunct, with the values of its variables.
#
# Compiled contexts only return whether they hold. When a goal is lost, the contexts of its plans are searched again,
# conjunct by conjunct, and the deepest failing conjunct is reported. This search changes nothing (see
# `jacaros.agents.mind.rules.context`) and ends after `MOST_STEPS` steps.


MOST_STEPS = 1_000
"""Maximum number of steps of the search for one plan (about ten microseconds each): answers of conjuncts, rules and
internal actions.
"""
LONGEST, LONGEST_CONJUNCT, LONGEST_VALUE = 120, 100, 40
"""Maximum numbers of characters shown of a conjunct and of the value of a variable."""


class _Stop(NamedTuple):
    """The conjunct at which a context stops.

    Attributes:
        depth: number of conjuncts before it that hold.
        conjunct: as written.
        values: of its variables, as ``Name=value``, for the first answer of the conjuncts before it.
        answers: number of answers of the conjuncts before it.
        missing: why no belief answers it; empty if only its values differ.
    """

    depth: int
    conjunct: str
    values: str
    answers: int
    missing: str

    def __str__(self) -> str:
        told = f"`{self.conjunct}`{' with ' if self.values else ''}{self.values}"
        if self.answers > 1:
            told += f" (the first of {self.answers} answers)"
        return f"{told}: {self.missing}" if self.missing else told


class FailingContexts:
    """Finds the failing conjuncts of the plans for one goal.

    Args:
        agent: the agent; its beliefs must still be as they were when no plan was found.
        goal: the goal or failure event, which begins with its `Trigger`.
        annotations: of the goal.
    """

    def __init__(self, agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> None:
        self._agent, self._goal, self._annotations = agent, goal, annotations

    def fits(self, plan: Plan) -> bool:
        """Return whether the trigger of a plan fits the goal; True if that cannot be determined."""
        trail = Trail()
        try:
            return self._matches(plan, Variables().__getitem__, trail)
        except Exception:
            return True
        finally:
            undo(trail, 0)

    def stop(self, plan: Plan) -> str:
        """Describe where the context of a plan fails; empty if it has none, or nothing can be said about it."""
        context = plan.node.context
        if context is None:
            return ""
        try:
            with reading(self._agent, MOST_STEPS) as view:
                names = Variables()
                if not self._matches(plan, names.__getitem__, view.trail):
                    return ""
                return _Search(self._agent, view, context, names.__getitem__).outcome()
        except Exception:
            # A message in a log must never make the run fail.
            return ""

    def _matches(self, plan: Plan, lookup: Callable[[str], Term], trail: Trail) -> bool:
        pattern = lower(plan.node.trigger.literal, lookup)
        return unify(pattern, literal_of(self._goal, self._annotations), trail)


class _Search:
    """One search of a context, conjunct by conjunct, from the left."""

    def __init__(
        self, agent: Circumstance, view: ReadOnly, context: nodes.Node, names: Callable[[str], Term]
    ) -> None:
        self._agent, self._view, self._names = agent, view, names
        self._conjuncts = operands(context) if isinstance(context, nodes.And) else [context]
        self._deepest: _Stop | None = None
        self._depth = 0

    def outcome(self) -> str:
        """Search until the context holds or nothing is left to search."""
        try:
            return "" if self._holds(0) else f"stops at {self._deepest}"  # it may hold by now
        except Impure:
            return f"not examined from `{self._text(self._depth)}` on, which may have effects"
        except SearchLimit:
            found = self._deepest
            return "" if found is None else f"stops at {found}; not searched to the end"

    def deepest(self) -> _Stop | None:
        """Return the conjunct at which the condition stops; None if it holds by now."""
        return None if self._holds(0) else self._deepest

    def _holds(self, depth: int) -> bool:
        """Return whether the conjuncts from *depth* on hold with the present values."""
        if depth == len(self._conjuncts):
            return True
        answered = False
        for _ in self._answers(depth):
            answered = True
            if self._holds(depth + 1):
                return True
        if not answered:
            self._note(depth)
        return False

    def _answers(self, depth: int) -> Generator[bool, None, None]:
        """Yield the answers of one conjunct; an error inside ends them."""
        view = self._view
        self._depth, mark = depth, len(view.trail)
        try:
            formula = lower(self._conjuncts[depth], self._names)
            for _ in view.answers(formula):
                view.beliefs.budget.spend()
                yield True
        except (Impure, SearchLimit):
            raise
        except Exception:
            return
        finally:
            undo(view.trail, mark)

    def _note(self, depth: int) -> None:
        """Record that a conjunct has no answer with the present values."""
        deepest = self._deepest
        if deepest is None or depth > deepest.depth:
            conjunct = self._conjuncts[depth]
            missing = self._missing(conjunct)
            self._deepest = _Stop(depth, self._text(depth), self._values(conjunct), 1, missing)
        elif depth == deepest.depth:
            self._deepest = deepest._replace(answers=deepest.answers + 1)

    def _missing(self, conjunct: nodes.Node) -> str:
        """Describe why no belief answers a literal, with a similar name."""
        if not isinstance(conjunct, nodes.Literal) or isinstance(conjunct.namespace, nodes.Variable):
            return ""
        return unmet(self._agent, lower(conjunct, self._names))

    def _text(self, depth: int) -> str:
        return short(written(self._conjuncts[depth]), LONGEST_CONJUNCT)

    def _values(self, conjunct: nodes.Node) -> str:
        shown = []
        for name in names_in(conjunct):
            value = deref(self._names(name))
            if value.__class__ is not Var:
                shown.append(f"{name}={short(_value_text(value), LONGEST_VALUE)}")
        return ", ".join(shown)


def written(node: nodes.Node) -> str:
    """Return a formula as its program has it."""
    span = node.span
    if span is not None and span.line == span.end_line:
        return span.file.lines[span.line - 1][span.column - 1 : span.end_column - 1]
    return unbracketed(format_term(node))


def _value_text(value: Term) -> str:
    value = excerpt(value)
    with suppress(ArithmeticFault, RecursionError):
        value = resolve(value)
    return text(value)


def short(written: str, longest: int = LONGEST) -> str:
    """Return a text, cut at *longest* characters."""
    return written if len(written) <= longest else f"{written[: longest - 3]}..."


ENV_FAILURE_REASON, ENV_FAILURE_DETAIL = functor("env_failure_reason", 1), functor("env_failure_detail", 1)

MOST_GOALS = 6
"""Maximum number of goals listed of a deeper stack, those next to the failure."""
MOST_PLANS = 3
"""Maximum number of unfit plans listed."""
LONGEST_MESSAGE = 600
"""Maximum number of characters of an ``error_msg`` shown; plans get all of it."""


class Loss(NamedTuple):
    """The description of a lost goal.

    Attributes:
        told: the first line: what failed, with what error, and where.
        details: further lines: the step and the goals it served, plans that did not fit, reason terms for plans.
        span: the place in the program, None if it is unknown.
    """

    told: str
    details: tuple[str, ...]
    span: Span | None

    def text(self) -> str:
        """Return the whole text; details are indented."""
        return "\n  ".join((self.told, *self.details))


def loss(agent: Circumstance, intention: Intention, reason: FailureReason, goal: Goal | None) -> Loss:
    """Describe an intention without a plan for its failure.

    Args:
        agent: the agent of the intention.
        intention: with the stack as it was.
        reason: of the failure.
        goal: the goal that failed, if it is not on the stack.
    """
    stack = note_goals(agent, intention, reason, goal)
    wanted = next((each for each in reversed(stack) if each[0].operator == "+" and each[0].kind), None)
    if wanted is not None:
        what = f"the goal {short(shown_goal(wanted))}"
    else:
        what = f"the plan for {reason.goals[-1]}" if reason.goals else "an intention"
    return loss_of(what, reason)


def note_goals(
    agent: Circumstance, intention: Intention, reason: FailureReason, goal: Goal | None
) -> list[Goal]:
    """Record with a reason the goals on the stack and the agent's plans, before they change.

    Returns:
        the goals that failed with the step, the inner ones first.
    """
    stack = [*reason.place.inner_goals, *([] if goal is None else [goal]), *goals_below(intention)]
    reason.goals = _shown(stack)
    unplanned = reason.place.unplanned
    reason.candidates = (
        unanswered(agent, reason.place) if unplanned is None else _candidates(agent, *unplanned)
    )
    return stack


def unanswered(agent: Circumstance, place: Place) -> tuple[str, ...]:
    """Return a line that says why no belief answers the test of a step, or why what a `.wait` waits for did not come."""
    step = None if place.info is None else place.info.node
    formula = step.formula if isinstance(step, nodes.Test | nodes.Constraint) else None
    if isinstance(formula, nodes.InternalAction) and formula.name == ".wait" and formula.arguments:
        formula = formula.arguments[0]
    event = _awaited_event(formula)
    condition = formula if event is None else event
    if not isinstance(condition, nodes.Literal | nodes.And):
        return ()
    try:
        with reading(agent, MOST_STEPS) as view:
            stop = _Search(agent, view, condition, cache(place.value)).deepest()
    except Exception:
        return ()  # a message in a log must never make the run fail
    if stop is None:
        told = written(condition)
        return (
            () if event is None else (f"`{told}` was added before; wait for the condition: `.wait({told})`",)
        )
    if isinstance(condition, nodes.Literal):
        return (stop.missing,) if stop.missing else ()
    return (f"stops at {stop}",)


def _awaited_event(formula: nodes.Node | None) -> nodes.Node | None:
    """Return the belief of an awaited event ``{+b}``."""
    steps = formula.body.steps if isinstance(formula, nodes.BodyTerm) else ()
    step = steps[0] if len(steps) == 1 else None
    return step.operand if isinstance(step, nodes.BeliefChange) and step.operator == "+" else None


def loss_of(what: str, reason: FailureReason) -> Loss:
    """Describe *what*, such as ``the goal !go``, whose goals were recorded in the reason."""
    told = f"{what} failed and has no plan for its failure{_why(reason)}{_place(reason)}"
    return Loss(told, details(reason, what), reason.place.span())


def lost_in_handler(
    agent: Circumstance, intention: Intention, goal: Goal, reason: FailureReason | None
) -> Loss:
    """Describe a failure event whose plans do not fit."""
    told = f"no applicable plan for the failure event {shown_goal(goal)}; the intention is dropped"
    if reason is None:
        return Loss(told, (), None)
    reason.goals = _shown(list(goals_below(intention)))
    reason.candidates = _candidates(agent, goal, reason)
    return Loss(f"{told}{_why(reason)}{_place(reason)}", details(reason), reason.place.span())


def inapplicable(agent: Circumstance, event: Goal, annotations: EventAnnotations) -> Loss:
    """Describe an event whose plans are not applicable."""
    return Loss(f"no applicable plan for {shown_goal(event)}", _candidates(agent, event, annotations), None)


def lost_question(asker: str, goal: Goal, reason: FailureReason) -> Loss | None:
    """Describe a question from *asker* whose plan failed; its goals were recorded in the reason.

    Return None if no plan was applicable: that is an answer, for example of a plan whose context checks the asker.
    """
    unplanned = reason.place.unplanned
    if unplanned is not None and unplanned[0] is goal:
        return None
    told = f"the question {shown_goal(goal)} from {asker} is answered false, because its plan failed"
    return Loss(
        f"{told}{_why(reason)}{_place(reason)}", details(reason, f"the question {shown_goal(goal)}"), None
    )


def why(reason: FailureReason) -> str:
    """Describe a reason for records of a run, in lines: error, message and place; the step; plans that did not fit, once
    recorded; the terms for plans.
    """
    step = _step(reason)
    return "\n".join(
        (
            f"{_error(reason)}{_place(reason)}",
            *([f"step: {step}"] if step else ()),
            *reason.candidates,
            *_terms(reason),
        )
    )


def details(reason: FailureReason, what: str = "") -> tuple[str, ...]:
    """Return the lines after message and place; *what*, such as ``the goal !go``, has already been named."""
    goals = [short(goal) for goal in reason.goals]
    if len(goals) == 1 and what.endswith(f" {goals[0]}"):
        goals = []
    lines = []
    step = _step(reason)
    if step:
        lines.append(f"step: {step}{', for ' if goals else ''}{', '.join(goals)}")
    elif len(goals) > 2:  # the message names the first and the last
        lines.append(f"for: {', '.join(goals[1:])}")
    return (*lines, *reason.candidates, *_terms(reason))


def _step(reason: FailureReason) -> str:
    step = reason.place.step()
    # The reason that it passes on is in the other lines.
    return ".fail(...)" if step.startswith(".fail(") else short(step)


def _terms(reason: FailureReason) -> list[str]:
    """Return the line with the annotations that plans can ask for.

    CArtAgO's reason is left out if it contains only the action itself and another term says more.
    """
    terms = reason.others()
    if any(functor_of(term) is ENV_FAILURE_DETAIL for term in terms):
        terms = [term for term in terms if functor_of(term) is not ENV_FAILURE_REASON]
    return [f"reason: {', '.join(short(text(excerpt(term))) for term in terms)}"] if terms else []


def goals_below(intention: Intention) -> Iterator[Goal]:
    """Yield the goals on the stack of an intention, the top one first; for a handler the failure event that it handles."""
    frames = intention.frames
    handlers = len(intention.handlers)
    index = len(frames) - 1
    while index >= 0:
        goal = frames[index][GOAL]
        if goal[0].functor.namespace != "jacaros":
            yield goal
        if goal[0].failing:
            handlers -= 1
            index = intention.handlers[handlers]
        index -= 1


def _shown(stack: list[Goal]) -> tuple[str, ...]:
    """Return goals as text; of a stack of thousands only the first and the last."""
    left = len(stack) - MOST_GOALS
    if left <= 1:
        return tuple(map(shown_goal, stack))
    return (*map(shown_goal, stack[: MOST_GOALS - 1]), f"{left} more", shown_goal(stack[-1]))


def _why(reason: FailureReason) -> str:
    told = _error(reason)
    return f": {told}" if told else ""


def _error(reason: FailureReason) -> str:
    return ", ".join(filter(None, (reason.known_error(), short(reason.message(), LONGEST_MESSAGE))))


def _place(reason: FailureReason) -> str:
    where = reason.place.where()
    return f" ({where})" if where else ""


def _candidates(agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> tuple[str, ...]:
    """Return the plans for a goal, those whose trigger fits first, each with the conjunct at which its context stops."""
    plans = agent.library.relevant(goal[0])
    contexts = FailingContexts(agent, goal, annotations)
    shown = list(islice(filter(contexts.fits, plans), MOST_PLANS))
    shown += islice((plan for plan in plans if plan not in shown), MOST_PLANS - len(shown))
    lines = [_candidate(plan, contexts.stop(plan)) for plan in shown]
    left = len(plans) - len(shown)
    return (*lines, f"and {left} more plans") if left > 0 else tuple(lines)


def _candidate(plan: Plan, stop: str) -> str:
    """Describe a plan that did not fit: trigger, place and the conjunct at which its context stops, or its context."""
    node = plan.node
    trigger = node.trigger
    told = f"{trigger.operator}{trigger.kind}{format_term(trigger.literal)}"
    if node.context is not None and not stop:
        told += f" : {unbracketed(format_term(node.context))}"
    line = f":{node.span.line}" if node.span is not None else ""
    return f"does not fit: {short(told)} ({plan.file}{line}){', ' if stop else ''}{stop}"
