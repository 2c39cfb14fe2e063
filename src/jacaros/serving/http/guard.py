"""Who may pass: host, origin and token of each request; and the size of its body."""

import asyncio
import json
from collections.abc import Callable
from typing import Any, NoReturn

from starlette.datastructures import Headers
from starlette.requests import ClientDisconnect, HTTPConnection, Request
from starlette.types import ASGIApp, Receive, Scope, Send

from jacaros.serving.access import Hosts
from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.http.problems import of_error
from jacaros.serving.tokens import Tokens

LARGEST = 64 * 1024
"""Maximum size of the body of a request, in bytes."""
BODY_PATIENCE = 10.0
"""Seconds in which the body of a request must arrive."""


class Guard:
    """Passes requests of known callers to an application.

    Args:
        app: the application; `caller_of` returns who calls it.
        hosts: host names and origins that requests may name.
        tokens: who may call.
        report: called with each exception that is a defect.
    """

    def __init__(
        self, app: ASGIApp, hosts: Hosts, tokens: Tokens, report: Callable[[Exception], object]
    ) -> None:
        self._app, self._hosts, self._tokens, self._report = app, hosts, tokens, report

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        try:
            scope.setdefault("state", {})["caller"] = self._admit(scope)
        except RequestError as error:
            await of_error(error)(scope, receive, send)
            return
        try:
            await self._app(scope, receive, send)
        except ClientDisconnect:
            pass
        except Exception as error:
            self._report(error)

    def _admit(self, scope: Scope) -> Caller:
        """Return who sends a request.

        Raises:
            RequestError: the token is unknown, or the request names a foreign host or origin.
        """
        headers = Headers(scope=scope)
        hosts = headers.getlist("host")
        if not self._hosts.knows_host(hosts):
            raise RequestError(
                "foreign_host", "unknown name in the header Host; to serve under it: --serve NAME:PORT"
            )
        if not self._hosts.knows_origin(headers.getlist("origin"), hosts[0]):
            raise RequestError("foreign_origin", "the header Origin names another site")
        kind, _, token = headers.get("authorization", "").partition(" ")
        if not token and scope["path"] == "/events":  # browsers send no header with event streams
            kind, token = "bearer", HTTPConnection(scope).query_params.get("access_token", "")
        caller = self._tokens.caller(token.strip(), "http") if kind.lower() == "bearer" else None
        if caller is None:
            told = "unknown token" if token else "send the header `Authorization: Bearer TOKEN`"
            raise RequestError("unauthorized", told)
        return caller


def caller_of(connection: HTTPConnection[Any]) -> Caller:
    """Return who sends a request."""
    caller: Caller = connection.scope["state"]["caller"]
    return caller


async def arguments_of(request: Request) -> dict[str, Any]:
    """Return the JSON object in the body of a request; an empty one without a body.

    Raises:
        RequestError: the body is too large or too slow, or is something else.
    """
    body = bytearray()
    try:
        async with asyncio.timeout(BODY_PATIENCE):
            async for piece in request.stream():
                body += piece
                if len(body) > LARGEST:
                    raise RequestError("too_large", f"a body has more than {LARGEST} bytes")
    except TimeoutError:
        raise RequestError("malformed", f"the body did not arrive within {BODY_PATIENCE:g} s") from None
    try:
        found = json.loads(body, parse_constant=_refuse) if body.strip() else {}
    except (ValueError, RecursionError) as error:
        told = "nested too deeply" if isinstance(error, RecursionError) else str(error)[:200]
        raise RequestError("malformed", f"the body is not JSON: {told}") from None
    if not isinstance(found, dict):
        raise RequestError("malformed", "the body must be a JSON object of arguments by name")
    return found


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is not a number in JSON")
