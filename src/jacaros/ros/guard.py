"""The guard process, which stops the robot when its agents no longer can.

It receives the heartbeat of one process of agents (`jacaros.ros.heartbeat`), on the same computer or over the graph,
and joins the same ROS graph under a name of its own.
"""

import asyncio
import json
import math
import secrets
import signal
import socket
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from jacaros.errors import UsageError
from jacaros.ros.backend import Backend
from jacaros.ros.brakes import CANCELLING, Brakes
from jacaros.ros.graph_heartbeat import NEWEST, TEXT, topics_of
from jacaros.ros.guarded import Named
from jacaros.ros.guarding import Watch
from jacaros.ros.heartbeat import NO_GUARD, line
from jacaros.ros.node import Sample

PERIOD = 0.05
"""Seconds between two zero velocities while the robot is being stopped."""
CANCELLED = 2.0
"""Seconds during which goals are cancelled: one may be on its way. Later ones are not the agents'."""
CONNECTING = 15.0
"""Seconds that a guard for one run waits for its agents."""
GOODBYE = 5.0
"""Seconds that the agents have to end after guard and agents received a signal."""
ENDING = 1.0
"""Seconds for which a guard stops the robot even after a signal to end."""
TIMEOUT = 0.3
"""Seconds without a heartbeat from the same computer after which the guard stops the robot."""
NETWORK_TIMEOUT = 0.5
"""The same over the graph: Wi-Fi often delays messages by 0.3 s."""


