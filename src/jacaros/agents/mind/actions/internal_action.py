"""Declare Python functions as internal actions, and check their arguments.

    @internal_action(".member", arity=2, backtracks=True)
    def member(ctx, item, collection):
        for candidate in list_items(collection):
            if ctx.unify(item, candidate):
                yield

The decorator holds all that is known of an action; the parser, checker, compiler and mind read it there and know no
names. The docstring of an action describes its arguments; other arguments raise `WrongArguments`. All bindings of
arguments are applied (`jacaros.agents.terms.substitution.resolve`); unbound variables are `Var`. A plain function succeeds
unless it returns False. A generator (``backtracks``) yields once per answer; bindings made before a yield are undone
before the next answer is searched. A function that suspends the intention (``suspends``) calls `Context.suspend` and
returns its result.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Final, TypeVar

from jacaros.agents.language.nodes import Declaration
from jacaros.agents.terms.collections import QueueValue, SetValue
from jacaros.agents.terms.operators import to_int
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import NUMBERS, String, Term, double, is_list, list_items

Function = Callable[..., Any]
F = TypeVar("F", bound=Function)
FixedArguments = tuple[Term | None, ...]
"""The arguments of a call as far as the program fixes them; None for those known only at run time."""


class WrongArguments(Exception):
    """The arguments do not fit: the step fails with ``error(wrong_arguments)``."""


class ActionError(Exception):
    """The action failed: the step fails with ``error(internal_action)`` or the given terms.

    Attributes:
        annotations: terms for the failure event; an ``error(..)`` among them replaces the default one.
    """

    def __init__(self, message: str, *annotations: Term) -> None:
        super().__init__(message)
        self.annotations = annotations


class Crashed(Exception):
    """Mixed into failures that are bugs in a project's own Python code: they are logged, too."""


def _undefined(*_: object) -> None:
    raise NotImplementedError("the declaration of an internal action has no function yet")


@dataclass(frozen=True, slots=True)
class InternalAction(Declaration):
    """An internal action with its declaration, as the registry keeps it.

    As a decorator it registers a function as the standard internal action that it declares.

    Attributes:
        name: with the leading dot of the standard ones.
        function: called with a `Context` and the arguments.
        backtracks: the function is a generator of answers.
        direct: returns a faster function for a call with the constant arguments of a program, or None. That function is
            called with the agent itself and all arguments, bindings not applied, and never suspends.
        values: returns the values of the first argument in all answers, called with the other arguments if the first one
            is unbound; None if `function` is needed. It must not read beliefs.
        collects: the function is called with a list instead: the values of the template in all answers of the `condition`.
            It returns the value of the last argument. The template is the argument before the condition, if there is one.
        by_name: it accesses variables by name, so all variables of the plan are kept for it.
        pure: it has no effects and uses no random numbers, so that questions and explanations of failures may call it.
        restricted: minimum number of arguments with which a restricted run refuses it; None for never.
    """

    name: str
    function: Function = _undefined
    backtracks: bool = False
    direct: Callable[[FixedArguments], Function | None] | None = None
    values: Callable[..., Iterable[Term]] | None = None
    collects: bool = False
    by_name: bool = False
    pure: bool = False
    restricted: int | None = None

    def __call__(self, function: F) -> F:
        """Register *function* under the name."""
        _declared[self.name] = replace(self, function=function)
        return function

    def is_collecting(self, count: int) -> bool:
        """Return whether a call with that number of arguments collects answers."""
        return self.collects and self.takes(count)


internal_action = InternalAction

InternalActions = dict[str, InternalAction]
_declared: InternalActions = {}
STANDARD: Final[Mapping[str, InternalAction]] = MappingProxyType(_declared)
"""The internal actions of the language; an agent may have more."""


# Each of these raises `WrongArguments` for another term, with a message that begins with *what*: "the first
# argument".


def number(term: Term, what: str) -> float:
    """Return the value of a number; an expression with unbound variables is rejected."""
    if term.__class__ in NUMBERS:
        return double(term)
    raise WrongArguments(f"{what} must be a number, not {text(term)}")


def whole(term: Term, what: str) -> int:
    """Return a number without its fraction, cut to 32 bits as in Jason."""
    return to_int(number(term, what))


def string(term: Term, what: str) -> str:
    """Return the characters of a string."""
    if term.__class__ is String:
        return str(term)
    raise WrongArguments(f"{what} must be a string, not {text(term)}")


def elements(term: Term, what: str) -> list[Term]:
    """Return the elements of a list; an open tail is ignored."""
    if is_list(term):
        return list(list_items(term))
    raise WrongArguments(f"{what} must be a list, not {text(term)}")


def members(term: Term, what: str) -> list[Term]:
    """Return the elements of a list, set or queue."""
    if isinstance(term, (SetValue, QueueValue)):
        return list(term)
    if is_list(term):
        return list(list_items(term))
    raise WrongArguments(f"{what} must be a list, a set or a queue, not {text(term)}")


def characters(term: Term) -> str:
    """Return a string without quotes, or any other term as text."""
    return str(term) if term.__class__ is String else text(term)
