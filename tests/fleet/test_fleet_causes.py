"""Explanations whose causes are in other systems."""

import asyncio
import re
from collections.abc import Awaitable, Callable
from typing import Any

from systems import Fleet, fleet

import jacaros
from jacaros import Mas
from jacaros.artifacts import Artifact, operation
from jacaros.fleet import protocol
from jacaros.fleet.carrier import MemberId
from played import played

SENDER = """
+!go(R)
   <- .print(go);
      .send(bob, tell, task(R)).
+!ask <- .send(bob, askOne, weather(W), A).
+!use(N) <-
    joinWorkspace("/main/lab", W); lookupArtifact("counter", Id);
    inc(N).
"""
RECEIVER = """
weather(fine).
+task(R) <- +heard(R).
+!watch <- joinWorkspace("/main/lab", W); lookupArtifact("counter", Id); focus(Id).
+count(N) <- +counted(N).
"""


class Counter(Artifact):
    """Counts."""

    def init(self) -> None:
        self.define_property("count", 0)

    @operation
    def inc(self, by: int) -> None:
        self.update_property("count", self.value("count") + by)


def in_fleet(*names: str) -> Callable[[Callable[[Fleet], Awaitable[None]]], Callable[..., None]]:
    """Make a test of a coroutine function that takes a fleet, on the virtual clock."""

    def play(scene: Callable[[Fleet], Awaitable[None]]) -> None:
        async def main() -> None:
            async with fleet(*names) as systems:
                await scene(systems)

        jacaros.run(main(), clock="fast")

    return played(play)


def because(mas: Mas, question: str) -> list[str]:
    """Return the causes in an explanation without their times, and with one space."""
    lines = mas.explain(question).text().partition("because:\n")[2].splitlines()
    return [" ".join(re.sub(r"[\d.]+ s  ", "", line).split()) for line in lines]


async def record(mas: Mas) -> None:
    """Begin to record, and let the others hear of it."""
    mas.system.keep_history()
    await mas.sleep(0.1)


@in_fleet("lab", "hall")
async def test_why_names_the_plan_of_the_sender_even_if_only_the_receiver_records(systems: Fleet) -> None:
    ann, bob = systems["lab"].add_agent("ann", SENDER), systems["hall"].add_agent("bob", RECEIVER)
    await record(systems["hall"])
    await ann.achieve("go(kitchen)").wait(timeout=9)
    await bob.until("heard(kitchen)", timeout=9)
    assert because(systems["hall"], "+task(_)") == [
        "event bob: +task(kitchen), handled by `+task(R)` (<bob>:3)",
        "message ann to bob: tell task(kitchen)",
        "remote ann@lab: step of its plan for `+!go(kitchen)` (<ann>:4)",
    ]
    assert systems["lab"].system.tracer is None


@in_fleet("lab", "hall")
async def test_why_continues_in_the_other_system_from_inside_a_plan(systems: Fleet) -> None:
    ann = systems["lab"].add_agent("ann", SENDER)
    systems["hall"].add_agent("bob", "+task(R) <- .wait(100); !do(R). +!do(R) <- .print(R).")
    await record(systems["hall"])
    await ann.achieve("go(kitchen)").wait(timeout=9)
    await systems["hall"].sleep(1)
    assert because(systems["hall"], "+!do(_)")[-1].startswith("remote ann@lab: step of its plan")


@in_fleet("lab", "hall")
async def test_an_agent_of_the_same_name_is_not_blamed(systems: Fleet) -> None:
    ann, bob = systems["lab"].add_agent("ann", SENDER), systems["hall"].add_agent("bob", RECEIVER)
    own = systems["hall"].add_agent("ann", "!idle. +!idle <- .wait(100000).")
    await record(systems["hall"])
    await ann.achieve("go(kitchen)").wait(timeout=9)
    await bob.until("heard(kitchen)", timeout=9)
    chain = because(systems["hall"], "+task(_)")
    assert chain[1:] == [
        "message ann@lab to bob: tell task(kitchen)",
        "remote ann@lab: step of its plan for `+!go(kitchen)` (<ann>:4)",
    ]
    assert own.believes("heard(_)") is False


