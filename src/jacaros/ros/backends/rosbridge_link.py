"""The WebSocket to a rosbridge server, through roslibpy's asyncio transport: connecting, and connecting again.

roslibpy brings two transports.  Twisted's reactor is one for the process and cannot be started twice; asyncio's loop is
one more loop, in a daemon thread that roslibpy keeps, and touches no signal handlers.  Both were as fast in measurements
(docs/decisions).  Of roslibpy's classes the connection is used, below its ``Ros`` and ``Topic``: those tell nothing of
messages lost while the link is down, know no actions of a server's side, and call back without an order of shutting down.

A link is up while the server answers pings: a robot that drove out of reach closes no connection.
"""

import asyncio
import json
import logging
import threading
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

import cbor2
from roslibpy.comm.comm_asyncio import (  # type: ignore[import-untyped]
    AsyncioRosBridgeClientFactory,
    AsyncioRosBridgeProtocol,
)

from jacaros.errors import UsageError
from jacaros.ros.backends.rosbridge_fragments import Fragments, frames

FIRST_PAUSE, LONGEST_PAUSE = 0.25, 2.0
"""Seconds between two attempts to connect: at first, and at most."""
CONNECTING = 4.0
"""Seconds after which an attempt is given up: a network that swallows packets says nothing for minutes."""
PING_EVERY, PING_PATIENCE = 1.0, 4.0
"""Seconds between pings, and for the answer."""
BACKLOG = 4_000_000
"""Bytes that may wait for a slow network; what is published beyond is dropped, for it would arrive too late anyway."""


class _Protocol(AsyncioRosBridgeProtocol):  # type: ignore[misc]
    """One connection; all but ``send_message`` and ``backlog`` is called on roslibpy's thread."""

    factory: "_Factory"
    transport: Any

    def __init__(self) -> None:
        super().__init__()
        self._handed_over = 0
        self._lock = threading.Lock()

    def send_message(self, payload: bytes) -> None:
        self._count(len(payload))
        super().send_message(payload)

    def _send(self, payload: bytes) -> None:
        self._count(-len(payload))
        super()._send(payload)

    def _count(self, size: int) -> None:
        with self._lock:
            self._handed_over += size

    def onMessage(self, payload: bytes, isBinary: bool) -> None:  # noqa: N802, N803
        self.factory.link.received(payload, isBinary)

    def backlog(self) -> int:
        """Bytes that wait: for roslibpy's thread, and for the network."""
        return self._handed_over + int(self.transport.get_write_buffer_size())


class _Factory(AsyncioRosBridgeClientFactory):  # type: ignore[misc]
    """Connects, and connects again."""

    protocol = _Protocol
    compression = None  # costs more time than it saves in a local network
    initialDelay, maxDelay, factor = FIRST_PAUSE, LONGEST_PAUSE, 1.7  # noqa: N815 (roslibpy's names)

    def __init__(self, link: "Link", url: str) -> None:
        self.link = link
        super().__init__(url)
        self.setProtocolOptions(
            autoPingInterval=PING_EVERY, autoPingTimeout=PING_PATIENCE, openHandshakeTimeout=CONNECTING
        )

    async def _connect_async(self) -> None:
        if self._stop:  # closed between two attempts
            return
        try:
            async with asyncio.timeout(CONNECTING):
                await super()._connect_async()
        except TimeoutError:
            self._schedule_reconnect()

    def _schedule_reconnect(self) -> None:
        self.link.failed()
        super()._schedule_reconnect()

    def halt(self) -> None:
        """Connect no more."""
        self._stop = True


