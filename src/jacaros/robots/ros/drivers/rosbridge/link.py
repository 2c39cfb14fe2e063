"""The connection to a rosbridge server, on the loop: made, monitored, and made again whenever it is lost.

The loop reads. Any thread can write: the exit hooks, which stop the robot, run in a thread if the loop is stuck or
has ended, and their messages must leave nevertheless. So frames do not use asyncio's transport, whose buffer only the
loop empties. They are written to the socket directly, under a lock that no sender waits for.

A link is up while the server answers pings: a robot that drove out of range closes no connection.
"""

import asyncio
import contextlib
import json
import selectors
import socket
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any, cast

import cbor2
from websockets.exceptions import WebSocketException

from jacaros.robots.ros.handoff import post
from jacaros.robots.ros.protocols.rosbridge_wire import Wire, address

FIRST_PAUSE, LONGEST_PAUSE, GROWTH = 0.25, 2.0, 1.7
"""Seconds between two attempts to connect: the first, the maximum, and the factor between them."""
CONNECTING = 4.0
"""Seconds after which an attempt is cancelled: a network that drops packets reports nothing for minutes."""
PING_EVERY, PING_PATIENCE = 1.0, 4.0
"""Seconds between pings, and for the answer."""
BACKLOG = 4_000_000
"""Bytes that may wait for a slow network; later messages are dropped, because they would arrive too late anyway."""
TRY_AGAIN = 0.002
"""Seconds until data that a slow network did not accept is offered again."""
LAST_MESSAGE = 0.5
"""Seconds that a thread other than the loop's waits for the network to accept a message: no other thread offers it
again."""
LARGEST = 10_000_000
"""Bytes of a message; servers close the connection at a longer one (their parameter ``max_message_size``)."""
SENDING, DOING = 0.5, 1.0
"""Seconds that closing waits for the last messages to leave, and for the server to process them."""
GOODBYE = 0.5
"""Seconds for the server to close the connection after our close frame."""


