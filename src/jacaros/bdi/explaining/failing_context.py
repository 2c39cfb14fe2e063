"""Where the context of a plan fails: its first failing conjunct, with the values of its variables.

Compiled contexts only return whether they hold. When a goal is lost, the contexts of its plans are searched again,
conjunct by conjunct, and the deepest failing conjunct is reported. This search changes nothing and is bounded: rules are
interpreted, only internal actions and functions without effects are called, nothing is logged, and it ends after
`MOST_STEPS` steps.
"""

from collections.abc import Callable, Generator, Iterator
from contextlib import suppress
from typing import Any, NamedTuple, NoReturn, cast

from jacaros.asl import nodes
from jacaros.asl.formatter import format_term
from jacaros.asl.lowering import Names, lower
from jacaros.asl.walk import names_in, operands, walk
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.explaining.missing_beliefs import missing_belief
from jacaros.bdi.explaining.step_text import unbracketed
from jacaros.bdi.rules.context import Context
from jacaros.bdi.rules.functions import OF_AGENT
from jacaros.bdi.rules.query import interpret_rule, solve_formula
from jacaros.bdi.rules.searching import run
from jacaros.bdi.state.belief_base import Table
from jacaros.bdi.state.budget import SearchBudget, SearchLimit
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.literals import EventAnnotations, literal_of
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.rule import Answers, Rule
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.arithmetic import RUNNING
from jacaros.terms.functions import FUNCTIONS
from jacaros.terms.iterative import CyclicTerm, excerpt
from jacaros.terms.operators import ArithmeticFault
from jacaros.terms.substitution import resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import Functor, Term, Var, deref, functor_of

MOST_STEPS = 1_000
"""Maximum number of steps of the search for one plan (about ten microseconds each): answers of conjuncts, rules and
internal actions.
"""
FACTS_PER_STEP = 16
"""Number of beliefs compared with a question in one step."""
LONGEST_CONJUNCT, LONGEST_VALUE = 100, 40
"""Maximum numbers of characters shown of a conjunct and of the value of a variable."""


class NotRepeatable(Exception):
    """Raised when a formula calls something that may have an effect."""


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
        agent, trail = self._agent, Trail()
        trail.serial = agent.trail.serial
        view = _LookOnly(agent, SearchBudget(MOST_STEPS))
        budget, running = agent.beliefs.budget, RUNNING.set(view)
        agent.beliefs.budget = view.beliefs.budget
        try:
            names = Names()
            if not self._matches(plan, names.__getitem__, trail):
                return ""
            return _Search(view, context, names, trail).outcome()
        except Exception:
            # A message in a log must never make the run fail.
            return ""
        finally:
            undo(trail, 0)
            agent.beliefs.budget = budget
            RUNNING.reset(running)

    def _matches(self, plan: Plan, lookup: Callable[[str], Term], trail: Trail) -> bool:
        pattern = lower(plan.node.trigger.literal, lookup)
        return unify(pattern, literal_of(self._goal, self._annotations), trail)


def holds(agent: Circumstance, condition: nodes.Node) -> bool:
    """Return whether a condition holds now, by the same search; False if that cannot be determined."""
    trail = Trail()
    trail.serial = agent.trail.serial
    view = _LookOnly(agent, SearchBudget(MOST_STEPS))
    budget, running = agent.beliefs.budget, RUNNING.set(view)
    agent.beliefs.budget = view.beliefs.budget
    try:
        view.refuse_effects(condition)
        return any(True for _ in view.answers(lower(condition, Names().__getitem__), trail))
    except Exception:
        return False
    finally:
        undo(trail, 0)
        agent.beliefs.budget = budget
        RUNNING.reset(running)


