"""Measure how an agent keeps its pace while a live page sends as much as it can.

The agent ticks 50 times a second. A client in a process of its own has the token of its page, and floods it. Each line
shows the ticks per second, the replies per second, and how many of the replies were errors.

    python benchmarks/page_flood.py --seconds 10
"""

import argparse
import asyncio
import json
import multiprocessing
import time
from contextlib import suppress
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

import jacaros
from jacaros import Mas
from jacaros.look import view

PROGRAM = """
{ offer(goal, count(n(number)), at_most(any)) }
counted(0).
!tick[every(20)].
+!tick : counted(N) <- -+counted(N + 1).
+!count(_).
+!wait(_) <- .wait(10).
endless(X) :- endless(Y) & X = Y + 1.
"""
ASKED = " & ".join(["counted(X)"] * 3_400)
AGENT = {"agent": "bob"}
FLOODS: dict[str, dict[str, Any]] = {
    "nothing": {},
    "40 KB questions": {"do": "console", **AGENT, "text": f"?{ASKED}"},
    "2 KB questions": {"do": "console", **AGENT, "text": f"?{ASKED[:1_995].rpartition(' & ')[0]}"},
    "endless questions": {"do": "console", **AGENT, "text": "?endless(X)"},
    "short questions": {"do": "console", **AGENT, "text": "?counted(N)"},
    "offered goals": {"do": "achieve", **AGENT, "goal": "count", "arguments": {"n": 1}},
    "goals that wait": {"do": "console", **AGENT, "text": "!wait(1)"},
    "beliefs": {"do": "console", **AGENT, "text": "-+seen(1)"},
    "why": {"do": "why", "question": "+counted(_)"},
    "stories": {"do": "story"},
    "lists of goals": {"do": "goals"},
}
AT_ONCE = 500
"""Maximum number of commands without a reply."""


def flood(
    address: str, command: dict[str, Any], seconds: float, results: "multiprocessing.Queue[tuple[int, int]]"
) -> None:
    """Send a command again and again, and count the replies and the errors among them."""
    replies = errors = sent = 0
    until = time.monotonic() + seconds
    text = json.dumps({**command, "id": 1})
    with suppress(ConnectionClosed, TimeoutError), connect(address, max_size=None) as socket:
        while time.monotonic() < until:
            while command and sent - replies < AT_ONCE and time.monotonic() < until:
                socket.send(text)
                sent += 1
                if sent % 50 == 0:
                    break
            replied, failed = _received(socket)
            replies, errors = replies + replied, errors + failed
    results.put((replies, errors))


def _received(socket: ClientConnection) -> tuple[int, int]:
    replies = errors = 0
    with suppress(TimeoutError):
        while True:
            message = socket.recv(timeout=0.01)
            if '"kind":"reply"' in str(message[:200]):
                replies += 1
                errors += '"ok":false' in str(message[:200])
    return replies, errors


async def measure(name: str, seconds: float) -> None:
    """Flood the page of a new run."""
    results: multiprocessing.Queue[tuple[int, int]] = multiprocessing.Queue()
    async with (
        Mas(seed=1, world="none", on_print=lambda *_: None, on_log=lambda *_: None) as mas,
        view(mas) as page,
    ):
        bob = mas.add_agent("bob", PROGRAM)
        address = f"{page.replace('http', 'ws', 1)}live"
        client = multiprocessing.Process(target=flood, args=(address, FLOODS[name], seconds + 2, results))
        client.start()
        await asyncio.sleep(1.5)
        before, begun = bob.ask("counted(N)"), time.monotonic()
        await asyncio.sleep(seconds)
        after, ended = bob.ask("counted(N)"), time.monotonic()
        assert before is not None
        assert after is not None
        ticks = (after["N"] - before["N"]) / (ended - begun)
        replies, errors = await asyncio.to_thread(results.get)
        await asyncio.to_thread(client.join)
    print(
        f"{name:20} {ticks:6.1f} ticks/s {replies / (seconds + 2):8.1f} replies/s {errors:6} errors",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=10.0, help="seconds per flood (default: 10)")
    parser.add_argument("flood", nargs="*", help=f"of {', '.join(FLOODS)} (default: all)")
    options = parser.parse_args()
    for name in options.flood or FLOODS:
        jacaros.run(measure(name, options.seconds))


if __name__ == "__main__":
    main()
