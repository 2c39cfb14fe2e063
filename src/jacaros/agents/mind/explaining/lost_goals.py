"""Describe goals that failed, and plans that were not selected: where, at which step, for which goals, and why."""

from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import suppress
from itertools import islice
from typing import NamedTuple

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Span
from jacaros.agents.language.lowering import Names, format_term, lower
from jacaros.agents.language.nodes import names_in, operands
from jacaros.agents.mind.explaining.failure_reason import FailureReason, shown_goal, unbracketed
from jacaros.agents.mind.rules.context import Impure, ReadOnly, reading
from jacaros.agents.mind.state.belief_base import Table
from jacaros.agents.mind.state.budget import SearchLimit
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import GOAL, Intention
from jacaros.agents.mind.state.plan import Plan
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, literal_of
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Functor, Term, Var, deref, functor, functor_of
from jacaros.files.texts import close_matches, did_you_mean

# Beliefs that a condition asks for and an agent lacks entirely: no fact and no rule has that name.


def missing_belief(tables: Mapping[Functor, Table], wanted: Functor) -> str:
    """Return ``no belief `ready```, with a similar name if there is one.

    Return an empty string if facts or rules of that name exist, or if nothing can be added to a name without arguments.

    Args:
        tables: facts and rules of the agent by functor.
        wanted: functor of the literal in the condition.
    """
    if _is_held(tables.get(wanted)):
        return ""
    same = sorted(symbol.arity for symbol in _held(tables, wanted) if symbol.name == wanted.name)
    if same:
        known = ", ".join(f"`{wanted.name}/{arity}`" for arity in same)
        return f"no belief `{wanted.name}/{wanted.arity}`; there is {known}"
    near = close_matches(wanted.name, sorted({symbol.name for symbol in _held(tables, wanted)}))
    if not near and not wanted.arity:
        return ""
    sign = "~" if wanted.negated else ""
    help = did_you_mean(f"{sign}{name}" for name in near)
    return f"no belief `{sign}{wanted.name}`{'; ' * bool(help)}{help}"


def _held(tables: Mapping[Functor, Table], wanted: Functor) -> Iterator[Functor]:
    """Yield the functors in use that differ from *wanted* only by name or number of arguments."""
    for symbol, table in tables.items():
        if _is_held(table) and (symbol.namespace, symbol.negated) == (wanted.namespace, wanted.negated):
            yield symbol


def _is_held(table: Table | None) -> bool:
    return table is not None and bool(table.rows or table.late)


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
        missing: the belief that the agent lacks entirely; empty unless that is the reason.
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
            return self._matches(plan, Names().__getitem__, trail)
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
                names = Names()
                if not self._matches(plan, names.__getitem__, view.trail):
                    return ""
                return _Search(self._agent, view, context, names).outcome()
        except Exception:
            # A message in a log must never make the run fail.
            return ""

    def _matches(self, plan: Plan, lookup: Callable[[str], Term], trail: Trail) -> bool:
        pattern = lower(plan.node.trigger.literal, lookup)
        return unify(pattern, literal_of(self._goal, self._annotations), trail)


class _Search:
    """One search of a context, conjunct by conjunct, from the left."""

    def __init__(self, agent: Circumstance, view: ReadOnly, context: nodes.Node, names: Names) -> None:
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
            formula = lower(self._conjuncts[depth], self._names.__getitem__)
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
        """Describe which belief of a literal the agent lacks entirely, with a similar name."""
        if not isinstance(conjunct, nodes.Literal) or isinstance(conjunct.namespace, nodes.Variable):
            return ""
        symbol = functor_of(lower(conjunct, self._names.__getitem__))
        return "" if symbol is None else missing_belief(self._agent.beliefs, symbol)

    def _text(self, depth: int) -> str:
        conjunct = self._conjuncts[depth]
        span = conjunct.span
        if span is not None and span.line == span.end_line:
            written = span.file.lines[span.line - 1][span.column - 1 : span.end_column - 1]
        else:
            written = unbracketed(format_term(conjunct))
        return short(written, LONGEST_CONJUNCT)

    def _values(self, conjunct: nodes.Node) -> str:
        shown = []
        for name in names_in(conjunct):
            value = deref(self._names[name])
            if value.__class__ is not Var:
                shown.append(f"{name}={short(_value_text(value), LONGEST_VALUE)}")
        return ", ".join(shown)


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
    reason.candidates = () if unplanned is None else _candidates(agent, *unplanned)
    return stack


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
