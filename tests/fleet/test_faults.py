"""Faults between members on a simulated network: bad input, silence, names that are taken, robots that must stand."""

import asyncio
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from queues import SimulatedNetwork

import jacaros
from jacaros import Mas, UsageError
from jacaros.artifacts import Artifact, operation
from jacaros.fleet import protocol
from jacaros.fleet.carrier import MemberId
from jacaros.fleet.channel import VERSION, Channel, Malformed, read_packet
from jacaros.fleet.joining import joining
from jacaros.fleet.member import Member, new_id
from jacaros.fleet.messages import FULL
from jacaros.runtime.clock import clock_of

BOUND = 0.6
"""Seconds after the loss of its driver within which a robot stands."""
HALL = """
name: hall
bounds: {from: [-40, -40], to: [40, 40]}
robots: [{name: turtlebot, pose: {x: -30, y: 0}}]
"""


class Two:
    """Two members of a fleet on a simulated network.

    Attributes:
        warnings: what they have logged, and by whom.
    """

    def __init__(self, seed: int = 0) -> None:
        self.network = SimulatedNetwork(clock_of(asyncio.get_running_loop()), seed)
        self.warnings: list[str] = []
        self.members: dict[str, Member] = {}
        self.here: Mas
        self.there: Mas

    def member(self, name: str, **options: Any) -> Mas:
        """Return a member that has not begun."""

        def joined(member: Member) -> None:
            self.members[name] = member

        def log(line: str, level: str) -> None:
            if level in ("warning", "error"):
                self.warnings.append(f"{name}: {line}")

        join = joining(self.network.carrier(), name, joined=joined)
        return Mas(name=name, join=join, on_log=log, **options)


def fleet_test(scene: Callable[..., Coroutine[Any, Any, None]]) -> Callable[..., None]:
    """Make a test of a scene with two members, ``here`` and ``there``."""

    def test(tmp_path: Path) -> None:
        async def main() -> None:
            two = Two()
            (tmp_path / "hall.yaml").write_text(HALL, encoding="utf-8")
            async with (
                two.member("here", world=tmp_path / "hall.yaml") as two.here,
                two.member("there") as two.there,
            ):
                await two.here.sleep(0.5)
                await scene(two)

        jacaros.run(main(), clock="fast")

    test.__name__, test.__doc__ = scene.__name__, scene.__doc__
    return test


# ---- robots


@pytest.mark.parametrize("fault", ["killed", "frozen", "cut at the driver's side only"])
def test_a_robot_stands_when_its_driver_is_lost(fault: str, tmp_path: Path) -> None:
    @fleet_test
    async def scene(two: Two) -> None:
        lab = two.here.create_workspace("lab")
        await two.here.make_artifact("wheels", "ArtCmdVel", workspace=lab)
        await two.here.sleep(0.1)
        bob = two.there.add_agent("bob", "+!go <- driveTo(30, 0).", join=["/main/lab"])
        lost: list[float] = []
        two.members["here"].watchers.append(lambda name, state: lost.append(two.here.clock.elapsed))
        bob.achieve("go")
        await two.here.sleep(3)
        truth = two.here.world.ground_truth  # type: ignore[union-attr]
        assert truth.odometer() > 0.3, "it drives"
        if fault == "killed":
            two.network.kill("there")
        elif fault == "frozen":
            two.network.cut("here", "there", noticed=False)
        else:
            two.network.notice_loss("there", "here", 0.01)
        began = two.here.clock.elapsed
        await two.here.sleep(5)
        noticed = lost[0] if lost else began
        moving = [
            each.time for each, last in zip(truth.path()[1:], truth.path(), strict=False) if each.x > last.x
        ]
        assert noticed - began <= 3.0
        assert moving[-1] - noticed <= BOUND

    scene(tmp_path)


# ---- operations and focuses


class Slow(Artifact):
    """Has an operation that takes long."""

    @operation
    async def work(self) -> None:
        """Work until cancelled."""
        self.define_property("working")
        try:
            await self.sleep(1000)
        finally:
            self.remove_property("working")


