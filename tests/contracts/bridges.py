"""Graphs behind a rosbridge server: nodes over the bridge, each a process, and nodes in the server's own graph."""

import contextlib
import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any, cast

from graphs import PATIENCE, InProcesses, ProcessPeer

import jacaros.robots.ros.errors

BRIDGED = (
    "rosbridge-ros1",
    "rosbridge-ros1-left",
    "rosbridge-ros2",
    "rosbridge-ros2-left",
    "rosbridge-ros2-right",
)
"""Kinds of graphs behind a bridge: whose ROS the server speaks, and which peer alone uses it; without one all do."""
STRING = "std_msgs/msg/String"
SERVER = Path(__file__).parent.parent / "rosbridge_server" / "server.py"


class BridgeServer:
    """The server as a process, with the graph behind it.

    Args:
        flavour: ``ros1`` or ``ros2``.
        flags: further ones of the program.
        port: where to listen; 0 for any.
    """

    def __init__(self, flavour: str, *flags: str, port: int = 0) -> None:
        self._process = subprocess.Popen(
            [sys.executable, str(SERVER), "--flavour", flavour, "--port", str(port), *flags],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ,
        )
        self._stdin, self._stdout = cast(
            "tuple[IO[str], IO[str]]", (self._process.stdin, self._process.stdout)
        )
        self.port: int = json.loads(self._stdout.readline()[1:])["port"]
        self._replies: dict[int, Any] = {}
        self._news = threading.Condition()
        self._number = 0
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def url(self) -> str:
        """Its address."""
        return f"ws://127.0.0.1:{self.port}"

    def do(self, command: str, *args: Any, peer: str = "", **kwargs: Any) -> Any:
        """Have the server, or a node of its graph, do something."""
        with self._news:
            self._number += 1
            number = self._number
        line = {"id": number, "do": command, "peer": peer, "args": args, "kwargs": kwargs}
        self._stdin.write(json.dumps(line) + "\n")
        self._stdin.flush()
        with self._news:
            assert self._news.wait_for(lambda: number in self._replies, PATIENCE), f"no answer to {command}"
            answer = self._replies.pop(number)
        return result_of(answer)

    def kill(self) -> None:
        """End it without a word."""
        self._process.kill()
        self._wait()

    def close(self) -> None:
        """End it."""
        if self._process.poll() is None:
            self._stdin.close()
            try:
                self._process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                self._process.kill()
        self._wait()

    def _wait(self) -> None:
        self._process.wait(PATIENCE)
        self._reader.join(PATIENCE)
        for stream in (self._stdin, self._stdout):
            with contextlib.suppress(BrokenPipeError):
                stream.close()

    def _read(self) -> None:
        for line in self._stdout:
            if line.startswith("@"):
                answer = json.loads(line[1:])
                with self._news:
                    self._replies[answer["id"]] = answer
                    self._news.notify_all()


def result_of(answer: dict[str, Any]) -> Any:
    """Give the result, or raise what went wrong there."""
    if "error" not in answer:
        return answer["result"]
    known = getattr(jacaros.robots.ros.errors, answer["error"], None)
    problem = (known or AssertionError)(answer["text"] if known else f"{answer}")
    if answer.get("reason") is not None:
        problem.reason = answer["reason"]
    raise problem


class NativePeer:
    """A peer in the server's own graph, as a node on the robot is."""

    def __init__(self, server: BridgeServer, name: str, namespace: str, options: dict[str, Any]) -> None:
        self._server = server
        self._name = name
        server.do("node", name, namespace, peer=name, **options)

    def __getattr__(self, command: str) -> Callable[..., Any]:
        if command.startswith("_"):
            raise AttributeError(command)
        return lambda *args, **kwargs: self._server.do(command, *args, peer=self._name, **kwargs)


class BehindBridge(InProcesses):
    """A graph with a bridge before it.

    Args:
        kind: of the graph.
        server: the bridge.
        native: names of the peers that are nodes of the graph itself; the others use the bridge.
    """

    def __init__(self, kind: str, server: BridgeServer, native: tuple[str, ...] = ()) -> None:
        super().__init__("rosbridge", {})
        self.kind = kind
        self.server = server
        self._native = native

    def peer(
        self, name: str, namespace: str = "", start: bool = True, flags: str = "", **options: Any
    ) -> Any:
        made: Any
        if name in self._native:
            made = NativePeer(self.server, name, namespace, options)
        else:
            environment = {"ROSBRIDGE_URI": self.server.url} | ({"PYTHON_FLAGS": flags} if flags else {})
            made = ProcessPeer("rosbridge", name, namespace, options, environment)
            self._peers.append(made)
        if start:
            made.start()
        return made

    def node_of(self, made: Any) -> str:
        return str(made.node_name()) if isinstance(made, NativePeer) else "/rosbridge_websocket"

    def kill(self, made: Any) -> None:
        if isinstance(made, NativePeer):
            self.server.do("vanish", made.node_name())
        else:
            super().kill(made)

    def close(self) -> None:
        super().close()
        self.server.close()


def behind_bridge(kind: str) -> BehindBridge:
    """Make a graph of one of the kinds `BRIDGED`."""
    _, flavour, *side = kind.split("-")
    others = {"left": ("right",), "right": ("left",)}
    return BehindBridge(kind, BridgeServer(flavour), others[side[0]] if side else ())


def talking(bridged: BehindBridge) -> list[Any]:
    """Peers that publish on /to_NAME what the other receives there: `robot` and a client."""
    robot, client = bridged.peer("robot"), bridged.peer("client")
    for sender, receiver, topic in ((robot, client, "/to_client"), (client, robot, "/to_robot")):
        sender.advertise(topic, STRING)
        receiver.subscribe(topic, STRING)
        bridged.wait_until(lambda s=sender, t=topic: s.subscription_count(t) == 1, f"{topic} is joined")
    return [robot, client]


def heard(peer: Any, topic: str, text: str) -> Callable[[], bool]:
    """Whether a text has arrived."""
    return lambda: {"data": text} in peer.received(topic)
