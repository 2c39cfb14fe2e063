"""Members on one computer without keys: they find each other without a server, and no other user finds them."""

import os
import uuid
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from players import Member, Player
from ports import free_port

from jacaros.fleet.network import Network, NoRouter, open_session, session_config
from jacaros.fleet.rendezvous import rendezvous
from jacaros.runtime.errors import UsageError

JOINED, KILLED, FROZEN = 1.0, 1.0, 3.0
"""Limits in seconds."""


@pytest.fixture
def fleet() -> str:
    """A fleet that no other test has."""
    return f"test-{uuid.uuid4().hex[:8]}"


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    """What is closed after the test."""
    with ExitStack() as entered:
        yield entered


def listening(pid: int) -> list[str]:
    """The sockets of a process that wait for the network, as in /proc/net."""
    inodes = set()
    for each in Path(f"/proc/{pid}/fd").iterdir():
        target = os.readlink(each)
        if target.startswith("socket:["):
            inodes.add(target[8:-1])
    found = []
    for kind in ("tcp", "tcp6", "udp", "udp6"):
        for line in Path(f"/proc/net/{kind}").read_text(encoding="utf-8").splitlines()[1:]:
            if line.split()[9] in inodes:
                found.append(f"{kind} {line.split()[1]}")
    return found


def test_members_find_each_other_within_a_second_and_outlive_each_other(fleet: str, stack: ExitStack) -> None:
    first, second = (stack.enter_context(Member(fleet, name)).joined() for name in ("first", "second"))
    assert first.sees("second") + second.sees("first") < JOINED
    first.kill()
    assert second.misses("first") < KILLED
    third = stack.enter_context(Member(fleet, "third")).joined()
    assert second.sees("third") + third.sees("second") < JOINED
    second.kill()
    third.misses("second")
    fourth = stack.enter_context(Member(fleet, "fourth")).joined()
    assert third.sees("fourth") + fourth.sees("third") < JOINED
    third.send("fourth", "hello")
    fourth.hears("third", "hello")


def test_members_that_start_together_all_find_each_other(fleet: str, stack: ExitStack) -> None:
    names = [f"m{number}" for number in range(5)]
    members = [stack.enter_context(Member(fleet, name)) for name in names]
    for member in members:
        member.joined()
    for member in members:
        for name in names:
            member.sees(name, 2.0)


def test_a_frozen_member_is_missed_and_comes_back_when_it_thaws(fleet: str, stack: ExitStack) -> None:
    first, second = (stack.enter_context(Member(fleet, name)).joined() for name in ("first", "second"))
    for frozen, other in ((first, second), (second, first)):
        other.sees(frozen.name)
        frozen.freeze()
        assert other.misses(frozen.name) < FROZEN
        frozen.thaw()
        other.sees(frozen.name)
        frozen.send(other.name, "back")
        other.hears(frozen.name, "back")


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="needs /proc of Linux")
def test_nothing_listens_on_any_interface(fleet: str, stack: ExitStack) -> None:
    member = stack.enter_context(Member(fleet, "member")).joined()
    assert listening(member.process.pid) == []


def test_a_member_is_found_while_its_socket_is_being_made(fleet: str) -> None:
    own, _ = rendezvous(fleet)
    own.unlink(missing_ok=True)  # as Zenoh does before it listens
    assert own in rendezvous(fleet)[1]


def test_fleets_do_not_see_each_other(fleet: str, stack: ExitStack) -> None:
    one = stack.enter_context(Member(fleet, "one")).joined()
    other = stack.enter_context(Member(f"{fleet}-b", "other")).joined()
    third = stack.enter_context(Member(f"{fleet}-b", "third")).joined()
    third.sees("other")
    other.sees("third")
    assert "came" not in "".join(line for line in one.lines if "/one/" not in line)
    assert one.do("links").lines[-2] == "links"


def test_the_sockets_of_dead_members_are_removed(fleet: str, stack: ExitStack) -> None:
    dead = stack.enter_context(Member(fleet, "dead")).joined()
    endpoint = session_config(Network(fleet, "member")).get_json("listen/endpoints")
    folder = Path(endpoint[endpoint.index("/") :].partition('"')[0]).parent
    files = {*folder.glob("*.sock"), *folder.glob("*.member")}
    assert any(each.suffix == ".sock" for each in files)
    dead.kill()
    dead.process.wait()
    for each in files:
        os.utime(each, (1, 1))
    session_config(Network(fleet, "member"))
    assert not files & set(folder.iterdir())


