"""Visitors of a fleet, and the commands that are visitors: `jacaros fleet list`, `ping` and `stop`."""

import asyncio
import json
import time
import uuid
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path

import pytest
from players import Player
from queues import SimulatedNetwork

import jacaros
from jacaros import Mas
from jacaros.fleet.carrier import MemberId
from jacaros.fleet.channel import Packet
from jacaros.fleet.joining import joining
from jacaros.fleet.member import Member
from jacaros.fleet.operator import Operator
from jacaros.fleet.protocol import Ask, write
from jacaros.fleet.rights import read_rights
from jacaros.runtime.cli.main import call
from jacaros.runtime.clock import Clock, clock_of


class Fleet:
    """Members on a simulated network, and what they log."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.network = SimulatedNetwork(clock)
        self.logged: list[str] = []
        self.members: dict[str, Member] = {}

    def member(self, name: str, *allowed: str) -> Mas:
        """Return a system that joins under a name, and gives others rights."""

        def joined(member: Member) -> None:
            self.members[name] = member

        join = joining(self.network.carrier(), name, read_rights(allowed), joined=joined)
        return Mas(name=name, join=join, on_log=lambda text, level: self.logged.append(text))

    def operator(self, name: str = "operator") -> Operator:
        """Return a visitor."""
        return Operator(self.network.carrier(), name, self.clock)


def run(test: Callable[[Fleet], Awaitable[None]]) -> None:
    async def main() -> None:
        await test(Fleet(clock_of(asyncio.get_running_loop())))

    jacaros.run(main(), clock="fast")


def test_a_visitor_sees_what_members_have_and_they_do_not_notice_it() -> None:
    async def test(fleet: Fleet) -> None:
        fleet.network.delay = 0.02
        async with fleet.member("lab") as lab, fleet.member("robot"):
            lab.add_agent("ann", "")
            lab.create_workspace("kitchen")
            await lab.sleep(1)
            noticed = list(fleet.logged)
            async with fleet.operator() as one, fleet.operator() as other:
                await asyncio.gather(one.look(2), other.look(2))
                for each in (one, other):
                    assert sorted(each.members) == ["lab", "robot"]
                picture = one.members["lab"].picture
                assert picture is not None
                assert picture.agents == ["ann"]
                assert [path for path, _ in picture.workspaces] == ["/main", "/main/kitchen"]
                assert one.members["lab"].delay == pytest.approx(0.04)
                assert list(fleet.members["lab"].peers) == ["robot"]
            await lab.sleep(10)
            assert fleet.logged == noticed
            assert fleet.members["lab"]._visits.backlog == 0

    run(test)


def test_a_visitor_sees_a_member_restart_and_leave() -> None:
    async def test(fleet: Fleet) -> None:
        async with fleet.operator() as operator:
            for _ in range(2):
                async with fleet.member("robot"):
                    await operator.look(2)
                    assert await operator.ping(operator.members["robot"], 1) == pytest.approx(0.002)
                assert await operator.until(lambda: not operator.members, 1)

    run(test)


def test_a_member_that_is_cut_off_does_not_answer_in_time() -> None:
    async def test(fleet: Fleet) -> None:
        async with fleet.member("robot"), fleet.operator() as operator:
            await operator.look(2)
            robot = operator.members["robot"]
            fleet.network.cut("robot", "operator", noticed=False)
            began = fleet.clock.elapsed
            assert await operator.ping(robot, 1) is None
            assert fleet.clock.elapsed - began == pytest.approx(1, abs=0.05)
            assert await operator.stop(robot, 1) == "it does not answer"

    run(test)


@pytest.mark.parametrize(
    ("visitor", "allowed", "refused"),
    [
        ("operator", (), ""),
        ("lab", ("lab=stop",), ""),
        ("lab", ("*=send,stop",), ""),
        ("lab", (), "`lab` lacks the right `stop`"),
        ("operator", ("operator=see",), "`operator` lacks the right `stop`"),
    ],
)
def test_only_a_visitor_with_the_right_stops_a_member(
    visitor: str, allowed: tuple[str, ...], refused: str
) -> None:
    async def test(fleet: Fleet) -> None:
        async with fleet.operator(visitor) as operator:
            async with fleet.member("robot", *allowed) as robot:
                await operator.look(2)
                stopping = asyncio.ensure_future(operator.stop(operator.members["robot"], 5))
                if refused:
                    assert await stopping == refused
                else:
                    assert await robot.ended() == 0
            assert await stopping == refused

    run(test)


def test_a_member_serves_a_limited_number_of_visitors() -> None:
    async def test(fleet: Fleet) -> None:
        async with fleet.member("robot") as robot:
            visits = fleet.members["robot"]._visits
            for number in range(100):
                visits.present(MemberId("operator", f"visit{number:03}"), True)
            await robot.sleep(1)
            assert len(visits._channels) == 16
            for number in range(100):
                visits.present(MemberId("operator", f"visit{number:03}"), False)
            assert visits.backlog == 0

    run(test)


def test_answers_to_a_visitor_that_acknowledges_none_are_limited() -> None:
    async def test(fleet: Fleet) -> None:
        async with fleet.member("robot") as robot:
            visits, visitor = fleet.members["robot"]._visits, MemberId("operator", "visit1")
            visits.present(visitor, True)
            ask = write(Ask(1, "ping" * 10_000))
            for number in range(1, 100_000):
                visits.received(visitor, Packet(number, number, 0, [ask], 1.0, 0.0, 0.0))
            assert 1 << 20 <= visits.backlog < 2 << 20
            await robot.sleep(1)

    run(test)


# ---- the commands, with members in processes


@pytest.fixture
def keyless(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> str:
    """The name of a fleet without keys or members."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    return f"commands{uuid.uuid4().hex[:8]}"


