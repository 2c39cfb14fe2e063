"""What a member with valid keys cannot do to another one, whatever it says."""

import asyncio
import sys
from collections.abc import Awaitable, Callable
from math import inf, nan
from typing import Any

import msgspec
import pytest
from queues import SimulatedNetwork

import jacaros
from jacaros import Mas
from jacaros.fleet import protocol
from jacaros.fleet.channel import VERSION, Malformed, read_packet
from jacaros.fleet.joining import joining
from jacaros.fleet.member import Member
from jacaros.fleet.peer import Peer
from jacaros.fleet.visits import visitor_id
from jacaros.runtime.clock import clock_of


class Pair:
    """Two members, of which one says what it likes.

    Attributes:
        lines: what the other one's agents have printed, and its log.
        ended: its answers to `request`.
    """

    def __init__(self) -> None:
        self.network = SimulatedNetwork(clock_of(asyncio.get_running_loop()))
        self.lines: list[str] = []
        self.members: dict[str, Member] = {}
        self.ended: list[protocol.Ended] = []
        self.good = self._member("good", lambda name, line: self.lines.append(line))
        self.evil = self._member("evil", lambda name, line: None)

    def _member(self, name: str, log: Callable[[str, str], None]) -> Mas:
        def joined(member: Member) -> None:
            self.members[name] = member

        join = joining(self.network.carrier(), name, joined=joined)
        return Mas(name=name, join=join, on_print=log, on_log=lambda line, level: log(name, line))

    @property
    def line(self) -> Peer:
        """The way of the evil one to the good one."""
        return self.members["evil"].peers["good"]

    async def say(self, *said: protocol.Said) -> None:
        """Let the evil one say something, and let it arrive."""
        for each in said:
            self.line.say(each)
        await self.good.sleep(1)

    async def request(self, said: Callable[[int], protocol.Said]) -> protocol.Ended:
        """Let the evil one ask for something. Return the answer."""
        self.ended.clear()
        self.line._calls.ask(said, self.ended.append)
        await self.good.sleep(1)
        return self.ended[0]

    async def execute(self, artifact: str, operation: str, arguments: object) -> protocol.Ended:
        """Let the evil one run an operation of an artifact in `/main` of the other one."""
        remote = self.evil.environment.workspace("/main@good").lookup(artifact)
        number = self.members["evil"]._names.number(remote)
        return await self.request(
            lambda call: protocol.Execute(
                call, number, operation, arguments, "eve", None, 0, "wait", True, None
            )
        )


def trespass(scene: Callable[[Pair], Awaitable[None]]) -> Callable[[], None]:
    """Make a test of a scene with two members."""

    def test() -> None:
        async def main() -> None:
            pair = Pair()
            async with pair.good as good, pair.evil as evil:
                assert good.environment
                assert evil.environment
                await good.sleep(1)
                await scene(pair)

        jacaros.run(main(), clock="fast")

    test.__name__, test.__doc__ = scene.__name__, scene.__doc__
    return test


def message(performative: str, content: Any, reply: str | None = None) -> protocol.Message:
    """Return a message to ``ann``."""
    return protocol.Message(performative, "eve", "ann", content, "m1", reply, None)


@pytest.mark.parametrize(
    "fields",
    [(1 << 63, 1, 0, 0.0), (1, 1 << 63, 0, 0.0), (1, 1, -1, 0.0), (1, 1, 0, nan), (1, 1, 0, inf)],
)
def test_numbers_beyond_all_reason_are_refused(fields: tuple[Any, ...]) -> None:
    base, first, ack, sent = fields
    packet = msgspec.msgpack.encode([base, first, ack, [b"x", b"y"], sent, 0.0, 0.0])
    with pytest.raises(Malformed):
        read_packet(b"JF%c%b" % (VERSION, packet))


@trespass
async def test_no_agent_takes_the_name_of_one_of_another_member(pair: Pair) -> None:
    pair.good.add_agent("ann", "+done[source(S)] <- .print(S).")
    await pair.say(
        protocol.AgentNews("bob@lab", True),
        protocol.ServiceNews("bob@lab", "cleaning", True),
        protocol.Message("tell", "bob@lab", "ann", [0, "done"], "m1", None, None),
    )
    assert pair.lines[-1] == "bob@lab@evil"
    assert pair.good.system.directory.names() == ("ann", "df")
    assert list(pair.good.system.services.providers("cleaning")) == ["bob@lab@evil"]


@trespass
async def test_no_workspace_takes_the_path_of_one_of_another_member(pair: Pair) -> None:
    await pair.say(protocol.WorkspaceNews("/main@lab", True))
    paths = [each.path for each in pair.good.environment.workspaces()]
    assert paths == ["/main", "/main@evil", "/main@lab@evil"]


async def asked(pair: Pair, goal: str) -> str:
    """Let ann ask eve, who does not answer. Return the id of the question."""
    ann = pair.good.add_agent("ann", f"+!ask <- {goal}. +!go <- .print(gone).")
    pair.evil.add_agent(
        "eve", "+?secret(X) <- .wait(100000). +!kqml_received(_, askHow, _, _) <- .wait(100000)."
    )
    await pair.good.sleep(1)
    ann.achieve("ask")
    await pair.good.sleep(1)
    return next(iter(pair.members["good"].peers["evil"].messages.asked))


_PLAN = "+!lesson <- .print(taught)."


