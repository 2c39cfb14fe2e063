"""The server of live pages with a real browser: what reaches the run, and who is kept out."""

import asyncio
import json
from collections.abc import Awaitable, Callable
from typing import Any

from devtools import Page, chromium, needs_chromium
from live_client import PATIENCE

import jacaros
from jacaros import Mas
from jacaros.look import view
from played import played

TOKEN = "a-token-that-tests-know"
LAB = """
name: lab
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
robots: [{name: turtlebot, pose: {x: -1, y: 0, yaw_degrees: 0}}]
"""
PROGRAM = "!count(0). +!count(N) <- -+counted(N); .wait(10); !count(N + 1). +seen(X) <- .print(seen, X)."


def browsing(test: Callable[[Page], Awaitable[None]]) -> None:
    """Run a test with a browser, an agent, a robot, and the address of their page."""

    async def main() -> None:
        async with Mas(seed=1, world=LAB, on_print=lambda *_: None) as mas, view(mas, token=TOKEN) as address:
            mas.add_agent("bob", PROGRAM)
            async with chromium() as page:
                page.mas, page.address = mas, address
                await test(page)

    jacaros.run(main())


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
@played(browsing)
async def test_a_belief_added_on_the_page_reaches_the_agent(page) -> None:
    await connected(page, page.address)
    reply = await page.evaluate(sending({"do": "belief", "agent": "bob", "op": "+", "text": "seen(key)"}))
    assert json.loads(reply)["ok"] is True
    await page.mas.agent("bob").until("seen(key)", PATIENCE)
    await page.wait_for("document.querySelector('#log').innerText.includes('seenkey')")
    assert page.errors == []


@needs_chromium
@played(browsing)
async def test_a_wrong_token_is_refused(page) -> None:
    await page.open(page.address.replace(TOKEN, "a-token-that-is-wrong"))
    assert "404" in await page.evaluate("document.body.innerText")
    assert await page.evaluate(sending({"do": "console"}, "/a-token-that-is-wrong/live")) == "refused"
    await counts_on(page.mas)


@needs_chromium
@played(browsing)
async def test_a_page_of_another_origin_is_refused_even_with_the_token(page) -> None:
    async def stranger(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await reader.readuntil(b"\r\n\r\n")
        writer.write(b"HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nConnection: close\r\n\r\n<p>hello</p>")
        writer.close()

    server = await asyncio.start_server(stranger, "127.0.0.1", 0)
    async with server:
        port = server.sockets[0].getsockname()[1]
        await page.open(f"http://127.0.0.1:{port}/")
        command = {"do": "console", "agent": "bob", "text": "?counted(X)"}
        assert await page.evaluate(sending(command, f"{page.address}live")) == "refused"
        script = f"import('{page.address}live.js').then(() => 'loaded', () => 'refused')"
        assert await page.evaluate(script) == "refused"
        await page.open(page.address)
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
