"""The server of live pages: files over HTTP, records and commands over a WebSocket, on the loop of the run.

It uses no timer of the loop, which may run on the virtual clock: what needs real time waits for a `Beat`. The run waits for
no page. What a page does not take is dropped, see `Delivery`.
"""

import asyncio
import json
import logging
import socket
from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from http import HTTPStatus
from typing import Any, cast

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from jacaros.look.page.live.access import Access, Pages, security_headers
from jacaros.look.page.live.delivery import Delivery, json_text
from jacaros.look.page.live.live_view import LiveView
from jacaros.look.page.live.timing import Allowance, Allowances, Beat, metered
from jacaros.runtime.clock import real_time
from jacaros.serving.access import LOOPBACK, listening_socket

LIVE = "live"
"""Path of the WebSocket below the token."""
CONNECTIONS, PAGES = 64, 16
"""Maximum number of connections, and of pages among them."""
IDLE = 4 * CONNECTIONS
"""Maximum number of connections that have sent nothing yet: more than arrive before the first line of one is read."""
ADMITTED = 200
"""Connections per second: enough for a page to load its modules, and few enough for the run to keep its turns."""
_LONGEST_LINE = 4096
"""Maximum number of bytes of the first line of a request."""
LARGEST = 64 * 1024
"""Maximum size of a command, in bytes."""
RECEIVED = 100e6
"""Bytes of commands that the loop takes per second: that time counts for the budget of a page, too."""
BURST = 20
"""Commands of one page between two beats."""
PIECES = 6
"""Messages to one page between two beats while it receives the records so far."""
PATIENCE = 20.0
"""Seconds in which a page must accept a message."""
GOODBYE = 0.5
"""Seconds for the last messages and for closing."""
GARBAGE = 10
"""Number of unreadable commands after which a page is disconnected."""


def bound_socket(address: str = LOOPBACK, port: int = 0) -> socket.socket:
    """Return a listening socket for pages; port 0 selects a free port."""
    help = "choose another --view-port or --view-address"
    return listening_socket("the view", address, port, help, CONNECTIONS)


