"""MCP over HTTP, at one address of the HTTP door, which has checked token, host and origin of each request."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, MutableMapping
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from dataclasses import replace
from typing import Any

from jacaros.runtime.mas.system import System
from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.crossing import Crossing
from jacaros.serving.service import service_of

Scope = MutableMapping[str, Any]
App = Callable[[Scope, Any, Any], Awaitable[None]]
PATH = "/mcp"
LEASE = 15.0
"""Seconds after the end of its last request or stream when a caller counts as gone."""
LARGEST = 64 * 1024
"""Maximum size of the body of a request, in bytes."""
MOST_SESSIONS, IDLE = 256, 600.0
"""Maximum number of sessions, and seconds without a request after which one ends."""


def mcp_app(system: System) -> Callable[[Crossing], AbstractAsyncContextManager[App]]:
    """Return what makes the application, on the loop of the HTTP door.

    Args:
        system: the run; already started.
    """

    @asynccontextmanager
    async def made(crossing: Crossing) -> AsyncIterator[App]:
        door = McpOverHttp(system, crossing)
        try:
            yield door
        finally:
            await door.close()

    return made


class McpOverHttp:
    """Serves MCP to the callers of the HTTP door. All of it belongs to the loop of that door.

    Args:
        system: the run.
        crossing: the way to it.
    """

    def __init__(self, system: System, crossing: Crossing) -> None:
        self._name, self._service, self._crossing = system.deployment.name, service_of(system), crossing
        self._clients: dict[Caller, Any] = {}
        self._serving: asyncio.Task[None] | None = None
        self._inner: asyncio.Future[App] = asyncio.get_running_loop().create_future()

    async def __call__(self, scope: Scope, receive: Any, send: Any) -> None:
        """Answer a request (ASGI)."""
        if self._serving is None:
            self._serving = asyncio.create_task(self._serve())
        inner = await asyncio.shield(self._inner)
        client = self._client(scope)
        client.came()
        try:
            await inner(scope, receive, send)
        finally:
            client.went()

    async def close(self) -> None:
        """End all sessions."""
        if self._serving is not None:
            self._serving.cancel()
            await asyncio.wait({self._serving})

    async def _serve(self) -> None:
        # Imported at the first request: importing the SDK takes longer than starting a run.
        from mcp.server.streamable_http_manager import StreamableHTTPSessionManager

        from jacaros.serving.mcp.server import Context, McpServer

        def client_of(ctx: Context) -> Any:
            assert ctx.request is not None, "each request comes over HTTP"
            return self._client(ctx.request.scope)

        server = McpServer(self._name, client_of).server
        manager = StreamableHTTPSessionManager(
            server, max_request_body_size=LARGEST, max_sessions=MOST_SESSIONS, session_idle_timeout=IDLE
        )
        async with manager.run():
            self._inner.set_result(manager.asgi_app)
            while True:
                await asyncio.sleep(LEASE / 10)
                await self._end_sessions()

    async def _end_sessions(self) -> None:
        """End the sessions of callers that are gone."""
        for client in tuple(self._clients.values()):
            if client.is_gone(LEASE):
                del self._clients[client.caller]
                with suppress(RequestError):
                    await client.leave()

    def _client(self, scope: Scope) -> Any:
        from mcp.server.auth.middleware.bearer_auth import AuthenticatedUser
        from mcp.server.auth.provider import AccessToken

        from jacaros.serving.mcp.clients import Client

        caller = replace(scope["state"]["caller"], door="mcp")
        if "user" not in scope:  # the SDK binds a session to the user that has begun it
            scope["user"] = AuthenticatedUser(AccessToken(token="", client_id=caller.name, scopes=[]))
        if caller not in self._clients:
            self._clients[caller] = Client(caller, self._crossing, self._service)
        return self._clients[caller]
