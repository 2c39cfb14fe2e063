"""A rosbridge server for tests, in front of a ROS graph inside its process.

    python server.py [--port 0] [--flavour ros1|ros2]

It behaves like rosbridge_suite: version 0.11 for ROS 1, version 2 for ROS 2, each with rosapi beside it.  What it
says is the line ``@{"port": N}``.  Then it takes commands as JSON lines on standard input, like the peers of the
contract tests: nodes of its own graph, made by ``node``, follow the commands of ``peer``, and the bridge itself can be
stopped, started and frozen while the graph lives on, as on a robot.
"""

import argparse
import asyncio
import sys
import tempfile
from collections import deque
from collections.abc import Callable, Coroutine, Mapping
from functools import partial
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent.parent / "contracts"))

from autobahn.asyncio.websocket import WebSocketServerFactory, WebSocketServerProtocol
from connection import Connection
from goals import SentGoals
from parameters import ParameterServices
from peer import Peer, answer, reading, reply
from rosapi import RosApi, write_ros1_types

from jacaros.robots.ros.drivers.memory.backend import MemoryBackend
from jacaros.robots.ros.drivers.memory.graph import MemoryGraph
from jacaros.robots.ros.node import NodeSettings
from jacaros.robots.ros.parameter_services import ParameterCallback, ParameterListeners
from jacaros.runtime.clock import WallClock, run

DOING = 0.002
"""Seconds after which what a client asks for is done."""
UNREGISTER_TIMEOUT = 0.3
"""Seconds for which a publisher stays after its client has left it (the server's parameter ``unregister_timeout``, 10)."""


class Socket(WebSocketServerProtocol):  # type: ignore[misc]
    """The WebSocket of one client."""

    connection: Connection | None = None
    waiting: deque[bytes]

    def onOpen(self) -> None:  # noqa: N802
        self.waiting = deque()
        self.connection = Connection(self.factory.bridge, self._write)
        self.factory.bridge.connections[self.connection] = self

    def onMessage(self, payload: bytes, isBinary: bool) -> None:  # noqa: N802, N803
        # As in the genuine server: a thread of its own does what is asked, and what it has not done is forgotten when the
        # client leaves.
        if not self.waiting:
            asyncio.get_running_loop().call_later(DOING, self._do_all)
        self.waiting.append(payload)

    def _do_all(self) -> None:
        while self.waiting and self.connection is not None:
            self.connection.receive(self.waiting.popleft())

    def onClose(self, wasClean: bool, code: int, reason: str) -> None:  # noqa: N802, N803
        self.waiting = deque()
        if self.connection is not None:
            self.factory.bridge.connections.pop(self.connection, None)
            self.connection.close()

    def _write(self, frame: bytes, binary: bool) -> None:
        if not self.factory.bridge.frozen and self.state == self.STATE_OPEN:
            self.sendMessage(frame, binary)


