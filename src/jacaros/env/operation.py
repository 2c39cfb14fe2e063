"""Operations: how artifacts declare them, how they are asked for, and what comes of it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, TypeVar, overload

from jacaros.env.ids import ArtifactId
from jacaros.env.resources.claim import Claim, Policy
from jacaros.env.resources.resource import Use
from jacaros.env.values import Atom, Structure
from jacaros.trace import Cause

F = TypeVar("F", bound=Callable[..., Any])

WhenPreempted = Literal["pause", "cancel", "finish"]
"""What an operation does when a more urgent claim takes away what it uses."""
Uses = str | Use | tuple[str | Use, ...]
"""What an operation uses, such as ``"wheels"``, ``("base", "arm")`` or ``"lift(2)"``."""

OPERATION = "operation"
LINK = "linked operation"
INTERNAL = "internal operation"
INIT = "init"
EXTERNAL = "external session"


@dataclass(frozen=True, slots=True)
class OperationOutcome:
    """What came of an operation; its outputs are in the `Out` objects among the arguments.

    Attributes:
        ok: False when it failed.
        message: text for people, None when it succeeded.
        reason: term for programs, None when it succeeded or failed without one.
    """

    ok: bool
    message: str | None = None
    reason: Structure | Atom | None = None


SUCCEEDED = OperationOutcome(True)


def ignore_outcome(outcome: OperationOutcome) -> None:
    """Take an outcome that nobody waits for."""


def ignore_preemption(resource: str | None) -> None:
    """Take a preemption that nobody asks about."""


@dataclass(slots=True)
class OperationRequest:
    """What somebody asks of an artifact.

    Attributes:
        artifact: which one.
        operation: name of the operation; with the number of arguments it selects the method.
        arguments: plain values, and `Out` objects where results are wanted.
        agent: on whose behalf, None for the environment itself.
        cause: what led to it.
        on_done: told the outcome once, after observers were told the changes; never after a cancel.
        timeout: seconds that the operation may take, waiting for its turn, its guard and its pauses included; then
            it is stopped like one that is cancelled, and fails with ``operation_timeout(Operation,Milliseconds)``.
            None: no limit.
        urgency: decides who gets what the operation uses; the greater one first.
        policy: what happens when it cannot have that at once.
        yields: the resources may be taken away from it; False for an operation of an atomic plan.
        within: claims of the caller that the operation is a part of, outermost first.
        on_preempted: called with the resource that a more urgent claim takes away from the running operation, and with
            None when it continues.
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


@dataclass(frozen=True, slots=True)
class Mark:
    """What a decorator leaves on a function until its class is complete; see the decorators."""

    kind: str
    name: str | None = None
    guard: str | None = None
    pausable: bool = False
    threaded: bool = False
    common: bool = False
    uses: Uses = ()
    when_preempted: WhenPreempted | None = None


_MARKS = "__jacaros_operations__"


def marks_of(function: object) -> tuple[Mark, ...]:
    """The marks that decorators left on *function*; empty for an ordinary method."""
    marks: tuple[Mark, ...] = getattr(function, _MARKS, ())
    return marks


def _marked(function: F | None, mark: Mark) -> F | Callable[[F], F]:
    def decorate(target: F) -> F:
        setattr(target, _MARKS, (*marks_of(target), mark))
        return target

    return decorate if function is None else decorate(function)


@overload
def operation(function: F, /) -> F: ...
@overload
def operation(
    *,
    name: str | None = None,
    guard: str | None = None,
    pausable: bool = False,
    threaded: bool = False,
    uses: Uses = (),
    when_preempted: WhenPreempted | None = None,
) -> Callable[[F], F]: ...
def operation(
    function: F | None = None,
    /,
    *,
    name: str | None = None,
    guard: str | None = None,
    pausable: bool = False,
    threaded: bool = False,
    uses: Uses = (),
    when_preempted: WhenPreempted | None = None,
) -> F | Callable[[F], F]:
    """Make a method an operation that agents can call.

    Args:
        function: the method, a ``def`` (one step) or ``async def`` (a step up to each step boundary).
        name: what agents call it, if not the method's name; several methods may share a name as long as
            they take different numbers of arguments.
        guard: name of a method with the same parameters; the operation waits until that is true.
        pausable: the operation obeys pauses (see `Artifact.pause_point`), because it stops what it does.
        threaded: the method blocks, so it runs in a worker thread; a plain ``def`` whose changes and
            signals are published together when it ends.
        uses: resources that no other operation may use meanwhile: a name, such as ``"wheels"``; several; ``"lift(2)"`` for
            one that two may use, ``"map(shared)"`` for one that only readers share.  Those of an artifact with a
            `robot_prefix` belong to this robot, all others to the run.
        when_preempted: what it does when a more urgent claim takes them away: ``pause`` and continue later (the default if
            it is pausable), ``cancel`` (it fails with ``preempted(Resource)``), or ``finish`` first (the default else).
    """
    return _marked(function, Mark(OPERATION, name, guard, pausable, threaded, False, uses, when_preempted))


def initializer(function: F, /) -> F:
    """Make a method a further ``init``: of all of them the one runs that takes the given number of arguments."""
    setattr(function, _MARKS, (*marks_of(function), Mark(INIT, "init")))
    return function


def common_operation(name: str) -> Callable[[F], F]:
    """Make a method of `Artifact` itself an operation called *name*, which every artifact has."""

    def decorate(function: F) -> F:
        setattr(function, _MARKS, (Mark(OPERATION, name, common=True),))
        return function

    return decorate


@overload
def link(function: F, /) -> F: ...
@overload
def link(
    *,
    name: str | None = None,
    guard: str | None = None,
    pausable: bool = False,
    threaded: bool = False,
    uses: Uses = (),
    when_preempted: WhenPreempted | None = None,
) -> Callable[[F], F]: ...
def link(
    function: F | None = None,
    /,
    *,
    name: str | None = None,
    guard: str | None = None,
    pausable: bool = False,
    threaded: bool = False,
    uses: Uses = (),
    when_preempted: WhenPreempted | None = None,
) -> F | Callable[[F], F]:
    """Make a method a linked operation: other artifacts call it through their ports, agents cannot.

    The arguments are those of `operation`; a method may be both.
    """
    return _marked(function, Mark(LINK, name, guard, pausable, threaded, False, uses, when_preempted))


@overload
def internal_operation(function: F, /) -> F: ...
@overload
def internal_operation(
    *, name: str | None = None, guard: str | None = None, threaded: bool = False
) -> Callable[[F], F]: ...
def internal_operation(
    function: F | None = None,
    /,
    *,
    name: str | None = None,
    guard: str | None = None,
    threaded: bool = False,
) -> F | Callable[[F], F]:
    """Make a method a process that the artifact starts itself, with `Artifact.start`.

    The arguments are those of `operation`.
    """
    return _marked(function, Mark(INTERNAL, name, guard, False, threaded))
