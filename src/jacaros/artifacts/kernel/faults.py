"""Failures of operations: exceptions in an artifact's code, and failed outcomes that the kernel itself creates.

An exception is attributed to the artifact's author or not, and described in words. An outcome has a message and a
reason term.
"""

import signal
import traceback
from types import CodeType
from typing import Any

from jacaros.artifacts.env.errors import ArtifactId, OperationFailed
from jacaros.artifacts.env.operation import INTERNAL, LINK, OPERATION, OperationOutcome, OperationRequest
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.kernel.declaration import ArgumentMismatch, UsageInterface
from jacaros.runtime.errors import InternalError

_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK", "SIGALRM", "SIGILL")
"""Those that `jacaros.robots.ros.lifetime` and `jacaros.runtime.clock` handle, on any system."""


def is_interruption(error: BaseException) -> bool:
    """Return whether a signal handler raised this exception in the middle of an artifact's code.

    An artifact that raises ``SystemExit`` or ``KeyboardInterrupt`` itself fails its operation; the process continues.
    """
    if isinstance(error, Exception):
        return False
    handlers = [signal.getsignal(getattr(signal, name)) for name in _SIGNALS if hasattr(signal, name)]
    # Python's own handler is not Python code, so it does not appear in the traceback.
    if isinstance(error, KeyboardInterrupt) and handlers[0] is signal.default_int_handler:
        return True
    codes = {_code(handler) for handler in handlers} - {None}
    return any(frame.f_code in codes for frame, _ in traceback.walk_tb(error.__traceback__))


def _code(handler: Any) -> CodeType | None:
    handler = getattr(handler, "func", handler)
    code = getattr(getattr(handler, "__func__", handler), "__code__", None)
    return code if isinstance(code, CodeType) else None


def text_of(error: object) -> str:
    """Return the text of *error*, even if its ``__str__`` raises."""
    try:
        return str(error)
    except Exception as broken:
        return f"(its __str__ raised {type(broken).__name__})"


def error_text(error: BaseException) -> str:
    """Return the class and text of an exception."""
    said = text_of(error)
    return f"{type(error).__name__}: {said}" if said else type(error).__name__


_CALLERS = {OPERATION: "agents", LINK: "other artifacts only", INTERNAL: "the artifact itself only"}


def unknown_operation(request: OperationRequest, kind: str, interface: UsageInterface) -> OperationOutcome:
    """Return the failure for an unknown operation, number of arguments, or kind of caller."""
    name, arity, artifact = request.operation, len(request.arguments), request.artifact
    for other in (OPERATION, LINK, INTERNAL):
        if other != kind and interface.table(other).find(name, arity) is not None:
            help = f"; its {other} of this name is for {_CALLERS[other]}"
            break
    else:
        help = interface.table(kind).explain(name)
    message = f"unknown {kind} `{request.key}` of artifact {artifact.name} ({artifact.type_name}){help}"
    return OperationOutcome(False, message, Structure("unknown_operation", (artifact, name)))


def wrong_arguments(request: OperationRequest, wrong: ArgumentMismatch) -> OperationOutcome:
    """Return the failure for an argument of the wrong kind."""
    message = f"operation {request.key} of artifact {request.artifact.name}: {wrong}"
    return OperationOutcome(False, message, Structure("wrong_op_arguments", (request.artifact, request.key)))


def not_available(artifact: ArtifactId) -> OperationOutcome:
    """Return the failure for a disposed artifact."""
    message = f"artifact {artifact.path} has been disposed"
    return OperationOutcome(False, message, Structure("artifact_not_available", (artifact.name,)))


def disposed(request: OperationRequest) -> OperationOutcome:
    """Return the failure of an operation whose artifact was disposed while it waited or ran."""
    message = f"artifact {request.artifact.path} was disposed before {request.key} ended"
    return OperationOutcome(False, message, Structure("artifact_disposed", (request.artifact.name,)))


def timed_out(request: OperationRequest, seconds: float) -> OperationOutcome:
    """Return the failure of an operation that exceeded its time limit."""
    milliseconds = round(seconds * 1000, 3)
    shown = f"{milliseconds:g} ms" if milliseconds < 1000 else f"{seconds:g} s"
    message = f"operation {request.key} of artifact {request.artifact.name} did not end within {shown}"
    return OperationOutcome(False, message, Structure("operation_timeout", (request.key, milliseconds)))


def without_resource(request: OperationRequest, reason: Structure | Atom) -> str:
    """Return the message for an operation that cannot have a resource, or has lost it."""
    said = {
        "preempted": "a more urgent claim preempted it at {}",
        "resource_busy": "{} is in use",
        "deadlock": "its wait for {} is part of a deadlock",
    }
    functor = reason.functor if isinstance(reason, Structure) else str(reason)
    name = reason.arguments[0] if isinstance(reason, Structure) else ""
    why = said.get(functor, "{}").format(name)
    return f"operation {request.key} of artifact {request.artifact.name}: {why}"


def failed(request: OperationRequest, error: BaseException) -> OperationOutcome:
    """Return the failure of an operation whose code raised *error*."""
    if isinstance(error, OperationFailed):
        # A user-defined subclass need not have called the constructor.
        message = getattr(error, "message", None)
        reason = getattr(error, "reason", None)
        return OperationOutcome(False, message if isinstance(message, str) else text_of(error), reason)
    functor = "internal_error" if isinstance(error, InternalError) else "operation_error"
    message = error_text_in(error, request)
    return OperationOutcome(False, message, Structure(functor, (request.key,)))


def error_text_in(error: BaseException, request: OperationRequest) -> str:
    """Return the class and text of an exception, and the operation that raised it."""
    where = f"in operation {request.key} of {request.artifact.name}"
    said = text_of(error)
    return f"{type(error).__name__} {where}: {said}" if said else f"{type(error).__name__} {where}"