@trespass
async def test_a_question_does_not_permit_plans(pair: Pair) -> None:
    question = await asked(pair, ".send(eve, askOne, secret(_))")
    await pair.say(message("tellHow", _PLAN, question), message("achieve", [0, "lesson"]))
    assert pair.lines[-2] == "[fleet] evil: refused a message: it lacks the right `tell_how` (--fleet-allow)"
    assert "taught" not in pair.lines


@trespass
async def test_the_plans_that_an_agent_asked_for_arrive(pair: Pair) -> None:
    question = await asked(pair, ".send(eve, askHow, {+!lesson})")
    await pair.say(message("untellHow", [0, "p__1"], question), message("tellHow", _PLAN, question))
    await pair.say(message("achieve", [0, "lesson"]))
    assert pair.lines[-1] == "taught"
    assert sum("tell_how" in line for line in pair.lines) == 1


@trespass
async def test_a_performative_cannot_write_into_the_terminal(pair: Pair) -> None:
    pair.good.add_agent("ann", "")
    await pair.say(message("tell\x1b[2J", [0, "done"]), message("tell", [99]))
    assert not any("\x1b" in line for line in pair.lines)


@trespass
async def test_an_answer_after_a_loss_is_not_news(pair: Pair) -> None:
    ann = pair.good.add_agent("ann", "+!ask <- .send(eve, askOne, p(_), A). -!ask[error(E)] <- .print(E).")
    pair.evil.add_agent("eve", "p(1).")
    await pair.good.sleep(1)
    ann.achieve("ask")
    await pair.good.sleep(0.0015)  # the question has arrived, its answer has not
    pair.network.cut("good", "evil")
    await pair.good.sleep(1)
    pair.network.heal("good", "evil")
    await pair.good.sleep(1)
    assert "member_lost" in pair.lines
    assert not ann.believes("p(_)")


@trespass
async def test_ending_the_run_is_a_right_of_its_own(pair: Pair) -> None:
    assert (await pair.execute("blackboard", "out", [2, "hello"])).ok
    ended = await pair.execute("system", "shutdownNode", [2])
    assert (ended.ok, ended.reason) == (False, [1, "not_permitted", [0, "stop"]])


@trespass
async def test_a_malformed_request_fails(pair: Pair) -> None:
    ended = await pair.execute("blackboard", "out", [2, [99]])
    assert (ended.ok, ended.message) == (False, "malformed request: no value: kind 99")


@trespass
async def test_no_member_uses_the_rights_of_another_one(pair: Pair) -> None:
    def create(workspace: str, call: int) -> protocol.Create:
        return protocol.Create(call, workspace, "mine", "Blackboard", [2], "eve")

    assert (await pair.request(lambda call: create("/main", call))).ok
    ended = await pair.request(lambda call: create("/main@evil", call))
    assert (ended.ok, ended.message) == (False, "workspace `/main@evil` is not of this system")
    for operation, arguments in (
        ("makeArtifact", [2, "/main@evil/mine", "Blackboard"]),
        ("createWorkspace", [2, "/main/lab", "evil"]),
        ("createWorkspace", [2, "/main@evil/lab"]),
    ):
        ended = await pair.execute("workspace", operation, arguments)
        assert (ended.ok, "is not of this system" in (ended.message or "")) == (False, True), operation
    assert (await pair.execute("workspace", "createWorkspace", [2, "lab"])).ok


@trespass
async def test_an_artifact_has_the_name_that_its_own_member_gives(pair: Pair) -> None:
    ann = pair.good.add_agent("ann", "")
    run = pair.members["evil"].me.incarnation
    reference = [8, run, 99, "fake", "Fake", "/elsewhere"]
    await pair.say(message("tell", [1, "look", reference]))
    sent = ann.ask("look(Id)")
    await pair.say(protocol.ArtifactNews("/main", 99, (99, "lamp", "Lamp", "eve", ["shine/0"])))
    lamp = pair.good.environment.workspace("/main@evil").lookup("lamp")
    assert sent == {"Id": lamp}
    assert (lamp.path, lamp.type_name, lamp.creator) == ("/main@evil/lamp", "Lamp", "eve")


@trespass
async def test_warnings_are_short_lines_of_printable_characters(pair: Pair) -> None:
    await pair.say(protocol.WorkspaceNews("/\n[good] all is well\x1b[2J" + "x" * 10_000 + "/y", True))
    warning = pair.lines[-1]
    assert warning.startswith("[fleet] evil: unknown workspace `/ [good] all is well\\x1b[2J")
    assert len(warning) < 600


@trespass
async def test_nothing_that_a_visitor_says_disturbs(pair: Pair) -> None:
    deep = protocol.write(message("tell", None))
    deep = deep.replace(b"\xc0", b"\x91" * 100_000 + b"\xc0", 1)
    visitor = visitor_id("evil")
    packet = msgspec.msgpack.encode([1, 1, 0, [b"hello", deep], 0.0, 0.0, 0.0])
    good = pair.members["good"]
    good.present(visitor, True)
    good.received(visitor, b"JF%c%b" % (VERSION, packet))
    await pair.say(message("tell", [0, "done"]))
    assert set(good.peers) == {"evil"}


@trespass
async def test_no_module_is_imported_for_another_member(pair: Pair) -> None:
    zen = "this.Zen"
    ended = await pair.request(lambda call: protocol.Create(call, "/main", "zen", zen, [2], None))
    assert (ended.ok, ended.message) == (
        False,
        "cannot create a this.Zen: this system does not use this itself",
    )
    assert not (await pair.execute("workspace", "makeArtifact", [2, "zen", zen])).ok
    assert not (await pair.execute("manrepo", "consultManual", [2, zen])).ok
    assert "this" not in sys.modules