def test_a_message_that_is_too_large_is_dropped_and_the_next_one_arrives(
    fleet: str, stack: ExitStack
) -> None:
    limit = {"transport/link/rx/max_message_size": 1 << 20}
    sender = stack.enter_context(Member(fleet, "sender")).joined()
    receiver = stack.enter_context(Member(fleet, "receiver", limit)).joined()
    sender.sees("receiver")
    sender.do("large", f"jacaros/{fleet}/to/receiver/1/from/sender/1", 2 << 20)
    sender.send("receiver", "small")
    receiver.hears("sender", "small")
    assert len(receiver.heard()) == 1


def test_routers_and_members_of_other_computers_need_keys(fleet: str) -> None:
    with pytest.raises(
        UsageError, match=r"192\.168\.1\.5: a fleet without keys stays on its computer\n  = help: .*keys"
    ):
        session_config(Network(fleet, "member", routers=("192.168.1.5",)))


@pytest.mark.parametrize(
    "address", ["", ":7447", "host:", "host:x", "host:70000", "a/b:1", "fd00::1", "[fd00::1"]
)
def test_addresses_are_checked(fleet: str, address: str) -> None:
    with pytest.raises(UsageError, match=r"error: invalid address: `.*`\n  = help: write HOST or HOST:PORT"):
        session_config(Network(fleet, "member", routers=(address,)))


@pytest.mark.parametrize(
    ("fleet", "member", "what"),
    [
        ("a/b", "m", "fleet"),
        ("", "m", "fleet"),
        ("f", "*", "member"),
        ("f", "x" * 49, "member"),
        ("f", "a@b", "member"),
    ],
)
def test_names_are_checked(fleet: str, member: str, what: str) -> None:
    with pytest.raises(UsageError, match=f"error: invalid name of a {what}: "):
        Network(fleet, member)


def test_members_talk_through_a_router_that_may_be_restarted(fleet: str, stack: ExitStack) -> None:
    at = {"routers": (f"127.0.0.1:{free_port()}",)}
    router = started_router(stack, fleet, *at["routers"])
    first, second = (stack.enter_context(Member(fleet, name, **at)).joined() for name in ("first", "second"))
    first.sees("second")
    first.send("second", "once")
    second.hears("first", "once")
    first.freeze()
    assert second.misses("first") < FROZEN
    first.thaw()
    second.sees("first")
    router.kill()
    assert second.misses("first") < KILLED
    router.process.wait()
    started_router(stack, fleet, *at["routers"])
    second.sees("first")
    first.send("second", "again")
    second.hears("first", "again")
    first.kill()
    assert second.misses("first") < KILLED
    assert len(second.heard()) == 2


def test_linked_routers_forward_and_a_member_changes_to_another_when_its_own_is_killed(
    fleet: str, stack: ExitStack
) -> None:
    one, two = f"127.0.0.1:{free_port()}", f"127.0.0.1:{free_port()}"
    killed = started_router(stack, fleet, one)
    linked = {"fleet": fleet, "member": "router", "routers": (one,)}
    stack.enter_context(Player(network=linked, router=two)).opened()
    first = stack.enter_context(Member(fleet, "first", routers=(one, two))).joined()
    second = stack.enter_context(Member(fleet, "second", routers=(two,))).joined()
    first.sees("second")
    first.send("second", "forwarded")
    second.hears("first", "forwarded")
    before = len(second.lines)
    killed.kill()
    second.until(f"came jacaros/{fleet}/member/first/1", after=before)
    first.sees("second")
    first.send("second", "around")
    second.hears("first", "around")


def test_a_router_that_does_not_answer_is_named(fleet: str) -> None:
    address = f"127.0.0.1:{free_port()}"
    with pytest.raises(NoRouter, match=f"{address}: connection refused"):
        open_session(session_config(Network(fleet, "member", routers=(address,))))


def started_router(stack: ExitStack, fleet: str, address: str) -> Player:
    """A router on an address of this computer."""
    return stack.enter_context(Player(network={"fleet": fleet, "member": "router"}, router=address)).opened()
