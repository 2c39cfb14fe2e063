"""A robot that serves MCP in a process of its own, and clients of the SDK."""

import asyncio
import os
import sys
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from mcp import StdioServerParameters, stdio_client
from mcp.client import Client
from mcp_types import CallToolResult, TextContent

ROBOT = """
{ offer(goal, go(place([window, corner, dock])), doc("Drive to a place in the room."), idempotent) }
{ offer(goal, charge, doc("Charge the battery."), when_left(cancel)) }
{ offer(belief, battery(percent(number), state(atom)), doc("Charge, and whether it charges.")) }
{ offer(question, place(name(atom), x(out(number)), y(out(number)))) }
{ offer(tell, closed(place(atom))) }
place(window, 0.5, 0). place(corner, 2, 2). place(dock, 1, 1).
+!go(Place) : closed(Place) <- .refuse(closed(Place)).
+!go(Place) : place(Place, X, Y) <- .print("to the ", Place); .progress(0.1, "on my way"); navigate_to(X, Y, 0).
@charge[cleanup(undone)] +!charge <- .wait(3600000).
+!undone <- .print("no longer charging").
"""
WORLD = ("--world", "patrol", "--mapping", "nav2.yaml", "--mapping", "turtlebot4.yaml")
ERAS = ("auto", "legacy")
"""Modes of the SDK's client: the newest version of the protocol, and the handshake of the earlier ones."""


@asynccontextmanager
async def client(
    folder: Path, mode: str = "auto", program: str = ROBOT, options: tuple[str, ...] = (), **of_client: Any
) -> AsyncIterator[Client]:
    """Start ``jacaros mcp``, and join it. Its error output goes to the file `errors` in the folder."""
    file = folder / "robot.asl"
    file.write_text(program)
    arguments = ["-m", "jacaros", "mcp", str(file), *options]
    server = StdioServerParameters(command=sys.executable, args=arguments, env=dict(os.environ))
    with (folder / "errors").open("w") as errors:
        async with Client(stdio_client(server, errors), mode=mode, **of_client) as joined:
            yield joined


def with_client(
    folder: Path, test: Callable[[Client], Awaitable[None]], mode: str = "auto", **of: Any
) -> str:
    """Run a test with a client. Return the error output of the server."""

    async def main() -> None:
        async with asyncio.timeout(60), client(folder, mode, **of) as joined:
            await test(joined)

    asyncio.run(main())
    return (folder / "errors").read_text()


def text(result: Any) -> str:
    """Return the text of a tool's result."""
    assert isinstance(result, CallToolResult)
    (content,) = result.content
    assert isinstance(content, TextContent)
    return content.text


async def told(joined: Client, tool: str, arguments: Mapping[str, Any] | None = None) -> str:
    """Call a tool; return its text."""
    return text(await joined.call_tool(tool, dict(arguments or {})))


async def wait_for(holds: Callable[[], Awaitable[bool]]) -> None:
    """Wait until a condition holds."""
    while not await holds():  # noqa: ASYNC110  # it is in another process
        await asyncio.sleep(0.02)