@in_fleet("lab", "hall")
async def test_an_answer_from_another_system_leads_back_to_the_question(systems: Fleet) -> None:
    ann = systems["lab"].add_agent(
        "ann", SENDER + "+!later <- .send(bob, askOne, weather(_)). +weather(W) <- +known."
    )
    systems["hall"].add_agent("bob", RECEIVER)
    await record(systems["lab"])
    await ann.achieve("later").wait(timeout=9)
    await ann.until("known", timeout=9)
    chain = because(systems["lab"], "+weather(_)")
    assert [line.split()[0] for line in chain] == ["event", "message", "message", "event"]
    assert chain[1].startswith("message bob to ann: tell weather(fine)")
    assert chain[-1].startswith("event ann: +!later")


@in_fleet("lab", "hall", "yard")
async def test_an_operation_and_what_it_changed_name_the_plan_behind_them(systems: Fleet) -> None:
    lab, hall, yard = (systems[name] for name in ("lab", "hall", "yard"))
    hall.add_artifact_types(Counter)
    await hall.make_artifact("counter", Counter, workspace=hall.create_workspace("lab"))
    ann, cat = lab.add_agent("ann", SENDER), yard.add_agent("cat", RECEIVER)
    for each in (hall, yard):
        await record(each)
    await cat.achieve("watch").wait(timeout=9)
    await ann.achieve("use(3)").wait(timeout=9)
    await cat.until("counted(3)", timeout=9)
    step = "remote ann@lab: step of its plan for `+!use(3)` (<ann>:8)"
    assert because(hall, "operation inc")[1:] == [step]
    assert because(yard, "+count(3)") == [
        "event cat: +count(3), handled by `+count(N)` (<cat>:5)",
        "property /main/lab/counter count(3)",
        step,
    ]
    bob = hall.add_agent("bob", SENDER)
    await bob.achieve("use(2)").wait(timeout=9)
    await cat.until("counted(5)", timeout=9)
    assert because(yard, "+count(5)")[-1] == "remote bob@hall: step of its plan for `+!use(2)` (<bob>:8)"


@in_fleet("lab", "hall")
async def test_no_step_is_described_while_no_member_records(systems: Fleet) -> None:
    sent: list[bytes] = []
    carry = systems.network.carry

    def heard(sender: MemberId, to: MemberId, datagram: bytes) -> None:
        sent.append(datagram)
        carry(sender, to, datagram)

    systems.network.carry = heard  # type: ignore[method-assign]
    ann = systems["lab"].add_agent("ann", SENDER)
    systems["hall"].add_agent("bob", RECEIVER)

    async def is_described() -> bool:
        sent.clear()
        await ann.achieve("go(kitchen)").wait(timeout=9)
        await systems["lab"].sleep(0.2)
        assert any(b"kitchen" in each for each in sent)
        return any(b"<ann>" in each for each in sent)

    await systems["lab"].sleep(0.2)
    assert not await is_described()
    history = systems["hall"].system.history()
    history.start()
    await systems["lab"].sleep(0.2)
    assert await is_described()
    history.stop()
    await systems["lab"].sleep(0.2)
    assert not await is_described()


@in_fleet("lab", "hall")
async def test_a_member_that_comes_later_hears_who_records(systems: Fleet) -> None:
    await record(systems["hall"])
    systems.network.cut("lab", "hall")
    await asyncio.sleep(4)
    systems.network.heal("lab", "hall")
    ann, bob = systems["lab"].add_agent("ann", SENDER), systems["hall"].add_agent("bob", RECEIVER)
    await asyncio.sleep(1)
    await ann.achieve("go(kitchen)").wait(timeout=9)
    await bob.until("heard(kitchen)", timeout=9)
    assert because(systems["hall"], "+task(_)")[-1].startswith("remote ann@lab:")


@in_fleet("lab", "hall")
async def test_what_a_stranger_says_of_itself_is_short_and_printable(systems: Fleet) -> None:
    systems["lab"].add_agent("ann", "")
    bob = systems["hall"].add_agent("bob", RECEIVER)
    await record(systems["hall"])
    evil = "\x1b]0;owned\x07\u202e\nplan" + "x" * 5000
    step = (f"ann{evil}", f"+!go{evil}", f"{evil}.asl", -(10**15))
    peer = systems.members["lab"].peers["hall"]
    peer.say(protocol.Message("tell", "ann", "bob", [1, "task", 1.0], "mid1", None, step))
    await bob.until("heard(1)", timeout=9)
    lines: list[Any] = systems["hall"].explain("+task(_)").text().splitlines()
    found = [line for line in lines if "step of its plan" in line]
    assert len(found) == 1
    assert found[0].isprintable()
    assert len(found[0]) < 800
