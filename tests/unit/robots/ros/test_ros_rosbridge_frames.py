"""Messages of a rosbridge server that are not operations, and messages for it that wait."""

import asyncio
import gc
import json
import shutil
import socket
import ssl
import subprocess
import threading
import time
import warnings
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import cbor2
import pytest

pytest.importorskip("websockets")

from websockets.frames import Frame
from websockets.server import ServerProtocol

from jacaros.robots.ros.drivers.rosbridge.link import BACKLOG, RosbridgeLink
from jacaros.robots.ros.protocols.rosbridge_wire import Wire
from jacaros.runtime.clock import WallClock, run

TEXT, BINARY, CONTINUATION = 1, 2, 0


class Server:
    """The other end of a `Wire`: takes and gives bytes."""

    def __init__(self) -> None:
        self._protocol = ServerProtocol(max_size=None)

    def feed(self, data: bytes) -> list[bytes]:
        """Take what the client sent; return its messages."""
        self._protocol.receive_data(data)
        messages = []
        for event in self._protocol.events_received():
            if isinstance(event, Frame):
                messages += [bytes(event.data)] * (event.opcode == TEXT)
            else:
                self._protocol.send_response(self._protocol.accept(event))  # type: ignore[arg-type]
        return messages

    def say(self, *frames: tuple[int, bytes, bool]) -> bytes:
        """Return the bytes of frames: kind, data, and whether it is the last of its message."""
        for kind, data, last in frames:
            self._protocol.send_frame(Frame(kind, data, last))  # type: ignore[arg-type]
        return self.output()

    def output(self) -> bytes:
        """Return what is to be sent."""
        return b"".join(self._protocol.data_to_send())


def told_of(payload: bytes) -> list[str]:
    told: list[str] = []
    RosbridgeLink(
        "ws://robot.example:9090", lambda: None, lambda: None, lambda _: None, told.append
    ).received(payload, binary=True)
    return told


@pytest.mark.parametrize(
    "payload",
    [
        b"",
        b"\xff" * 9,
        b"\x81" * 5000,
        b"\x5b" + b"\x7f" * 8,
        cbor2.dumps([1, 2]),
        cbor2.dumps(cbor2.CBORTag(30, [1, 0])),
        cbor2.dumps(cbor2.CBORTag(35, "(")),
        cbor2.dumps(cbor2.CBORTag(37, b"short")),
    ],
    ids=range(8),
)
def test_a_frame_of_junk_is_reported_and_ignored(payload: bytes) -> None:
    (told,) = told_of(payload)
    assert told.startswith("ignored an invalid frame of the rosbridge server: ")
    assert len(told) < 600


def test_messages_arrive_whole_however_the_network_cuts_them() -> None:
    wire, server = Wire("ws://robot.example:9090"), Server()
    assert not wire.opened
    server.feed(wire.output())
    data = server.say(
        (TEXT, b"one", True),
        (BINARY, b"t", False),
        (CONTINUATION, b"w", False),
        (9, b"ping between two parts", True),
        (CONTINUATION, b"o", True),
        (TEXT, "drei: \u00e4".encode(), True),
    )
    messages = [message for each in data for message in wire.feed(bytes([each]))]
    assert wire.opened
    assert messages == [(b"one", False), (b"two", True), ("drei: \u00e4".encode(), False)]


