"""Limits of connections: their number, and the time for headers, requests and responses."""

import asyncio
import logging
from typing import Any

from uvicorn.protocols.http.auto import AutoHTTPProtocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from jacaros.serving.http.problems import problem

MOST_CONNECTIONS = 256
"""Maximum number of connections; a further one replaces the oldest that has not sent a request."""
HEADER_PATIENCE = 10.0
"""Seconds in which a connection must send the header of a request."""
LARGEST_HEADER = 16 * 1024
"""Maximum size of the header of a request, in bytes."""
WRITE_PATIENCE = 20.0
"""Seconds in which a client must accept data."""
_QUIET = logging.Logger("jacaros.http", logging.CRITICAL + 1)
"""Logs nothing: what strangers send does not belong in the output of a run."""


class _Impatient:
    """The part of a connection that aborts it when the client does not read."""

    transport: Any
    _unread: asyncio.TimerHandle | None = None

    def pause_writing(self) -> None:
        """Wait for the client, for a limited time."""
        super().pause_writing()  # type: ignore[misc]
        loop = asyncio.get_running_loop()
        self._unread = loop.call_later(WRITE_PATIENCE, self.transport.abort)

    def resume_writing(self) -> None:
        """The client has read."""
        super().resume_writing()  # type: ignore[misc]
        if self._unread is not None:
            self._unread.cancel()


class LimitedWebSocket(_Impatient, WebSocketsSansIOProtocol):
    """A WebSocket."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.logger = _QUIET


class LimitedConnection(_Impatient, AutoHTTPProtocol):  # type: ignore[valid-type,misc]
    """A connection for HTTP. With the package httptools, its parser takes 0.15 ms for a request instead of 0.35 ms.

    Args:
        idle: the connections that wait for the header of their first request, the oldest first.
    """

    connections: Any  # what both kinds of connections of uvicorn have
    scope: Any
    cycle: Any
    loop: Any

    def __init__(self, *arguments: Any, idle: "dict[LimitedConnection, None]", **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.logger = _QUIET
        self._idle = idle
        self._deadline: asyncio.TimerHandle | None = None
        self._header_size = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        self._idle[self] = None
        if len(self.connections) > MOST_CONNECTIONS:
            next(iter(self._idle)).transport.abort()
        self._look()

    def connection_lost(self, exc: Exception | None) -> None:
        self._idle.pop(self, None)
        self._stop()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        self._header_size = 0 if self._has_request() else self._header_size + len(data)
        if self._header_size > LARGEST_HEADER and not self.transport.is_closing():
            self.send_400_response("header too large")
        self._look()

    def _has_request(self) -> bool:
        """Return whether the header of a request has arrived; httptools makes the scope before that."""
        return self.scope is not None and "path" in self.scope

    def _look(self) -> None:
        """Limit the time until the next request, however slowly data arrives."""
        is_socket = self not in self.connections  # it has become a WebSocket
        if is_socket or self._has_request():
            self._idle.pop(self, None)
        if is_socket or (self._has_request() and (self.cycle is None or not self.cycle.response_complete)):
            self._stop()
        elif self._deadline is None:
            self._deadline = self.loop.call_later(HEADER_PATIENCE, self.transport.abort)

    def _stop(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def send_400_response(self, msg: str) -> None:
        """Answer what is not HTTP."""
        response = problem("malformed", msg.rstrip(".").lower())
        response.headers["Connection"] = "close"
        head = [b"HTTP/1.1 400 Bad Request", *(b"%s: %s" % each for each in response.raw_headers), b"", b""]
        self.transport.write(b"\r\n".join(head) + bytes(response.body))
        self.transport.close()
