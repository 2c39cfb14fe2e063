"""Where the context of a plan fails: its first failing conjunct, with the values of its variables.

Compiled contexts only return whether they hold. When a goal is lost, the contexts of its plans are searched again,
conjunct by conjunct, and the deepest failing conjunct is reported. This search changes nothing (see
`jacaros.bdi.rules.read_only`) and ends after `MOST_STEPS` steps.
"""

from collections.abc import Callable, Generator
from contextlib import suppress
from typing import NamedTuple

from jacaros.asl import nodes
from jacaros.asl.formatter import format_term
from jacaros.asl.lowering import Names, lower
from jacaros.asl.walk import names_in, operands
from jacaros.bdi.explaining.missing_beliefs import missing_belief
from jacaros.bdi.explaining.step_text import unbracketed
from jacaros.bdi.rules.read_only import Impure, ReadOnly, reading
from jacaros.bdi.state.budget import SearchLimit
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.literals import EventAnnotations, literal_of
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.excerpt import excerpt
from jacaros.terms.operators import ArithmeticFault
from jacaros.terms.substitution import resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import Term, Var, deref, functor_of

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
