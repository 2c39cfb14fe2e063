"""What an agent written in Python says to others and hears from them."""

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

from jacaros.bdi.state.speech_act import SpeechAct, message_id
from jacaros.clock import Clock
from jacaros.extension.views import ReceivedMessage
from jacaros.mas.embedding.errors import UnknownAgent
from jacaros.mas.idleness import Activity, AgentTimer
from jacaros.mas.python_agents.attendance import Attendance
from jacaros.mas.python_agents.inbox import Inbox
from jacaros.terms.values import Term


class Correspondence:
    """The messages of one agent.

    Args:
        name: of the agent.
        send: delivers a message; False when there is no such receiver.
        names: of all agents.
        clock: time-outs are counted on it.
        activity: that of the run.
        attendance: told what is waited for.

    Attributes:
        inbox: where messages for the agent go.
    """

    def __init__(
        self,
        name: str,
        send: Callable[[SpeechAct], bool],
        names: Callable[[], Sequence[str]],
        clock: Clock,
        activity: Activity,
        attendance: Attendance,
    ) -> None:
        self.inbox = Inbox()
        self._name, self._send, self._names = name, send, names
        self._clock, self._activity, self._attendance = clock, activity, attendance
        self._count = 0

    def say(self, receiver: str, performative: str, content: Term) -> None:
        """Send a message.

        Raises:
            UnknownAgent: there is no such agent.
        """
        self._say(receiver, performative, content, self._next_id(), None)

    def _next_id(self) -> str:
        self._count += 1
        return message_id(self._count, self._name)

    def _say(self, receiver: str, performative: str, content: Term, id: str, reply: str | None) -> None:
        target = self._name if receiver == "self" else receiver
        sender = "self" if target == self._name else self._name
        if not self._send(SpeechAct(performative, sender, target, content, id, reply)):
            raise UnknownAgent(receiver, self._names())

    async def ask(self, receiver: str, performative: str, content: Term, timeout: float | None) -> SpeechAct:
        """Send a question and wait for the answer.

        Raises:
            UnknownAgent: there is no such agent.
            TimeoutError: no answer came within *timeout* seconds.
        """
        id = self._next_id()
        answer = self.inbox.ask(id)
        try:
            self._say(receiver, performative, content, id, None)
            await self._wait_for(answer, timeout, f"no answer from {receiver}")
            if answer.result().performative == "undelivered":
                raise UnknownAgent(receiver, self._names())
            return answer.result()
        finally:
            self.inbox.forget(id)

    async def next_message(self, timeout: float | None) -> ReceivedMessage:
        """Wait for the next message.

        Raises:
            TimeoutError: none came within *timeout* seconds.
        """
        while (message := self.inbox.take()) is None:
            try:
                await self._wait_for(self.inbox.arrival(), timeout, "no message")
            except BaseException:
                self.inbox.give_up()
                raise
        return ReceivedMessage(message, self._answer)

    async def _wait_for(self, future: "asyncio.Future[Any]", timeout: float | None, what: str) -> None:
        timer = None
        if timeout is not None:
            late = TimeoutError(f"{what} within {timeout:g} s")
            timer = AgentTimer(self._clock, self._activity, timeout, lambda: _fail(future, late))
        try:
            with self._attendance.waiting():
                await future
        finally:
            if timer is not None:
                timer.cancel()

    def _answer(self, question: SpeechAct, performative: str, content: Term) -> None:
        self._say(question.sender, performative, content, self._next_id(), question.id)

    def close(self) -> None:
        """Read no more messages: a question gets the answer that there is none."""
        self.inbox.close(self._refuse)

    def _refuse(self, message: SpeechAct) -> None:
        received = ReceivedMessage(message, self._answer)
        if received.is_question:
            try:
                received.reply(None)
            except UnknownAgent:
                return


def _fail(future: "asyncio.Future[Any]", error: Exception) -> None:
    if not future.done():
        future.set_exception(error)
