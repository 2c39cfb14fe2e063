"""The heartbeat of the agents' process: its path, its messages, and its sender.

A Unix socket connects one process of agents to its guard.  Each line is a JSON object.  The agents send

    {"simulated_time": B, "topics": [[NAME, TYPE], ...], "actions": [[NAME, TYPE], ...]}
                      first, and whenever what they drive has changed
    {}                every `PERIOD` seconds, from their event loop: a loop that is stuck sends nothing
    {"permit": TRIP}  after this trip: their motions are interrupted, and the robot may be released
    {"leaving": true} when their process begins to end: it stops the robot itself, and heartbeats may be late
    {"goodbye": true} before they close normally

and the guard answers, first and whenever one of these changes,

    {"found": {NAME: N, ...}, "tripped": WHY, "trip": TRIP}

with the number of receivers that it has found for each topic and action, the reason for which it is stopping the robot
(empty if it is not), and an id of that trip.

Over the graph, for a guard on the robot's computer, both directions use a topic of ``std_msgs/msg/String`` below the
agents' node: ``/patrol/heartbeat``, and ``/patrol/guard`` for the answers. Each message is a JSON object with the whole
state, because any of them may be lost:

    {"run": ID, "driving": B, "permits": {GUARD: TRIP, ...}, "goodbye": B, and the first fields above}
    {"guard": NAME, and the fields of a guard's answer above}

``driving`` is whether the robot may be moving: its last velocity was not zero, or a goal is running. It is sent before the
first such command.
"""

import asyncio
import hashlib
import json
import os
import secrets
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.guarded import Guarded, guarded_by
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.private import private_folder

PERIOD = 0.05
"""Seconds between two heartbeats."""
NO_GUARD = (
    "error: a guard needs Unix sockets, which Python does not have on Windows\n"
    "  = help: run the agents in WSL 2, on Linux or on macOS, or start them without --guard"
)
LOCAL = "the guard on this computer"
"""Its key in `Guarded.found`."""
UNREAD = 65536
"""Number of unread bytes after which a guard counts as gone."""


def socket_path(kind: str, graph: str, node: str) -> Path:
    """Return the path of the socket of *node*'s guard, in a folder that only the user can access.

    Args:
        kind, graph: the ROS graph: its kind, and domain or address.
        node: absolute name of the agents' node.

    Raises:
        UsageError: the folder belongs to another user, others can write to it, or the system has no Unix sockets.
    """
    if sys.platform == "win32":
        raise UsageError(NO_GUARD)
    folder = private_folder("heartbeats")
    mark = hashlib.sha256(f"{kind} {graph} {node}".encode()).hexdigest()[:12]
    return folder / f"guard-{mark}.sock"


def line(**fields: Any) -> bytes:
    """Return one message in the form in which it is sent."""
    return json.dumps(fields).encode() + b"\n"


def description(guarded: Guarded, simulated_time: bool) -> dict[str, Any]:
    """Return the fields that say what the process drives."""
    return {"simulated_time": simulated_time, "topics": guarded.topics, "actions": guarded.actions}


class Heartbeat:
    """Sends the heartbeat of this process to its guard, until it is closed or the guard is gone.

    It uses real time, not the run's clock: a paused simulator must not stop the robot.

    Args:
        guarded: what the process drives.
        simulated_time: whether messages use the time of a simulator.
        on_lost: called once when a guard that was ready is gone.
    """

    def __init__(self, guarded: Guarded, simulated_time: bool, on_lost: Callable[[], None]) -> None:
        self._ready: asyncio.Future[None] | None = None
        self._guarded, self._simulated_time = guarded, simulated_time
        self._on_lost = on_lost
        self._changed = False
        self._writer: asyncio.StreamWriter | None = None
        self._reading: asyncio.Task[None] | None = None
        self._timer: asyncio.TimerHandle | None = None

    async def connect(self, path: Path) -> None:
        """Connect to the guard and start the heartbeat.

        Raises:
            OSError: no guard listens there.
            UsageError: the system has no Unix sockets.
        """
        if sys.platform == "win32":
            raise UsageError(NO_GUARD)
        self._ready = asyncio.get_running_loop().create_future()
        reader, self._writer = await asyncio.open_unix_connection(path)
        self._guarded.on_change = self._note_change
        self._describe()
        self._beat()
        self._reading = asyncio.ensure_future(self._read(reader))

    async def wait_until_ready(self) -> None:
        """Wait until the guard has opened everything that was named. What it has found is in `Guarded.found`.

        Raises:
            OSError: the guard is gone before that.
        """
        assert self._ready is not None
        await self._ready

    async def close(self) -> None:
        """Say goodbye: the robot has been stopped, so the guard need not stop it."""
        writer = self._writer
        self._end()
        if writer is not None:
            with suppress(OSError):
                writer.write(line(goodbye=True))
                writer.close()
                await writer.wait_closed()

    def leaving(self) -> None:
        """Announce that the process is ending and stops its robot itself, which takes longer than a heartbeat; on any
        thread."""
        writer = self._writer
        if writer is not None:
            with suppress(OSError):
                os.write(writer.get_extra_info("socket").fileno(), line(leaving=True))

    def _note_change(self) -> None:
        # Sent with the next heartbeat: making an artifact may take long, and moves nothing yet.
        self._changed = True

    def _describe(self) -> None:
        self._changed = False
        self._send(line(**description(self._guarded, self._simulated_time)))

    def _beat(self) -> None:
        self._timer = asyncio.get_running_loop().call_later(PERIOD, self._beat)
        if self._changed:
            self._describe()
        self._send(b"{}\n")

    def _send(self, data: bytes) -> None:
        if self._writer is None:
            return
        self._writer.write(data)
        if self._writer.transport.get_write_buffer_size() > UNREAD:
            self._lose()

    async def _read(self, reader: asyncio.StreamReader) -> None:
        with suppress(OSError):
            while text := await reader.readline():
                message = json.loads(text)
                if self._ready is not None and not self._ready.done():
                    self._ready.set_result(None)
                self._guarded.found[LOCAL] = message["found"]
                if message["tripped"]:
                    self._guarded.interrupt()
                    self._send(line(permit=message["trip"]))
        self._lose()

    def _lose(self) -> None:
        if self._writer is not None:
            self._writer.transport.abort()
            self._end()
            if self._ready is not None and not self._ready.done():
                self._ready.set_exception(ConnectionError("the guard is gone"))
            else:
                self._on_lost()

    def _end(self) -> None:
        self._writer = None
        self._guarded.found[LOCAL] = {}
        self._guarded.on_change = lambda: None
        if self._timer is not None:
            self._timer.cancel()
        if self._reading is not None and self._reading is not asyncio.current_task():
            self._reading.cancel()


