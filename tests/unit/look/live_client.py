"""A page for tests: connects to a live server over real sockets, collects records, and sends commands."""

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from typing import Any
from urllib.parse import urlsplit

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from jacaros import Mas
from jacaros.look import view

PATIENCE = 20.0
"""Seconds of waiting after which a test fails."""


class LivePage:
    """A connected page.

    Attributes:
        hello: the first message.
        records: what came so far.
        notes: other messages, replies excepted.
        mas: the system whose page this is, in `viewed`.
    """

    mas: Mas

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket
        self.hello: dict[str, Any] = {}
        self.records: list[dict[str, Any]] = []
        self.notes: list[dict[str, Any]] = []
        self._replies: dict[object, dict[str, Any]] = {}
        self._changed = asyncio.Event()
        self._count = 0

    async def read(self) -> None:
        """Receive messages until the connection ends."""
        async for message in self.socket:
            self._take(json.loads(message))
            self._changed.set()

    def _take(self, message: Any) -> None:
        if isinstance(message, list):
            self.records += message
        elif message["kind"] == "reply":
            self._replies[message["id"]] = message
        else:
            self.notes.append(message)
            self.hello = message if message["kind"] == "hello" else self.hello

    async def until(self, condition: Callable[[], Any]) -> Any:
        """Wait until a condition holds; return its value."""
        async with asyncio.timeout(PATIENCE):
            while not (found := condition()):
                self._changed.clear()
                await self._changed.wait()
        return found

    async def event(self, name: str, **data: object) -> dict[str, Any]:
        """Wait for an event whose data contain *data*; return its data."""

        def found() -> dict[str, Any] | None:
            matching = (
                each["data"]
                for each in self.records
                if each.get("event") == name and data.items() <= each["data"].items()
            )
            return next(matching, None)

        result: dict[str, Any] = await self.until(found)
        return result

    async def do(self, command: str, **fields: object) -> dict[str, Any]:
        """Send a command; return the reply."""
        self._count += 1
        number = self._count
        await self.socket.send(json.dumps({"id": number, "do": command, **fields}))
        reply: dict[str, Any] = await self.until(lambda: self._replies.get(number))
        return reply

    async def done(self, command: str, **fields: object) -> Any:
        """Return the result of a command."""
        reply = await self.do(command, **fields)
        assert reply["ok"], reply
        return reply["result"]

    async def refused(self, command: str, **fields: object) -> str:
        """Return the error of a command, in one line."""
        reply = await self.do(command, **fields)
        assert not reply["ok"]
        assert "\n" not in reply["error"]
        return str(reply["error"])

    def of(self, kind: str) -> list[dict[str, Any]]:
        """Return the records of a kind so far."""
        return [each for each in self.records if each["kind"] == kind]


@asynccontextmanager
async def live_page(address: str) -> AsyncIterator[LivePage]:
    """Connect to a server, as the page at *address* does."""
    async with connect(socket_address(address), max_size=None, compression=None) as socket:
        page = LivePage(socket)
        reading = asyncio.create_task(page.read())
        try:
            await page.until(lambda: page.hello)
            yield page
        finally:
            reading.cancel()
            with suppress(asyncio.CancelledError, ConnectionClosed):
                await reading


@asynccontextmanager
async def viewed(mas: Mas, role: str = "operator") -> AsyncIterator[LivePage]:
    """Run a system and connect to its page."""
    async with mas, view(mas, role=role) as address, live_page(address) as page:
        page.mas = mas
        yield page


def socket_address(address: str) -> str:
    """Return the address of the WebSocket of a page."""
    return f"{address.replace('http', 'ws', 1)}live"


async def get(address: str, path: str = "", **headers: str) -> tuple[int, dict[str, str], bytes]:
    """Send a GET request; return status, headers and content of the response. Fields with the value "" are left out."""
    parts = urlsplit(address)
    assert parts.hostname is not None
    reader, writer = await asyncio.open_connection(parts.hostname, parts.port)
    fields = {"Host": parts.netloc, **{name.replace("_", "-"): value for name, value in headers.items()}}
    lines = [
        f"GET {parts.path}{path} HTTP/1.1",
        *(f"{name}: {value}" for name, value in fields.items() if value),
    ]
    writer.write(("\r\n".join(lines) + "\r\n\r\n").encode())
    async with asyncio.timeout(PATIENCE):
        answer = await reader.read()
    writer.close()
    head, _, content = answer.partition(b"\r\n\r\n")
    first, *rest = head.decode().split("\r\n")
    return int(first.split()[1]), dict(line.split(": ", 1) for line in rest), content
