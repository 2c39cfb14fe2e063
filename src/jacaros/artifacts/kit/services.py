"""Services that an artifact calls, and services and actions that it offers.

What ends a call without a response is one of these reasons; a plan gets them as ``env_failure_reason(R)``:

============================  ======================================================================================
R                             what happened
============================  ======================================================================================
service_unavailable(Name)     nobody offers the service
service_timeout(S)            the server is there, but did not answer within S seconds
service_failed(Name)          the server failed, or the connection to it broke
refused(Text)                 it answered ``success: false``, where the operation takes that for a failure
============================  ======================================================================================

Requests of others are carried out as internal operations of the artifact.

What comes from the graph takes turns with the operations of agents: its steps change properties, send signals and wait, and
a step that fails is undone.  Whatever becomes of it, its client gets an answer:

=====================  ==========================================  ====================================================
how it ends            client of a service                         client of an action
=====================  ==========================================  ====================================================
well                   the response that was set                   succeeded, with the result that was set
``self.fail(Text)``    ``success: false`` and ``message: Text``,   aborted, with this text; the result's ``error_code``
                       or a failed call without such fields        is that of the reason ``aborted(Code)``
client cancels                                                     canceled, when ``finally`` has run
artifact disposed      a failed call                               aborted
=====================  ==========================================  ====================================================
"""

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from jacaros.env.ids import ArtifactId
from jacaros.env.kernel.declaration import DeclaredOperation
from jacaros.env.kernel.steps import Steps
from jacaros.env.operation import OperationOutcome, OperationRequest
from jacaros.env.values import Atom, Structure
from jacaros.ros.action import Abort, ServerGoal
from jacaros.ros.backend import Backend, Client, Handler
from jacaros.ros.errors import CallTimedOut, RosError, ServiceError, ServiceUnavailable
from jacaros.ros.message import field_names
from jacaros.ros.names import response_type, result_type

ABORTED = "aborted"
"""Functor of the failure reason whose first argument is the result's ``error_code``."""


class RequestFailed(Exception):
    """The operation that was to serve a request failed; the text says why."""


class Reply:
    """What the client of a request gets when it has been served.

    Attributes:
        message: the response or result; None for one with its defaults.
    """

    def __init__(self, ros: Backend, type_name: str) -> None:
        self._ros, self._type_name = ros, type_name
        self.message: Any = None

    def set(self, message: Any = None, /, **fields: Any) -> None:
        """Give a message, or the fields of one; a later call replaces it.

        Raises:
            MessageMismatch: a field is unknown, or its value does not fit.
        """
        self.message = message if message is not None else self._ros.message(self._type_name, **fields)


class ServedOperation:
    """A service or action of an artifact whose requests one of its operations serves.

    Args:
        ros: the middleware.
        steps: the operations of the artifact.
        artifact: its id.
        declared: the operation; it takes a request (of an action: the goal) and a `Reply`.
    """

    def __init__(self, ros: Backend, steps: Steps, artifact: ArtifactId, declared: DeclaredOperation) -> None:
        self._ros, self._steps, self._artifact, self._declared = ros, steps, artifact, declared

    def handler(self, type_name: str) -> Handler:
        """What the middleware calls for each request of a service."""
        response = response_type(type_name)
        fields = self._ros.fields(response)

        async def handle(request: Any) -> Any:
            reply = Reply(self._ros, response)
            outcome = await self._serve(request, reply)
            if outcome.ok:
                return reply.message
            text = outcome.message or "it failed"
            if "success" in fields and fields["success"].base == "bool":
                return {"success": False, **({"message": text} if "message" in fields else {})}
            raise RequestFailed(text)

        return handle

    def execute(self, type_name: str) -> Callable[[ServerGoal], Awaitable[Any]]:
        """What the middleware calls for each goal of an action."""
        result = result_type(type_name)
        has_code = "error_code" in self._ros.fields(result)

        async def carry_out(goal: ServerGoal) -> Any:
            reply = Reply(self._ros, result)
            outcome = await self._serve(goal, reply)
            if outcome.ok:
                return reply.message
            code = _code(outcome.reason) if has_code else None
            raise Abort(outcome.message or "it failed", None if code is None else {"error_code": code})

        return carry_out

    async def _serve(self, request: object, reply: Reply) -> OperationOutcome:
        """Carry the operation out; cancelling this cancels it, and is over when its ``finally`` has run."""
        done: asyncio.Future[OperationOutcome] = asyncio.get_running_loop().create_future()

        def report(outcome: OperationOutcome) -> None:
            if not done.done():
                done.set_result(outcome)

        wanted = OperationRequest(self._artifact, self._declared.name, (request, reply), None, on_done=report)
        execution = self._steps.start(self._declared, wanted)
        if execution is None:
            raise RequestFailed(f"artifact {self._artifact.name} takes no requests any more")
        try:
            return await done
        except asyncio.CancelledError:
            execution.cancel()
            if execution.task is not None:
                await asyncio.wait((execution.task,))
            raise


def _code(reason: object) -> int | None:
    """The number in a reason such as ``aborted(203)``."""
    if isinstance(reason, Structure) and reason.functor == ABORTED and reason.arguments:
        code = reason.arguments[0]
        if isinstance(code, int) and not isinstance(code, bool):
            return code
    return None


MESSAGES = ("message", "status_message", "error_msg", "error_message")
"""Fields in which responses say in words why they refuse."""


class CallFailure(Exception):
    """A call had no response that counts.

    Attributes:
        functor, arguments: the failure reason, such as ``service_timeout(2)``.
    """

    def __init__(self, message: str, functor: str, *arguments: object) -> None:
        super().__init__(message)
        self.functor, self.arguments = functor, arguments


async def call(client: Client, timeout: float, fields: Mapping[str, Any], must_succeed: bool) -> Any:
    """Call a service and give its response.

    Args:
        client: of the service.
        timeout: seconds for waiting for the server and for the answer together.
        fields: of the request.
        must_succeed: take ``success: false`` in the response for a failure.

    Raises:
        CallFailure: with one of the reasons of this file.
        RosError: the request does not fit the service, or its responses have no field ``success``.
    """
    name = Atom(client.name.lstrip("/"))
    try:
        response = await client.call(fields, timeout)
    except ServiceUnavailable as error:
        raise CallFailure(str(error), "service_unavailable", name) from None
    except CallTimedOut as error:
        raise CallFailure(str(error), "service_timeout", timeout) from None
    except ServiceError as error:
        raise CallFailure(str(error), "service_failed", name) from None
    if must_succeed and not succeeded(client, response):
        text = next((str(getattr(response, each)) for each in MESSAGES if getattr(response, each, "")), "")
        told = f": {text}" if text else ""
        raise CallFailure(f"service {client.name} refused{told}", "refused", text)
    return response


def succeeded(client: Client, response: Any) -> bool:
    """Whether a response says ``success: true``; raises `RosError` when it says nothing about that."""
    success = getattr(response, "success", None)
    if success is None:
        known = ", ".join(field_names(response) or ()) or "none"
        raise RosError(
            f"service {client.name} cannot be told to have succeeded: its response has no field success (it has {known})"
        )
    return bool(success)