class RosbridgeConnection(asyncio.Protocol):
    """One connection.

    Args:
        url: address of the server.
        on_message: called with each message, and whether it is binary.
    """

    def __init__(self, url: str, on_message: Callable[[bytes, bool], None]) -> None:
        self._loop = asyncio.get_running_loop()
        self._home = threading.get_ident()
        self._wire = Wire(url)
        self._on_message = on_message
        self._queued: deque[bytes] = deque()
        self._output = bytearray()
        self._lock = threading.Lock()
        """Held for reading and writing, never during a wait. Only readers wait for it."""
        self._retrying = False
        self._transport: asyncio.Transport | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._ping_sent: float | None = None
        self.opened: asyncio.Future[None] = self._loop.create_future()
        self.ended: asyncio.Future[None] = self._loop.create_future()
        self.over = False
        """Whether nothing can be read any longer."""

    @property
    def backlog(self) -> int:
        """Number of bytes that wait for the network."""
        return len(self._output)

    @property
    def is_open(self) -> bool:
        """Whether messages can be sent."""
        return not self.over and self._wire.opened

    # asyncio's interface:

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast(
            "asyncio.Transport", transport
        )  # those of the proactor loop are of another class
        self._socket: socket.socket = transport.get_extra_info("socket").dup()
        self._push()

    def data_received(self, data: bytes) -> None:
        self._ping_sent = None
        self._take(data, self._on_message)
        if not self.opened.done() and self._wire.opened:
            self.opened.set_result(None)
            self._ping_later()
        elif not self.opened.done() and self._wire.failure is not None:
            self.drop()

    def connection_lost(self, exc: Exception | None) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._lose()
        if not self.opened.done():
            self.opened.set_exception(exc or self._wire.failure or ConnectionError("closed by the server"))
        self.ended.set_result(None)

    # Interface for the link:

    def send(self, text: bytes) -> None:
        """Send a message, from any thread and even in a signal handler."""
        self._queued.append(text)
        if not self._push() and threading.get_ident() != self._home:
            self.flush(LAST_MESSAGE)

    def flush(self, seconds: float) -> None:
        """Wait until all sent data has left the process; blocks."""
        deadline = time.monotonic() + seconds
        while not self._push() and time.monotonic() < deadline:
            time.sleep(TRY_AGAIN)

    def close(self) -> None:
        """Send the close frame after the pending messages; from any thread."""
        with self._lock:
            while self._queued:
                self._wire.send(self._queued.popleft())
            self._wire.close()
        self.flush(LAST_MESSAGE)

    def drop(self) -> None:
        """End the connection, from any thread."""
        if self._transport is None:
            return
        if not (self._loop.is_running() and post(self._loop, self._transport.abort)):
            with contextlib.suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)
            self._lose()

    def wait(
        self, done: Callable[[], object], seconds: float, on_message: Callable[[bytes, bool], object]
    ) -> None:
        """Block until *done* returns True or the connection is lost.

        The loop reads meanwhile, in its thread; if it has ended, this thread reads in its place.
        """
        deadline = time.monotonic() + seconds
        while not (done() or self.over) and (rest := deadline - time.monotonic()) > 0.0:
            if self._loop.is_running():
                time.sleep(min(rest, TRY_AGAIN))
            else:
                self._read_here(min(rest, 0.1), on_message)

    def _lose(self) -> None:
        with self._lock:
            self.over = True
            self._output.clear()
            self._socket.close()

    def _read_here(self, seconds: float, on_message: Callable[[bytes, bool], object]) -> None:
        self._push()
        with selectors.DefaultSelector() as selector:
            selector.register(self._socket, selectors.EVENT_READ)
            if not selector.select(seconds):
                return
        try:
            data = self._socket.recv(262144)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if data:
            self._take(data, on_message)
        else:
            self.over = True

    def _take(self, data: bytes, on_message: Callable[[bytes, bool], object]) -> None:
        try:
            with self._lock:
                messages = self._wire.feed(data)
        except OSError:  # of TLS
            self.drop()
            return
        self._push()
        for payload, binary in messages:
            on_message(payload, binary)

    def _push(self) -> bool:
        """Write what the network accepts now; return False if data must wait.

        A thread that finds the lock taken returns: its holder checks again for data queued meanwhile.
        """
        while self._lock.acquire(blocking=False):
            try:
                sent = self._write()
            finally:
                self._lock.release()
            if not sent:
                if not self._retrying:
                    self._retrying = post(self._loop, self._loop.call_later, TRY_AGAIN, self._push_again)
                return False
            if not self._queued:
                break
        return True

    def _push_again(self) -> None:
        self._retrying = False
        self._push()

    def _write(self) -> bool:
        while self._queued:
            self._wire.send(self._queued.popleft())
        self._output += self._wire.output()
        try:
            while self._output:
                del self._output[: self._socket.send(self._output)]
        except (BlockingIOError, InterruptedError):
            return False
        except OSError:  # the reader also detects it
            self._output.clear()
        return True

    def _ping_later(self) -> None:
        self._timer = self._loop.call_later(PING_EVERY, self._ping)

    def _ping(self) -> None:
        now = self._loop.time()
        if self._ping_sent is None:
            self._ping_sent = now
            with self._lock:
                self._wire.ping()
            self._push()
        elif now - self._ping_sent > PING_PATIENCE:
            self.drop()
            return
        self._ping_later()


