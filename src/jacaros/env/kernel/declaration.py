"""The declaration of an operation, made from a marked method or from a function."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

from jacaros.env.errors import InvalidArtifact
from jacaros.env.kernel.signature import Signature, signature_of
from jacaros.env.operation import INTERNAL, Mark, WhenPreempted
from jacaros.env.resources.resource import Use, read_uses
from jacaros.suggestions import aside

FOR_ONE_ARTIFACT = 1_000_000
"""Depth of operations that an artifact defines itself: they override those of all its classes."""


@dataclass(frozen=True, slots=True)
class DeclaredOperation:
    """One operation of an artifact type.

    Attributes:
        name: its name for callers.
        kind: `OPERATION` (for agents), `LINK` (for other artifacts) or `INTERNAL`.
        function: takes the artifact and the arguments.
        source: the user-defined function, for messages and the manual.
        signature: its parameters.
        guard: takes the same as `function`. The operation waits while it is false.
        pausable: whether it obeys a pause.
        threaded: whether it runs in a worker thread.
        coroutine: whether it runs as a task, because it may have several steps or a thread.
        common: whether every artifact has it.
        depth: depth of its class in the hierarchy. A deeper class overrides those above it.
        uses: resources that it holds while it runs, without the name of the robot.
        when_preempted: what it does when they are taken away.
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


def _nothing(_: object) -> None:
    """Do nothing."""


NOTHING: Final = DeclaredOperation(
    "nothing", INTERNAL, _nothing, _nothing, Signature((), None), None, False, False, False, 0
)
"""Stands for the operation of requests that have none: refused ones, sensor messages, an ``init`` that does not exist."""


def declare_method(
    mark: Mark, method: str, function: Callable[..., Any], owner: type, depth: int
) -> DeclaredOperation:
    """Declare *function*, the method *method* of the class *owner*, as an operation.

    Raises:
        InvalidArtifact: a threaded operation is a coroutine, agents cannot pass one of its parameters, or its guard
            does not fit.
    """
    guard = None
    if mark.guard is not None:
        guard = getattr(owner, mark.guard, None)
        if not callable(guard):
            methods = [name for name in dir(owner) if not name.startswith("_")]
            help = aside(mark.guard, methods)
            raise InvalidArtifact(f"{function.__qualname__}: unknown guard method {mark.guard}{help}")
    signature = signature_of(function, skip_first=True)
    if guard is not None:
        guard = _suited(guard, signature_of(guard, skip_first=True), signature, function)
    return _declare(mark, mark.name or method, function, function, signature, guard, depth)


def declare_function(
    mark: Mark, name: str, function: Callable[..., Any], guard: Callable[..., Any] | None
) -> DeclaredOperation:
    """Declare a function, which does not take the artifact, as an operation of one artifact.

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
    while isinstance(source, partial):  # the docstring of a partial is that of the class
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
        raise InvalidArtifact(f"{name_of(source)} runs in a thread, so it cannot be async; write a plain def")
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
    """Return what an operation uses, and what it does when it is preempted."""
    try:
        uses = read_uses(mark.uses)
    except ValueError as wrong:
        raise InvalidArtifact(f"{name_of(source)}: {wrong}") from None
    wanted = mark.when_preempted
    if wanted is None:
        return uses, "pause" if mark.pausable else "finish"
    if wanted not in ("pause", "cancel", "finish"):
        raise InvalidArtifact(
            f"{name_of(source)}: expected pause, cancel or finish as when_preempted, found {wanted!r}"
        )
    if wanted == "pause" and not mark.pausable:
        raise InvalidArtifact(f'{name_of(source)}: when_preempted="pause" needs pausable=True')
    if wanted == "cancel" and mark.threaded:
        raise InvalidArtifact(
            f'{name_of(source)} runs in a thread, which cannot be cancelled; write when_preempted="finish"'
        )
    return uses, wanted


def _suited(
    guard: Callable[..., object], takes: Signature, wanted: Signature, function: Callable[..., Any]
) -> Callable[..., object]:
    """Check a guard. It takes the parameters of the operation, or none."""
    if inspect.iscoroutinefunction(guard):
        raise InvalidArtifact(f"{name_of(function)}: expected a plain def as guard, found an async def")
    if not takes.parameters and takes.rest is None:
        return lambda artifact, *_: guard(artifact)
    if not all(map(takes.takes, wanted.arities)) or (wanted.rest is not None and takes.rest is None):
        raise InvalidArtifact(
            f"{name_of(function)}: expected a guard with the parameters of the operation ({wanted}), or none; "
            f"found ({takes})"
        )
    return guard


def name_of(function: Callable[..., Any]) -> str:
    """Return the name of a function for messages."""
    return str(getattr(function, "__qualname__", function))
