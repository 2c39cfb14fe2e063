"""MCP over HTTP: callers with tokens, in the same process as the HTTP door."""

import asyncio
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import AbstractAsyncContextManager

import httpx
import pytest
from httpx2 import AsyncClient
from mcp.client import Client
from mcp.client.streamable_http import streamable_http_client
from mcp_lab import ERAS, text, told, wait_for

import jacaros
from jacaros import Mas
from jacaros.serving.crossing import Crossing
from jacaros.serving.mcp.http import McpOverHttp

ANNA, EVE = "anna-0123456789abcdef", "eve-0123456789abcdef"
LAMP = """
{ offer(goal, glow, when_left(cancel)) }
{ offer(goal, sum(a(number), b(number), sum(out(number)))) }
{ offer(belief, lit(yes(boolean))) }
lit(false).
+!glow <- .progress(0.5, "half as bright"); .wait(3600000).
+!sum(A, B, A + B).
"""


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Serve a lamp over HTTP, to anna, a user, and eve, an observer."""
    folder = tmp_path_factory.mktemp("lamp")
    tokens = folder / "tokens.yaml"
    tokens.touch(0o600)
    tokens.write_text(f"anna: {{token: {ANNA}, roles: [user]}}\neve: {{token: {EVE}, roles: [observer]}}\n")
    (folder / "lamp.asl").write_text(LAMP)
    command = [sys.executable, "-m", "jacaros", "run", "lamp.asl", "--serve", "0", "--tokens", "tokens.yaml"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=folder) as run:
        assert run.stderr is not None
        shown = run.stderr.readline()
        found = re.search(r"http:[/]{2}\S+", shown)
        try:
            assert found is not None, shown + run.stderr.read()
            yield found[0] + "/mcp"
        finally:
            run.terminate()
            assert "error" not in run.stderr.read()


def joined(http: AsyncClient, url: str, mode: str = "auto") -> AbstractAsyncContextManager[Client]:
    return Client(streamable_http_client(url, http_client=http), mode=mode)


def http_client(token: str) -> AsyncClient:
    return AsyncClient(headers={"Authorization": f"Bearer {token}"}, timeout=30)


@pytest.mark.parametrize("mode", ERAS)
def test_a_client_gives_goals_and_cancels_them(url: str, mode: str) -> None:
    notes: list[str | None] = []

    async def hear(progress: float, total: float | None, message: str | None) -> None:
        del progress, total
        notes.append(message)

    async def main() -> None:
        async with asyncio.timeout(60), http_client(ANNA) as http, joined(http, url, mode) as model:
            added = await model.call_tool("lamp_sum", {"a": 1, "b": 2})
            assert added.structured_content == {"sum": 3}
            glowing = asyncio.create_task(model.call_tool("lamp_glow", progress_callback=hear))

            async def glows() -> bool:
                return "half as bright" in notes

            await wait_for(glows)
            glowing.cancel()

            async def cancelled() -> bool:
                return bool(json.loads(await told(model, "goals"))[-1]["state"] == "cancelled")

            await wait_for(cancelled)
            assert "asked by mcp:anna" in await told(model, "why", {"question": "!glow"})

    asyncio.run(main())


def test_each_caller_has_its_own_roles_and_goals(url: str) -> None:
    async def main() -> None:
        async with (
            asyncio.timeout(60),
            http_client(ANNA) as one,
            http_client(EVE) as other,
            joined(one, url) as anna,
            joined(other, url) as eve,
        ):
            assert "lamp_glow" in [each.name for each in (await anna.list_tools()).tools]
            await anna.call_tool("lamp_sum", {"a": 1, "b": 2})
            assert "lamp_glow" not in [each.name for each in (await eve.list_tools()).tools]
            assert await told(eve, "goals") == "[]"
            id = json.loads(await told(anna, "goals"))[-1]["id"]
            wrong = await eve.call_tool("cancel_goal", {"id": id})
            assert (wrong.is_error, text(wrong)) == (True, f"no goal `{id}`")

    asyncio.run(main())


def test_a_session_belongs_to_the_caller_that_began_it(url: str) -> None:
    hello = {
        "jsonrpc": "2.0",
        "id": 1,
        "method": "initialize",
        "params": {
            "protocolVersion": "2025-06-18",
            "capabilities": {},
            "clientInfo": {"name": "x", "version": "1"},
        },
    }
    headers = {"Accept": "application/json, text/event-stream", "Authorization": f"Bearer {ANNA}"}
    with httpx.Client(headers=headers) as http:
        begun = http.post(url, json=hello)
        session = {"Mcp-Session-Id": begun.headers["mcp-session-id"]}
        listed = {"jsonrpc": "2.0", "id": 2, "method": "tools/list"}
        assert http.post(url, json=listed, headers=session).status_code == 200
        stolen = http.post(url, json=listed, headers={**session, "Authorization": f"Bearer {EVE}"})
        assert stolen.status_code == 404


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Authorization": "Bearer wrong"}, 401),
        ({}, 401),
        ({"Authorization": f"Bearer {ANNA}", "Origin": "https://evil.example"}, 403),
        ({"Authorization": f"Bearer {ANNA}", "Host": "evil.example"}, 403),
    ],
)
def test_strangers_are_refused(url: str, headers: dict[str, str], status: int) -> None:
    assert httpx.post(url, json={}, headers=headers).status_code == status


def test_an_sdk_that_cannot_be_imported_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mcp.server.streamable_http_manager", None)

    async def main() -> None:
        loop = asyncio.get_running_loop()
        async with asyncio.timeout(30), Mas() as mas, McpOverHttp(mas.system, Crossing(loop)) as app:
            for _ in range(2):
                with pytest.raises(ImportError):
                    await app({}, None, None)

    jacaros.run(main())