class _Search:
    """One search of a context, conjunct by conjunct, from the left."""

    def __init__(self, agent: "_LookOnly", context: nodes.Node, names: Names, trail: Trail) -> None:
        self._agent, self._names, self._trail = agent, names, trail
        self._conjuncts = operands(context) if isinstance(context, nodes.And) else [context]
        self._deepest: _Stop | None = None

    def outcome(self) -> str:
        """Search until the context holds or nothing is left to search."""
        searches = [self._answers(0)]
        answered = [False]
        try:
            while searches:
                depth = len(searches) - 1
                if next(searches[-1], None) is None:
                    searches.pop()
                    if not answered.pop():
                        self._note(depth)
                elif depth + 1 == len(self._conjuncts):
                    return ""  # it holds by now
                else:
                    answered[-1] = True
                    searches.append(self._answers(depth + 1))
                    answered.append(False)
        except NotRepeatable:
            return f"not examined from `{self._text(len(searches) - 1)}` on, which may have effects"
        except SearchLimit:
            found = self._deepest
            return "" if found is None else f"stops at {found}; not searched to the end"
        finally:
            while searches:
                searches.pop().close()
        return f"stops at {self._deepest}"

    def _answers(self, depth: int) -> Generator[bool, None, None]:
        """Yield the answers of one conjunct; an error inside ends them."""
        conjunct, mark = self._conjuncts[depth], len(self._trail)
        self._agent.refuse_effects(conjunct)
        try:
            formula = lower(conjunct, self._names.__getitem__)
            for _ in self._agent.answers(formula, self._trail):
                self._agent.beliefs.budget.spend()
                yield True
        except (NotRepeatable, SearchLimit):
            raise
        except Exception:
            return
        finally:
            undo(self._trail, mark)

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
        if not isinstance(conjunct, nodes.Literal):
            return ""
        symbol = functor_of(lower(conjunct, self._names.__getitem__))
        return "" if symbol is None else self._agent.missing_belief(symbol)

    def _text(self, depth: int) -> str:
        conjunct = self._conjuncts[depth]
        span = conjunct.span
        if span is not None and span.line == span.end_line:
            written = span.file.lines[span.line - 1][span.column - 1 : span.end_column - 1]
        else:
            written = unbracketed(format_term(conjunct))
        return _short(written, LONGEST_CONJUNCT)

    def _values(self, conjunct: nodes.Node) -> str:
        shown = []
        for name in names_in(conjunct):
            value = deref(self._names[name])
            if value.__class__ is not Var:
                shown.append(f"{name}={_short(_value_text(value), LONGEST_VALUE)}")
        return ", ".join(shown)


def _value_text(value: Term) -> str:
    value = excerpt(value)
    with suppress(ArithmeticFault, CyclicTerm, RecursionError):
        value = resolve(value)
    return text(value)


def _short(written: str, longest: int) -> str:
    return written if len(written) <= longest else f"{written[: longest - 3]}..."


class _LookOnly:
    """The view of an agent for a search that changes nothing, logs nothing and counts its steps."""

    def __init__(self, agent: Circumstance, budget: SearchBudget) -> None:
        self.beliefs = _Beliefs(self, agent, budget)
        self.engine = _Actions(agent)
        self.context = _Silent(agent, self)
        self.architecture = agent.architecture
        self.options = agent.options
        self._agent = agent
        self._repeatable: dict[int, nodes.Node] = {}

    def answers(self, formula: Term, trail: Trail) -> Iterator[Any]:
        """Return the answers of a formula."""
        view = cast("Circumstance", self)
        return run(solve_formula(view, formula, trail), self.options.rule_depth)

    def refuse_effects(self, formula: nodes.Node) -> None:
        """Check a formula for calls that may have an effect.

        Raises:
            NotRepeatable: it calls a function of the agent or the project, or a predicate whose namespace is a variable.
        """
        if id(formula) in self._repeatable:
            return
        for node in walk(formula):
            if isinstance(node, nodes.FunctionCall):
                own = OF_AGENT.get(node.name)
                if node.name not in FUNCTIONS and not (own is not None and own.repeatable):
                    raise NotRepeatable
            elif isinstance(node, nodes.Literal) and isinstance(node.namespace, nodes.Variable):
                raise NotRepeatable
        self._repeatable[id(formula)] = formula

    def call_own(self, term: Term) -> Term:
        """Return the value of a function that needs the agent, as `jacaros.bdi.rules.functions.call_own`."""
        own = OF_AGENT.get(term[0].name)
        view = cast("Circumstance", self)
        return self._agent.call_own(term) if own is None else own.evaluate(view, term)

    def missing_belief(self, symbol: Functor) -> str:
        """Describe that the agent has no belief of that name at all."""
        return missing_belief(self._agent.beliefs, symbol)

    def warn_of_operand(self, what: str, value: Term) -> None:
        """Do nothing: the warning has been logged."""


