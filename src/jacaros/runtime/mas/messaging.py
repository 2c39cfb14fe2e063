"""The messages of Python code: what it reads in the order of arrival, and questions that it asks."""

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Sequence
from contextlib import AbstractContextManager, suppress
from typing import Generic, TypeVar

from jacaros.agents.mind.state.act import Activity, SpeechAct, message_id
from jacaros.agents.python.agent import ReceivedMessage
from jacaros.agents.terms.values import Term
from jacaros.runtime.clock import Clock
from jacaros.runtime.mas.embedding.waits import UnknownAgent, fail
from jacaros.runtime.mas.scheduler import AgentTimer

T = TypeVar("T")
Send = Callable[[SpeechAct], bool]
"""Delivers a message. Returns False if the receiver is unknown."""
ListNames = Callable[[], Sequence[str]]
"""Returns the names of all participants."""


class Arrivals(Generic[T]):
    """Items that are kept until they are read. Several readers are served in order."""

    def __init__(self) -> None:
        self._items: deque[T] = deque()
        self._readers: deque[asyncio.Future[None]] = deque()

    def put(self, item: T) -> None:
        """Add an item, for the first waiting reader."""
        self._items.append(item)
        self._wake()

    def _wake(self) -> None:
        while self._readers:
            reader = self._readers.popleft()
            if not reader.done():
                reader.set_result(None)
                return

    async def next(self, wait: "Callable[[asyncio.Future[None]], Awaitable[None]]") -> T:
        """Return the next item. Without one, await *wait* with a future that ends when there may be one."""
        while not self._items:
            reader: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            self._readers.append(reader)
            try:
                await wait(reader)
            except BaseException:
                with suppress(ValueError):
                    self._readers.remove(reader)
                if self._items:  # the reader may have been woken before: the item is for the next one
                    self._wake()
                raise
        return self._items.popleft()

    def take(self) -> list[T]:
        """Return all items that have not been read yet, without waiting."""
        taken = list(self._items)
        self._items.clear()
        return taken

    def __len__(self) -> int:
        return len(self._items)


class Correspondent:
    """A participant that sends messages, and waits for the answers to its questions.

    Args:
        name: its name.
        send: delivers messages.
        names: returns the names of all participants.

    Attributes:
        when_read: called with each message that it reads, or None.
    """

    def __init__(self, name: str, send: Send, names: ListNames) -> None:
        self.name = name
        self.when_read: Callable[[SpeechAct], object] | None = None
        self._send, self._names = send, names
        self._count = 0
        self._asked: dict[str, asyncio.Future[SpeechAct]] = {}
        self._abandoned: set[str] = set()

    def say(self, receiver: str, performative: str, content: Term, in_reply_to: str | None = None) -> None:
        """Send a message.

        Raises:
            UnknownAgent: the receiver does not exist.
        """
        self._say(receiver, performative, content, self._next_id(), in_reply_to)

    def _next_id(self) -> str:
        self._count += 1
        return message_id(self._count, self.name)

    def _say(self, receiver: str, performative: str, content: Term, id: str, reply: str | None) -> None:
        if not self._send(SpeechAct(performative, self.name, receiver, content, id, reply)):
            raise UnknownAgent(receiver, self._names())

    async def question(
        self,
        receiver: str,
        performative: str,
        content: Term,
        wait: "Callable[[asyncio.Future[SpeechAct]], Awaitable[SpeechAct]]",
    ) -> SpeechAct:
        """Send a question, and return what *wait* returns for its answer. The answer is discarded if that fails.

        Raises:
            UnknownAgent: the receiver does not exist.
        """
        id = self._next_id()
        asked = self._asked[id] = asyncio.get_running_loop().create_future()
        try:
            self._say(receiver, performative, content, id, None)
            answer = await wait(asked)
        finally:
            if self._asked.pop(id, None) is not None:
                self._abandoned.add(id)
        if answer.performative == "undelivered":
            raise UnknownAgent(receiver, self._names())
        return answer

    def takes_answer(self, message: SpeechAct) -> bool:
        """Return whether a message is the answer to a question, which has been passed to the waiting task."""
        question = message.in_reply_to
        if question is None:
            return False
        asked = self._asked.pop(question, None)
        if asked is not None:
            if not asked.done():
                self.note_read(message)
                asked.set_result(message)
            return True
        if question in self._abandoned:
            self._abandoned.remove(question)
            return True
        return False

    def note_read(self, message: SpeechAct) -> None:
        """The message is being read."""
        if self.when_read is not None:
            self.when_read(message)


class Messaging(Correspondent):
    """Sends and receives the messages of a Python agent.

    Args:
        name: name of the agent.
        send: delivers messages.
        names: returns the names of all participants.
        clock: clock for time limits.
        activity: activity of the run.
        waiting: the context of a wait for others.
    """

    def __init__(
        self,
        name: str,
        send: Send,
        names: ListNames,
        clock: Clock,
        activity: Activity,
        waiting: Callable[[], AbstractContextManager[None]],
    ) -> None:
        super().__init__(name, send, names)
        self._clock, self._activity, self._waiting = clock, activity, waiting
        self._unread: Arrivals[SpeechAct] = Arrivals()
        self._is_closed = False

    def _say(self, receiver: str, performative: str, content: Term, id: str, reply: str | None) -> None:
        if receiver not in ("self", self.name):
            super()._say(receiver, performative, content, id, reply)
        elif not self._send(SpeechAct(performative, "self", self.name, content, id, reply)):
            raise UnknownAgent(receiver, self._names())

    async def ask(self, receiver: str, performative: str, content: Term, timeout: float | None) -> SpeechAct:
        """Send a question and wait for the answer.

        Raises:
            UnknownAgent: the receiver does not exist.
            TimeoutError: no answer arrived within *timeout* seconds.
        """
        missing = f"no answer from {receiver}"
        return await self.question(
            receiver, performative, content, lambda answer: self._wait_for(answer, timeout, missing)
        )

    async def next_message(self, timeout: float | None) -> ReceivedMessage:
        """Wait for the next message.

        Raises:
            TimeoutError: none arrived within *timeout* seconds.
        """
        message = await self._unread.next(lambda arrival: self._wait_for(arrival, timeout, "no message"))
        self.note_read(message)
        return ReceivedMessage(message, self._answer)

    async def _wait_for(self, future: "asyncio.Future[T]", timeout: float | None, what: str) -> T:
        timer = None
        if timeout is not None:
            late = TimeoutError(f"{what} within {timeout:g} s")
            timer = AgentTimer(self._clock, self._activity, timeout, lambda: fail(future, late))
        try:
            with self._waiting():
                return await future
        finally:
            if timer is not None:
                timer.cancel()

    def receive(self, message: SpeechAct) -> None:
        """Receive a message for the agent."""
        if self.takes_answer(message):
            return
        if self._is_closed:
            self._refuse(message)
        else:
            self._unread.put(message)

    def _answer(self, question: SpeechAct, performative: str, content: Term) -> None:
        self.say(question.sender, performative, content, question.id)

    def close(self) -> None:
        """Stop reading messages. Questions get a negative answer."""
        self._is_closed = True
        for message in self._unread.take():
            self._refuse(message)

    def _refuse(self, message: SpeechAct) -> None:
        received = ReceivedMessage(message, self._answer)
        if received.is_question:
            with suppress(UnknownAgent):
                received.reply(None)
