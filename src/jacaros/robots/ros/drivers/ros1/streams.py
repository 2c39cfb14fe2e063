"""Messages of ROS 1 on a socket, each with its length: read on the loop, written as far as the other end accepts
them.

rospy uses threads for both. Then the connection's thread has to wake the loop's thread before an agent can react, and
a third thread has to send the command; each costs 0.1 ms on an idle machine.
"""

import asyncio
import selectors
import socket
import threading
from collections import deque
from collections.abc import Callable
from contextlib import suppress

CHUNK = 65536
"""Bytes that are read at a time; up to `LARGE_CHUNK` of a long message."""
LARGE_CHUNK = 1 << 20
_LENGTH = 4
"""Bytes of the length in front of a message, little-endian."""


CLOSED_CHECK = 1.0
"""Seconds between attempts to send to a blocked socket: an epoll selector does not report a socket that was closed."""


class Inlet:
    """The messages of one publisher, read on the loop.

    Args:
        loop: the loop.
        connection: closed with this object.
        take: called with complete messages, the oldest first, and the number of bytes received.
        ended: called on the loop when the publisher has closed the connection.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        connection: socket.socket,
        take: Callable[[list[bytes], int], None],
        ended: Callable[[], None],
    ) -> None:
        self._loop = loop
        self._socket = connection
        self._take, self._ended = take, ended
        self._rest = bytearray()
        self._wanted = 0
        """Length of `_rest` at which its first message is complete; 0 while unknown."""

    def open(self) -> None:
        """Start reading."""
        self._socket.setblocking(False)
        self._loop.add_reader(self._socket.fileno(), self._read)

    def close(self) -> None:
        """Stop reading."""
        if self._socket.fileno() >= 0:
            self._loop.remove_reader(self._socket.fileno())
            self._socket.close()

    def _read(self) -> None:
        try:
            data = self._socket.recv(min(max(CHUNK, self._wanted - len(self._rest)), LARGE_CHUNK))
            if len(data) == CHUNK:
                data += self._behind()
        except (BlockingIOError, InterruptedError):
            return
        except OSError:
            data = b""
        if not data:
            self.close()
            self._ended()
            return
        # The usual case: exactly one message.
        if not self._rest and int.from_bytes(data[:_LENGTH], "little") + _LENGTH == len(data):
            self._take([data[_LENGTH:]], len(data))
            return
        self._rest += data
        self._take(self._whole() if len(self._rest) >= self._wanted else [], len(data))

    def _behind(self) -> bytes:
        """Read the backlog of a busy loop: the newest messages are only known when all have been read."""
        with suppress(OSError):  # nothing else to read; an end of the connection shows at the next read
            return self._socket.recv(LARGE_CHUNK)
        return b""

    def _whole(self) -> list[bytes]:
        """Split off the complete messages."""
        rest, messages, start = self._rest, [], 0
        self._wanted = 0
        while len(rest) - start >= _LENGTH:
            end = start + _LENGTH + int.from_bytes(rest[start : start + _LENGTH], "little")
            if end > len(rest):
                self._wanted = end - start
                break
            messages.append(bytes(memoryview(rest)[start + _LENGTH : end]))
            start = end
        del rest[:start]
        return messages


class Outbox:
    """Sends to one subscriber: immediately what its socket accepts, the rest in a temporary thread.

    However slow the subscriber is, publishing does not block.

    Args:
        connection: closed with this object.
        size: maximum number of waiting messages, the oldest is dropped first; 0: no limit.

    Attributes:
        sent_bytes, sent_messages: totals so far.
    """

    def __init__(self, connection: socket.socket, size: int) -> None:
        self.sent_bytes = self.sent_messages = 0
        self._socket = connection
        self._lock = threading.Lock()
        self._begun = b""
        """The rest of a partly sent message."""
        self._waiting: deque[bytes] = deque(maxlen=size or None)
        self._sending = self._closed = False
        self._problem: OSError | None = None
        connection.setblocking(False)
        # Commands are short and come one at a time: they must not be delayed.
        with suppress(OSError):
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    @property
    def busy(self) -> bool:
        """Whether data remains to be sent."""
        return self._sending

    def send(self, data: bytes) -> None:
        """Send *data*, including its length, now or after the waiting messages; callable from any thread.

        Raises:
            OSError: the subscriber has gone.
        """
        with self._lock:
            if self._closed:
                raise BrokenPipeError("the connection is closed")
            if self._sending:
                self._waiting.append(data)
                return
            self._begun = self._rest_of(data)
            if self._problem is not None:
                raise self._problem
            if not self._begun:
                return
            self._sending = True
        threading.Thread(target=self._send_rest, name="ROS slow subscriber", daemon=True).start()

    def close(self) -> None:
        """Stop sending; callable from any thread."""
        with self._lock:
            if self._closed:
                return
            self._closed = True
            with suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)
            if not self._sending:
                self._socket.close()

    def _rest_of(self, data: bytes) -> bytes:
        """Send what the socket accepts, and return the rest."""
        try:
            sent = self._socket.send(data)
        except (BlockingIOError, InterruptedError):
            return data
        except OSError as problem:
            self._problem = problem
            return b""
        self.sent_bytes += sent
        if sent < len(data):
            return data[sent:]
        self.sent_messages += 1
        return b""

    def _send_rest(self) -> None:
        with selectors.DefaultSelector() as writable:
            with suppress(ValueError):  # rospy has closed the socket: the next attempt to send fails
                writable.register(self._socket, selectors.EVENT_WRITE)
            self._send_when(writable)

    def _send_when(self, writable: selectors.BaseSelector) -> None:
        while True:
            writable.select(CLOSED_CHECK)
            with self._lock:
                if not self._closed:
                    self._begun = self._rest_of(self._begun)
                if not self._begun and self._waiting:
                    self._begun = self._waiting.popleft()
                if self._closed or self._problem is not None or not self._begun:
                    self._sending = False
                    if self._closed:
                        self._socket.close()
                    return
