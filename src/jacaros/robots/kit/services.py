"""Services that an artifact calls, and services and actions that it offers.

A call without a response fails with one of these reasons, which a plan receives as ``env_failure_reason(R)``:

============================  ======================================================================================
R                             meaning
============================  ======================================================================================
service_unavailable(Name)     no node offers the service
service_timeout(S)            the server exists, but did not answer within S seconds
server_lost                   the server disappeared during the call; it is unknown whether it was executed
service_failed(Name)          the server failed, or the connection to it broke
refused(Text)                 it answered ``success: false``, and the operation treats that as a failure
============================  ======================================================================================

Requests from other nodes run as internal operations of the artifact.

They take turns with the operations of agents: their steps change properties, send signals and wait, and a step that
fails is undone.  The client always gets an answer:

=====================  ==========================================  ====================================================
end of the operation   client of a service                         client of an action
=====================  ==========================================  ====================================================
success                the response that was set                   succeeded, with the result that was set
``self.fail(Text)``    ``success: false`` and ``message: Text``,   aborted, with this text; the result's ``error_code``
                       or a failed call without such fields        is that of the reason ``aborted(Code)``
client cancels                                                     canceled, after ``finally`` has run
artifact disposed      a failed call                               aborted
=====================  ==========================================  ====================================================
"""

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Any

from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.kernel.declaration import DeclaredOperation
from jacaros.artifacts.kernel.steps import Steps
from jacaros.robots.ros.action import Abort, ServerGoal
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.errors import (
    CallTimedOut,
    ParameterRefused,
    ParameterUnknown,
    RosError,
    ServerGone,
    ServiceUnavailable,
    TransformUnavailable,
)
from jacaros.robots.ros.message import field_names
from jacaros.robots.ros.names import response_type, result_type
from jacaros.robots.ros.parameter import Parameters, ParameterValue
from jacaros.robots.ros.services import Client, Handler

ABORTED = "aborted"
"""Functor of the failure reason whose first argument is the result's ``error_code``."""


class RequestFailed(Exception):
    """Raised when the operation that serves a request fails."""


class Reply:
    """The answer to a request.

    Attributes:
        message: the response or result; None: one with default values.
    """

    def __init__(self, ros: Backend, type_name: str) -> None:
        self._ros, self._type_name = ros, type_name
        self.message: Any = None

    def set(self, message: Any = None, /, **fields: Any) -> None:
        """Set the message, or its fields; a later call replaces it.

        Raises:
            MessageMismatch: a field is unknown, or a value does not match its type.
        """
        self.message = message if message is not None else self._ros.message(self._type_name, **fields)


class ServedOperation:
    """A service or action of an artifact whose requests are served by one of its operations.

    Args:
        ros: the middleware.
        steps: the operations of the artifact.
        artifact: id of the artifact.
        declared: the operation; it takes a request (of an action: the goal) and a `Reply`.
    """

    def __init__(self, ros: Backend, steps: Steps, artifact: ArtifactId, declared: DeclaredOperation) -> None:
        self._ros, self._steps, self._artifact, self._declared = ros, steps, artifact, declared

    def handler(self, type_name: str) -> Handler:
        """Return the function that the middleware calls for each request of a service."""
        response = response_type(type_name)
        fields = self._ros.fields(response)

        async def handle(request: Any) -> Any:
            reply = Reply(self._ros, response)
            outcome = await self._serve(request, reply)
            if outcome.ok:
                return reply.message
            text = outcome.message or "the operation failed"
            if "success" in fields and fields["success"].base == "bool":
                return {"success": False, **({"message": text} if "message" in fields else {})}
            raise RequestFailed(text)

        return handle

    def execute(self, type_name: str) -> Callable[[ServerGoal], Awaitable[Any]]:
        """Return the function that the middleware calls for each goal of an action."""
        result = result_type(type_name)
        has_code = "error_code" in self._ros.fields(result)

        async def carry_out(goal: ServerGoal) -> Any:
            reply = Reply(self._ros, result)
            outcome = await self._serve(goal, reply)
            if outcome.ok:
                return reply.message
            code = _code(outcome.reason) if has_code else None
            raise Abort(
                outcome.message or "the operation failed", None if code is None else {"error_code": code}
            )

        return carry_out

    async def _serve(self, request: object, reply: Reply) -> OperationOutcome:
        """Run the operation. Cancelling this coroutine cancels it, and returns after its ``finally`` has run."""
        done: asyncio.Future[OperationOutcome] = asyncio.get_running_loop().create_future()

        def report(outcome: OperationOutcome) -> None:
            if not done.done():
                done.set_result(outcome)

        wanted = OperationRequest(self._artifact, self._declared.name, (request, reply), None, on_done=report)
        execution = self._steps.start(self._declared, wanted)
        if execution is None:
            raise RequestFailed(f"artifact {self._artifact.name} is disposed and serves no requests")
        try:
            return await done
        except asyncio.CancelledError:
            execution.cancel()
            if execution.task is not None:
                await asyncio.wait((execution.task,))
            raise


def _code(reason: object) -> int | None:
    """Return the number in a reason such as ``aborted(203)``."""
    if isinstance(reason, Structure) and reason.functor == ABORTED and reason.arguments:
        code = reason.arguments[0]
        if isinstance(code, int) and not isinstance(code, bool):
            return code
    return None


MESSAGES = ("message", "status_message", "error_msg", "error_message")
"""Response fields that hold the text of a refusal."""


def failure_reason(
    error: RosError, name: object, timeout: object, parameter: object = ""
) -> tuple[str, *tuple[object, ...]]:
    """Return the functor and arguments of the reason for a call that failed.

    Args:
        error: what failed.
        name: name of what was called.
        timeout: seconds that it was given.
        parameter: name of the parameter that was asked for, if any.
    """
    match error:
        case ServiceUnavailable():
            return "service_unavailable", name
        case CallTimedOut():
            return "service_timeout", timeout
        case ServerGone():
            return ("server_lost",)
        case ParameterUnknown():
            return "parameter_unknown", parameter
        case ParameterRefused():
            return "parameter_refused", parameter
        case TransformUnavailable():
            return "transform_unavailable", Atom(error.reason)
    return "service_failed", name


async def set_parameter(
    parameters: Parameters, name: str, value: ParameterValue, timeout: float | None
) -> None:
    """Set a parameter of a node; an integer is accepted for a floating-point number, which agents do not distinguish.

    Raises:
        RosError: the parameter is unknown or refused, or the node does not answer.
    """
    if isinstance(value, int) and not isinstance(value, bool):
        with suppress(ParameterUnknown):  # setting it gives a better error
            if isinstance(await parameters.get(name, timeout), float):
                value = float(value)
    await parameters.set(name, value, timeout)


def refusal(name: str, response: Any) -> tuple[str, str]:
    """Return the message about a service that refused, and the text of its response."""
    text = next((str(getattr(response, each)) for each in MESSAGES if getattr(response, each, "")), "")
    return f"service {name} refused{f': {text}' if text else ''}", text


def succeeded(client: Client, response: Any) -> bool:
    """Return whether a response has ``success: true``. Raises `RosError` if it has no such field."""
    success = getattr(response, "success", None)
    if success is None:
        known = ", ".join(field_names(response) or ()) or "none"
        raise RosError(
            f"service {client.name}: cannot check its success: the response has no field `success` (it has {known})"
        )
    return bool(success)
