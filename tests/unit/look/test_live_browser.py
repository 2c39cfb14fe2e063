"""The server of live pages with a real browser: who is kept out."""

import asyncio
import json
from typing import Any

from devtools import Page, chromium, needs_chromium
from live_client import PATIENCE

from jacaros import Mas
from jacaros.look import view

LAB = """
name: lab
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
robots: [{name: turtlebot, pose: {x: -1, y: 0, yaw_degrees: 0}}]
"""
PROGRAM = "!count(0). +!count(N) <- -+counted(N); .wait(10); !count(N + 1)."


async def connected(page: Page, address: str) -> None:
    """Open the page and wait until it shows the robot."""
    await page.open(address)
    await page.wait_for("document.querySelector('#robots').innerText.includes('turtlebot')")


async def counts_on(mas: Mas) -> None:
    """Wait until the agent has continued to count."""
    found = mas.agent("bob").ask("counted(N)")
    until = (found["N"] if found is not None else 0) + 10
    async with asyncio.timeout(PATIENCE):
        await mas.agent("bob").until(f"counted(N) & N >= {until}")


def sending(command: dict[str, Any], address: str = "live") -> str:
    """An expression of JavaScript that sends a command, as any script could; its value is the reply, or "refused"."""
    return f"""new Promise((resolve) => {{
      const url = new URL({json.dumps(address)}, location.href);
      url.protocol = "ws:";
      const socket = new WebSocket(url);
      socket.onerror = () => resolve("refused");
      socket.onopen = () => socket.send(JSON.stringify({json.dumps({**command, "id": 7})}));
      socket.onmessage = (event) => {{
        const message = JSON.parse(event.data);
        if (message.kind === "reply") {{ socket.close(); resolve(JSON.stringify(message)); }}
      }};
    }})"""


@needs_chromium
async def test_a_page_of_another_origin_is_refused_even_with_the_token() -> None:
    async def stranger(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await reader.readuntil(b"\r\n\r\n")
        writer.write(b"HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nConnection: close\r\n\r\n<p>hello</p>")
        writer.close()

    async with (
        Mas(seed=1, world=LAB, on_print=lambda *_: None) as mas,
        view(mas) as address,
        chromium() as page,
        await asyncio.start_server(stranger, "127.0.0.1", 0) as server,
    ):
        mas.add_agent("bob", PROGRAM)
        port = server.sockets[0].getsockname()[1]
        await page.open(f"http://127.0.0.1:{port}/")
        command = {"do": "console", "agent": "bob", "text": "?counted(X)"}
        assert await page.evaluate(sending(command, f"{address}live")) == "refused"
        script = f"import('{address}live.js').then(() => 'loaded', () => 'refused')"
        assert await page.evaluate(script) == "refused"
        await page.open(address)
        assert json.loads(await page.evaluate(sending(command)))["ok"] is True


@needs_chromium
async def test_closing_the_browser_is_harmless() -> None:
    async with Mas(seed=1, world=LAB, on_print=lambda *_: None) as mas, view(mas) as address:
        mas.add_agent("bob", PROGRAM)
        for _ in range(2):
            async with chromium() as page:
                await connected(page, address)
            await counts_on(mas)
        assert mas.exit_code is None
