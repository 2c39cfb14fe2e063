"""Faults between members in processes of their own, on Zenoh over loopback: the logs of both sides are compared."""

import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from ports import free_port
from processes import Member, Proxy, Router, compare, compare_operations, new_fleet, until

pytestmark = pytest.mark.slow


@pytest.fixture
def pair(tmp_path: Path) -> Iterator[tuple[Member, Member]]:
    """Two members on this computer."""
    fleet = new_fleet()
    with Member(fleet, "a", tmp_path) as a, Member(fleet, "b", tmp_path) as b:
        a.knows(b)
        b.knows(a)
        yield a, b


def _talk(*, of: Member, to: Member, messages: int, each_second: float) -> None:
    of.order("send", to.name, messages, each_second)
    of.order("operate", to.name, messages // 10, 10 / each_second)


def test_a_killed_member_is_noticed_within_a_second(pair: tuple[Member, Member]) -> None:
    a, b = pair
    _talk(of=a, to=b, messages=1000, each_second=1000)
    until(lambda: len(b.events("received")) > 100, 10, "messages arrive")
    b.kill()
    assert until(lambda: a.has("member", "b", "lost"), 5, "it is noticed") <= 1.0
    a.until("sent all")
    a.until("operated all")
    compare_operations(a, b)


def test_a_frozen_member_is_noticed_within_three_seconds_and_returns(pair: tuple[Member, Member]) -> None:
    a, b = pair
    for one, other in ((a, b), (b, a)):
        _talk(of=one, to=other, messages=500, each_second=100)
    until(lambda: b.events("received"), 10, "messages arrive")
    b.signal(signal.SIGSTOP)
    assert until(lambda: a.has("member", "b", "lost"), 5, "it is noticed") <= 3.0
    b.signal(signal.SIGCONT)
    a.until("member", "b", "joined", times=2, seconds=5)
    _settle(a, b)


def _settle(a: Member, b: Member) -> None:
    """Wait until both have ended, and compare what they noted."""
    for each in (a, b):
        each.until("sent all", seconds=30)
        each.until("operated all", seconds=30)
    for one, other in ((a, b), (b, a)):
        one.order("send", other.name, 1, 1000)
        one.until("sent all", times=2)
        last = one.events("sent")[-1][2]
        other.until("received", last)
        one.has_all_outcomes()
        tally = compare(one, other)
        assert tally["received"] >= 1
        compare_operations(one, other)


@pytest.fixture
def apart(tmp_path: Path) -> Iterator[tuple[Member, Member, Proxy]]:
    """Two members at a router, one of them by way of a proxy."""
    fleet, port = new_fleet(), free_port()
    with (
        Router(fleet, port),
        Proxy(port) as proxy,
        Member(fleet, "a", tmp_path, f"127.0.0.1:{proxy.port}") as a,
        Member(fleet, "b", tmp_path, f"127.0.0.1:{port}") as b,
    ):
        a.knows(b)
        b.knows(a)
        yield a, b, proxy


def test_a_link_that_is_cut_for_ten_seconds(apart: tuple[Member, Member, Proxy]) -> None:
    a, b, proxy = apart
    a.order("focus", "b")
    a.until("focused", True)
    for one, other in ((a, b), (b, a)):
        _talk(of=one, to=other, messages=1500, each_second=100)
    until(lambda: len(b.events("received")) > 50, 10, "messages arrive")
    proxy.cut()
    begin = time.monotonic()
    for one, other in ((a, b), (b, a)):
        one.until("member", other.name, "lost", seconds=4)
    until(lambda: time.monotonic() - begin > 10, 12, "ten seconds")
    proxy.heal()
    for one, other in ((a, b), (b, a)):
        one.until("member", other.name, "joined", times=2, seconds=10)
    _settle(a, b)
    effects = len(b.events("effect"))
    until(lambda: a.events("property")[-1][3] == effects, 5, "the newest value of a focused artifact arrives")


def test_a_slow_link_with_stalls(apart: tuple[Member, Member, Proxy]) -> None:
    a, b, proxy = apart
    proxy.delay, proxy.stalls = 0.2, 0.1
    for one, other in ((a, b), (b, a)):
        _talk(of=one, to=other, messages=500, each_second=100)
    _settle(a, b)
    assert not a.has("member", "b", "lost")


def test_a_router_that_is_killed_and_restarted(tmp_path: Path) -> None:
    fleet, port = new_fleet(), free_port()
    with Router(fleet, port) as router:
        address = f"127.0.0.1:{port}"
        with Member(fleet, "a", tmp_path, address) as a, Member(fleet, "b", tmp_path, address) as b:
            a.knows(b)
            b.knows(a)
            for one, other in ((a, b), (b, a)):
                _talk(of=one, to=other, messages=500, each_second=100)
            until(lambda: len(b.events("received")) > 50, 10, "messages arrive")
            router.kill()
            a.until("member", "b", "lost", seconds=4)
            with Router(fleet, port):
                a.until("member", "b", "joined", times=2, seconds=10)
                _settle(a, b)


def test_the_second_member_of_a_name_is_refused(pair: tuple[Member, Member], tmp_path: Path) -> None:
    a, b = pair
    with Member(a.fleet, "b", tmp_path) as other:
        until(lambda: other.events("failed"), 15, "it is refused")
        assert "has a member called b already" in other.events("failed")[0][2]
    _talk(of=a, to=b, messages=10, each_second=1000)
    _talk(of=b, to=a, messages=10, each_second=1000)
    _settle(a, b)
    assert not a.has("member", "b", "lost")


def test_a_killed_member_is_replaced_by_its_next_run(pair: tuple[Member, Member], tmp_path: Path) -> None:
    a, b = pair
    b.kill()
    with Member(a.fleet, "b", tmp_path) as again:
        a.until("member", "b", "joined", times=2)
        again.knows(a)
        _talk(of=a, to=again, messages=10, each_second=1000)
        _talk(of=again, to=a, messages=10, each_second=1000)
        _settle(a, again)


def test_a_flood_arrives_once_and_in_order(pair: tuple[Member, Member]) -> None:
    a, b = pair
    a.order("send", "b", 20_000, 10_000)
    a.until("sent all", seconds=30)
    until(lambda: len(b.events("received")) == len(a.events("sent")), 20, "everything arrives")
    assert compare(a, b)["received"] == 20_000
    assert not b.has("member", "a", "lost")


def test_a_slow_receiver(pair: tuple[Member, Member]) -> None:
    a, b = pair
    b.order("focus", "a")
    b.until("focused", True)
    b.until("focused", True)
    b.order("slow", 0.01)
    a.order("spin", 1000, 10_000)
    a.order("send", "b", 1500, 2000, 10_000)
    a.until("sent all", seconds=30)
    a.order("backlog")
    until(lambda: a.events("backlog"), 10, "it answers")
    assert a.events("backlog")[0][2] < (8 << 20) + 20_000
    assert [event[3] for event in a.events("refused")][:1] == ["error(mailbox_full)"]
    until(
        lambda: ["scan", 1000] in [event[2:] for event in b.events("property")],
        40,
        "the newest value arrives",
    )
    assert len(b.events("property")) < 900, "old values were sent to a slow receiver"
    b.order("slow", 0)
    until(lambda: len(b.events("received")) == len(a.events("sent")), 30, "everything arrives")
    compare(a, b)
