"""The protocol of a rosbridge server without sockets: bytes, and numbered requests.

A connection is a WebSocket, with TLS below it for ``wss``: the state machines of ``websockets`` and ``ssl``, which may not
run on two threads at a time.
"""

import itertools
import ssl
import time
from collections.abc import Callable
from functools import cache
from typing import Any, Generic, TypeVar

from websockets.client import ClientProtocol
from websockets.frames import Frame, Opcode
from websockets.protocol import State
from websockets.uri import parse_uri

from jacaros.robots.ros.errors import CallFailed, ServiceError, ServiceUnavailable

_DATA = (Opcode.TEXT, Opcode.BINARY, Opcode.CONT)


def address(url: str) -> tuple[str, int]:
    """Return the host and the port of a server."""
    uri = parse_uri(url)
    return uri.host, uri.port


class Wire:
    """The client's input and output on its connection.

    Args:
        url: address of the server, with its port.
        context: trusted certificates for ``wss``; default: those of the system.
    """

    def __init__(self, url: str, context: ssl.SSLContext | None = None) -> None:
        uri = parse_uri(url)
        # No extension: compression costs more time than it saves in a local network. No limit of the message size:
        # only requested topics arrive.
        self._protocol = ClientProtocol(uri, max_size=None)
        self._tls = _Tls(context or _system_context(), uri.host) if uri.secure else None
        self._parts: list[bytes] = []
        self._binary = False
        self._protocol.send_request(self._protocol.connect())

    @property
    def opened(self) -> bool:
        """Whether the server has accepted the connection, and it is not being closed."""
        return self._protocol.state is State.OPEN

    @property
    def failure(self) -> Exception | None:
        """The error in the server's handshake."""
        return self._protocol.handshake_exc

    def feed(self, data: bytes) -> list[tuple[bytes, bool]]:
        """Process bytes of the server. Return the messages that are now complete, each with whether it is binary.

        Raises:
            ssl.SSLError: the server's certificate does not match its address, or it violates TLS.
        """
        if self._tls is not None:
            data = self._tls.decrypted(data)
        if data:
            self._protocol.receive_data(data)
        messages = []
        for event in self._protocol.events_received():
            if isinstance(event, Frame) and event.opcode in _DATA:
                if event.opcode is not Opcode.CONT:
                    self._binary = event.opcode is Opcode.BINARY
                if event.fin and not self._parts:
                    messages.append((bytes(event.data), self._binary))
                    continue
                self._parts.append(bytes(event.data))
                if event.fin:
                    messages.append((b"".join(self._parts), self._binary))
                    self._parts.clear()
        return messages

    def send(self, text: bytes) -> None:
        """Write a message; it is lost if the connection is being closed."""
        if self.opened:
            self._protocol.send_text(text)

    def ping(self) -> None:
        """Send a ping."""
        if self.opened:
            self._protocol.send_ping(b"")

    def close(self) -> None:
        """Send a close frame; the server then closes the connection."""
        if self.opened:
            self._protocol.send_close(1000)

    def output(self) -> bytes:
        """Return the bytes to send to the server."""
        data = b"".join(self._protocol.data_to_send())
        return data if self._tls is None else self._tls.encrypted(data)


class _Tls:
    """The client's side of TLS."""

    def __init__(self, context: ssl.SSLContext, host: str) -> None:
        self._incoming, self._outgoing = ssl.MemoryBIO(), ssl.MemoryBIO()
        self._tls = context.wrap_bio(self._incoming, self._outgoing, server_hostname=host)
        self._ready = False
        self._waiting = b""
        self._shake_hands()

    def decrypted(self, data: bytes) -> bytes:
        self._incoming.write(data)
        if not self._ready:
            self._shake_hands()
        parts = []
        try:
            while self._ready and (part := self._tls.read(65536)):
                parts.append(part)
        except ssl.SSLWantReadError:
            pass
        return b"".join(parts)

    def encrypted(self, data: bytes) -> bytes:
        self._waiting += data
        while self._ready and self._waiting:
            self._waiting = self._waiting[self._tls.write(self._waiting) :]
        return self._outgoing.read()

    def _shake_hands(self) -> None:
        try:
            self._tls.do_handshake()
            self._ready = True
        except ssl.SSLWantReadError:
            pass


@cache
def _system_context() -> ssl.SSLContext:
    return ssl.create_default_context()


T = TypeVar("T")

_ABSENT = ("does not exist", "unavailable", "absent from")
"""Parts of the server's error for a missing service."""

Done = Callable[[dict[str, Any] | None, ServiceError | None], None]
"""Takes the fields of a response, or the error."""

