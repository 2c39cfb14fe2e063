"""Find out what the robot can do, and use it, as a language model does over MCP.

    TOKEN=... python mcp_client.py soap bathroom

A language model joins with the same address and token. This client needs ``pip install "jacaros[mcp]"``.
"""

import asyncio
import os
import sys

from httpx2 import AsyncClient
from mcp.client import Client
from mcp.client.streamable_http import streamable_http_client


async def told(done: float, total: float | None, note: str | None) -> None:
    """Print the progress of a goal."""
    del total
    print(f"{done:.0%} {note or ''}")


async def main() -> None:
    """Give one goal, and ask what came before it."""
    parcel, room = sys.argv[1:]
    url = os.environ.get("URL", "http://127.0.0.1:8000/mcp")
    headers = {"Authorization": f"Bearer {os.environ['TOKEN']}"}
    async with (
        AsyncClient(headers=headers, timeout=300) as http,
        Client(streamable_http_client(url, http_client=http)) as robot,
    ):
        tools = {tool.name: tool for tool in (await robot.list_tools()).tools}
        print("tools:", ", ".join(tools))
        given = {"parcel": parcel, "room": room}
        result = await robot.call_tool("robot_deliver", given, progress_callback=told)
        print(*(part.text for part in result.content))
        why = await robot.call_tool("why", {"question": f'why !deliver("{parcel}", {room}, _)'})
        print(*(part.text for part in why.content))


if __name__ == "__main__":
    asyncio.run(main())
