"""What an internal action is given: a narrow view of the agent that calls it; and the functions that need an agent."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, Final, NamedTuple, cast

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import Variables, lower_value
from jacaros.agents.language.nodes import walk
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.rules.query import interpret_rule, solve_formula
from jacaros.agents.mind.rules.searching import run
from jacaros.agents.mind.state.belief_base import BeliefTables, Item, Table
from jacaros.agents.mind.state.budget import SearchBudget, SearchLimit
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import PLAN, Intention, variables_of
from jacaros.agents.mind.state.plan import Answers, Plan, Rule
from jacaros.agents.terms.functions import FunctionNames
from jacaros.agents.terms.operators import RUNNING, ArithmeticFault, settle
from jacaros.agents.terms.substitution import free_variables, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import ACTION, NUMBERS, Functor, List, String, Term, Var, functor

# Arithmetic functions that need an agent: its beliefs, clock, random numbers, and the functions of its program.


class RegisteredFunction(NamedTuple):
    """A function of a program (``{ register_function("my.sum", 2, "sum") }``).

    Attributes:
        arity: number of its arguments.
        implementation: name of the rule or internal action that has one argument more, for the value.
    """

    arity: int
    implementation: str


def known_names(agent: Circumstance) -> FunctionNames:
    """Names of functions that terms parsed at run time may call."""
    registered = {name: function.arity for name, function in agent.functions.own.items()}
    return FunctionNames(registered, agent.functions.project.functions)


def call_function(agent: Circumstance, term: Term) -> Term:
    """Evaluate a function call; return the call itself while arguments are unknown.

    Raises:
        ArithmeticFault: a function of the program does not return a number.
    """
    value = call_own(agent, term)
    return settle(term) if value is None else value


def call_own(agent: Circumstance, term: Term) -> Term:
    """Return the value of a function that needs the agent; None for other functions, or if it has no value yet."""
    name = term[0].name
    standard = OF_AGENT.get(name)
    if standard is not None:
        return standard.evaluate(agent, term)
    evaluator = agent.functions.project.evaluators.get(name)
    if evaluator is not None:
        return evaluator(*term[1:])
    function = agent.functions.own.get(name)
    return None if function is None else call_registered(agent, function, term)


class FunctionOfAgent(NamedTuple):
    """A function of the language that needs the agent.

    Attributes:
        evaluate: gives the value of a call; None while it has none.
        pure: it may be called once more to explain a failure.
    """

    evaluate: Callable[[Circumstance, Term], Term]
    pure: bool = True


def _count(agent: Circumstance, term: Term) -> Term:
    return float(sum(1 for _ in agent.context.answers(resolve(term[1]))))


def _time(agent: Circumstance, _: Term) -> Term:
    return float(round(agent.architecture.now() * 1000))


def _random(agent: Circumstance, term: Term) -> Term:
    limit = settle(term[1]) if len(term) > 1 else 1.0
    return agent.architecture.random.random() * limit if limit.__class__ is float else None


OF_AGENT: Final = {
    ".count": FunctionOfAgent(_count),
    "system.time": FunctionOfAgent(_time),
    "math.random": FunctionOfAgent(_random, pure=False),
}


def call_registered(agent: Circumstance, function: RegisteredFunction, term: Term) -> Term:
    """Return the first answer of the rule or internal action, which must be a number; None while arguments are unknown."""
    if free_variables(term):
        return None
    value = Var("Result")
    trail = agent.trail
    mark = len(trail)
    formula = (_symbol(function), *term[1:], value)
    for _ in run(solve_formula(agent, formula, trail), agent.options.rule_depth):
        found = settle(value)
        undo(trail, mark)
        if found.__class__ in NUMBERS:
            return found
        raise ArithmeticFault(f"value of function {term[0].name} is not a number: {text(found)}")
    undo(trail, mark)
    raise ArithmeticFault(
        f"function {term[0].name} has no value: {function.implementation}/{function.arity + 1} does not hold"
    )


def _symbol(function: RegisteredFunction) -> Functor:
    if "." in function.implementation:
        return functor(function.implementation, function.arity + 1, kind=ACTION)
    return functor(function.implementation, function.arity + 1)


@contextmanager
def evaluating(agent: Circumstance) -> Iterator[None]:
    """Evaluate calls inside terms for this agent within the context."""
    before = RUNNING.set(agent)
    try:
        yield
    finally:
        RUNNING.reset(before)


_KEPT = 200
"""Texts of which the syntax is kept: agents read the same ones again and again."""
_CONSTANTS = (nodes.Literal, nodes.Number, nodes.String, nodes.ListTerm)


class Context:
    """First argument of every internal action.

    Attributes:
        agent: the agent, for actions about its beliefs, goals and plans.
        architecture: its port to its host.
        trail: where bindings are noted.
    """

    __slots__ = ("_parsed", "agent", "architecture", "trail")

    def __init__(self, agent: Circumstance) -> None:
        self.agent: Any = agent
        self.architecture = agent.architecture
        self.trail: Trail = agent.trail
        self._parsed = lru_cache(_KEPT)(self._parse)

    @property
    def intention(self) -> Intention | None:
        """The intention whose step this is, or in a context the one that the plan would belong to; None for a new one."""
        current: Intention | None = self.agent.current
        return current

    def unify(self, left: Term, right: Term) -> bool:
        """Unify two terms; nothing stays bound when they do not."""
        mark = len(self.trail)
        if unify(left, right, self.trail):
            return True
        undo(self.trail, mark)
        return False

    def unify_all(self, *pairs: tuple[Term, Term]) -> bool:
        """Unify the terms of every pair; nothing stays bound when some do not."""
        mark = len(self.trail)
        if all(unify(left, right, self.trail) for left, right in pairs):
            return True
        undo(self.trail, mark)
        return False

    def answers(self, formula: Term) -> Iterator[None]:
        """The answers of a formula; its bindings hold until the next one is asked for."""
        for _ in run(solve_formula(self.agent, formula, self.trail), self.agent.options.rule_depth):
            yield

    def succeeds(self, formula: Term) -> bool:
        """Whether a formula holds; the bindings of its first answer stay."""
        return any(True for _ in self.answers(formula))

    def parse_term(self, text: str) -> Term:
        """The term that a text denotes; its variables are those of the plan where the names agree.

        Raises:
            AslError: the text is not a term.
        """
        node, term = self._parsed(text, len(self.agent.functions.own))
        return lower_value(node, self._names().__getitem__) if term is None else term

    def _parse(self, text: str, _functions: int) -> tuple[nodes.Term, Term]:
        """Return the syntax of a text, and its term if it has neither variables nor anything to be evaluated."""
        node = parse_term(text, functions=known_names(self.agent))
        constant = all(isinstance(part, _CONSTANTS) for part in walk(node))
        return node, lower_value(node) if constant else None

    def _names(self) -> Variables:
        """The variables of the running plan by their names."""
        current = self.intention
        return Variables(variables_of(current.frames[-1]) if current is not None and current.frames else ())

    def report(self, action: str, fault: object) -> None:
        """Warn of an internal action that failed in a condition."""
        current = self.intention
        plan = (
            f" in plan {text(current.frames[-1][PLAN].label)}"
            if current is not None and current.frames
            else ""
        )
        self.architecture.log(
            "warning", f"condition {action}{plan} does not hold because of an error: {fault}"
        )

    def report_plan(self, plan: Plan, fault: object) -> None:
        """Warn of a plan whose context cannot be evaluated; later plans are tried."""
        self.architecture.log("warning", f"cannot evaluate the context of plan {text(plan.label)}: {fault}")

    def suspendable(self) -> Intention:
        """The calling intention, for an action that returns what it waits for (`pending.Waiting`)."""
        current = self.intention
        if current is None:
            raise RuntimeError("only the step of an intention can be suspended")
        return current


# Questions that change nothing: a read-only view of an agent, in which its beliefs, rules and functions answer a formula.
#
# The view does not list what is forbidden. It gives the search (`jacaros.agents.mind.rules.query`) tables that can only be
# read and internal actions whose decorator declares them ``pure``; rules are interpreted, so the same holds for what they
# call. Everything else raises `Impure`. Nothing is logged or printed, and the number of steps is limited.


FACTS_PER_STEP = 16
"""Number of beliefs compared with a question in one step."""
LARGEST = 100_000
"""Maximum number of elements or characters that an internal action may return to a question."""


class Impure(Exception):
    """Raised when a question calls something that may have an effect."""

    def __init__(self, name: str) -> None:
        super().__init__(f"`{name}` may have effects, and a question must not have any")


@contextmanager
def reading(agent: Circumstance, steps: int) -> Iterator["ReadOnly"]:
    """Give a view of an agent in which formulae can be evaluated; it raises `Impure` and `SearchLimit`.

    Args:
        agent: the agent.
        steps: maximum number of steps of about ten microseconds: answers of rules and internal actions, or `FACTS_PER_STEP`
            beliefs.
    """
    view = ReadOnly(agent, SearchBudget(steps))
    budget = agent.beliefs.budget
    running = RUNNING.set(view)
    agent.beliefs.budget = view.beliefs.budget  # for pure actions that search, too
    try:
        yield view
    finally:
        undo(view.trail, 0)
        agent.beliefs.budget = budget
        RUNNING.reset(running)


class ReadOnly:
    """The view of one agent.

    Attributes:
        beliefs, engine, context, architecture, options, observers, functions: what a search needs of an agent.
        trail: the bindings of the search.
    """

    def __init__(self, agent: Circumstance, budget: SearchBudget) -> None:
        self.beliefs = _Beliefs(agent.beliefs, budget)
        self.engine = _Actions(agent)
        self.trail = Trail()
        self.trail.serial = agent.trail.serial
        self.context = _Silent(agent, self)
        self.architecture, self.options = agent.architecture, agent.options
        self.observers, self.functions = agent.observers, agent.functions

    def answers(self, formula: Term) -> Iterator[Any]:
        """Return the answers of a formula."""
        return run(solve_formula(cast("Circumstance", self), formula, self.trail), self.options.rule_depth)

    def call_own(self, term: Term) -> Term:
        """Return the value of a function that needs the agent, as `jacaros.agents.mind.rules.context.call_own`.

        Raises:
            Impure: it draws a random number, or is the project's Python code.
        """
        name = term[0].name
        view, own = cast("Circumstance", self), OF_AGENT.get(name)
        if own is not None and own.pure:
            return own.evaluate(view, term)
        if own is not None or name in self.functions.project.evaluators:
            raise Impure(name)
        registered = self.functions.own.get(name)
        return None if registered is None else call_registered(view, registered, term)

    def warn_of_operand(self, what: str, value: Term) -> None:
        """Do nothing: a question logs nothing."""


class _Silent(Context):
    """A context for internal actions that logs nothing."""

    __slots__ = ("_view",)

    def __init__(self, agent: Circumstance, view: ReadOnly) -> None:
        super().__init__(agent)
        self._view, self.trail = view, view.trail

    def answers(self, formula: Term) -> Iterator[None]:
        """Return the answers of a formula, in the same view of the agent."""
        for _ in self._view.answers(formula):
            yield

    def unify(self, left: Term, right: Term) -> bool:
        """Unify two terms, unless one is too large: repeated concatenation would exhaust the memory in few steps."""
        for each in (left, right):
            if (each.__class__ is String and len(each) > LARGEST) or (
                each.__class__ is List and each.size > LARGEST
            ):
                raise SearchLimit(f"a list or string of the search has more than {LARGEST} elements")
        return super().unify(left, right)

    def report(self, action: str, fault: object) -> None:
        """Pass on what ends the whole question; other errors mean that the action does not hold."""
        if isinstance(fault, Impure | SearchLimit):
            raise fault


class _Actions:
    """An engine that interprets rules, since compiled ones do not count their steps, and has the pure internal actions."""

    def __init__(self, agent: Circumstance) -> None:
        self._actions = agent.engine.actions
        self.actions = self

    def get(self, name: str) -> InternalAction | None:
        """Return the action of a name.

        Raises:
            Impure: it is not declared pure.
        """
        action = self._actions.get(name)
        if action is not None and action.prints:
            return InternalAction(name, lambda *_: True)  # it always succeeds; nothing is printed
        if action is not None and not action.pure:
            raise Impure(name)
        return action

    def answers(self, view: Any, rule: Rule, arguments: tuple[Term, ...], trail: Trail) -> Answers:
        """Return a generator of the answers of a rule, see `jacaros.agents.mind.rules.searching.run`."""
        return interpret_rule(view, rule.node, arguments, trail)


class _Beliefs:
    """The tables of a belief base; each entry that is read counts."""

    def __init__(self, beliefs: BeliefTables, budget: SearchBudget) -> None:
        self._beliefs, self.budget = beliefs, budget

    def __getitem__(self, symbol: Functor) -> "_Table":
        return _Table(
            self._beliefs.get(symbol) or Table(symbol), self.budget
        )  # not [symbol], which would create it

    def __iter__(self) -> Iterator[Functor]:
        return iter(list(self._beliefs))

    def items(self) -> Iterator[tuple[Functor, "_Table"]]:
        return ((symbol, self[symbol]) for symbol in self)


class _Table:
    def __init__(self, table: Table, budget: SearchBudget) -> None:
        self._table, self._budget = table, budget

    def still_holds(self, _entry: object) -> bool:
        """True: nothing changes while a question is answered."""
        return True

    def entries(self) -> Iterator[Item]:
        """Yield all beliefs and rules, each with its annotations."""
        return self._counted(self._table.entries())

    def candidates(self, arguments: tuple[Term, ...]) -> Iterator[Item]:
        """Yield the beliefs and rules that may match, each with its annotations."""
        return self._counted(self._table.candidates(arguments))

    def _counted(self, entries: Iterable[Item]) -> Iterator[Item]:
        for number, item in enumerate(entries):
            if number % FACTS_PER_STEP == 0:
                self._budget.spend()
            yield item
