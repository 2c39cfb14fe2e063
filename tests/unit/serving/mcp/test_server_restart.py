"""A run that serves ends and starts again: clients get an error and come back, and no goal is pursued twice."""

import asyncio
import json
import re
import signal
import socket
import subprocess
import sys
from collections.abc import AsyncIterator, Iterator
from contextlib import ExitStack, asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from httpx2 import AsyncClient
from mcp.client import Client
from mcp.client.streamable_http import streamable_http_client
from mcp_lab import text, told, wait_for

ANNA, MODEL = "anna-0123456789abcdef", "model-0123456789abcdef"
PROGRAM = """
{ offer(goal, work(number(integer)), at_most(any), idempotent) }
{ offer(goal, sum(a(number), b(number), sum(out(number))), at_most(any)) }
{ offer(belief, lit(yes(boolean))) }
lit(false).
+!work(N) <- .print("begun ", N); .wait(3600000).
+!sum(A, B, A + B).
"""
OVER_HTTP, OVER_MCP = range(1, 21), range(21, 26)
"""Goals that are pursued when the server ends."""


class Server:
    """A run that serves in a process of its own."""

    def __init__(self, folder: Path, port: int) -> None:
        command = [sys.executable, "-m", "jacaros", "run", "lamp.asl", "--serve", str(port)]
        command += ["--tokens", "tokens.yaml"]
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, cwd=folder)
        assert self._process.stderr is not None
        shown = self._process.stderr.readline()
        found = re.search(r"http:[/]{2}\S+", shown)
        assert found is not None, shown + self._process.stderr.read()
        self.url = found[0]

    @property
    def runs(self) -> bool:
        """Whether it has not ended."""
        return self._process.poll() is None

    def end(self, number: signal.Signals) -> list[str]:
        """End the run by a signal. Return the goals that it began."""
        self._process.send_signal(number)
        output, _ = self._process.communicate(timeout=60)
        return [line.rpartition(" ")[2] for line in output.splitlines() if "begun" in line]


@contextmanager
def server(folder: Path, port: int) -> Iterator[Server]:
    """Start a run, and end it at the latest here."""
    made = Server(folder, port)
    try:
        yield made
    finally:
        if made.runs:
            made.end(signal.SIGKILL)


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as found:
        port: int = found.getsockname()[1]
        return port


async def given_over_http(http: httpx.AsyncClient, number: int) -> str:
    """Give a goal and wait for its end. Return its state, or that the connection was lost."""
    try:
        response = await http.post(
            "/agents/lamp/goals/work", json={"number": number}, headers={"Prefer": "wait=60"}
        )
    except httpx.TransportError:
        return "lost"
    return str(response.json().get("state", response.json().get("code")))


async def watched(http: httpx.AsyncClient) -> list[Any]:
    """Read an event stream until its end."""
    heard = []
    try:
        async with http.stream("GET", "/events?beliefs=lamp.lit") as response:
            async for line in response.aiter_lines():
                if line.startswith("data: "):
                    heard.append(json.loads(line.removeprefix("data: ")))
    except httpx.TransportError:
        heard.append("lost")
    return heard


@asynccontextmanager
async def joined(url: str) -> AsyncIterator[Client]:
    headers = {"Authorization": f"Bearer {MODEL}"}
    async with (
        AsyncClient(headers=headers, timeout=30) as http,
        Client(streamable_http_client(f"{url}/mcp", http_client=http)) as client,
    ):
        yield client


async def given_over_mcp(url: str, number: int) -> str:
    """Call the tool of a goal. Return its text, or that the connection was lost: the SDK ends the client then."""
    try:
        async with joined(url) as model:
            return text(await model.call_tool("lamp_work", {"number": number}))
    except BaseExceptionGroup as lost:
        return f"lost {lost.exceptions}"


@pytest.mark.slow
@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGKILL])
def test_clients_get_an_error_come_back_and_no_goal_is_pursued_twice(
    end: signal.Signals, tmp_path: Path
) -> None:
    tokens = tmp_path / "tokens.yaml"
    tokens.touch(0o600)
    tokens.write_text("".join(f"{t.split('-')[0]}: {{token: {t}, roles: [user]}}\n" for t in (ANNA, MODEL)))
    (tmp_path / "lamp.asl").write_text(PROGRAM)
    port = free_port()

    async def main() -> None:
        with ExitStack() as servers:
            first = servers.enter_context(server(tmp_path, port))
            headers = {"Authorization": f"Bearer {ANNA}"}
            anna = httpx.AsyncClient(base_url=first.url, headers=headers, timeout=90)
            async with anna:
                working = [
                    asyncio.create_task(each)
                    for each in (
                        *(given_over_http(anna, number) for number in OVER_HTTP),
                        *(given_over_mcp(first.url, number) for number in OVER_MCP),
                    )
                ]
                watching = asyncio.create_task(watched(anna))
                async with joined(first.url) as model:

                    async def all_run() -> bool:
                        mine, its = (await anna.get("/goals")).text, await told(model, "goals")
                        return (mine.count("running"), its.count("running")) == (
                            len(OVER_HTTP),
                            len(OVER_MCP),
                        )

                    await wait_for(all_run)
                old = (await anna.get("/goals")).json()["goals"][0]["id"]
                begun = await asyncio.to_thread(first.end, end)
                assert sorted(map(int, begun)) == [*OVER_HTTP, *OVER_MCP]
                ends, heard = await asyncio.gather(*working), await watching
                if end == signal.SIGTERM:
                    why = "agent lamp has ended"
                    assert ends == ["failed"] * len(OVER_HTTP) + [
                        f"failed: work({n}): {why}" for n in OVER_MCP
                    ]
                    told_of = [each["arguments"]["number"] for each in heard if each.get("message") == why]
                    assert sorted(told_of) == [*OVER_HTTP]
                else:
                    assert {each.split()[0] for each in ends} == {"lost"}
                    assert heard[-1] == "lost"
                second = servers.enter_context(server(tmp_path, port))
                assert (await anna.get("/goals")).json() == {"goals": []}
                assert (await anna.get(f"/goals/{old}")).json()["code"] == "unknown_goal"
                added = await anna.post(
                    "/agents/lamp/goals/sum", json={"a": 1, "b": 2}, headers={"Prefer": "wait=9"}
                )
                assert added.json()["results"] == {"sum": 3}
                async with joined(second.url) as again:
                    assert await told(again, "goals") == "[]"
                    result = await again.call_tool("lamp_sum", {"a": 1, "b": 2})
                    assert result.structured_content == {"sum": 3}
                assert second.end(signal.SIGTERM) == []

    asyncio.run(asyncio.wait_for(main(), 90))
