"""Exceptions of a project's Python code, as the mind takes them."""

from asyncio import CancelledError
from collections.abc import Callable
from pathlib import Path

from jacaros.bdi.actions.internal_action import ActionError, Crashed, WrongArguments
from jacaros.env.values import Atom, Structure
from jacaros.errors import InternalError
from jacaros.extension.literal import Literal, term_of
from jacaros.project_modules import place_of
from jacaros.terms.operators import ArithmeticFault
from jacaros.terms.values import Term

FAULTS = (Exception, SystemExit, CancelledError)
"""What Python code of a project may raise without ending more than the step that called it."""


class ActionCrashed(ActionError, Crashed):
    """The Python code of an internal action raised an exception that is no `ActionError`."""


class FunctionCrashed(ArithmeticFault, Crashed):
    """The Python code of an arithmetic function raised an exception."""


def action_fault(name: str, function: Callable[..., object], error: BaseException) -> Exception:
    """How the step of an internal action fails for an exception of its function.

    Raises:
        InternalError: the exception is one: a defect of JaCaROS.
    """
    if isinstance(error, InternalError):
        raise error
    if isinstance(error, WrongArguments):
        return error
    if isinstance(error, ActionError):
        return ActionError(str(error), *map(_annotation, error.annotations))
    return ActionCrashed(crash_text(name, function, error))


def _annotation(value: Term) -> Term:
    return term_of(value) if isinstance(value, (Literal, Structure, Atom, str)) else value


def crash_text(name: str, function: Callable[..., object], error: BaseException) -> str:
    """What people are told of an exception: the action, the exception, and where it was raised."""
    what = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return f"{name}: {what} ({_place(function, error)})"


def _place(function: Callable[..., object], error: BaseException) -> str:
    code = getattr(function, "__code__", None)
    if code is None:
        return getattr(function, "__module__", "?")
    file = Path(code.co_filename)
    place, line = place_of(error, file.parent) or (file, code.co_firstlineno)
    return f"{place}:{line}"
