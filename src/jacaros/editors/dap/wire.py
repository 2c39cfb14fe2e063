"""Messages of the Debug Adapter Protocol: JSON behind a header with its length, on two file descriptors."""

import asyncio
import io
import json
import os
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from contextvars import Context
from typing import Any

from jacaros.runtime.errors import JacarosError
from jacaros.runtime.output import Output

Message = Mapping[str, Any]
LARGEST = 16 << 20
"""Maximum length of a message, in bytes."""
_LENGTH = b"content-length:"


class ProtocolError(JacarosError):
    """Raised for input that is not a message of the protocol."""


class Wire:
    """A client on two file descriptors. A client that does not read keeps nothing waiting.

    Args:
        source: descriptor of the client's messages.
        sink: descriptor of ours.
    """

    def __init__(self, source: int, sink: int) -> None:
        self._source = os.fdopen(source, "rb")
        self._output = Output(io.FileIO(sink, "wb"), "the editor", raw=True)
        self._output.when_gone = lambda: None  # its input ends, too

    def read(self) -> Message | None:
        """Wait for the next message. Return None at the end of the input.

        Raises:
            ProtocolError: the input is not a message.
        """
        length = 0
        while (line := self._source.readline(1024)).strip():
            if line.lower().startswith(_LENGTH):
                length = _length(line)
        if not line:
            return None
        if not length:
            raise ProtocolError("expected a header `Content-Length: N`")
        try:
            message = json.loads(self._source.read(length))
        except ValueError as error:
            raise ProtocolError(f"invalid JSON: {error}") from None
        if not isinstance(message, dict):
            raise ProtocolError("expected a JSON object")
        return message

    def send(self, message: Message) -> None:
        """Send a message; any thread may call it."""
        self.send_text(text_of(message))

    def send_text(self, text: str) -> None:
        """Send a message that is JSON already."""
        body = text.encode()
        self._output.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))

    def listen(self, take: Callable[[Message], None], ended: Callable[[str], None]) -> None:
        """Call *take* with each message on the running loop, and *ended* at their end, with the error if there is one.

        A daemon thread reads: an idle client does not keep the process alive, and a paused run does not hold messages.
        """
        loop = asyncio.get_running_loop()

        def read_all() -> None:
            why = ""
            with suppress(RuntimeError):  # the loop has ended
                try:
                    while (message := self.read()) is not None:
                        loop.call_soon_threadsafe(take, message, context=Context())
                except (ProtocolError, OSError, ValueError) as error:
                    why = str(error)
                loop.call_soon_threadsafe(ended, why, context=Context())

        threading.Thread(target=read_all, name="jacaros dap input", daemon=True).start()

    def close(self) -> None:
        """Send what waits."""
        self._output.close()


def text_of(message: Message) -> str:
    """Return a message as JSON."""
    return json.dumps(message)


def _length(header: bytes) -> int:
    try:
        length = int(header[len(_LENGTH) :])
    except ValueError:
        length = -1
    if not 0 < length <= LARGEST:
        raise ProtocolError(f"invalid header `{header.decode('latin-1').strip()}`")
    return length