@fleet_test
async def test_an_operation_ends_when_only_its_caller_has_noticed_the_loss(two: Two) -> None:
    two.here.add_artifact_types(Slow)
    await two.here.make_artifact("slow", Slow, workspace=two.here.create_workspace("lab"))
    ann = two.here.add_agent("ann", "", focus=["lab/slow"])
    await two.here.sleep(0.1)
    bob = two.there.add_agent(
        "bob", "+!go <- work. -!go[env_failure_reason(R)] <- +failed(R).", join=["/main/lab"]
    )
    bob.achieve("go")
    await ann.until("working", timeout=1)
    two.network.notice_loss("there", "here", 0.5)
    await bob.until("failed(member_lost(here))", timeout=1)
    await ann.until("not working", timeout=2)
    assert not any(
        "here" in each and "does not answer" in each for each in two.warnings if each[:4] == "here"
    )


@fleet_test
async def test_an_artifact_without_properties_can_be_focused(two: Two) -> None:
    two.here.add_artifact_types(Slow)
    await two.here.make_artifact("slow", Slow, workspace=two.here.create_workspace("lab"))
    await two.here.sleep(1)
    bob = two.there.add_agent("bob", "+!go <- work.", focus=["/main/lab/slow"])
    bob.achieve("go")
    await bob.until("working", timeout=2)


@fleet_test
async def test_nothing_is_kept_of_a_disposed_artifact(two: Two) -> None:
    two.here.add_artifact_types(Slow)
    lab = two.here.create_workspace("lab")
    served = two.members["here"].peers["there"]._served
    for number in range(3):
        slow = await two.here.make_artifact(f"slow{number}", Slow, workspace=lab)
        await two.here.sleep(0.1)
        bob = two.there.add_agent(f"bob{number}", "", focus=[f"/main/lab/slow{number}"])
        await bob.until("focusing(_, _, _, _, _, _)", timeout=1)
        assert len(served._watching) == 1
        two.here.environment.workspace(lab).dispose_artifact(slow)
        await two.here.sleep(0.5)
        assert not served._watching


# ---- names


@fleet_test
async def test_a_member_of_the_same_name_is_refused_and_shuts_none_out(two: Two) -> None:
    with pytest.raises(UsageError, match="has a member called there already"):
        async with two.member("there"):
            pass
    ann = two.here.add_agent("ann", '+!go <- .send("bob@there", askOne, a(X), A); +A.')
    two.there.add_agent("bob", "a(1).")
    await two.here.sleep(5)
    await ann.achieve("go").wait(timeout=2)
    assert ann.believes("a(1)")


@fleet_test
async def test_a_member_that_was_cut_off_while_another_had_its_name_returns(two: Two) -> None:
    await two.here.sleep(1)
    me = two.members["here"]
    original = two.members["there"].me
    two.network.cut("here", "there")
    await two.here.sleep(1)
    me.present(rival := new_id("there"), True)
    assert me.peers["there"].id == rival
    me.present(rival, False)
    two.network.heal("here", "there")
    ann = two.here.add_agent("ann", '+!go <- .send("bob@there", askOne, a(X), A); +A.')
    two.there.add_agent("bob", "a(1).")
    await two.here.sleep(5)
    assert me.peers["there"].id == original
    await ann.achieve("go").wait(timeout=2)
    assert ann.believes("a(1)")


@fleet_test
async def test_a_member_whose_clock_went_back_joins_again(two: Two) -> None:
    two.network.kill("there")
    await two.here.sleep(1)
    early = MemberId("there", "0000")
    two.members["here"].present(early, True)
    assert two.members["here"].peers["there"].id == early


# ---- a cut that outlasts the memory


@fleet_test
async def test_a_cut_longer_than_the_memory_heals_without_a_restart(two: Two) -> None:
    ann = two.here.add_agent("ann", '+!go <- .send("bob@there", tell, b). +undelivered(M, R) <- +back(R).')
    bob = two.there.add_agent("bob", "")
    await ann.achieve("go").wait(timeout=2)
    await bob.until("b", timeout=2)
    two.network.cut("here", "there")
    await two.here.sleep(600)
    two.network.heal("here", "there")
    await two.here.sleep(2)
    cat = two.there.add_agent("cat", "")
    await two.here.sleep(1)
    two.here.send("cat@there", "tell", "c")
    await cat.until("c", timeout=2)