GRAPH_PERIOD = 0.1
"""Seconds between two heartbeats."""
ANSWERING = 2.0
"""Seconds to wait at the start for the answer of a node that listens to the heartbeat."""
LOST = 3.0
"""Seconds without an answer after which a guard is reported as lost."""
TEXT = "std_msgs/msg/String"
NEWEST = QoS(depth=1)
"""An old heartbeat is worthless: it is replaced by a newer one, and not repeated."""


def topics_of(node: str) -> tuple[str, str]:
    """Return the topics of the heartbeat of *node* and of the guards' answers."""
    return f"{node}/heartbeat", f"{node}/guard"


class GraphHeartbeat:
    """Publishes the heartbeat of this process until the node ends, and obeys the guards that answer.

    It uses real time, as `jacaros.robots.ros.heartbeat.Heartbeat` does.

    Args:
        backend: the node of the agents; it has joined the graph.
        simulated_time: whether messages use the time of a simulator.
        log: called with one line when a guard appears or disappears.
    """

    def __init__(self, backend: Backend, simulated_time: bool, log: Callable[[str], None]) -> None:
        self._simulated_time, self._log = simulated_time, log
        self._guarded = guarded_by(backend)
        self._id = secrets.token_hex(8)
        self._permits: dict[str, str] = {}
        self._heard: dict[str, float] = {}
        heartbeat, answer = topics_of(backend.node_name)
        self._publisher = backend.publisher(heartbeat, TEXT, NEWEST)
        backend.subscription(answer, TEXT, self._hear, NEWEST)
        self._guarded.announce(self._publish)
        self._beat()

    async def wait_for_answer(self) -> None:
        """Wait until a guard has answered, if a node listens to the heartbeat, for at most `ANSWERING` seconds."""
        for _ in range(round(ANSWERING / GRAPH_PERIOD)):
            if self._heard or not self._publisher.subscription_count:
                return
            await asyncio.sleep(GRAPH_PERIOD)

    def goodbye(self) -> None:
        """Report that the process ends and stops its robot itself; on any thread."""
        self._publish(goodbye=True)

    def close(self) -> None:
        """Stop the heartbeat. The topics end with the node."""
        self._timer.cancel()
        self._guarded.announce(None)

    def _beat(self) -> None:
        loop = asyncio.get_running_loop()
        self._timer = loop.call_later(GRAPH_PERIOD, self._beat)
        self._publish()
        for guard in [guard for guard, heard in self._heard.items() if loop.time() - heard > LOST]:
            del self._heard[guard], self._guarded.found[guard]
            self._log(f"warning: the guard {guard} no longer answers; it may be unable to stop the robot")

    def _publish(self, goodbye: bool = False) -> None:
        state = description(self._guarded, self._simulated_time)
        state |= {
            "run": self._id,
            "driving": self._guarded.driving,
            "permits": self._permits,
            "goodbye": goodbye,
        }
        self._publisher.publish({"data": json.dumps(state)})

    def _hear(self, sample: Sample) -> None:
        try:
            message = json.loads(sample.message.data)
            guard, trip = message["guard"], message["trip"]
        except (ValueError, KeyError, TypeError):
            return  # another program uses the topic
        if guard not in self._heard:
            self._log(f"the guard {guard} watches over the graph")
        self._heard[guard] = asyncio.get_running_loop().time()
        self._guarded.found[guard] = message["found"]
        if message["tripped"] and self._permits.get(guard) != trip:
            self._guarded.interrupt()
            self._permits[guard] = trip
            self._publish()