class Bridge:
    """The server and its graph."""

    def __init__(self, ros1: bool, folder: Path, talkative: bool = False, knows_actions: bool = True) -> None:
        self.ros1 = ros1
        self.talkative = talkative
        self.knows_actions = knows_actions and not ros1
        self.frozen = False
        self.graph = MemoryGraph()
        self.graph.parameter_listeners = _ParameterEvents(self)
        settings = NodeSettings(WallClock(), "rosbridge_websocket", interface_paths=(folder,))
        self.node = MemoryBackend(settings, self.graph)
        self.goals = SentGoals(self)
        self.parameters = ParameterServices(self.node)
        self.rosapi = RosApi(self.node, ros1, self.goals.under_way)
        self.connections: dict[Connection, Socket] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None
        self.port = 0

    async def start(self, port: int) -> None:
        """Listen."""
        loop = asyncio.get_running_loop()
        factory = WebSocketServerFactory(loop=loop)
        factory.protocol, factory.bridge = Socket, self
        factory.setProtocolOptions(maxMessagePayloadSize=10_000_000)
        self._server = await loop.create_server(factory, "127.0.0.1", port)
        self.port = self._server.sockets[0].getsockname()[1]

    def stop(self) -> None:
        """Be gone at once, as after a crash."""
        if self._server is not None:
            self._server.close()
        for connection, wire in list(self.connections.items()):
            connection.close()
            wire.transport.abort()
        self.connections.clear()

    def freeze(self, frozen: bool) -> None:
        """Read and write nothing more, without closing anything, as behind a network that is gone."""
        self.frozen = frozen
        for wire in self.connections.values():
            (wire.transport.pause_reading if frozen else wire.transport.resume_reading)()

    def begin(self, work: Coroutine[Any, Any, None]) -> None:
        """Do *work* beside the rest."""
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def unregister_later(self, publisher: Any) -> None:
        """Take a publisher out of the graph some time after its client has left it."""
        asyncio.get_running_loop().call_later(UNREGISTER_TIMEOUT, publisher.close)

    def topic_type(self, topic: str) -> str | None:
        """The type of a topic that is there."""
        return self.graph.topics().get(topic)

    def is_latched(self, topic: str) -> bool:
        """Whether all publishers keep their messages for late subscriptions."""
        publishers = self.graph.topic(topic).publishers
        return bool(publishers) and all(each.qos.durability == "transient_local" for each in publishers)


class _ParameterEvents(ParameterListeners):
    """Tells the clients what it tells the nodes of the graph."""

    def __init__(self, bridge: Bridge) -> None:
        super().__init__()
        self._bridge = bridge

    def of(self, node: str) -> list[ParameterCallback]:
        return [*super().of(node), partial(self._tell, node)]

    def _tell(self, node: str, changed: Mapping[str, Any]) -> None:
        if not self._bridge.ros1:
            for connection in list(self._bridge.connections):
                connection.tell_parameters(self._bridge.parameters.event(node, changed))


def action(bridge: Bridge, command: dict[str, Any], peers: dict[str, Peer]) -> Callable[..., Any]:
    """Return what does a command."""

    def say(text: str) -> None:
        for connection in list(bridge.connections):
            connection.say(text)

    def add_node(*args: Any, **kwargs: Any) -> None:
        peers[command["peer"]] = Peer("memory", WallClock(), *args, graph=bridge.graph, **kwargs)

    if command["peer"] in peers:
        return getattr(peers[command["peer"]], command["do"])
    actions: dict[str, Callable[..., Any]] = {
        "stop": bridge.stop,
        "start": lambda: bridge.start(bridge.port),
        "freeze": lambda: bridge.freeze(True),
        "thaw": lambda: bridge.freeze(False),
        "vanish": bridge.graph.vanish,
        "say": say,
        "rosapi": partial(setattr, bridge.rosapi, "running"),
        "rosapi_without": bridge.rosapi.remove,
        "node": add_node,
    }
    return actions[command["do"]]


async def serve(port: int, make: Callable[[], Bridge]) -> None:
    """Run until standard input ends."""
    bridge, peers = make(), dict[str, Peer]()
    await bridge.node.start()
    await bridge.start(port)
    reply({"port": bridge.port})
    commands = reading()
    while (command := await commands.get()) is not None:
        bridge.begin(answer(command, action(bridge, command, peers)))
    for each in peers.values():
        await each.close()
    bridge.stop()
    await bridge.node.close()


def main() -> None:
    """Read the options and serve."""
    parser = argparse.ArgumentParser(description="A rosbridge server for tests.")
    parser.add_argument("--port", type=int, default=0)
    parser.add_argument("--flavour", choices=("ros1", "ros2"), default="ros2")
    parser.add_argument(
        "--talkative", action="store_true"
    )  # tell clients of refusals, as some other servers do
    parser.add_argument("--without-actions", action="store_true")  # be one of before actions
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if options.flavour == "ros1":
            write_ros1_types(Path(folder))
        manner = (options.flavour == "ros1", Path(folder), options.talkative, not options.without_actions)
        run(lambda: serve(options.port, lambda: Bridge(*manner)), WallClock())


if __name__ == "__main__":
    main()