# ---- a receiver that cannot keep up


@fleet_test
async def test_sending_fails_while_too_much_is_under_way(two: Two) -> None:
    text = "x" * 100_000
    two.there.add_agent("bob", "")
    ann = two.here.add_agent(
        "ann",
        f"""+!go(0). +!go(N) <- .send("bob@there", tell, b(N, "{text}")); !go(N - 1).
        -!go(N)[error(E), error_msg(M)] <- +failed(E, M).""",
    )
    await two.here.sleep(0.1)
    two.network.cut("here", "there", noticed=False)
    await ann.achieve("go(200)").wait(timeout=9)
    assert ann.believes('failed(mailbox_full, "there is too slow")')
    assert FULL < two.members["here"].peers["there"].backlog < FULL + 2 * len(text)


# ---- bad input


STEP = ("eve", "", "+!go", 1)
VALID: list[Any] = [
    protocol.Here(
        2, 1, ["bob"], [("bob", "mop")], [("/main/lab", [(7, "slow", "Slow", None, ["work/0"])])], ""
    ),
    protocol.Watched(True, "http://127.0.0.1:8000/"),
    protocol.Bye(),
    protocol.AgentNews("bob", True),
    protocol.ServiceNews("bob", "mop", True),
    protocol.Message("tell", "eve", "bob", [1, "p", 2.0, [2, "x"], [5, "k", 1.0]], "m1", None, STEP),
    protocol.Message("askOne", "eve", "bob", [1, "a", [4, 0]], "m2", None, None),
    protocol.Returned("m1", "bob", "eve", "tell", [0, "p"], "mailbox_full"),
    protocol.WorkspaceNews("/main/evil", True),
    protocol.ArtifactNews("/main/lab", 8, (8, "x", "X", "eve", ["y/1"])),
    protocol.Execute(1, 1, "work", [2], "eve", 0.1, 0, "wait", True, STEP),
    protocol.Create(2, "/main/lab", "new", "Slow", [2], "eve"),
    protocol.CreateWorkspace(3, "/main/new"),
    protocol.Dispose(4, 99),
    protocol.Focus(5, 1, 1, "eve"),
    protocol.StopFocus(1, 1),
    protocol.Link(6, 1, "next", 1),
    protocol.Handle(1, "cancel"),
    protocol.Ended(1, True, None, None, [[1]], None),
    protocol.Observed(1, True, [("s", [2])], [(1, "p", [2], [2])], [1], None),
    protocol.Ask(7, "status"),
    protocol.Answer(7, ""),
]
"""A message of each kind, mostly about what there is."""
VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**64 - 1)
    | st.integers(-1, 11)
    | st.floats()
    | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=4),
    max_leaves=8,
)
CHANGES = st.lists(st.tuples(st.integers(0, 99), VALUES), max_size=3)


def test_the_messages_to_change_are_valid_and_of_all_kinds() -> None:
    assert [protocol.read(protocol.write(each)) for each in VALID] == VALID
    assert {type(each) for each in VALID} == set(protocol.Said.__args__)


def _changed(message: Any, changes: list[tuple[int, Any]]) -> bytes:
    """Return a message with other values at some of its places."""
    data: list[Any] = msgspec.msgpack.decode(protocol.write(message))
    for place, value in changes:
        places = list(_places(data))
        inside, index = places[place % len(places)]
        inside[index] = value
    return msgspec.msgpack.encode(data)


def _places(data: list[Any]) -> Iterator[tuple[list[Any], int]]:
    for index, each in enumerate(data):
        yield data, index
        if isinstance(each, list):
            yield from _places(each)


PAYLOADS = st.binary(max_size=40) | st.builds(_changed, st.sampled_from(VALID), CHANGES)


