"""Load on the HTTP door: goals from several clients, watchers, and the agents' own ticks meanwhile.

http_door.py [--seconds 60] [--rate 500] [--watchers 0] [--clients 8] [--role observer]
"""

import argparse
import asyncio
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

PROGRAM = """
{ offer(goal, count(n(number), next(out(number))), at_most(any)) }
{ offer(belief, ticks(count(number))) }
ticks(0).
!tick.
+!count(N, N + 1).
+!tick <- .wait(20); ?ticks(N); -+ticks(N + 1); !!tick.
"""
TOKEN = "benchmark-0123456789abcdef"


class Connection:
    """A minimal client: one request at a time on one connection."""

    def __init__(self, port: int) -> None:
        self._port = port

    async def open(self) -> "Connection":
        self._reader, self._writer = await asyncio.open_connection("127.0.0.1", self._port)
        return self

    async def request(self, method: str, path: str, body: str = "", more: str = "") -> dict[str, object]:
        head = f"{method} {path} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {TOKEN}\r\n{more}"
        self._writer.write(f"{head}Content-Length: {len(body)}\r\n\r\n{body}".encode())
        header = await self._reader.readuntil(b"\r\n\r\n")
        length = int(header.lower().partition(b"content-length: ")[2].partition(b"\r\n")[0])
        return dict(json.loads(await self._reader.readexactly(length)))

    async def watch(self, seen: Counter[str], token: str) -> None:
        head = f"GET /events?beliefs=load.ticks HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {token}\r\n\r\n"
        self._writer.write(head.encode())
        while data := await self._reader.read(1 << 16):
            seen["events"] += data.count(b"data: ")
            seen["reads"] += 1


async def ticks(connection: Connection) -> float:
    found = await connection.request("GET", "/agents/load/beliefs/ticks")
    return float(found["beliefs"][0]["count"])  # type: ignore[index]


def token_of(watcher: int) -> str:
    return f"watcher-{watcher:03}-0123456789abcdef"


async def look(run: int) -> None:
    """Print the memory of a run after 10, 30 and 60 seconds."""
    for more in (10, 20, 30):
        await asyncio.sleep(more)
        print(memory(run))


def memory(run: int) -> str:
    status = Path(f"/proc/{run}/status")
    return next(line for line in status.read_text().splitlines() if line.startswith("VmRSS"))


async def load(port: int, run: int, arguments: argparse.Namespace) -> None:
    seen: Counter[str] = Counter()
    states: Counter[object] = Counter()
    watchers = [
        asyncio.create_task((await Connection(port).open()).watch(seen, token_of(number)))
        for number in range(arguments.watchers)
    ]
    looking = asyncio.create_task(look(run))
    late: list[float] = []
    begun, first = time.monotonic(), await ticks(await Connection(port).open())

    async def give(number: int) -> None:
        connection = await Connection(port).open()
        for count in range(number, arguments.seconds * arguments.rate, arguments.clients):
            due = begun + count / arguments.rate
            await asyncio.sleep(max(0.0, due - time.monotonic()))
            found = await connection.request(
                "POST", "/agents/load/goals/count", f'{{"n": {count}}}', "Prefer: wait=30\r\n"
            )
            late.append(time.monotonic() - due)
            right = found.get("state") == "achieved" and found["results"] == {"next": count + 1}
            states["right" if right else str(found)[:200]] += 1

    if arguments.rate:
        await asyncio.gather(*map(give, range(arguments.clients)))
    else:
        await asyncio.sleep(arguments.seconds)
    seconds = time.monotonic() - begun
    rate = (await ticks(await Connection(port).open()) - first) / seconds
    late.sort()
    print(f"{sum(states.values()) / seconds:.0f} goals/s for {seconds:.1f} s: {dict(states)}")
    if late:
        print(
            f"response: median {late[len(late) // 2] * 1e3:.1f} ms, 99 % {late[len(late) * 99 // 100] * 1e3:.1f} ms"
        )
    print(f"ticks of the agent: {rate:.1f}/s; events seen by {len(watchers)} watchers: {dict(seen)}")
    for each in (looking, *watchers):
        each.cancel()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    for name, default in (("seconds", 60), ("rate", 500), ("watchers", 0), ("clients", 8)):
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument(
        "--role", default="observer", help="role of the watchers; an operator hears of all goals"
    )
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        program, tokens = Path(folder) / "load.asl", Path(folder) / "tokens.yaml"
        program.write_text(PROGRAM)
        tokens.touch(0o600)
        tokens.write_text(
            f"bench: {{token: {TOKEN}, roles: [user]}}\n"
            + "".join(
                f"watcher{each}: {{token: {token_of(each)}, roles: [{arguments.role}]}}\n"
                for each in range(arguments.watchers)
            )
        )
        command = (
            sys.executable,
            "-m",
            "jacaros",
            "run",
            str(program),
            "--serve",
            "0",
            "--tokens",
            str(tokens),
        )
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as run:
            assert run.stderr is not None
            port = int(next(line for line in run.stderr if "serve: " in line).rpartition(":")[2])
            try:
                asyncio.run(load(port, run.pid, arguments))
                print(memory(run.pid))
            finally:
                run.terminate()
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(f"processor time of the run: {used.ru_utime + used.ru_stime:.1f} s")


if __name__ == "__main__":
    main()
