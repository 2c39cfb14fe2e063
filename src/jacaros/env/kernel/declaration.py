"""One operation as its artifact type declares it, made from a marked method or from a function."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from jacaros.env.errors import InvalidArtifact, spelling_hint
from jacaros.env.kernel.signature import Signature, signature_of
from jacaros.env.operation import Mark, WhenPreempted
from jacaros.env.resources.resource import Use, read_uses

FOR_ONE_ARTIFACT = 1_000_000
"""Depth of operations that one artifact defines for itself: they replace those of all its classes."""


@dataclass(frozen=True, slots=True)
class DeclaredOperation:
    """One operation of an artifact type.

    Attributes:
        name: what its callers call it.
        kind: `OPERATION` (for agents), `LINK` (for other artifacts) or `INTERNAL` (for itself).
        function: takes the artifact and the arguments.
        source: what the author wrote, for messages and the manual.
        signature: its parameters.
        guard: takes the same as `function`; the operation waits while it is false.
        pausable: True when it obeys a pause.
        threaded: True when it runs in a worker thread.
        coroutine: True when it runs as a task: it may have several steps, or a thread.
        common: True when every artifact has it.
        depth: depth of its class in the hierarchy; a deeper class replaces what is above it.
        uses: resources that it holds while it runs, without the name of the robot.
        when_preempted: what it does when these are taken away.
    """

    name: str
    kind: str
    function: Callable[..., Any]
    source: Callable[..., Any]
    signature: Signature
    guard: Callable[..., object] | None
    pausable: bool
    threaded: bool
    coroutine: bool
    depth: int
    common: bool = False
    uses: tuple[Use, ...] = ()
    when_preempted: WhenPreempted = "finish"


def declare_method(
    mark: Mark, method: str, function: Callable[..., Any], owner: type, depth: int
) -> DeclaredOperation:
    """Make the declaration of the operation *function*, which is *method* of the class *owner*.

    Raises:
        InvalidArtifact: a threaded operation is a coroutine, agents cannot give one of its parameters, or
            its guard does not suit.
    """
    guard = None
    if mark.guard is not None:
        guard = getattr(owner, mark.guard, None)
        if not callable(guard):
            methods = [name for name in dir(owner) if not name.startswith("_")]
            help = spelling_hint(mark.guard, methods)
            raise InvalidArtifact(f"{function.__qualname__}: the guard {mark.guard} is not a method{help}")
    signature = signature_of(function, skip_first=True)
    if guard is not None:
        guard = _suited(guard, signature_of(guard, skip_first=True), signature, function)
    return _declare(mark, mark.name or method, function, function, signature, guard, depth)


def declare_function(
    mark: Mark, name: str, function: Callable[..., Any], guard: Callable[..., Any] | None
) -> DeclaredOperation:
    """Make the declaration of an operation of one artifact from a function that does not take it.

    Raises:
        InvalidArtifact: as for `declare_method`.
    """

    def call(_: object, *arguments: object) -> object:
        return function(*arguments)

    def check(_: object, *arguments: object) -> object:
        return guard(*arguments) if guard is not None else True

    signature = signature_of(function, skip_first=False)
    suited = None
    if guard is not None:
        suited = _suited(check, signature_of(guard, skip_first=False), signature, function)
    source = function
    while isinstance(source, partial):  # its own docstring says nothing
        source = source.func
    return _declare(mark, name, call, source, signature, suited, FOR_ONE_ARTIFACT)


def _declare(
    mark: Mark,
    name: str,
    function: Callable[..., Any],
    source: Callable[..., Any],
    signature: Signature,
    guard: Callable[..., object] | None,
    depth: int,
) -> DeclaredOperation:
    coroutine = inspect.iscoroutinefunction(source)
    if mark.threaded and coroutine:
        raise InvalidArtifact(f"{name_of(source)} runs in a thread: make it a plain def, without async")
    uses, when_preempted = _uses(mark, source)
    return DeclaredOperation(
        name,
        mark.kind,
        function,
        source,
        signature,
        guard,
        mark.pausable,
        mark.threaded,
        coroutine or mark.threaded,
        depth,
        mark.common,
        uses,
        when_preempted,
    )


def _uses(mark: Mark, source: Callable[..., Any]) -> tuple[tuple[Use, ...], WhenPreempted]:
    """What an operation uses, and what it does when it is preempted."""
    try:
        uses = read_uses(mark.uses)
    except ValueError as wrong:
        raise InvalidArtifact(f"{name_of(source)}: {wrong}") from None
    wanted = mark.when_preempted
    if wanted is None:
        return uses, "pause" if mark.pausable else "finish"
    if wanted not in ("pause", "cancel", "finish"):
        raise InvalidArtifact(
            f"{name_of(source)}: when_preempted is {wanted!r}: write pause, cancel or finish"
        )
    if wanted == "pause" and not mark.pausable:
        raise InvalidArtifact(f'{name_of(source)}: when_preempted="pause" needs pausable=True')
    if wanted == "cancel" and mark.threaded:
        raise InvalidArtifact(
            f'{name_of(source)} runs in a thread, which cannot be cancelled: write when_preempted="finish"'
        )
    return uses, wanted


def _suited(
    guard: Callable[..., object], takes: Signature, wanted: Signature, function: Callable[..., Any]
) -> Callable[..., object]:
    """A guard without parameters is for any arguments; else it must take those of the operation."""
    if inspect.iscoroutinefunction(guard):
        raise InvalidArtifact(f"{name_of(function)}: its guard must be a plain def")
    if not takes.parameters and takes.rest is None:
        return lambda artifact, *_: guard(artifact)
    if not all(map(takes.takes, wanted.arities)) or (wanted.rest is not None and takes.rest is None):
        raise InvalidArtifact(
            f"{name_of(function)}: its guard takes ({takes}); it must take the same as the operation, "
            f"({wanted}), or nothing"
        )
    return guard


def name_of(function: Callable[..., Any]) -> str:
    """What a function is called in messages."""
    return str(getattr(function, "__qualname__", function))
