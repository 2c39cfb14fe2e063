"""MCP over the standard input and output of the process, which then belong to the client."""

import asyncio
import json
import os
import re
import threading
from collections.abc import AsyncIterator, Awaitable, Callable
from concurrent.futures import Future
from contextlib import suppress
from queue import SimpleQueue
from typing import Any, BinaryIO, cast

import mcp_types as types
from mcp.server.stdio import stdio_server

from jacaros.runtime.mas.system import System
from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.crossing import Crossing, DoorThread, Outbox
from jacaros.serving.mcp.clients import Client
from jacaros.serving.mcp.server import Context, McpServer
from jacaros.serving.service import service_of
from jacaros.serving.stdio import Wire

LONGEST_LINE = 1 << 20
"""Maximum length of a message, in bytes."""
MOST_LINES = 100
"""Number of messages that wait in each direction."""
GOODBYE = 1.0
"""Seconds for the last messages when the run ends."""
_MALFORMED = json.dumps(
    {
        "jsonrpc": "2.0",
        "id": None,
        "error": {
            "code": types.PARSE_ERROR,
            "message": f"not a JSON-RPC message of at most {LONGEST_LINE} bytes",
        },
    }
)


class Lines:
    """Lines of the client, read in a daemon thread: an idle client does not keep the process alive.

    Args:
        file: where to read.
        answer: answers a line that is not a message.
        ended: called when the client has closed it.
    """

    def __init__(
        self, file: BinaryIO, answer: Callable[[str], Awaitable[None]], ended: Callable[[], None]
    ) -> None:
        self._file, self._answer, self._ended = file, answer, ended
        self._lines: Outbox[str | None] = Outbox(asyncio.get_running_loop())
        self._room = threading.Semaphore(MOST_LINES)
        threading.Thread(target=self._read, name="jacaros mcp input", daemon=True).start()

    async def __aiter__(self) -> AsyncIterator[str]:
        while True:
            for line in await self._lines.take():
                self._room.release()
                if line is None:
                    self._ended()
                    return
                try:
                    types.jsonrpc_message_adapter.validate_json(line, by_name=False)
                except ValueError:
                    await self._answer(_MALFORMED + "\n")  # the SDK says nothing
                else:
                    yield line

    def _read(self) -> None:
        with suppress(OSError, RuntimeError):  # the loop has ended
            while line := self._file.readline(LONGEST_LINE):
                rest = line
                while not rest.endswith(b"\n") and (rest := self._file.readline(LONGEST_LINE)):
                    line = b"too long"
                if line.strip():
                    self._pass(line.decode("utf-8", "replace"))
            self._pass(None)

    def _pass(self, line: str | None) -> None:
        self._room.acquire()
        self._lines.put(line)


class Writer:
    """Messages to the client, written in a daemon thread: a client that does not read keeps nothing alive.

    Args:
        file: where to write.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._texts = SimpleQueue[tuple[str, Future[None] | None]]()
        threading.Thread(target=self._write, name="jacaros mcp output", daemon=True).start()

    async def write(self, text: str) -> None:
        """Write a text soon; wait if the client is slow to read."""
        if self._texts.qsize() < MOST_LINES:
            self._texts.put((text, None))
        else:
            await self._written(text)

    async def flush(self) -> None:
        """Do nothing: each text is flushed."""

    async def finish(self) -> None:
        """Wait until everything is written, for a limited time."""
        with suppress(TimeoutError):
            async with asyncio.timeout(GOODBYE):
                await self._written("")

    async def _written(self, text: str) -> None:
        done: Future[None] = Future()
        self._texts.put((text, done))
        await asyncio.wrap_future(done)

    def _write(self) -> None:
        while True:
            text, done = self._texts.get()
            with suppress(OSError):  # the client is gone; its input will end, too
                self._file.write(text.encode())
                self._file.flush()
            if done is not None and done.set_running_or_notify_cancel():
                done.set_result(None)


class StdioDoor:
    """Serves a run to the process that started this one. The run ends with its client.

    Args:
        system: the run; already started.
        wire: what `jacaros.serving.stdio.claim` returned.
        roles: roles of the client.
        patience: see `McpServer`.
    """

    def __init__(self, system: System, wire: Wire, roles: frozenset[str], patience: float | None) -> None:
        self._system, self._wire, self._roles, self._patience = system, wire, roles, patience
        self._service = service_of(system)
        self._client: Client | None = None
        self._thread = DoorThread("jacaros mcp", self._serve, self._failed)
        system.close_last(self._thread.close)

    def _failed(self, error: Exception) -> None:
        self._system.console.log(f"error: MCP server: {type(error).__name__}: {error}", "error")

    async def _serve(self, crossing: Crossing) -> None:
        def client_of(ctx: Context) -> Client:
            if self._client is None:
                self._client = Client(Caller(_name(ctx), "mcp", self._roles), crossing, self._service)
            return self._client

        server = McpServer(self._system.deployment.name, client_of, self._patience).server
        writer = Writer(os.fdopen(self._wire.sink, "wb", closefd=False))
        lines = Lines(os.fdopen(self._wire.source, "rb", closefd=False), writer.write, self._left)
        try:
            async with stdio_server(cast(Any, lines), cast(Any, writer)) as (read, write):
                await server.run(read, write, server.create_initialization_options())
        finally:
            await writer.finish()
        with suppress(RequestError):  # the run has ended
            if self._client is not None:
                await self._client.leave()
                await crossing.wait(self._goals_ended)
            await crossing.call(self._system.stop_system, 0.0, 0)

    def _left(self) -> None:
        if self._client is not None:
            self._client.left = True

    async def _goals_ended(self) -> None:
        """Wait for the goals of the client that continue without it, and for the clean-up of the others."""
        for goal in tuple(self._service.goals.values()):
            await goal.wait()


def _name(ctx: Context) -> str:
    """Return the name by which a client introduces itself, such as ``claude-ai``."""
    params = ctx.session.client_params
    return re.sub(r"[^A-Za-z0-9._-]", "_", params.client_info.name)[:40] if params is not None else "client"