def test_a_server_that_is_not_a_websocket_is_refused() -> None:
    wire = Wire("ws://robot.example:9090")
    wire.feed(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n")
    assert "404" in str(wire.failure)
    assert not wire.opened


def test_nothing_is_sent_after_the_goodbye() -> None:
    wire, server = Wire("ws://robot.example:9090"), Server()
    server.feed(wire.output())
    wire.feed(server.output())
    wire.send(b"last")
    wire.close()
    wire.send(b"too late")
    wire.ping()
    assert server.feed(wire.output()) == [b"last"]


@pytest.fixture(scope="session")
def certificate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A certificate for robot.example, with its key."""
    if shutil.which("openssl") is None:
        pytest.skip("no openssl to make a certificate with")
    path = tmp_path_factory.mktemp("tls") / "robot.pem"
    made = path.with_suffix(".crt")
    command = "req -x509 -nodes -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -subj /CN=robot.example"
    name = ("-addext", "subjectAltName=DNS:robot.example")
    subprocess.run(
        ("openssl", *command.split(), *name, "-keyout", path, "-out", made), check=True, capture_output=True
    )
    path.write_bytes(path.read_bytes() + made.read_bytes())
    return path


class SecureServer(Server):
    """The same behind TLS."""

    def __init__(self, certificate: Path) -> None:
        super().__init__()
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate)
        self._incoming, self._outgoing = ssl.MemoryBIO(), ssl.MemoryBIO()
        self._tls = context.wrap_bio(self._incoming, self._outgoing, server_side=True)

    def feed(self, data: bytes) -> list[bytes]:
        """Take what the client sent; return its messages."""
        self._incoming.write(data)
        try:
            self._tls.do_handshake()
            plain = self._tls.read(1_000_000)
        except ssl.SSLWantReadError:
            return []
        return super().feed(plain)

    def output(self) -> bytes:
        """Return what is to be sent."""
        plain = super().output()
        if plain:
            self._tls.write(plain)
        return self._outgoing.read()


def test_a_secure_server_gets_and_sends_messages(certificate: Path) -> None:
    trusting = ssl.create_default_context(cafile=str(certificate))
    wire, server = Wire("wss://robot.example:9090", trusting), SecureServer(certificate)
    wire.send(b"not yet")
    for _ in range(4):
        server.feed(wire.output())
        wire.feed(server.output())
    assert wire.opened
    wire.send(b"hello")
    assert server.feed(wire.output()) == [b"hello"]
    assert wire.feed(server.say((TEXT, b"welcome", True))) == [(b"welcome", False)]


def test_a_server_of_another_name_is_not_trusted(certificate: Path) -> None:
    trusting = ssl.create_default_context(cafile=str(certificate))
    wire, server = Wire("wss://other.example:9090", trusting), SecureServer(certificate)
    server.feed(wire.output())
    with pytest.raises(ssl.SSLCertVerificationError):
        wire.feed(server.output())


class Robot:
    """A server on a socket, in a thread of its own; it reads only on request."""

    def __init__(self) -> None:
        self._listening = socket.create_server(("127.0.0.1", 0))
        self._listening.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        self.url = f"ws://127.0.0.1:{self._listening.getsockname()[1]}"
        self.reading = threading.Event()
        self.reading.set()
        self.received: list[dict[str, Any]] = []
        self.over = threading.Event()
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        with self._listening, self._listening.accept()[0] as connection:
            server = Server()
            while self.reading.wait() and (data := connection.recv(65536)):
                for text in server.feed(data):
                    message = json.loads(text)
                    self.received.append(message)
                    if message["op"] == "call_service":
                        connection.sendall(server.say((TEXT, b'{"op": "publish", "topic": "/a"}', True)))
                        answer = {"op": "service_response", "id": message["id"], "values": {"sum": 3}}
                        connection.sendall(server.say((TEXT, json.dumps(answer).encode(), True)))
                connection.sendall(server.output())
        self.over.set()

    def wait_for(self, condition: Callable[[], object]) -> None:
        """Wait until *condition* holds."""
        deadline = time.monotonic() + 20.0
        while not condition():
            assert time.monotonic() < deadline
            time.sleep(0.005)


@asynccontextmanager
async def linked(robot: Robot) -> AsyncIterator[tuple[RosbridgeLink, list[Any]]]:
    up, got = asyncio.Event(), list[Any]()
    link = RosbridgeLink(robot.url, up.set, lambda: None, got.append, print)
    link.start()
    await up.wait()
    yield link, got
    robot.reading.set()
    await asyncio.to_thread(link.finish, QUESTION)
    assert robot.over.wait(20)


QUESTION = {"op": "call_service", "id": "call_service:1"}
PICTURE = {"op": "publish", "topic": "/picture", "msg": {"data": "x" * 100_000}}


async def test_messages_for_a_slow_server_are_dropped_beyond_a_limit_and_the_others_arrive() -> None:
    robot = Robot()
    async with linked(robot) as (link, _):
        robot.reading.clear()
        sent = 0
        while link.send(PICTURE, droppable=True):
            sent += 1
        assert BACKLOG / 100_000 <= sent < 1000
        assert link.send({"op": "publish", "topic": "/stop"})
    assert [message.get("topic") for message in robot.received] == ["/picture"] * sent + ["/stop", None]


async def test_a_thread_stops_the_robot_while_the_loop_is_stuck_behind_a_slow_network() -> None:
    robot = Robot()
    async with linked(robot) as (link, _):
        robot.reading.clear()
        while link.send(PICTURE, droppable=True):
            pass
        robot.reading.set()
        stop = threading.Thread(target=link.send, args=({"op": "publish", "topic": "/stop"},))
        stop.start()
        # The loop, on which this runs, does nothing else meanwhile.
        robot.wait_for(lambda: any(message["topic"] == "/stop" for message in robot.received))
        stop.join()


def test_what_is_sent_after_the_loop_has_ended_arrives_and_is_answered() -> None:
    robot, links = Robot(), list[RosbridgeLink]()

    async def main() -> None:
        up = asyncio.Event()
        links.append(RosbridgeLink(robot.url, up.set, lambda: None, lambda _: None, print))
        links[0].start()
        await up.wait()

    run(main, WallClock())
    assert links[0].send({"op": "publish", "topic": "/stop"})
    links[0].finish(QUESTION)
    assert robot.over.wait(20)
    assert links[0]._awaited is None
    assert [message.get("topic") for message in robot.received] == ["/stop", None]
    links.clear()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)  # of a transport that its loop has not closed
        gc.collect()
