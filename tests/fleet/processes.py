"""Members of a fleet in processes of their own, a router, and a proxy that delays and cuts, for tests."""

import asyncio
import json
import os
import random
import signal
import socket
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any, Self

from ports import free_port

HERE = Path(__file__).parent
_FLEETS = count(1)


def new_fleet() -> str:
    """Return a name of a fleet that no other test uses."""
    return f"test{os.getpid()}x{next(_FLEETS)}"


class Process:
    """A process that ends with its standard input, and with the test."""

    def __init__(self, *arguments: str) -> None:
        self.popen = subprocess.Popen([sys.executable, *arguments], stdin=subprocess.PIPE)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.signal(signal.SIGCONT)
        assert self.popen.stdin is not None
        self.popen.stdin.close()
        try:
            self.popen.wait(30)
        except subprocess.TimeoutExpired:
            self.kill()
            raise

    def signal(self, number: int) -> None:
        """Send it a signal."""
        self.popen.send_signal(number)

    def kill(self) -> None:
        """Kill it."""
        self.popen.kill()
        self.popen.wait()


class Router(Process):
    """A router of a fleet on a port of this computer. It ends with Ctrl+C."""

    def __init__(self, fleet: str, port: int) -> None:
        super().__init__("-m", "jacaros", "fleet", "router", fleet, "--listen", f"127.0.0.1:{port}")
        until(lambda: is_open(port), 10, "the router listens")

    def __exit__(self, *_: object) -> None:
        self.signal(signal.SIGINT)
        super().__exit__()


def is_open(port: int) -> bool:
    """Return whether something listens on a port."""
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def until(holds: Callable[[], object], seconds: float, what: str) -> float:
    """Wait until something holds. Return the seconds that this took."""
    begin = time.monotonic()
    while not holds():
        assert time.monotonic() - begin < seconds, f"not within {seconds} s: {what}"
        time.sleep(0.01)
    return time.monotonic() - begin


class Member(Process):
    """A member of a fleet. See `member_process`."""

    def __init__(self, fleet: str, name: str, folder: Path, *routers: str) -> None:
        self.fleet, self.name, self.path = fleet, name, folder / f"{name}{next(_FLEETS)}.jsonl"
        self.path.touch()
        super().__init__(str(HERE / "member_process.py"), fleet, name, str(self.path), *routers)

    def order(self, *order: object) -> None:
        """Give it an order."""
        assert self.popen.stdin is not None
        self.popen.stdin.write(json.dumps(order).encode() + b"\n")
        self.popen.stdin.flush()

    def events(self, kind: str) -> list[list[Any]]:
        """Return what it has noted of a kind: time, kind, data."""
        lines = self.path.read_text(encoding="utf-8").split("\n")[:-1]  # the last one may be half written
        return [event for event in map(json.loads, lines) if event[1] == kind]

    def has(self, kind: str, *data: object) -> bool:
        """Return whether it has noted an event."""
        return any(event[2:] == list(data) for event in self.events(kind))

    def until(self, kind: str, *data: object, seconds: float = 60.0, times: int = 1) -> None:
        """Wait until it has noted an event, perhaps more than once."""
        what = f"{self.name} notes {kind} {data}"
        until(lambda: sum(each[2:] == list(data) for each in self.events(kind)) >= times, seconds, what)

    def has_all_outcomes(self) -> None:
        """Wait until all its operations have ended."""
        until(lambda: len(self.events("outcome")) >= len(self.events("operation")), 30, "all operations end")

    def knows(self, *others: "Member") -> None:
        """Wait until it knows the artifacts of other members."""
        for other in others:
            self.until("member", other.name, "joined")
            until(lambda other=other: other.events("began"), 60, f"{other.name} has begun")  # type: ignore[misc]