class _Silent(Context):
    """A context for internal actions whose errors have already been reported."""

    __slots__ = ("_view",)

    def __init__(self, agent: Circumstance, view: _LookOnly) -> None:
        super().__init__(agent)
        self._view, self.trail = view, Trail()

    def answers(self, formula: Term) -> Iterator[None]:
        """Return the answers of a formula, in the same view of the agent."""
        for _ in self._view.answers(formula, self.trail):
            yield

    def report(self, action: str, fault: object) -> None:
        """Do nothing."""


class _Actions:
    """The internal actions that may be called again."""

    def __init__(self, agent: Circumstance) -> None:
        self._actions = agent.engine.actions
        self.actions = self

    def get(self, name: str) -> InternalAction | None:
        """Return the action of a name.

        Raises:
            NotRepeatable: it may have an effect.
        """
        action = self._actions.get(name)
        if action is not None and action.prints:
            return InternalAction(name, lambda *_: True)  # it always succeeds; nothing is printed again
        if action is not None and not action.repeatable:
            raise NotRepeatable
        return action


class _Beliefs:
    """The tables of a belief base; each entry that is read counts."""

    def __init__(self, agent: _LookOnly, mind: Circumstance, budget: SearchBudget) -> None:
        self._agent, self._beliefs, self.budget = agent, mind.beliefs, budget

    def __getitem__(self, symbol: Functor) -> "_Table":
        table = self._beliefs.get(symbol)
        if table is None:
            table = Table(symbol)
        if type(table).candidates is not Table.candidates:
            raise NotRepeatable  # a project's class looks up beliefs elsewhere
        return _Table(self._agent, table, self.budget)

    def items(self) -> NoReturn:
        """Raise an exception: a variable as a question may stand for anything.

        Raises:
            NotRepeatable: always.
        """
        raise NotRepeatable


class _Table:
    def __init__(self, agent: _LookOnly, table: Table, budget: SearchBudget) -> None:
        self._agent, self._table, self._budget = agent, table, budget

    def still_holds(self, _entry: object) -> bool:
        """True: nothing changes while a failure is explained."""
        return True

    def candidates(self, arguments: tuple[Term, ...]) -> Iterator[tuple[Any, tuple[Term, ...]]]:
        for number, (entry, annotations) in enumerate(self._table.candidates(arguments)):
            if isinstance(entry, Rule):
                self._budget.spend()
                yield _Interpreted(self._agent, entry), annotations
            else:
                if number % FACTS_PER_STEP == 0:
                    self._budget.spend()
                yield entry, annotations


class _Interpreted:
    """A rule whose body is searched as a term: compiled rules do not count their steps."""

    def __init__(self, agent: _LookOnly, rule: Rule) -> None:
        self._agent, self._rule = agent, rule.node

    def search(self, _agent: object, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """Return a generator of the answers, see `jacaros.bdi.rules.searching.run`."""
        self._agent.refuse_effects(self._rule.body)
        view = cast("Circumstance", self._agent)
        return interpret_rule(view, self._rule, arguments, trail)
