"""One call of a service as one step of a plan.

What ends it without a response is one of these reasons; a plan gets them as ``env_failure_reason(R)``:

============================  ======================================================================================
R                             what happened
============================  ======================================================================================
service_unavailable(Name)     nobody offers the service
service_timeout(S)            the server is there, but did not answer within S seconds
service_failed(Name)          the server failed, or the connection to it broke
refused(Text)                 it answered ``success: false``, where the operation takes that for a failure
============================  ======================================================================================
"""

from collections.abc import Mapping
from typing import Any

from jacaros.env.values import Atom
from jacaros.ros.backend import Client
from jacaros.ros.errors import CallTimedOut, RosError, ServiceError, ServiceUnavailable
from jacaros.ros.message import field_names

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
