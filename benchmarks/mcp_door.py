"""Load on the MCP door over stdio: goals, and the agents' own ticks meanwhile; or requests of a hostile client.

mcp_door.py [--seconds 60] [--rate 500] [--fuzz 0]
"""

import argparse
import asyncio
import json
import random
import resource
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

PROGRAM = """
{ offer(goal, count(n(number), next(out(number))), at_most(any)) }
{ offer(belief, ticks(count(number))) }
{ offer(tell, hint(x(any))) }
{ offer(question, twice(x(integer), y(out(integer)))) }
ticks(0).
twice(X, 2 * X).
!tick.
+!count(N, N + 1).
+!tick <- .wait(20); ?ticks(N); -+ticks(N + 1); !!tick.
"""
HELLO = {
    "protocolVersion": "2025-06-18",
    "capabilities": {},
    "clientInfo": {"name": "load", "version": "1"},
}
METHODS = (
    *("tools/call", "tools/list", "resources/read", "resources/subscribe", "resources/unsubscribe"),
    *("resources/list", "ping", "prompts/get", "initialize", "x", "completion/complete"),
)


class Peer:
    """A minimal client: JSON-RPC in lines, any number of requests at once."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self.process = process
        self.answers: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self.unexpected: Counter[str] = Counter()
        self._number = 0
        self._reading = asyncio.create_task(self._read())

    async def _read(self) -> None:
        assert self.process.stdout is not None
        async for line in self.process.stdout:
            found = json.loads(line)
            answer = self.answers.pop(found.get("id"), None)
            if answer is None:
                self.unexpected[kind_of(found)] += 1
            elif not answer.done():
                answer.set_result(found)

    def send(self, line: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(line.encode("utf-8", "surrogatepass") + b"\n")

    def request(self, method: str, params: Any) -> "asyncio.Future[dict[str, Any]]":
        self._number += 1
        answer = self.answers[self._number] = asyncio.get_running_loop().create_future()
        self.send(json.dumps({"jsonrpc": "2.0", "id": self._number, "method": method, "params": params}))
        return answer

    async def call(self, tool: str, arguments: Any) -> dict[str, Any]:
        found = await self.request("tools/call", {"name": tool, "arguments": arguments})
        return dict(found.get("result") or found["error"])

    async def ticks(self) -> float:
        found = await self.request("resources/read", {"uri": "jacaros://load/beliefs/ticks"})
        return float(json.loads(found["result"]["contents"][0]["text"])[0]["count"])


def kind_of(message: dict[str, Any]) -> str:
    if "error" in message:
        return f"error {message['error']['code']}: {message['error']['message'][:24]}"
    if message.get("result", {}).get("isError"):
        return "isError"
    return "result" if "result" in message else str(message.get("method"))


def memory(pid: int) -> str:
    status = Path(f"/proc/{pid}/status")
    return next(line for line in status.read_text().splitlines() if line.startswith("VmHWM"))


async def load(peer: Peer, seconds: int, rate: int) -> None:
    states: Counter[str] = Counter()
    late: list[float] = []
    first, begun = await peer.ticks(), time.monotonic()

    async def give(number: int, due: float) -> None:
        found = await peer.call("load_count", {"n": number})
        late.append(time.monotonic() - due)
        right = found.get("structuredContent") == {"next": number + 1}
        states["right" if right else str(found)[:200]] += 1

    async with asyncio.TaskGroup() as goals:
        for number in range(seconds * rate):
            due = begun + number / rate
            await asyncio.sleep(max(0.0, due - time.monotonic()))
            goals.create_task(give(number, due))
            if number % (rate * 10) == rate * 5:
                print(memory(peer.process.pid))
    lasted = time.monotonic() - begun
    ticks = (await peer.ticks() - first) / lasted
    late.sort()
    print(f"{sum(states.values()) / lasted:.0f} goals/s for {lasted:.1f} s: {dict(states)}")
    print(
        f"response: median {late[len(late) // 2] * 1e3:.1f} ms, 99 % {late[len(late) * 99 // 100] * 1e3:.1f} ms"
    )
    print(f"ticks of the agent: {ticks:.1f}/s; {memory(peer.process.pid)}")


def junk(source: random.Random, depth: int = 0) -> Any:
    """Return a random value."""
    kind = source.randrange(9 if depth < 4 else 7)
    if kind == 7:
        return [junk(source, depth + 1) for _ in range(source.randrange(4))]
    if kind == 8:
        return {str(junk(source, 4))[:20]: junk(source, depth + 1) for _ in range(source.randrange(4))}
    text = "".join(chr(source.choice((0, 10, 34, 65, 92, 0xE9, 0xD800, 0x1F600))) for _ in range(9))
    values = (None, True, source.random() * 10**308, -(10**400), text, "a" * 20_000, source.randrange(100))
    return values[kind]


def hostile(source: random.Random, number: int) -> str:
    """Return a line that is more or less a request."""
    name = source.choice(("load_count", "load_tell_hint", "load_twice", "goals", "cancel_goal", "why", "x"))
    arguments = source.choice(({"n": junk(source)}, {"x": junk(source)}, {"id": junk(source)}, junk(source)))
    params = source.choice(
        (
            {"name": name, "arguments": arguments},
            {"uri": source.choice(("jacaros://load/beliefs/ticks", "jacaros://[/", "file:///etc/passwd", junk(source)))},
            junk(source),
        )
    )  # fmt: skip
    request = {
        "jsonrpc": "2.0",
        "id": f"f{number}" if number % 10 else junk(source),
        "method": source.choice(METHODS),
        "params": params,
    }
    line = json.dumps(request)
    kind = source.randrange(10)
    if kind == 0:
        return line[: source.randrange(len(line))].replace("\n", " ")
    if kind == 1:
        return "[" * 5_000 + "]" * 5_000
    if kind == 2:
        return json.dumps(
            {"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": junk(source)}}
        )
    return line


async def fuzz(peer: Peer, requests: int) -> None:
    source = random.Random(7)
    for number in range(requests):
        peer.send(hostile(source, number))
        if number == requests // 2:
            peer.send("x" * 5_000_000)
        if number % 100 == 0:
            await peer.request("ping", {})
            found = await peer.call("load_count", {"n": number})
            assert found.get("structuredContent") == {"next": number + 1}, found
    await asyncio.sleep(0)
    before = await peer.ticks()
    await asyncio.sleep(2)
    print(f"{requests} hostile requests; answers: {dict(peer.unexpected.most_common())}")
    print(f"afterwards {(await peer.ticks() - before) / 2:.1f} ticks/s; {memory(peer.process.pid)}")


async def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    for name, default in (("seconds", 60), ("rate", 500), ("fuzz", 0)):
        parser.add_argument(f"--{name}", type=int, default=default)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "load.asl"
        program.write_text(PROGRAM)
        command = (sys.executable, "-m", "jacaros", "mcp", str(program))
        pipe = asyncio.subprocess.PIPE
        process = await asyncio.create_subprocess_exec(*command, stdin=pipe, stdout=pipe, limit=1 << 26)
        peer = Peer(process)
        await peer.request("initialize", HELLO)
        peer.send('{"jsonrpc": "2.0", "method": "notifications/initialized"}')
        if arguments.fuzz:
            await fuzz(peer, arguments.fuzz)
        else:
            await load(peer, arguments.seconds, arguments.rate)
        assert process.stdin is not None
        process.stdin.close()
        print(f"exit code {await process.wait()}")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"processor time of the run: {used.ru_utime + used.ru_stime:.1f} s")


if __name__ == "__main__":
    asyncio.run(main())