class LiveServer:
    """Serves pages until it is closed.

    Args:
        listening: listening socket.
        access: access rules.
        source: provides the records.

    Attributes:
        visitors: number of pages that have connected so far.
    """

    def __init__(self, listening: socket.socket, access: Access, source: LiveView) -> None:
        self._socket, self._access, self._source = listening, access, source
        self._pages = Pages()
        self._beat: Beat | None = None
        self._server: Server | None = None
        self._idle: dict[_Connection, None] = {}
        self._connections: dict[ServerConnection, None] = {}
        self._deliveries: dict[ServerConnection, Delivery] = {}
        self._allowances = Allowances()
        self.visitors = 0
        self._second = 0.0
        """Real time at which the counting of `_admitted` connections started."""
        self._admitted: Counter[bool] = Counter()
        """Accepted connections of this second, with and without the token."""

    @property
    def address(self) -> str:
        """Address of the page, with the token."""
        return address_of(self._socket, self._access)

    @property
    def complete(self) -> bool:
        """Whether all connected pages have received everything."""
        return all(each.complete for each in self._deliveries.values())

    async def start(self) -> None:
        """Begin to serve on the running loop."""
        self._beat = Beat()
        quiet = logging.Logger("jacaros.view", logging.CRITICAL + 1)  # do not log data of strangers
        self._server = await serve(
            self._talk,
            sock=self._socket,
            process_request=self._respond,
            create_connection=cast(Any, self._connection),  # any callable is accepted
            server_header=None,
            compression=None,
            open_timeout=None,
            ping_interval=None,
            close_timeout=None,
            max_size=LARGEST,
            max_queue=4,
            write_limit=LARGEST,
            logger=quiet,
        )

    async def close(self, patience: float = GOODBYE, visited: bool = False) -> None:
        """Send waiting records, then disconnect all pages.

        Args:
            patience: maximum seconds of real time for sending.
            visited: whether to wait that long for the first page, too.
        """
        server, beat = self._server, self._beat
        if server is None or beat is None:
            self._socket.close()
            return
        self._server = None
        until = real_time() + patience
        while real_time() < until and not (self.complete and (self.visitors or not visited)):
            await beat.next()
        until = real_time() + GOODBYE
        server.close()
        while self._connections and real_time() < until:
            await beat.next()
        for idle in tuple(self._idle):
            idle.drop()
        for connection in tuple(self._connections):
            self._disconnect(connection)
        await server.wait_closed()
        beat.close()

    def release(self) -> None:
        """Close the listening socket; closing twice is harmless."""
        self._socket.close()

    # ---- requests

    def _connection(self, *arguments: Any, **options: Any) -> ServerConnection:
        return _Connection(self, *arguments, **options)

    def idle(self, connection: "_Connection") -> None:
        """Register a connection that has sent nothing yet; if there are too many, drop the oldest."""
        self._idle[connection] = None
        if len(self._idle) > IDLE:
            next(iter(self._idle)).drop()

    def admits(self, connection: "_Connection", line: bytes) -> bool:
        """Return whether a connection that has sent its first line may be accepted now.

        Those without the token have a limit of their own: they cannot keep out a page that has it.
        """
        self._idle.pop(connection, None)
        now = real_time()
        if now - self._second >= 1.0:
            self._second = now
            self._admitted.clear()
        target = line.split(b" ")[1:2]
        known = bool(target) and self._access.path(target[0].decode("latin-1")) is not None
        self._admitted[known] += 1
        return self._admitted[known] <= ADMITTED

    def opened(self, connection: "_Connection") -> None:
        """Register an accepted connection; if there are too many, drop the oldest one that is not a page."""
        self._connections[connection] = None
        if len(self._connections) > CONNECTIONS:
            oldest = next((each for each in self._connections if each not in self._deliveries), connection)
            self._disconnect(oldest)

    def lost(self, connection: "_Connection") -> None:
        """Remove a closed connection."""
        self._idle.pop(connection, None)
        self._connections.pop(connection, None)

    def _disconnect(self, connection: ServerConnection) -> None:
        """Abort a connection without waiting for the other side."""
        if connection in self._connections:  # otherwise its transport is already closed
            connection.transport.abort()

    def _respond(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return the response to a request; None opens the WebSocket."""
        hosts = request.headers.get_all("Host")
        if not self._access.knows_host(hosts):
            return _response(HTTPStatus.FORBIDDEN, {})
        headers = security_headers(hosts[0], self._access.framed)
        if not self._access.knows_origin(request.headers.get_all("Origin"), hosts[0]):
            return _response(HTTPStatus.FORBIDDEN, headers)
        path = self._access.path(request.path)
        if path is None:
            return _response(HTTPStatus.NOT_FOUND, headers)
        if path == LIVE and request.headers.get("Upgrade", "").lower() == "websocket":
            full = len(self._deliveries) >= PAGES
            return _response(HTTPStatus.SERVICE_UNAVAILABLE, headers) if full else None
        if not path and not request.path.partition("?")[0].endswith("/"):
            return _response(HTTPStatus.MOVED_PERMANENTLY, {**headers, "Location": f"/{self._access.token}/"})
        found = self._pages.find(path)
        if found is None:
            return _response(HTTPStatus.NOT_FOUND, headers)
        kind, content = found
        return _response(HTTPStatus.OK, {**headers, "Content-Type": kind}, content)

    # ---- pages

    async def _talk(self, connection: ServerConnection) -> None:
        """Send records to a page and execute its commands until it disconnects."""
        delivery = self._deliveries[connection] = self._source.begin()
        self.visitors += 1
        allowance = self._allowances.begin()
        sending = asyncio.create_task(self._send(connection, delivery))
        try:
            await self._listen(connection, delivery, allowance)
        except ConnectionClosed:
            pass
        finally:
            self._allowances.end(allowance)
            self._source.end(delivery)
            del self._deliveries[connection]
            sending.cancel()
            self._disconnect(connection)

    async def _send(self, connection: ServerConnection, delivery: Delivery) -> None:
        assert self._beat is not None
        sent = 0
        with suppress(ConnectionClosed):
            while True:
                await delivery.arrived.wait()
                message = delivery.take()
                if message is not None:
                    await self._within_patience(connection, message)
                    sent += 1
                if message is None or sent >= PIECES or delivery.complete:
                    sent = 0
                    await self._beat.next()

    async def _within_patience(self, connection: ServerConnection, message: str) -> None:
        """Send a message; disconnect a page that accepts nothing for `PATIENCE` seconds."""
        assert self._beat is not None
        sending = asyncio.create_task(connection.send(message))
        sending.add_done_callback(_retrieve)
        await asyncio.sleep(0)
        until = real_time() + PATIENCE
        try:
            while not sending.done():
                if real_time() > until:
                    self._disconnect(connection)
                await self._beat.next()
        finally:
            sending.cancel()
        sending.result()

    async def _listen(self, connection: ServerConnection, delivery: Delivery, allowance: Allowance) -> None:
        """Execute the commands of a page within its budget; commands that wait do not block later ones."""
        assert self._beat is not None
        garbage = count = 0
        running: set[asyncio.Task[None]] = set()
        try:
            async for message in connection:
                command = _command(message)
                garbage += command is None
                if garbage >= GARBAGE:
                    self._disconnect(connection)
                    return
                work = metered(self._reply(connection, delivery, command), allowance.spend)
                task = asyncio.create_task(work)  # pyright: ignore[reportArgumentType] - a generator is one, too
                running.add(task)
                task.add_done_callback(running.discard)
                count += 1
                allowance.spend(len(message) / RECEIVED)
                await asyncio.sleep(0)  # the command's first turn, which costs what is to be paid
                while connection in self._connections and (
                    count % BURST == 0 or len(running) >= BURST or allowance.is_used_up
                ):
                    await self._beat.next()
                    count += 1
        finally:
            for task in running:
                task.cancel()

    async def _reply(
        self, connection: ServerConnection, delivery: Delivery, command: Mapping[str, Any] | None
    ) -> None:
        reply: Mapping[str, Any] = {"kind": "reply", "id": None, "ok": False, "error": "unreadable command"}
        if command is not None:
            reply = await self._source.answer(delivery, command)
        with suppress(ConnectionClosed):
            await connection.send(json_text(reply))


class _Connection(ServerConnection):
    """A connection registered with the server from its beginning, and accepted when its first line has come."""

    def __init__(self, pages: LiveServer, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._pages_server = pages
        self._first = b""
        self._is_accepted = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Wait for the first line: a connection that sends nothing costs little."""
        self._opened_transport = cast(asyncio.Transport, transport)
        self._pages_server.idle(self)

    def drop(self) -> None:
        self._pages_server.lost(self)
        self._opened_transport.abort()

    def data_received(self, data: bytes) -> None:
        """Receive data; with the first line, start, or abort if there are too many connections."""
        if self._is_accepted:
            super().data_received(data)
            return
        self._first += data
        line, end, _ = self._first.partition(b"\n")
        if not end and len(line) < _LONGEST_LINE:
            return
        if not self._pages_server.admits(self, line):
            self.drop()
            return
        self._is_accepted = True
        super().connection_made(self._opened_transport)
        self._pages_server.opened(self)
        super().data_received(self._first)

    def eof_received(self) -> None:
        """End a connection that ends before its first line."""
        if self._is_accepted:
            super().eof_received()

    def connection_lost(self, exc: Exception | None) -> None:
        self._pages_server.lost(self)
        if self._is_accepted:
            super().connection_lost(exc)


def _retrieve(task: asyncio.Task[None]) -> None:
    """Retrieve the exception of a task, so that asyncio does not log it as unhandled."""
    if not task.cancelled():
        task.exception()


def address_of(listening: socket.socket, access: Access) -> str:
    """Return the address of a page, with the token."""
    host, port = listening.getsockname()[:2]
    if host in ("0.0.0.0", "::"):
        host = socket.gethostname()
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/{access.token}/"


def _response(status: HTTPStatus, headers: Mapping[str, str], content: bytes | None = None) -> Response:
    if content is None:
        content = f"{status.value} {status.phrase}\n".encode()
        headers = {"Content-Type": "text/plain; charset=utf-8", **headers}
    fields = {**headers, "Content-Length": str(len(content)), "Connection": "close"}
    return Response(status.value, status.phrase, Headers(fields), content)


def _command(message: str | bytes) -> Mapping[str, Any] | None:
    """Return the command in a message, None if it is unreadable."""
    try:
        command = json.loads(message)
    except (ValueError, RecursionError):
        return None
    return command if isinstance(command, dict) else None
