"""Operations: how artifacts declare them, how callers request them, and their outcomes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal, TypedDict, TypeVar, Unpack, overload

from jacaros.artifacts.env.arbiter import Claim, Policy
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed
from jacaros.artifacts.env.expectation import Expect
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.runtime.trace import Cause

F = TypeVar("F", bound=Callable[..., Any])

WhenPreempted = Literal["pause", "cancel", "finish"]
"""What an operation does when a more urgent claim takes away its resources."""
Uses = str | tuple[str, ...]
"""The resources of an operation, such as ``"wheels"`` or ``("base", "arm")``."""

OPERATION = "operation"
LINK = "linked operation"
INTERNAL = "internal operation"
INIT = "init"


@dataclass(frozen=True, slots=True)
class OperationOutcome:
    """The outcome of an operation. Its outputs are in the `Out` objects among the arguments.

    Attributes:
        ok: whether it succeeded.
        message: text for users. None if it succeeded.
        reason: term for programs. None if it succeeded, or failed without a reason.
    """

    ok: bool
    message: str | None = None
    reason: Structure | Atom | None = None

    @classmethod
    def of(cls, failure: OperationFailed) -> "OperationOutcome":
        """Return the outcome of an operation that ends with *failure*."""
        return cls(False, failure.message, failure.reason)

    @property
    def failure(self) -> OperationFailed:
        """The exception for a failed outcome."""
        return OperationFailed(self.message or "", self.reason)


SUCCEEDED = OperationOutcome(True)


def ignore_outcome(outcome: OperationOutcome) -> None:
    """Ignore an outcome."""


def ignore_preemption(resource: str | None) -> None:
    """Ignore a preemption."""


@dataclass(slots=True)
class OperationRequest:
    """A request to run an operation of an artifact.

    Attributes:
        artifact: the artifact.
        operation: name of the operation. With the number of arguments it selects the method.
        arguments: plain values, and `Out` objects for results.
        agent: the agent on whose behalf it runs. None for the environment itself.
        cause: what led to it.
        on_done: called once with the outcome, after observers have received the changes. Never called after a cancel.
        timeout: time limit in seconds, including the wait for its turn, its guard and pauses. After it, the operation is
            cancelled and fails with ``operation_timeout(Operation,Milliseconds)``. None: no limit.
        urgency: decides who gets the resources that the operation uses. The greater one wins.
        policy: what happens if a resource is not available immediately.
        yields: whether its resources may be taken away. False for an operation of an atomic plan.
        within: claims of the caller that the operation is part of, outermost first.
        on_preempted: called with the resource that a more urgent claim takes away from the running operation, and with
            None when the operation continues.
    """

    artifact: ArtifactId
    operation: str
    arguments: tuple[object, ...] = ()
    agent: str | None = None
    cause: Cause | None = None
    on_done: Callable[[OperationOutcome], None] = ignore_outcome
    timeout: float | None = None
    urgency: int = 0
    policy: Policy = "wait"
    yields: bool = True
    within: tuple[Claim, ...] = ()
    on_preempted: Callable[[str | None], None] = ignore_preemption

    @property
    def key(self) -> str:
        """Name and number of arguments, such as ``inc/1``."""
        return f"{self.operation}/{len(self.arguments)}"


@dataclass(frozen=True, slots=True)
class Mark:
    """The mark that a decorator leaves on a function until its class is complete. See the decorators."""

    kind: str
    name: str | None = None
    guard: str | None = None
    pausable: bool = False
    common: bool = False
    uses: Uses = ()
    when_preempted: WhenPreempted | None = None
    expect: Expect | Sequence[Expect] = ()
    meanwhile: Expect | Sequence[Expect] = ()


_MARKS = "__jacaros_operations__"


def marks_of(function: object) -> tuple[Mark, ...]:
    """Return the marks that decorators left on *function*. Empty for an ordinary method."""
    marks: tuple[Mark, ...] = getattr(function, _MARKS, ())
    return marks


class StartedOptions(TypedDict, total=False):
    """The options of `internal_operation`. See `operation`."""

    name: str | None
    guard: str | None


class OperationOptions(StartedOptions, total=False):
    """The options of `operation` and `link`. See `operation`."""

    pausable: bool
    uses: Uses
    when_preempted: WhenPreempted | None
    expect: Expect | Sequence[Expect]
    meanwhile: Expect | Sequence[Expect]


def _marked(function: F, mark: Mark) -> F:
    setattr(function, _MARKS, (*marks_of(function), mark))
    return function


def _decorated(function: F | None, mark: Mark) -> F | Callable[[F], F]:
    """Mark a function, or return a decorator that does."""
    return partial(_marked, mark=mark) if function is None else _marked(function, mark)


@overload
def operation(function: F, /) -> F: ...
@overload
def operation(**options: Unpack[OperationOptions]) -> Callable[[F], F]: ...
def operation(function: F | None = None, /, **options: Unpack[OperationOptions]) -> F | Callable[[F], F]:
    """Declare a method as an operation for agents.

    Args:
        function: the method, a ``def`` (one step) or ``async def`` (one step up to each step boundary).
        options: name: its name for agents. Default: the method's name. Several methods may share a name if they take
                different numbers of arguments.
            guard: name of a method with the same parameters. The operation waits until it returns true.
            pausable: whether the operation stops its work while paused (see `Artifact.pause_point`).
            uses: resources that no other operation may use meanwhile: a name, such as ``"wheels"``, or several. In an
                artifact with a `robot_prefix` they belong to this robot, otherwise to the run.
            when_preempted: what it does when a more urgent claim takes them away: ``pause`` and continue later (the
                default if it is pausable), ``cancel`` (it fails with ``preempted(Resource)``), or ``finish`` first (the
                default otherwise).
            expect: effects on properties: when the method has returned, the operation succeeds as soon as they show, and
                fails if they do not (see `Expect`).
            meanwhile: must hold while the method runs; otherwise it is cancelled and the operation fails.

    Raises:
        InvalidArtifact: (when the class is created) the declaration is invalid.
    """
    return _decorated(function, Mark(OPERATION, **options))


def initializer(function: F, /) -> F:
    """Declare a method as a further ``init``. The one that takes the given number of arguments is called."""
    return _marked(function, Mark(INIT, "init"))


def common_operation(name: str) -> Callable[[F], F]:
    """Declare a method of `Artifact` itself as an operation called *name* of every artifact."""
    return lambda function: _marked(function, Mark(OPERATION, name, common=True))


@overload
def link(function: F, /) -> F: ...
@overload
def link(**options: Unpack[OperationOptions]) -> Callable[[F], F]: ...
def link(function: F | None = None, /, **options: Unpack[OperationOptions]) -> F | Callable[[F], F]:
    """Declare a method as a linked operation: other artifacts call it through their ports, agents cannot.

    The options are those of `operation`. A method may be both.
    """
    return _decorated(function, Mark(LINK, **options))


@overload
def internal_operation(function: F, /) -> F: ...
@overload
def internal_operation(**options: Unpack[StartedOptions]) -> Callable[[F], F]: ...
def internal_operation(
    function: F | None = None, /, **options: Unpack[StartedOptions]
) -> F | Callable[[F], F]:
    """Declare a method as a process that the artifact starts itself, with `Artifact.start`.

    The options are those of `operation`, without ``pausable``, ``uses`` and ``when_preempted``.
    """
    return _decorated(function, Mark(INTERNAL, **options))
