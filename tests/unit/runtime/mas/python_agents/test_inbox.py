"""Messages for Python agents: readers, answers, refusals."""

import asyncio

import pytest

from jacaros.agents.mind.state.act import Activity, SpeechAct
from jacaros.agents.terms.values import atom
from jacaros.runtime.clock import clock_of
from jacaros.runtime.mas.agents.python_agents import TaskActivity
from jacaros.runtime.mas.messaging import Messaging


def message(number: int, reply: str | None = None, performative: str = "tell") -> SpeechAct:
    return SpeechAct(performative, "bob", "ann", atom(f"m{number}"), number, reply)


class Desk:
    """The messages of an agent ``ann``, and what it sends."""

    def __init__(self) -> None:
        self.sent: list[SpeechAct] = []
        activity = Activity()
        self.mail = Messaging(
            "ann",
            self._send,
            lambda: ("ann", "bob"),
            clock_of(asyncio.get_running_loop()),
            activity,
            TaskActivity(activity, lambda: None).waiting,
        )

    def _send(self, said: SpeechAct) -> bool:
        self.sent.append(said)
        return True

    async def read(self) -> str:
        return str((await self.mail.next_message(None)).content)


async def test_readers_are_served_in_turn_and_a_cancelled_one_keeps_nothing() -> None:
    desk = Desk()
    first, second, third = (asyncio.ensure_future(desk.read()) for _ in range(3))
    await asyncio.sleep(0)
    desk.mail.receive(message(1))
    first.cancel()
    assert await second == "m1"
    desk.mail.receive(message(2))
    assert await third == "m2"
    desk.mail.receive(message(3))
    assert await desk.read() == "m3"


async def test_an_answer_goes_to_the_waiting_task_and_a_late_one_is_discarded() -> None:
    desk = Desk()
    asking = asyncio.ensure_future(desk.mail.ask("bob", "askOne", atom("q"), None))
    late = asyncio.ensure_future(desk.mail.ask("bob", "askOne", atom("q"), 1.0))
    await asyncio.sleep(0)
    desk.mail.receive(message(1, desk.sent[0].id))
    assert (await asking).content == atom("m1")
    with pytest.raises(TimeoutError, match="no answer from bob within 1 s"):
        await late
    desk.mail.receive(message(2, desk.sent[1].id))
    desk.mail.receive(message(3, "another"))
    assert await desk.read() == "m3"


async def test_unread_questions_get_a_negative_answer_at_the_end() -> None:
    desk = Desk()
    desk.mail.receive(message(1, performative="askAll"))
    desk.mail.receive(message(2))
    desk.mail.close()
    desk.mail.receive(message(3, performative="askOne"))
    answers = [(said.performative, said.receiver, said.in_reply_to) for said in desk.sent]
    assert answers == [("untell", "bob", "mid1_bob"), ("untell", "bob", "mid3_bob")]
