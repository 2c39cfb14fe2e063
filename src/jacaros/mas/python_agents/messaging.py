"""The messages of a Python agent."""

import asyncio
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from jacaros.agents.mind.state.act import SpeechAct, message_id
from jacaros.agents.python.agent import ReceivedMessage
from jacaros.agents.terms.values import Term
from jacaros.mas.embedding.errors import UnknownAgent
from jacaros.mas.idleness import Activity, AgentTimer
from jacaros.mas.python_agents.task_activity import TaskActivity
from jacaros.runtime.clock import Clock


class Messaging:
    """Sends and receives the messages of one agent.

    Args:
        name: name of the agent.
        send: delivers a message. Returns False if the receiver is unknown.
        names: returns the names of all agents.
        clock: clock for time limits.
        activity: activity of the run.
        task_activity: counts waits.

    Attributes:
        inbox: receives messages for the agent.
    """

    def __init__(
        self,
        name: str,
        send: Callable[[SpeechAct], bool],
        names: Callable[[], Sequence[str]],
        clock: Clock,
        activity: Activity,
        task_activity: TaskActivity,
    ) -> None:
        self.inbox = Inbox()
        self._name, self._send, self._names = name, send, names
        self._clock, self._activity, self._task_activity = clock, activity, task_activity
        self._count = 0

    def say(self, receiver: str, performative: str, content: Term) -> None:
        """Send a message.

        Raises:
            UnknownAgent: the receiver does not exist.
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
            UnknownAgent: the receiver does not exist.
            TimeoutError: no answer arrived within *timeout* seconds.
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
            TimeoutError: none arrived within *timeout* seconds.
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
            with self._task_activity.waiting():
                await future
        finally:
            if timer is not None:
                timer.cancel()

    def _answer(self, question: SpeechAct, performative: str, content: Term) -> None:
        self._say(question.sender, performative, content, self._next_id(), question.id)

    def close(self) -> None:
        """Stop reading messages. Questions get a negative answer."""
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


class Inbox:
    """Messages that wait to be read, and questions that wait for their answers.

    Attributes:
        when_read: called with each message that the agent reads, or None.
    """

    def __init__(self) -> None:
        self.when_read: Callable[[SpeechAct], object] | None = None
        self._messages: deque[SpeechAct] = deque()
        self._readers: deque[asyncio.Future[None]] = deque()
        self._asked: dict[str, asyncio.Future[SpeechAct]] = {}
        self._abandoned: set[str] = set()
        self._refuse: Callable[[SpeechAct], None] | None = None

    def put(self, message: SpeechAct) -> None:
        """Add a message. The answer to a question is passed to the waiting task."""
        question = message.in_reply_to
        if question is not None and question in self._asked:
            asked = self._asked.pop(question)
            if not asked.done():
                self._note_read(message)
                asked.set_result(message)
        elif question is not None and question in self._abandoned:
            self._abandoned.remove(question)
        elif self._refuse is not None:
            self._refuse(message)
        else:
            self._messages.append(message)
            self._wake()

    def take(self) -> SpeechAct | None:
        """Return the next message, or None."""
        if not self._messages:
            return None
        message = self._messages.popleft()
        self._note_read(message)
        return message

    def _note_read(self, message: SpeechAct) -> None:
        if self.when_read is not None:
            self.when_read(message)

    def arrival(self) -> "asyncio.Future[None]":
        """Return a future that ends when there may be a message. Several readers are served in order."""
        reader: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._readers.append(reader)
        reader.add_done_callback(self._cancelled)
        return reader

    def _wake(self) -> None:
        while self._readers:
            reader = self._readers.popleft()
            if not reader.done():
                reader.set_result(None)
                return

    def _cancelled(self, reader: "asyncio.Future[None]") -> None:
        if reader in self._readers:
            self._readers.remove(reader)

    def give_up(self) -> None:
        """A reader was cancelled, perhaps after it had been woken: the message goes to the next one."""
        if self._messages:
            self._wake()

    def ask(self, question: str) -> "asyncio.Future[SpeechAct]":
        """Return a future for the answer to a question. `forget` abandons it."""
        asked: asyncio.Future[SpeechAct] = asyncio.get_running_loop().create_future()
        self._asked[question] = asked
        return asked

    def forget(self, question: str) -> None:
        """Discard the answer to this question when it arrives."""
        if self._asked.pop(question, None) is not None:
            self._abandoned.add(question)

    def close(self, refuse: Callable[[SpeechAct], None]) -> None:
        """Pass unread messages, and later ones, to *refuse*."""
        self._refuse = refuse
        while self._messages:
            refuse(self._messages.popleft())