@given(st.lists(PAYLOADS, max_size=30))
def test_no_payload_disturbs_anything_else(payloads: list[bytes]) -> None:
    async def main() -> None:
        two = Two()
        async with two.member("here") as here, two.member("there") as there, two.member("evil"):
            lab = here.create_workspace("lab")
            here.add_artifact_types(Slow)
            await here.make_artifact("slow", Slow, workspace=lab)
            here.add_agent("bob", "a(1). +!p(X) <- +q(X).")
            with _errors() as errors:
                await here.sleep(0.2)
                for payload in payloads:
                    two.members["evil"].peers["here"].channel.send(payload)
                await here.sleep(0.2)
                await here.make_artifact("fresh", Slow, workspace=here.create_workspace("fresh"))
                await here.sleep(0.2)
                program = '+!go <- .send("bob@here", askOne, a(X), A); +A.'
                ann = there.add_agent("ann", program, focus=["/main/fresh/fresh"])
                await ann.achieve("go").wait(timeout=2)
                assert ann.believes("a(_)")
            assert not errors
            assert sum(each.startswith("here") and "invalid message" in each for each in two.warnings) <= 1

    jacaros.run(main(), clock="fast")


@contextmanager
def _errors() -> Iterator[list[Any]]:
    """Collect what callbacks of the event loop raise."""
    loop = asyncio.get_running_loop()
    found: list[Any] = []
    loop.set_exception_handler(lambda _, context: found.append(context))
    yield found


@fleet_test
async def test_datagrams_of_another_kind_or_version_are_refused_once(two: Two) -> None:
    here = two.members["here"]
    stranger = MemberId("stranger", "1")
    good = b"JF%c" % VERSION
    for _ in range(3):
        for datagram in (b"", b"hello", b"JF", b"JF\x63", good, good + b"\xff" * 9, good + b"\x91\x01"):
            here.received(stranger, datagram)
    here.received(MemberId("older", "1"), b"JF\x00...")
    assert two.warnings == [
        "here: [fleet] ignored from stranger: bytes that are not a message of JaCaROS",
        f"here: [fleet] ignored from older: version 0 of the fleet's messages, this one has version {VERSION}",
    ]
    assert set(here.peers) == {"there"}


NUMBERS = st.integers(-1, 5) | st.integers(0, 2**62) | st.integers(-(2**63), 2**64 - 1)
FLOATS = st.floats(-1e12, 1e12) | st.floats()


@given(
    st.lists(
        st.tuples(
            NUMBERS, NUMBERS, NUMBERS, st.lists(st.binary(max_size=5), max_size=3), FLOATS, FLOATS, FLOATS
        )
    )
)
def test_forged_numbers_stop_no_channel_but_their_own(forged: list[tuple[Any, ...]]) -> None:
    async def main() -> None:
        clock = clock_of(asyncio.get_running_loop())
        received: list[bytes] = []
        channel = Channel(clock, lambda datagram: None, received.append)
        channel.send(b"a")
        with _errors() as errors:
            for each in forged:
                with suppress(Malformed):
                    channel.heard(read_packet(b"JF%c" % VERSION + msgspec.msgpack.encode(each)))
                await clock.sleep(0.1)
            await clock.sleep(5)
        assert not errors
        assert channel.backlog in (0, 1)
        channel.give_up()

    jacaros.run(main(), clock="fast")


@fleet_test
async def test_a_message_of_many_megabytes_delays_no_other_for_good(two: Two) -> None:
    two.there.add_agent("bob", "")
    cat = two.there.add_agent("cat", "")
    await two.here.sleep(0.1)
    two.here.send("bob@there", "tell", jacaros.Structure("b", ("x" * (FULL // 2),)))
    two.here.send("cat@there", "tell", "c")
    await cat.until("c", timeout=2)


def test_a_sender_keeps_its_name_over_a_cut() -> None:
    lines: list[str] = []

    async def main() -> None:
        two = Two()
        async with (
            two.member("here") as here,
            two.member("there", on_print=lambda _, text: lines.append(text)) as there,
        ):
            ann = here.add_agent("ann", "+!say(X) <- .send(bob, tell, said(X)).")
            bob = there.add_agent("bob", "+said(X)[source(S)] <- .print(X, S).")
            await here.sleep(1)
            two.network.cut("here", "there")
            await ann.achieve("say(1)").wait(timeout=1)
            await here.sleep(1)
            two.network.heal("here", "there")
            await bob.until("said(1)", timeout=1)
            assert lines == ["1ann"]

    jacaros.run(main(), clock="fast")
