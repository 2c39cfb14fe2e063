"""MCP over HTTP, at one address of the HTTP door, which has checked token, host and origin of each request."""

import asyncio
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from jacaros.runtime.mas.system import System
from jacaros.serving.callers import Caller
from jacaros.serving.crossing import Crossing
from jacaros.serving.remote import RemoteCallers
from jacaros.serving.service import service_of

if TYPE_CHECKING:
    from jacaros.serving.mcp.clients import Client

Scope = MutableMapping[str, Any]
App = Callable[[Scope, Any, Any], Awaitable[None]]
PATH = "/mcp"
LARGEST = 64 * 1024
"""Maximum size of the body of a request, in bytes."""
MOST_SESSIONS, IDLE = 256, 600.0
"""Maximum number of sessions, and seconds without a request after which one ends."""


class McpOverHttp:
    """Serves MCP to the callers of the HTTP door. All of it belongs to the loop of that door.

    Args:
        system: the run; already served.
        crossing: the way to it.
    """

    def __init__(self, system: System, crossing: Crossing) -> None:
        self._system, self._crossing = system, crossing
        self._clients = RemoteCallers(self._new)
        self._serving: asyncio.Task[None] | None = None
        self._inner: asyncio.Future[App] = asyncio.get_running_loop().create_future()

    async def __call__(self, scope: Scope, receive: Any, send: Any) -> None:
        """Answer a request (ASGI)."""
        if self._serving is None:
            self._serving = asyncio.create_task(self._serve())
        if not self._inner.done():
            await asyncio.wait((self._serving, self._inner), return_when=asyncio.FIRST_COMPLETED)
        if not self._inner.done():
            await self._serving  # raises why it does not serve, such as another version of the SDK
        inner = self._inner.result()
        with self._client(scope).present():
            await inner(scope, receive, send)

    async def __aenter__(self) -> "McpOverHttp":
        return self

    async def __aexit__(self, *_: object) -> None:
        """End all sessions."""
        if self._serving is not None:
            self._serving.cancel()
            await asyncio.wait({self._serving})

    async def _serve(self) -> None:
        # Imported at the first request: importing the SDK takes longer than starting a run.
        from mcp.server.streamable_http_manager import StreamableHTTPSessionManager

        from jacaros.serving.mcp.server import Context, McpServer

        def client_of(ctx: Context) -> "Client":
            assert ctx.request is not None, "each request comes over HTTP"
            return self._client(ctx.request.scope)

        server = McpServer(self._system.deployment.name, client_of).server
        manager = StreamableHTTPSessionManager(
            server, max_request_body_size=LARGEST, max_sessions=MOST_SESSIONS, session_idle_timeout=IDLE
        )
        async with manager.run():
            self._inner.set_result(manager.asgi_app)
            await self._clients.look()

    def _client(self, scope: Scope) -> "Client":
        from mcp.server.auth.middleware.bearer_auth import AuthenticatedUser
        from mcp.server.auth.provider import AccessToken

        caller = replace(scope["state"]["caller"], door="mcp")
        if "user" not in scope:  # the SDK binds a session to the user that has begun it
            scope["user"] = AuthenticatedUser(AccessToken(token="", client_id=caller.name, scopes=[]))
        return self._clients.of(caller)

    def _new(self, caller: Caller) -> "Client":
        from jacaros.serving.mcp.clients import Client

        return Client(caller, self._crossing, service_of(self._system))
