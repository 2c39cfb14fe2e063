"""How a Python function becomes an internal action, and the checks of arguments that actions share.

    @internal_action(".member", arity=2, backtracks=True)
    def member(ctx, item, collection):
        for candidate in list_items(collection):
            if ctx.unify(item, candidate):
                yield

The decorator holds all that is known of an action: parser, checker, compiler and mind ask it there and know no names.
The docstring of an action says what its arguments are; others raise `WrongArguments`.
The arguments arrive with all bindings applied (`jacaros.terms.substitution.resolve`); unbound ones are `Var`.  A plain
function succeeds unless it returns False.  A generator (``backtracks``) yields once for every answer; bindings
made before a yield are taken back before the next one is looked for.  A function that suspends the intention
(``suspends``) calls `Context.suspend` and returns what that gave.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Final, TypeVar

from jacaros.asl.declaration import Declaration
from jacaros.terms.collections import QueueValue, SetValue
from jacaros.terms.operators import to_int
from jacaros.terms.text import text
from jacaros.terms.values import String, Term, is_list, list_items

Function = Callable[..., Any]
Declared = TypeVar("Declared", bound=Function)
Written = tuple[Term | None, ...]
"""The arguments of a call as far as they are written out in a program; None for those that are known at run time."""


class WrongArguments(Exception):
    """The arguments do not fit: the step fails with ``error(wrong_arguments)``."""


class ActionError(Exception):
    """The action could not be done: the step fails with ``error(internal_action)`` or the given terms.

    Attributes:
        annotations: terms for the failure event; an ``error(..)`` among them replaces the default one.
    """

    def __init__(self, message: str, *annotations: Term) -> None:
        super().__init__(message)
        self.annotations = annotations


class Crashed(Exception):
    """Mixed into the failures of a project's own Python code that nobody meant: people are told of them too."""


def _undefined(*_: object) -> None:
    raise NotImplementedError("the declaration of an internal action has no function yet")


@dataclass(frozen=True, slots=True)
class InternalAction(Declaration):
    """An internal action with all that is known of it, as the registry keeps it.

    As a decorator it registers a function as the standard internal action that it declares.

    Attributes:
        name: with the leading dot of the standard ones.
        function: called with a `Context` and the arguments.
        backtracks: the function is a generator of answers.
        direct: asked for a quicker function for a call with the arguments that a program writes out, or None: it is called
            with the agent itself and all arguments, bindings not applied, and never suspends.
        values: gives what the first argument is in each answer, called with the others while that one is a variable without
            value; None where this takes the function itself.  It must not look at beliefs.
        collects: the function is called with a list instead: what the template is in each answer of the `condition`.
            It returns the value of the last argument.  The template is the argument before the condition, if there is one.
        by_name: it reaches variables by their names, so all variables of the plan are kept for it.
        repeatable: it only looks, so it may be called once more to explain a failure; it neither acts nor throws dice.
        restricted: fewest arguments with which a restricted run refuses it; None for never.
    """

    name: str
    function: Function = _undefined
    backtracks: bool = False
    direct: Callable[[Written], Function | None] | None = None
    values: Callable[..., Iterable[Term]] | None = None
    collects: bool = False
    by_name: bool = False
    repeatable: bool = False
    restricted: int | None = None

    def __call__(self, function: Declared) -> Declared:
        """Register *function* under the name."""
        _declared[self.name] = replace(self, function=function)
        return function

    def is_collecting(self, count: int) -> bool:
        """Return whether a call with that number of arguments collects answers."""
        return self.collects and self.takes(count)


internal_action = InternalAction

Registry = dict[str, InternalAction]
_declared: Registry = {}
STANDARD: Final[Mapping[str, InternalAction]] = MappingProxyType(_declared)
"""The internal actions of the language; an agent may have more."""


# Each of these raises `WrongArguments` for another term, with a message that begins with *what*: "the first argument".


def number(term: Term, what: str) -> float:
    """The value of a number; an expression of unbound variables is none."""
    if term.__class__ is float:
        return float(term)
    raise WrongArguments(f"{what} must be a number, not {text(term)}")


def whole(term: Term, what: str) -> int:
    """A number without its fraction, cut to 32 bits as in Jason."""
    return to_int(number(term, what))


def string(term: Term, what: str) -> str:
    """The characters of a string."""
    if term.__class__ is String:
        return str(term)
    raise WrongArguments(f"{what} must be a string, not {text(term)}")


def elements(term: Term, what: str) -> list[Term]:
    """The elements of a list; an open end is passed over."""
    if is_list(term):
        return list(list_items(term))
    raise WrongArguments(f"{what} must be a list, not {text(term)}")


def members(term: Term, what: str) -> list[Term]:
    """The elements of a list, set or queue."""
    if isinstance(term, (SetValue, QueueValue)):
        return list(term)
    if is_list(term):
        return list(list_items(term))
    raise WrongArguments(f"{what} must be a list, a set or a queue, not {text(term)}")


def characters(term: Term) -> str:
    """A string bare, any other term as it is written."""
    return str(term) if term.__class__ is String else text(term)