class Guard:
    """Receives the heartbeat of one process of agents after another.

    Args:
        backend: the guard's node.
        agents: absolute name of the agents' node.
        path: path of the socket.
        timeout: seconds without a heartbeat after which it stops the robot; None: `TIMEOUT` and `NETWORK_TIMEOUT`.
        once: end when the agents have ended normally, or if none connect; agents on other computers are ignored.
        log: called with one line.
        orphaned: called when agents have died, after that was logged.
    """

    def __init__(
        self,
        backend: Backend,
        agents: str,
        path: Path,
        timeout: float | None,
        once: bool,
        log: Callable[[str], None],
        orphaned: Callable[[], None] = lambda: None,
    ) -> None:
        self._backend, self._agents, self._path, self._once, self._log = backend, agents, path, once, log
        self._orphaned = orphaned
        self._network_timeout = NETWORK_TIMEOUT if timeout is None else timeout
        self._watch = Watch(TIMEOUT if timeout is None else timeout, self._trip, self._release)
        self._brakes = Brakes(backend, log)
        self._writer: asyncio.StreamWriter | None = None
        self._answer: Callable[[bytes], None] = lambda message: None
        self._run = ""
        """The run that is heard over the graph."""
        self._tripped_at = self._cancelled_at = -math.inf
        self._trip_id = ""
        self._reported: dict[str, int] = {}
        self._ending = False
        self._wake = asyncio.Event()
        self._wanted: tuple[list[Named], list[Named]] = ([], [])

    async def run(self) -> None:
        """Run until SIGINT or SIGTERM, or with *once* until the agents have ended.

        Raises:
            UsageError: another guard uses the same path, or the system has no Unix sockets.
        """
        if sys.platform == "win32":
            raise UsageError(NO_GUARD)
        loop = asyncio.get_running_loop()
        listening = _listening(self._path)
        made = self._path.stat().st_ino
        try:
            await self._backend.start()
            # Set afterwards: the backend's own handlers would refuse the messages that still stop the robot.
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                loop.add_signal_handler(number, self._end)
            server = await asyncio.start_unix_server(self._serve, sock=listening)
            if not self._once:
                self._listen()
            await self._guard(loop)
            server.close()
            await self._disconnect()
            await self._backend.close()
        finally:
            listening.close()
            with suppress(FileNotFoundError):
                if self._path.stat().st_ino == made:  # the next guard of these agents may have replaced it
                    self._path.unlink()

    async def _disconnect(self) -> None:
        writer, self._writer = self._writer, None
        if writer is not None:
            writer.close()
            with suppress(OSError):
                await writer.wait_closed()

    async def _guard(self, loop: asyncio.AbstractEventLoop) -> None:
        deadline = loop.time() + CONNECTING if self._once else math.inf
        while True:
            now = loop.time()
            rest = min(self._watch.look(now), PERIOD if self._watch.tripped else 1.0)
            self._forget_gone()
            if self._watch.tripped:
                self._brake(now)
            if self._ending and not self._watch.agents and now - self._tripped_at >= ENDING:
                return
            if self._watch.agents:
                deadline = math.inf
            if now > deadline:
                return
            self._wake.clear()
            with suppress(TimeoutError):
                await asyncio.wait_for(self._wake.wait(), rest)

    def _brake(self, now: float) -> None:
        self._brakes.stop()
        if now - self._tripped_at < CANCELLED and now - self._cancelled_at >= CANCELLING:
            self._cancelled_at = now
            self._brakes.cancel()

    def _end(self) -> None:
        """Handle a signal: end, but not before the agents, which have probably received it, too."""
        self._ending = True
        asyncio.get_running_loop().call_later(GOODBYE, self._watch.leave)
        self._wake.set()

    def _trip(self, why: str) -> None:
        now = asyncio.get_running_loop().time()
        self._tripped_at, self._cancelled_at = now, -math.inf
        self._trip_id = secrets.token_hex(4)
        self._brake(now)
        self._report()
        self._log(f"warning: {self._agents}: {why}; the guard {self._brakes.described} until they return")

    def _release(self) -> None:
        self._cover()
        self._log(f"{self._agents}: the guard has released the robot")

    def _forget_gone(self) -> None:
        if not (self._watch.agents or self._watch.tripped) and any(self._wanted):
            self._wanted = ([], [])
            self._cover()

    # ---- the heartbeat

    def _listen(self) -> None:
        """Listen to agents on other computers."""
        heartbeat, answer = topics_of(self._agents)
        publisher = self._backend.publisher(answer, TEXT, NEWEST)
        self._answer = lambda message: publisher.publish({"data": message.decode()})
        self._backend.subscription(heartbeat, TEXT, self._hear, NEWEST)

    def _hear(self, sample: Sample) -> None:
        """Take a heartbeat from the graph, unless the agents are on this computer and were heard already."""
        watch = self._watch
        try:
            message = json.loads(sample.message.data)
            run, driving, permits = message["run"], message["driving"], message["permits"]
        except (ValueError, KeyError, TypeError):
            return  # another program uses the topic
        if self._writer is not None or (run != self._run and watch.agents and not watch.tripped):
            return
        if not watch.agents:
            if self._ending:
                return  # a guard that is ending takes no agents, as at its socket
            watch.connect(asyncio.get_running_loop().time(), self._network_timeout)
        elif message["goodbye"] and watch.driving:
            self._brakes.stop()  # the zero velocity of the agents may have been lost
        self._run, watch.driving = run, driving
        self._take(message | {"permit": permits.get(self._backend.node_name)})

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        # Of two processes with one name, the first keeps its guard; one that is ending takes no others.
        if (self._writer is not None and not self._watch.tripped) or (
            self._ending and not self._watch.agents
        ):
            writer.close()
            return
        if self._writer is not None:
            self._writer.close()  # that of a frozen process
        self._writer = writer
        self._watch.connect(asyncio.get_running_loop().time())
        with suppress(OSError, ValueError):
            while text := await reader.readline():
                if self._writer is writer:
                    self._take(json.loads(text))
        writer.close()
        if self._writer is writer:
            self._writer = None
            if self._watch.agents:
                self._watch.lose()
                self._orphaned()
        self._wake.set()

    def _take(self, message: dict[str, Any]) -> None:
        self._watch.beat(asyncio.get_running_loop().time())
        if "topics" in message:
            self._brakes.simulated_time = message["simulated_time"]
            self._wanted = (_pairs(message["topics"]), _pairs(message["actions"]))
            if not self._watch.tripped:
                self._cover()
            self._report()
        elif self._brakes.found != self._reported:
            self._report()
        if message.get("leaving"):
            self._watch.expect_end()
        if message.get("permit") == self._trip_id:
            self._watch.permit()
        if message.get("goodbye"):
            self._watch.leave()
            self._forget_gone()
            self._ending = self._ending or self._once

    def _cover(self) -> None:
        self._watch.armed = any(self._wanted)
        self._brakes.cover(*self._wanted)

    def _report(self) -> None:
        self._reported = self._brakes.found
        state = line(
            guard=self._backend.node_name,
            found=self._reported,
            tripped=self._watch.tripped,
            trip=self._trip_id,
        )
        if self._writer is not None:
            self._writer.write(state)
        elif self._watch.agents:
            self._answer(state)


def _pairs(written: list[list[str]]) -> list[Named]:
    return [(name, kind) for name, kind in written]


def _listening(path: Path) -> socket.socket:
    """Listen at *path*, in place of a dead guard."""
    if sys.platform == "win32":
        raise UsageError(NO_GUARD)
    made = socket.socket(socket.AF_UNIX)
    try:
        made.connect(str(path))
    except OSError:
        path.unlink(missing_ok=True)
    else:
        made.close()
        raise UsageError("another guard of these agents is already running")
    made.close()
    made = socket.socket(socket.AF_UNIX)
    made.bind(str(path))
    return made
