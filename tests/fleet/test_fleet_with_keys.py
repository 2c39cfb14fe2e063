"""Members with keys, and strangers: none without the right key is let in or heard, and the members run on."""

import socket
import threading
import time
import uuid
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import pytest
from players import Member, Player
from ports import free_port

from jacaros.fleet.authority import create_keys

FLOOD = 10_000
FROZEN = 3.0


class Lab:
    """A fleet with keys: `a` and `b` are there, and other processes may come."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self.fleet = f"test-{uuid.uuid4().hex[:8]}"
        self.folder = folder / self.fleet
        self.stack = stack
        create_keys(self.folder, self.fleet, ["a", "b", "c", "mallory"])
        self.port = free_port()
        self.a = self.member("a", listen=self.port).joined()
        self.b = self.member("b").joined()
        self.said = 0

    def member(self, name: str, keys: Path | None = None, **fields: Any) -> Member:
        """Start a member."""
        return self.stack.enter_context(Member(self.fleet, name, keys=keys or self.folder / name, **fields))

    def stranger(self, **plain: Any) -> Player:
        """Start a client that connects to `a`."""
        settings = {"mode": "client", "connect/timeout_ms": 0, "scouting/multicast/enabled": False}
        return self.stack.enter_context(Player(plain=settings | plain))

    def router(self) -> str:
        """Start a router, and return its address."""
        address = f"127.0.0.1:{free_port()}"
        network = {"fleet": self.fleet, "member": "router", "keys": self.folder / "router"}
        self.stack.enter_context(Player(network=network, router=address)).opened()
        return address

    def mallory(self, **fields: Any) -> Player:
        """Start a session with the key of a member that does not announce itself."""
        network = {"fleet": self.fleet, "member": "mallory", "keys": self.folder / "mallory", **fields}
        return self.stack.enter_context(Player(network=network)).opened()

    def runs_on(self) -> None:
        """Assert that `a` and `b` talk, and that neither has heard or seen anything false."""
        self.said += 1
        self.a.sees("b")
        self.b.sees("a")
        self.a.send("b", f"hello{self.said}")
        self.b.send("a", f"hi{self.said}")
        self.b.hears("a", f"hello{self.said}")
        self.a.hears("b", f"hi{self.said}")
        for member, other, word in ((self.a, "b", "hi"), (self.b, "a", "hello")):
            own = f"heard jacaros/{self.fleet}/to/{member.name}/1/from/{other}/1 {word}"
            heard = [line for line in member.heard() if "/from/c/1 " not in line]
            assert heard == [f"{own}{number}" for number in range(1, self.said + 1)]
            seen = {line.partition("/member/")[2] for line in member.lines if "/member/" in line}
            assert seen - {"c/1"} == {"a/1", "b/1"}


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    """What is closed after the test."""
    with ExitStack() as entered:
        yield entered


@pytest.fixture(scope="module")
def two(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    """A fleet with two members, for all tests: none of them harms it."""
    with ExitStack() as members:
        yield Lab(tmp_path_factory.mktemp("keys"), members)


@pytest.fixture
def lab(two: Lab, stack: ExitStack) -> Iterator[Lab]:
    """The fleet; what the test adds is closed after it."""
    two.stack, before = stack, two.stack
    yield two
    two.stack = before


def connected(player: Player, line: str) -> None:
    """Wait until a session has these links."""
    for _ in range(200):
        if line in player.do("links").lines:
            return
        time.sleep(0.05)
    raise AssertionError(f"{line} is not among {player.lines}")


def test_a_client_without_tls_is_refused(lab: Lab) -> None:
    lab.stranger(**{"connect/endpoints": [f"tcp/127.0.0.1:{lab.port}"]}).until("refused .*")
    lab.runs_on()


def test_a_client_without_a_key_is_refused(lab: Lab) -> None:
    tls = {"root_ca_certificate": lab.folder / "a" / "ca.pem", "verify_name_on_connect": False}
    endpoint = [f"tls/127.0.0.1:{lab.port}"]
    lab.stranger(**{"connect/endpoints": endpoint, "transport/link/tls": tls}).until("refused .*")
    lab.runs_on()


def test_a_member_of_another_authority_is_refused_and_refuses(lab: Lab, tmp_path: Path) -> None:
    create_keys(tmp_path / "false", lab.fleet, ["b"])
    false = lab.member("b", tmp_path / "false" / "b").joined()  # finds `a` and `b` by multicast
    lab.member("b", tmp_path / "false" / "b", routers=(f"127.0.0.1:{lab.port}",)).until("refused .*")
    lab.runs_on()
    assert "links" in false.do("links").lines
    assert not false.heard()


def test_a_member_that_is_not_in_the_list_is_not_heard(lab: Lab) -> None:
    create_keys(lab.folder, lab.fleet, ["late"])  # after `a` and `b` have read their lists
    late = lab.member("late").joined()
    connected(late, "links a b")
    late.send("a", "hello")
    lab.runs_on()
    assert not late.heard()
    assert [line for line in late.lines if line.startswith("came ")] == [
        f"came jacaros/{lab.fleet}/member/late/1"
    ]


def attack(lab: Lab, mallory: Player) -> None:
    """Let a member speak, listen and ask in the name of others."""
    own = f"jacaros/{lab.fleet}"
    for key in ("to/b/1/**", "to/*/1/**", "**"):
        mallory.do("hear", f"{own}/{key}")
    mallory.do("hear", "**").do("token", f"{own}/member/a/2").do("token", f"{own}/member/c/1")
    for key in ("to/b/1/from/a/1", "to/*/*/from/a/1", "to/**", "**", "to/b/1/from/*/1"):
        mallory.do("put", f"{own}/{key}", "false")
        mallory.do("delete", f"{own}/{key}")
    mallory.do("query", "**").do("query", "@/**").do("query", f"{own}/member/**")
    mallory.do("flood", f"{own}/to/b/1/from/a/1", FLOOD)
    lab.runs_on()
    heard = mallory.heard()
    assert not [line for line in heard if line.split()[-1].startswith(("hello", "hi"))]
    assert not [line for line in mallory.lines if line.startswith("answer")]


def test_a_member_can_neither_speak_nor_listen_in_the_name_of_another(lab: Lab) -> None:
    mallory = lab.mallory()
    connected(mallory, "links a b")
    attack(lab, mallory)


def test_neither_can_a_member_behind_a_router(lab: Lab) -> None:
    mallory = lab.mallory(routers=(lab.router(),))
    connected(mallory, "links router")
    attack(lab, mallory)


def test_members_talk_to_those_behind_a_router(lab: Lab) -> None:
    c = lab.member("c", routers=(lab.router(),)).joined()
    lab.a.sees("c")
    c.sees("a")
    c.send("a", "from-c")
    lab.a.hears("c", "from-c")
    c.freeze()
    assert lab.a.misses("c") < FROZEN
    c.thaw()
    lab.a.sees("c")
    lab.runs_on()


def test_a_recorded_connection_cannot_be_replayed(lab: Lab) -> None:
    """Bytes of a whole session of a member, sent again by a stranger who has listened on the line."""
    recorded = bytearray()
    with socket.create_server(("127.0.0.1", 0)) as proxy:
        threading.Thread(target=forward, args=(proxy, lab.port, recorded), daemon=True).start()
        c = lab.member("c", routers=(f"127.0.0.1:{proxy.getsockname()[1]}",)).joined()
        c.sees("a")
        c.send("a", "recorded")
        lab.a.hears("c", "recorded")
        before = len(lab.a.heard())
        c.kill()
        c.process.wait()
    assert len(recorded) > 1000
    with socket.create_connection(("127.0.0.1", lab.port)) as again, suppress(ConnectionError):
        again.sendall(recorded)
        again.shutdown(socket.SHUT_WR)
        while again.recv(1 << 16):
            pass
    lab.runs_on()
    assert len(lab.a.heard()) == before + 1


def forward(proxy: socket.socket, port: int, recorded: bytearray) -> None:
    """Forward one connection to a port, and record what the client sends."""
    client, _ = proxy.accept()
    with client, socket.create_connection(("127.0.0.1", port)) as server, suppress(OSError):
        threading.Thread(target=copy, args=(server, client, bytearray()), daemon=True).start()
        copy(client, server, recorded)


def copy(source: socket.socket, target: socket.socket, recorded: bytearray) -> None:
    """Copy bytes from one connection to another one."""
    with suppress(OSError):
        while data := source.recv(1 << 16):
            recorded += data
            target.sendall(data)


def test_connections_that_say_nothing_do_not_stop_members(lab: Lab) -> None:
    """The last test: Zenoh waits for 0.1 s after each failed handshake, which would delay those who join."""
    with ExitStack() as idle:
        for _ in range(150):
            idle.enter_context(socket.create_connection(("127.0.0.1", lab.port))).sendall(b"\0" * 99)
        lab.runs_on()
