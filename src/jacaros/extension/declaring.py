"""The decorators by which a Python function becomes part of the language of a project."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar, overload

Function = TypeVar("Function", bound=Callable[..., object])

_MARK = "__jacaros_declared__"


@dataclass(frozen=True, slots=True)
class Declared:
    """What a decorator says of a function.

    Attributes:
        kind: ``internal action`` or ``arithmetic function``.
        function: the function itself.
        name: as programs write it; None for the default, module and function.
        arity: number of arguments, or least and most of them; None for what the parameters say.
    """

    kind: str
    function: Callable[..., object]
    name: str | None
    arity: int | tuple[int, int | None] | None = None


ACTION, FUNCTION = "internal action", "arithmetic function"


@overload
def internal_action(name: Function, /) -> Function: ...


@overload
def internal_action(name: str | None = None, /) -> Callable[[Function], Function]: ...


def internal_action(name: str | Function | None = None, /) -> object:
    """Make a function an internal action of the project's agents.

    The module must be found by the first part of the name: ``my.norm(X, Y, L)`` makes agents look for ``my.py``,
    or a package ``my/``, beside the project.  The function stays as it is and may be called from Python too.

    * A plain function succeeds unless it returns False.  One that declares what it returns (``-> float``) gives
      its value to one more argument, the last; None is no value, and the action fails.
    * A generator gives an answer with every ``yield``; conditions try them in turn.
    * A coroutine (``async def``) suspends the intention that calls it until it is done; dropping the intention
      cancels it.

    Arguments arrive as Python values.  A parameter annotated `Out` is a result: what is set there is unified with
    the argument.  A first parameter annotated `Agent` is given the calling agent, and does not count.

    Args:
        name: as programs write it, with dots; the module and the function unless given.

    Examples:
        @internal_action("my.norm")
        def norm(x: float, y: float) -> float:
            return math.hypot(x, y)
    """
    return _declare(ACTION, name, None)


@overload
def arithmetic_function(name: Function, /) -> Function: ...


@overload
def arithmetic_function(
    name: str | None = None, /, *, arity: int | tuple[int, int | None] | None = None
) -> Callable[[Function], Function]: ...


def arithmetic_function(
    name: str | Function | None = None, /, *, arity: int | tuple[int, int | None] | None = None
) -> object:
    """Make a function an arithmetic function of the project's programs: ``X = my.sq(3) + 1``.

    It is given its arguments as Python values once all of them are known, and returns a number.  An exception
    fails the step with ``error(arithmetic_error)``.

    Args:
        name: as programs write it, with dots; the module and the function unless given.
        arity: number of arguments, or least and most of them (None: any number); what the parameters say unless
            given.

    Examples:
        @arithmetic_function("my.sq")
        def sq(x: float) -> float:
            return x * x
    """
    return _declare(FUNCTION, name, arity)


def _declare(
    kind: str, name: str | Function | None, arity: int | tuple[int, int | None] | None
) -> Function | Callable[[Function], Function]:
    if callable(name):
        return _mark(name, Declared(kind, name, None, arity))
    if name is not None and (not isinstance(name, str) or "." not in name[1:] or name.startswith(".")):
        raise ValueError(f"the name of an {kind} has the module in front, as in 'my.norm', not {name!r}")
    return lambda function: _mark(function, Declared(kind, function, name, arity))


def _mark(function: Function, declared: Declared) -> Function:
    setattr(function, _MARK, (*declarations(function), declared))
    return function


def declarations(function: object) -> tuple[Declared, ...]:
    """What decorators said of a function."""
    found: tuple[Declared, ...] = getattr(function, _MARK, ())
    return found
