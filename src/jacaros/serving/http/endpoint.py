"""A resource as an application of its own: it answers each of its methods, and turns errors into problem documents."""

from collections.abc import Awaitable, Callable

from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocketClose

from jacaros.serving.callers import RequestError
from jacaros.serving.http.problems import of_error, problem

Answer = Callable[[Request], Awaitable[Response]]


class Endpoint:
    """Answers the requests of one path (ASGI).

    Args:
        methods: what answers each method; that of GET answers HEAD, too.
    """

    def __init__(self, **methods: Answer) -> None:
        self._methods = methods

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        request = Request(scope, receive)
        try:
            response = await self._answer(request)
        except RequestError as error:
            response = of_error(error)
        except ClientDisconnect:
            return
        except Exception:
            response = problem("internal_error", "a defect of JaCaROS; its log has the details")
            await response(scope, receive, send)
            raise  # to the log
        await response(scope, receive, send)

    async def _answer(self, request: Request) -> Response:
        method = "GET" if request.method == "HEAD" else request.method
        if method in self._methods:
            return await self._methods[method](request)
        found = problem("method_not_allowed", f"{request.method} is not a method of {request.url.path[:200]}")
        found.headers["Allow"] = ", ".join(self._methods)
        return found


async def unknown(scope: Scope, receive: Receive, send: Send) -> None:
    """Answer a request for an unknown path."""
    if scope["type"] == "websocket":
        await WebSocketClose()(scope, receive, send)
    else:
        await problem("unknown_path", f"no resource {scope['path'][:200]}")(scope, receive, send)