def compare(sender: Member, receiver: Member) -> Counter[str]:
    """Check what both noted of the messages of one: each came once, in order, or came back. Return how many did what."""
    sent = [event[2] for event in sender.events("sent")]
    own = set(sent)
    came = [event[2] for event in receiver.events("received") if event[2] in own]
    back = {event[2]: event[3] for event in sender.events("undelivered")}
    assert len(set(came)) == len(came), f"twice: {[each for each, n in Counter(came).items() if n > 1][:9]}"
    place = {number: at for at, number in enumerate(sent)}
    assert came == sorted(came, key=place.__getitem__), "out of order"
    arrived = set(came)
    lost = [each for each in sent if each not in arrived and each not in back]
    assert not lost, f"neither delivered nor returned: {lost[:9]} ({len(lost)})"
    both = [each for each in back if each in arrived and back[each] != "unconfirmed"]
    assert not both, f"delivered and returned: {both[:9]}"
    return Counter(sent=len(sent), received=len(came), returned=len(back))


def compare_operations(caller: Member, owner: Member) -> Counter[str]:
    """Check that each operation has one outcome, one effect if it succeeded, and at most one otherwise."""
    asked = [event[2] for event in caller.events("operation")]
    outcomes = Counter(event[2] for event in caller.events("outcome"))
    effects = Counter(event[2] for event in owner.events("effect"))
    assert outcomes == Counter(asked), (
        f"not one outcome each: {outcomes - Counter(asked)}, {Counter(asked) - outcomes}"
    )
    assert not [each for each, times in effects.items() if times > 1]
    good = [event[2] for event in caller.events("outcome") if event[3] == "ok"]
    assert not [each for each in good if not effects[each]]
    return Counter(asked=len(asked), succeeded=len(good), effects=len(effects))


class Proxy:
    """Passes connections on to a port, in a thread of its own.

    Attributes:
        delay: seconds that everything takes.
        stalls: share of pieces that take half a second more, as what TCP has to send again.
    """

    def __init__(self, to: int) -> None:
        self.port, self._to = free_port(), to
        self.delay = self.stalls = 0.0
        self._is_cut = False
        self._writers: set[asyncio.StreamWriter] = set()
        self._random = random.Random(1)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        until(lambda: is_open(self.port), 5, "the proxy listens")
        return self

    def __exit__(self, *_: object) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(10)

    def _run(self) -> None:
        self._loop.run_until_complete(self._serve())
        self._loop.run_forever()
        self._loop.run_until_complete(self._end())
        self._loop.close()

    async def _serve(self) -> None:
        self._server = await asyncio.start_server(self._accept, "127.0.0.1", self.port)

    async def _end(self) -> None:
        self._server.close()
        self._close_all()
        ending = asyncio.all_tasks() - {asyncio.current_task()}
        for task in ending:
            task.cancel()
        await asyncio.gather(*ending, return_exceptions=True)

    def cut(self) -> None:
        """Let nothing through, in silence."""
        self._is_cut = True

    def heal(self) -> None:
        """Let new connections through. The streams of the former ones have holes."""
        self._is_cut = False
        self._loop.call_soon_threadsafe(self._close_all)

    def _close_all(self) -> None:
        for each in self._writers:
            each.close()
        self._writers.clear()

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._writers.add(writer)
        if self._is_cut:
            return  # accepted by the kernel, and never answered
        try:
            there, back = await asyncio.open_connection("127.0.0.1", self._to)
        except OSError:
            writer.close()
            return
        self._writers.add(back)
        await asyncio.gather(self._pass(reader, back), self._pass(there, writer))

    async def _pass(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        pieces: asyncio.Queue[tuple[float, bytes]] = asyncio.Queue()
        writing = asyncio.ensure_future(self._write(pieces, writer))
        try:
            while piece := await reader.read(1 << 16):
                stall = 0.5 if self._random.random() < self.stalls else 0.0
                pieces.put_nowait((self._loop.time() + self.delay + stall, piece))
        except OSError:
            pass
        finally:
            writing.cancel()
            writer.close()

    async def _write(self, pieces: asyncio.Queue[tuple[float, bytes]], writer: asyncio.StreamWriter) -> None:
        while True:
            at, piece = await pieces.get()
            await asyncio.sleep(at - self._loop.time())
            if not self._is_cut:
                writer.write(piece)
                await writer.drain()