LOOK_AGAIN, LOOK_STEADILY = 0.25, 1.0
"""Seconds after which a polled value is requested again: while it is empty, and otherwise."""
PATIENCE = 3.0
"""Seconds for one answer of rosapi."""
UNANSWERED = 10.0
"""Seconds after which an unanswered request is repeated."""


class Requests:
    """Pending calls.

    Args:
        send: passes an operation to the link. Returns False if it is lost.
    """

    def __init__(self, send: Callable[[dict[str, Any]], bool]) -> None:
        self._send = send
        self._counter = itertools.count(1)
        self._pending: dict[str, tuple[str, Done]] = {}
        self.interruptions = 0
        """Number of lost connections: earlier answers may no longer be valid."""

    def begin(self, service: str, arguments: Any, done: Done, timeout: float | None = None) -> str:
        """Call *service*; *done* is called once, possibly immediately.

        Args:
            service: absolute name.
            arguments: fields of the request as JSON values.
            done: called with the answer.
            timeout: seconds after which a newer server may drop the call.

        Returns:
            The number with which the call can be dropped.
        """
        operation = self.operation(service, arguments)
        number: str = operation["id"]
        self._pending[number] = (service, done)
        if timeout is not None:
            operation["timeout"] = timeout
        if not self._send(operation):
            self._end(number, None, CallFailed(f"service {service}: no connection to the rosbridge server"))
        return number

    def forget(self, number: str) -> None:
        """Drop a call: its answer is no longer needed."""
        self._pending.pop(number, None)

    def answered(self, message: dict[str, Any]) -> None:
        """Handle an answer of the server."""
        number, values = message.get("id"), message.get("values")
        if not isinstance(number, str):
            return
        if message.get("result", True):
            self._end(number, values if isinstance(values, dict) else {}, None)
        else:
            self._end(number, None, _failure(message.get("service", ""), values))

    def fail_all(self) -> None:
        """Fail all calls: the connection is lost, and their answers with it."""
        self.interruptions += 1
        for number, (service, _) in list(self._pending.items()):
            text = f"service {service}: the connection to the rosbridge server was lost during the call"
            self._end(number, None, CallFailed(text))

    def _end(self, number: str, values: dict[str, Any] | None, problem: ServiceError | None) -> None:
        _, done = self._pending.pop(number, ("", None))
        if done is not None:
            done(values, problem)

    def operation(self, service: str, arguments: Any) -> dict[str, Any]:
        """Return the operation that calls *service*."""
        number = f"call_service:{service}:{next(self._counter)}"
        return {"op": "call_service", "id": number, "service": service, "args": arguments}


def _failure(service: str, text: object) -> ServiceError:
    """Classify an error of the server, which consists of text only."""
    words = str(text)
    if any(sign in words for sign in _ABSENT):
        return ServiceUnavailable(f"no node offers service {service}: {words}")
    return CallFailed(f"service {service}: {words}")


class Polled(Generic[T]):
    """A value of the graph that rosapi reports, polled on demand.

    Nothing is requested unless the value is read: reading it returns the last known value and requests a new one if
    necessary. Values of a lost connection are forgotten: the server may be another one, and other nodes must register
    with it again.

    Args:
        requests: sends the requests.
        service: service of rosapi, such as ``/rosapi/subscribers``.
        arguments: fields of its request.
        read: reads the fields of the response.
        unknown: the value before the first answer, and after a failure.
    """

    def __init__(
        self,
        requests: Requests,
        service: str,
        arguments: dict[str, Any],
        read: Callable[[dict[str, Any]], T],
        unknown: T,
    ) -> None:
        self._requests = requests
        self._service = service
        self._arguments = arguments
        self._read = read
        self._unknown = unknown
        self._value = unknown
        self._asked = -LOOK_AGAIN
        self._interruptions = requests.interruptions
        self.asking = False

    @property
    def value(self) -> T:
        """The last known value; requests a new one if it is old."""
        now = time.monotonic()
        if self._interruptions != self._requests.interruptions:
            self._interruptions = self._requests.interruptions
            self._value, self._asked, self.asking = self._unknown, -LOOK_AGAIN, False
        # A server that may not serve rosapi to us does not answer at all.
        pause = UNANSWERED if self.asking else LOOK_STEADILY if self._value else LOOK_AGAIN
        if now - self._asked >= pause:
            self._asked, self.asking = now, True
            self._requests.begin(self._service, self._arguments, self._seen)
        return self._value

    def _seen(self, values: dict[str, Any] | None, _: ServiceError | None) -> None:
        self.asking = False
        try:
            self._value = self._unknown if values is None else self._read(values)
        except (KeyError, TypeError):  # another version of rosapi
            self._value = self._unknown