@pytest.fixture
def robots(keyless: str, tmp_path: Path) -> Iterator[dict[str, Player]]:
    """Two members in processes."""
    (tmp_path / "robot.asl").write_text('+fleet_member(Name, State) <- .print(Name, " ", State).')
    words = ("run", str(tmp_path / "robot.asl"), "--fleet", keyless, "--clock", "real", "--member")
    with Player([*words, "one"]) as one, Player([*words, "two"]) as two:
        one.until(r"\[robot\] two joined")
        two.until(r"\[robot\] one joined")
        yield {"one": one, "two": two}


def test_the_commands_look_at_members_and_stop_them(
    keyless: str, robots: dict[str, Player], capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["fleet", "list", keyless]) == 0
    header, one, two = capsys.readouterr().out.splitlines()
    assert header.split() == ["member", "delay", "clock", "agents", "workspaces", "page"]
    assert [line.split()[0] for line in (one, two)] == ["one", "two"]
    assert [line.split()[5:] for line in (one, two)] == [["robot", "/main"]] * 2

    assert call(["fleet", "list", keyless, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [each["member"] for each in data] == ["one", "two"]
    assert all(0 < each["delay_seconds"] < 1 for each in data)
    assert all(abs(each["clock_ahead_seconds"]) < 0.5 for each in data)

    assert call(["fleet", "ping", keyless, "two", "--count", "2"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(": ")[:2] for line in lines[:2]] == [["two", "1"], ["two", "2"]]
    assert lines[2].startswith("two: 2 sent, 2 answered; min/median/max ")

    assert call(["fleet", "ping", keyless, "tow"]) == 2
    assert "unknown member of fleet" in capsys.readouterr().err

    assert call(["fleet", "stop", keyless]) == 2
    assert "--all stops one, two" in capsys.readouterr().err

    assert call(["fleet", "stop", keyless, "two"]) == 0
    assert capsys.readouterr().out == "two: stopped\n"
    assert robots["two"].process.wait(5) == 0
    robots["one"].until(r"\[fleet\] two has left")
    assert call(["fleet", "stop", keyless, "--all"]) == 0
    assert robots["one"].process.wait(5) == 0
    assert not [line for line in robots["one"].lines if "operator" in line and "stopped by" not in line]


def test_a_fleet_without_members_is_reported_soon(keyless: str, capsys: pytest.CaptureFixture[str]) -> None:
    began = time.monotonic()
    assert call(["fleet", "list", keyless]) == 0
    assert time.monotonic() - began < 2
    assert capsys.readouterr().out == f"fleet {keyless} has no members\n"
    assert call(["fleet", "stop", keyless, "--all"]) == 2
    assert f"fleet {keyless} has no members" in capsys.readouterr().err


def test_a_ping_ends_with_a_summary_when_it_is_interrupted(keyless: str, robots: dict[str, Player]) -> None:
    with Player(["fleet", "ping", keyless, "one"]) as ping:
        ping.until(r"one: 2: .* ms")
        ping.interrupt()
        ping.until(r"one: \d+ sent, \d+ answered; .*")
        assert ping.process.wait(5) == 130


def test_the_operator_of_a_fleet_with_keys_stops_a_member_and_others_do_not(
    keyless: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call(["fleet", "keys", keyless, "robot", "desk"]) == 0
    folder = tmp_path / "jacaros" / "fleets" / keyless
    (tmp_path / "robot.asl").write_text("")
    with Player(["run", str(tmp_path / "robot.asl"), "--fleet", keyless, "--clock", "real"]) as robot:
        robot.until(r"\[fleet\] robot in the fleet .*")
        desk = ["--keys", str(folder / "desk")]
        capsys.readouterr()
        while call(["fleet", "stop", keyless, "robot", *desk]) == 2:  # it has not joined yet
            assert robot.process.poll() is None
        assert "`desk` lacks the right `stop`" in capsys.readouterr().err
        assert call(["fleet", "stop", keyless, "robot"]) == 0
        assert robot.process.wait(5) == 0
