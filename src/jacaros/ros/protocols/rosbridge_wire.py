"""The bytes of one connection to a rosbridge server: a WebSocket, TLS below it for ``wss``, and fragments above it.

Both layers are the state machines of ``websockets`` and ``ssl``. Nothing here may run on two threads at a time.
"""

import itertools
import json
import ssl
from collections import OrderedDict
from collections.abc import Iterator
from functools import cache
from typing import Any

from websockets.client import ClientProtocol
from websockets.frames import Frame, Opcode
from websockets.protocol import State
from websockets.uri import parse_uri

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


LONGEST = 4_000_000
"""Maximum number of characters of a fragment.

Servers accept no message of more than 10 MB (the parameter ``max_message_size``) and close the connection otherwise.
Even with each character escaped, a fragment is below this limit. Servers send larger messages in fragments, too.
"""
OPEN_AT_ONCE = 20
"""Number of incomplete operations; the oldest is dropped first."""

_numbers = itertools.count(1)


def frames(operation: dict[str, Any]) -> Iterator[bytes]:
    """Convert an operation to one frame or, if it is too long, to several."""
    text = json.dumps(operation, separators=(",", ":"))
    if len(text) <= LONGEST:
        yield text.encode()
        return
    number, total = f"fragment:{next(_numbers)}", -(-len(text) // LONGEST)
    for index in range(total):
        piece = text[index * LONGEST : (index + 1) * LONGEST]
        fragment = {"op": "fragment", "id": number, "data": piece, "num": index, "total": total}
        yield json.dumps(fragment, separators=(",", ":")).encode()


class Fragments:
    """Joins the server's fragments."""

    def __init__(self) -> None:
        self._open: OrderedDict[str, dict[int, str]] = OrderedDict()

    def add(self, fragment: dict[str, Any]) -> dict[str, Any] | None:
        """Add a fragment. Return the operation if it was the last one.

        Raises:
            KeyError, TypeError, ValueError: the fragment is invalid, or the fragments are not an operation.
        """
        number, total, index = str(fragment["id"]), int(fragment["total"]), int(fragment["num"])
        if not isinstance(fragment["data"], str) or not 0 <= index < total:
            raise ValueError("expected a fragment with a text, and a number below the total")
        pieces = self._open.setdefault(number, {})
        pieces[index] = fragment["data"]
        if len(pieces) < total:
            while len(self._open) > OPEN_AT_ONCE:
                self._open.popitem(last=False)
            return None
        del self._open[number]
        operation = json.loads("".join(pieces[each] for each in range(total)))
        if not isinstance(operation, dict):
            raise ValueError("the fragments are not an operation")
        return operation

    def clear(self) -> None:
        """Forget incomplete operations."""
        self._open.clear()
