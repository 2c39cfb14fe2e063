"""What fails an operation: exceptions of an artifact's code, and the failed outcomes that the kernel itself makes.

Of exceptions it says which are the author's, and puts them into words; an outcome has a message and a reason term.
"""

import signal
import traceback
from types import CodeType
from typing import Any

from jacaros.env.errors import OperationFailed
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel.interface import Interface
from jacaros.env.kernel.signature import WrongArguments
from jacaros.env.operation import INTERNAL, LINK, OPERATION, OperationOutcome, OperationRequest
from jacaros.env.values import Atom, Structure
from jacaros.errors import InternalError

_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK", "SIGALRM", "SIGILL")
"""Those that `jacaros.ros.lifetime` and `jacaros.alarm` handle, on any system."""


def is_interruption(error: BaseException) -> bool:
    """True for what a signal handler raised in the middle of an artifact's code; all else is the code's own.

    An artifact that raises ``SystemExit`` or ``KeyboardInterrupt`` by itself ends its operation, not the process.
    """
    if isinstance(error, Exception):
        return False
    handlers = [signal.getsignal(getattr(signal, name)) for name in _SIGNALS if hasattr(signal, name)]
    # The handler of Python itself is no Python code, so no trace shows it.
    if isinstance(error, KeyboardInterrupt) and handlers[0] is signal.default_int_handler:
        return True
    codes = {_code(handler) for handler in handlers} - {None}
    return any(frame.f_code in codes for frame, _ in traceback.walk_tb(error.__traceback__))


def _code(handler: Any) -> CodeType | None:
    handler = getattr(handler, "func", handler)
    code = getattr(getattr(handler, "__func__", handler), "__code__", None)
    return code if isinstance(code, CodeType) else None


def text_of(error: object) -> str:
    """What *error* says of itself, also when its ``__str__`` is broken."""
    try:
        return str(error)
    except Exception as broken:
        return f"(its text cannot be had: {type(broken).__name__})"


def told(error: BaseException) -> str:
    """An exception in words: its class, and what it says."""
    said = text_of(error)
    return f"{type(error).__name__}: {said}" if said else type(error).__name__


_CALLERS = {OPERATION: "agents", LINK: "other artifacts only", INTERNAL: "the artifact itself only"}


def key(request: OperationRequest) -> str:
    """Name and number of arguments, such as ``inc/1``."""
    return f"{request.operation}/{len(request.arguments)}"


def unknown_operation(request: OperationRequest, kind: str, interface: Interface) -> OperationOutcome:
    """The artifact has no operation of that name and number of arguments for that caller."""
    name, arity, artifact = request.operation, len(request.arguments), request.artifact
    for other in (OPERATION, LINK, INTERNAL):
        if other != kind and interface.table(other).find(name, arity) is not None:
            help = f"; its {other} of that name is for {_CALLERS[other]}"
            break
    else:
        help = interface.table(kind).explain(name)
    message = f"artifact {artifact.name} ({artifact.type_name}) has no {kind} {key(request)}{help}"
    return OperationOutcome(False, message, Structure("unknown_operation", (artifact, name)))


def wrong_arguments(request: OperationRequest, wrong: WrongArguments) -> OperationOutcome:
    """An argument is not of the kind that the operation wants."""
    message = f"operation {key(request)} of artifact {request.artifact.name}: {wrong}"
    return OperationOutcome(False, message, Structure("wrong_op_arguments", (request.artifact, key(request))))


def not_available(artifact: ArtifactId) -> OperationOutcome:
    """The artifact is there no more."""
    message = f"artifact {artifact.path} is not available: it has been disposed"
    return OperationOutcome(False, message, Structure("artifact_not_available", (artifact.name,)))


def disposed(request: OperationRequest) -> OperationOutcome:
    """The artifact went away while the operation was waiting or running."""
    message = f"artifact {request.artifact.path} was disposed before {key(request)} ended"
    return OperationOutcome(False, message, Structure("artifact_disposed", (request.artifact.name,)))


def timed_out(request: OperationRequest, seconds: float) -> OperationOutcome:
    """The operation did not end in the time that its caller gave it."""
    milliseconds = round(seconds * 1000, 3)
    shown = f"{milliseconds:g} ms" if milliseconds < 1000 else f"{seconds:g} s"
    message = f"operation {key(request)} of artifact {request.artifact.name} did not end within {shown}"
    return OperationOutcome(False, message, Structure("operation_timeout", (key(request), milliseconds)))


def without_resource(request: OperationRequest, reason: Structure | Atom) -> str:
    """Words for an operation that cannot have what it uses, or has lost it."""
    said = {
        "preempted": "a more urgent claim took {} away",
        "resource_busy": "{} is in use",
        "deadlock": "it waited for {} in a circle with others",
        "resource_exceeded": "it asks for more units of {} than there are",
    }
    functor = reason.functor if isinstance(reason, Structure) else str(reason)
    name = reason.arguments[0] if isinstance(reason, Structure) else ""
    why = said.get(functor, "{}").format(name)
    return f"operation {key(request)} of artifact {request.artifact.name}: {why}"


def failed(request: OperationRequest, error: BaseException) -> OperationOutcome:
    """The code of the operation raised *error*."""
    if isinstance(error, OperationFailed):
        # A class of the author's own need not have called the constructor.
        message = getattr(error, "message", None)
        reason = getattr(error, "reason", None)
        return OperationOutcome(False, message if isinstance(message, str) else text_of(error), reason)
    functor = "internal_error" if isinstance(error, InternalError) else "operation_error"
    message = told_in(error, request)
    return OperationOutcome(False, message, Structure(functor, (key(request),)))


def told_in(error: BaseException, request: OperationRequest) -> str:
    """An exception in words, and the operation in which it was raised."""
    where = f"in operation {key(request)} of {request.artifact.name}"
    said = text_of(error)
    return f"{type(error).__name__} {where}: {said}" if said else f"{type(error).__name__} {where}"