class Link:
    """A connection that is made again whenever it is lost.

    Args:
        url: address of the server, ``ws://robot.lab.example:9090``.
        on_up: called on roslibpy's thread when the connection is there.
        on_down: called there when it is lost, and when an attempt has failed.
        on_message: called there with each message of the server.
        on_problem: called there with a line about what cannot be understood.
    """

    def __init__(
        self,
        url: str,
        on_up: Callable[[], None],
        on_down: Callable[[], None],
        on_message: Callable[[dict[str, Any]], None],
        on_problem: Callable[[str], None],
    ) -> None:
        # Connections that fail are told through `Waiting`; roslibpy would print tracebacks as well.
        logging.getLogger("roslibpy").setLevel(logging.CRITICAL)
        self._url = url
        self._on_up = on_up
        self._on_down = on_down
        self._on_message = on_message
        self._on_problem = on_problem
        self._factory: _Factory | None = None
        self._protocol: _Protocol | None = None
        self._closing = False
        self._fragments = Fragments()
        self._idle = threading.Event()

    @property
    def up(self) -> bool:
        """Whether there is a connection."""
        return self._protocol is not None

    def start(self) -> None:
        """Begin to connect; blocks for a moment when roslibpy's thread must be started."""
        factory = self._factory = _Factory(self, self._url)
        factory.on("ready", self._opened)
        factory.on("close", self._closed)
        factory.connect()

    def send(self, message: dict[str, Any], droppable: bool = False) -> bool:
        """Send *message*, from any thread; False when it is lost because there is no connection.

        Args:
            message: what the protocol calls an operation.
            droppable: lose it also when too much waits already.
        """
        protocol = self._protocol
        if protocol is None or (droppable and protocol.backlog() > BACKLOG):
            return False
        for frame in frames(message):
            protocol.send_message(frame)
        return self._protocol is protocol

    def finish(self, seconds: float) -> None:
        """Wait until what was sent has left the process, then close; blocks, so not on the loop."""
        self._closing = True
        factory, protocol = self._factory, self._protocol
        if factory is None:
            return
        factory.halt()
        if protocol is None:
            return
        # The connection's own thread does this after the messages that were handed to it before.
        loop: Any = factory.manager.loop
        loop.call_soon_threadsafe(self._close_when_sent, protocol, seconds)
        self._idle.wait(seconds + 0.5)

    def received(self, payload: bytes, binary: bool) -> None:
        """Take a frame of the server, JSON or, in binary ones, CBOR; on roslibpy's thread."""
        try:
            message = cbor2.loads(payload) if binary else json.loads(payload)
            if message["op"] == "fragment":
                message = self._fragments.add(message)
            if message is not None and isinstance(message["op"], str):
                self._on_message(message)
        except (
            Exception
        ) as problem:  # a CBOR frame of junk may be dates, fractions, expressions: each has errors of its own
            told = f"{type(problem).__name__}: {str(problem)[:80]}"
            self._on_problem(
                f"the rosbridge server sent a frame that is not an operation; it is ignored: {payload[:80]!r} ({told})"
            )

    def failed(self) -> None:
        """An attempt to connect has failed, or the connection is lost; on roslibpy's thread."""
        if self._protocol is None and not self._closing:
            self._on_down()

    def _opened(self, protocol: _Protocol) -> None:
        if self._closing:
            protocol.send_close()
            return
        self._protocol = protocol
        self._fragments.clear()
        self._on_up()

    def _closed(self, _: Any) -> None:
        was_up, self._protocol = self._protocol is not None, None
        self._idle.set()
        if was_up:
            self._on_down()

    def _close_when_sent(self, protocol: _Protocol, seconds: float) -> None:
        if seconds > 0.0 and self._protocol is protocol and protocol.backlog():
            loop = asyncio.get_running_loop()
            loop.call_later(0.005, self._close_when_sent, protocol, seconds - 0.005)
        else:
            protocol.send_close()


def checked_url(url: str) -> str:
    """Give the address of a server with its port, 9090 by default.

    Raises:
        UsageError: it is none.
    """
    try:
        parts = urlsplit(url)
        port = parts.port
    except ValueError:
        port, parts = None, urlsplit("")
    if parts.scheme not in ("ws", "wss") or not parts.hostname:
        raise UsageError(
            f"a rosbridge server has an address such as ws://robot.lab.example:9090, not {url!r}"
        )
    return url if port is not None else f"{parts.scheme}://{parts.netloc}:9090{parts.path}"
