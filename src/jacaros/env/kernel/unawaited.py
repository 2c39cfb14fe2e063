"""Step boundaries without ``await``: nothing happens then, and Python itself only mutters about it."""

import inspect
import sys
from collections.abc import Callable, Coroutine, Sequence
from functools import wraps
from typing import Any, Protocol, TypeVar, cast

from jacaros.env.errors import InvalidArtifact
from jacaros.env.operation import marks_of

F = TypeVar("F", bound=Callable[..., Coroutine[Any, Any, Any]])


class AskedFor:
    """One step boundary that an operation has asked for.

    Attributes:
        coroutine: what is to be awaited.
        name: of the method.
        place: file and line of the call.
    """

    __slots__ = ("coroutine", "name", "place")

    def __init__(self, coroutine: Coroutine[Any, Any, Any], name: str, place: tuple[str, int]) -> None:
        self.coroutine, self.name, self.place = coroutine, name, place

    @property
    def is_forgotten(self) -> bool:
        """True as long as nobody has awaited it."""
        return inspect.getcoroutinestate(self.coroutine) == inspect.CORO_CREATED


class Asking(Protocol):
    """An operation that may ask for step boundaries (`jacaros.env.execution.OperationExecution`)."""

    asked_for: Sequence[AskedFor]


def step_boundary(method: F) -> F:
    """Have an operation that calls *method*, a coroutine of an artifact, and does not await it, fail when it ends."""

    @wraps(method)
    def asking(artifact: Any, *arguments: Any, **options: Any) -> Coroutine[Any, Any, Any]:
        coroutine = method(artifact, *arguments, **options)
        steps = getattr(
            artifact, "_steps", None
        )  # a test may call a method of an artifact that is in no workspace
        execution: Asking | None = steps.turns.holder if steps is not None else None
        if execution is not None:
            caller = sys._getframe(1)
            asked = AskedFor(coroutine, method.__name__, (caller.f_code.co_filename, caller.f_lineno))
            # Several may wait for their await, as in asyncio.gather(self.sleep(1), self.until(guard)).
            execution.asked_for = [*(each for each in execution.asked_for if each.is_forgotten), asked]
        return coroutine

    return cast(F, asking)


def watch_operations(artifact_type: type) -> None:
    """Have calls of the operations that a class declares itself watched in the same way, when its methods make them.

    The kernel runs the plain functions, which its interface has by now.
    """
    for attribute, member in list(vars(artifact_type).items()):
        if marks_of(member) and inspect.iscoroutinefunction(member):
            watched = step_boundary(member)
            watched.plain = member
            setattr(artifact_type, attribute, watched)


def forgotten(execution: Asking) -> InvalidArtifact | None:
    """What to tell of an operation that has ended with a step boundary not awaited."""
    left = [each for each in execution.asked_for if each.is_forgotten]
    for each in left:
        each.coroutine.close()
    if not left:
        return None
    name, (file, line) = left[0].name, left[0].place
    return InvalidArtifact(
        f"self.{name}(...) does nothing without await: write `await self.{name}(...)`, in an async def ({file}:{line})"
    )
