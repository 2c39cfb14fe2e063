"""Arithmetic functions that need an agent: its beliefs, clock, random numbers, and the functions of its program."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final, NamedTuple

from jacaros.agents.mind.rules.query import solve_formula
from jacaros.agents.mind.rules.searching import run
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.terms.arithmetic import RUNNING, settle
from jacaros.agents.terms.functions import FunctionNames
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import free_variables, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import ACTION, NUMBERS, Functor, Term, Var, functor


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
    before = RUNNING.set(agent)  # pyright: ignore[reportArgumentType]
    try:
        yield
    finally:
        RUNNING.reset(before)