class RosbridgeLink:
    """A connection that is made again whenever it is lost.

    Args:
        url: address of the server, ``ws://robot.lab.example:9090``.
        on_up: called on the loop when the connection is made.
        on_down: called there when it is lost, and when an attempt has failed.
        on_message: called there with each message of the server.
        on_problem: called, from any thread, with a line about an invalid message.
    """

    def __init__(
        self,
        url: str,
        on_up: Callable[[], None],
        on_down: Callable[[], None],
        on_message: Callable[[dict[str, Any]], None],
        on_problem: Callable[[str], None],
    ) -> None:
        self._url = url
        self._on_up = on_up
        self._on_down = on_down
        self._on_message = on_message
        self._on_problem = on_problem
        self._loop: asyncio.AbstractEventLoop | None = None
        self._work: asyncio.Task[None] | None = None
        self._connection: RosbridgeConnection | None = None
        self._awaited: str | None = None
        """The id of the last question until its answer has arrived."""

    @property
    def up(self) -> bool:
        """Whether there is a connection."""
        return self._connection is not None

    def start(self) -> None:
        """Start connecting; on the loop."""
        self._loop = asyncio.get_running_loop()
        self._work = self._loop.create_task(self._keep_connected())

    def stop(self) -> None:
        """Stop connecting; on the loop."""
        self._connection = None
        if self._work is not None:
            self._work.cancel()

    def send(self, message: dict[str, Any], droppable: bool = False) -> bool:
        """Send *message*, from any thread. Return False if it is lost: there is no connection, or it is too large.

        Args:
            message: an operation of the protocol.
            droppable: also drop it if too much data is already waiting.
        """
        connection = self._connection
        if connection is None or (droppable and connection.backlog > BACKLOG):
            return False
        frame = json.dumps(message, separators=(",", ":")).encode()
        if len(frame) > LARGEST:
            return False
        connection.send(frame)
        return self._connection is connection

    def finish(self, question: dict[str, Any]) -> None:
        """Send *question*, whose answer shows that everything before it is done, and close; blocks, on any thread but
        the loop's."""
        connection = self._connection
        if connection is not None:
            self._awaited = question["id"]
            self.send(question)
            connection.wait(lambda: self._awaited is None, DOING, self._operation)
            connection.flush(SENDING)
            connection.close()
            connection.wait(lambda: False, GOODBYE, lambda payload, binary: None)
            connection.drop()
        if self._loop is not None:
            post(self._loop, self.stop)

    def received(self, payload: bytes, binary: bool) -> None:
        """Handle a message of the server; on the loop."""
        operation = self._operation(payload, binary)
        if operation is not None:
            self._on_message(operation)

    def _operation(self, payload: bytes, binary: bool) -> dict[str, Any] | None:
        """Decode a message, JSON or, if binary, CBOR; None if there is nothing for the loop."""
        try:
            message: Any = cbor2.loads(payload) if binary else json.loads(payload)
            if not isinstance(message["op"], str):
                return None
            if self._awaited is not None and message.get("id") == self._awaited:
                self._awaited = None
                return None
        except Exception as problem:
            # An invalid CBOR message may contain dates, fractions, expressions: each raises errors of its own.
            told = f"{type(problem).__name__}: {str(problem)[:80]}"
            self._on_problem(f"ignored an invalid frame of the rosbridge server: {payload[:80]!r} ({told})")
            return None
        operation: dict[str, Any] = message
        return operation

    async def _keep_connected(self) -> None:
        pause = FIRST_PAUSE
        while True:
            connection = await self._connect()
            if connection is not None:
                pause = FIRST_PAUSE
                self._connection = connection
                self._on_up()
                # The end of a program may cancel this task before the exit hooks run: they need the connection.
                await asyncio.shield(connection.ended)
                self._connection = None
            self._on_down()
            await asyncio.sleep(pause)
            pause = min(pause * GROWTH, LONGEST_PAUSE)

    async def _connect(self) -> RosbridgeConnection | None:
        host, port = address(self._url)
        connection = RosbridgeConnection(self._url, self.received)
        try:
            async with asyncio.timeout(CONNECTING):
                loop = asyncio.get_running_loop()
                await loop.create_connection(lambda: connection, host, port)
                await connection.opened
            return connection
        except (OSError, UnicodeError, WebSocketException):
            return None
        finally:
            if not connection.is_open:
                connection.drop()
