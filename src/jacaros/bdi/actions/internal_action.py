"""How a Python function becomes an internal action.

    @internal_action(".member", backtracks=True)
    def member(ctx, item, collection):
        for candidate in list_items(collection):
            if ctx.unify(item, candidate):
                yield

The arguments arrive with all bindings applied (`jacaros.terms.substitution.resolve`); unbound ones are `Var`.  A plain
function succeeds unless it returns False.  A generator (``backtracks``) yields once for every answer; bindings
made before a yield are taken back before the next one is looked for.  A function that suspends the intention
(``suspends``) calls `Context.suspend` and returns what that gave.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from jacaros.terms.values import Term

Function = Callable[..., Any]
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


@dataclass(frozen=True, slots=True)
class InternalAction:
    """An internal action as the registry keeps it.

    Attributes:
        name: with the leading dot of the standard ones.
        function: called with a `Context` and the arguments.
        backtracks: the function is a generator of answers.
        suspends: it may suspend the intention, or acts on it: not for contexts and rules.
        minimum, maximum: number of arguments allowed; maximum None for any number.
        direct: asked for a quicker function for a call with the arguments that a program writes out, or None: it is called
            with the agent itself and all arguments, bindings not applied, and never suspends.
        values: gives what the first argument is in each answer, called with the others while that one is a variable without
            value; None where this takes the function itself.  It must not look at beliefs.
        result_hint: how its author gives it one argument more, for the result; empty when it has all or is not in Python.
    """

    name: str
    function: Function
    backtracks: bool = False
    suspends: bool = False
    minimum: int = 0
    maximum: int | None = None
    direct: Callable[[Written], Function | None] | None = None
    values: Callable[..., Iterable[Term]] | None = None
    result_hint: str = ""


Registry = dict[str, InternalAction]
STANDARD: Registry = {}
"""The internal actions of the language; an agent may have more."""


def internal_action(
    name: str,
    *,
    arity: int | tuple[int, int | None] = (0, None),
    backtracks: bool = False,
    suspends: bool = False,
    direct: Callable[[Written], Function | None] | None = None,
    values: Callable[..., Iterable[Term]] | None = None,
) -> Callable[[Function], Function]:
    """Register a standard internal action; *arity* is a number of arguments, or least and most (None: any)."""
    least, most = (arity, arity) if isinstance(arity, int) else arity

    def register(function: Function) -> Function:
        STANDARD[name] = InternalAction(name, function, backtracks, suspends, least, most, direct, values)
        return function

    return register
