"""Detect step boundaries without ``await``, which have no effect and cause only a vague warning of Python."""

import inspect
import sys
from collections.abc import Callable, Coroutine, Sequence
from functools import wraps
from typing import Any, NamedTuple, Protocol, TypeVar, cast

from jacaros.env.errors import InvalidArtifact
from jacaros.env.operation import marks_of

F = TypeVar("F", bound=Callable[..., Coroutine[Any, Any, Any]])


class AskedFor(NamedTuple):
    """A step boundary that an operation has called.

    Attributes:
        coroutine: the coroutine to be awaited.
        name: name of the method.
        place: file and line of the call.
    """

    coroutine: Coroutine[Any, Any, Any]
    name: str
    place: tuple[str, int]

    @property
    def is_forgotten(self) -> bool:
        """Return whether it has not been awaited."""
        return inspect.getcoroutinestate(self.coroutine) == inspect.CORO_CREATED


class Asking(Protocol):
    """An operation that may call step boundaries (`jacaros.env.execution.OperationExecution`)."""

    asked_for: Sequence[AskedFor]


def step_boundary(method: F) -> F:
    """Fail an operation that calls *method*, a coroutine of an artifact, and ends without awaiting it."""

    @wraps(method)
    def asking(artifact: Any, *arguments: Any, **options: Any) -> Coroutine[Any, Any, Any]:
        coroutine = method(artifact, *arguments, **options)
        steps = getattr(
            artifact, "_steps", None
        )  # a test may call a method of an artifact outside of a workspace
        execution: Asking | None = steps.turns.holder if steps is not None else None
        if execution is not None:
            caller = sys._getframe(1)
            asked = AskedFor(coroutine, method.__name__, (caller.f_code.co_filename, caller.f_lineno))
            # Several may be pending, as in asyncio.gather(self.sleep(1), self.until(guard)).
            execution.asked_for = [*(each for each in execution.asked_for if each.is_forgotten), asked]
        return coroutine

    return cast(F, asking)


def watch_operations(artifact_type: type) -> None:
    """Watch calls of a class's own operations in the same way, when its methods make them.

    The kernel runs the original functions, which its interface already contains.
    """
    for attribute, member in list(vars(artifact_type).items()):
        if marks_of(member) and inspect.iscoroutinefunction(member):
            watched = step_boundary(member)
            watched.plain = member
            setattr(artifact_type, attribute, watched)


def forgotten(execution: Asking) -> InvalidArtifact | None:
    """Return the error for an operation that has ended without awaiting a step boundary, or None."""
    left = [each for each in execution.asked_for if each.is_forgotten]
    for each in left:
        each.coroutine.close()
    if not left:
        return None
    name, (file, line) = left[0].name, left[0].place
    return InvalidArtifact(
        f"self.{name}(...) has no effect without await; write `await self.{name}(...)` in an async def ({file}:{line})"
    )
