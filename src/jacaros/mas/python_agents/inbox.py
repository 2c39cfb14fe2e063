"""The messages for an agent written in Python."""

import asyncio
from collections import deque
from collections.abc import Callable

from jacaros.bdi.state.speech_act import SpeechAct


class Inbox:
    """Messages that wait to be read, and questions that wait for their answers."""

    def __init__(self) -> None:
        self._messages: deque[SpeechAct] = deque()
        self._readers: deque[asyncio.Future[None]] = deque()
        self._asked: dict[str, asyncio.Future[SpeechAct]] = {}
        self._abandoned: set[str] = set()
        self._refuse: Callable[[SpeechAct], None] | None = None

    def put(self, message: SpeechAct) -> None:
        """Take a message in: the answer to a question goes to who asked."""
        question = message.in_reply_to
        if question is not None and question in self._asked:
            asked = self._asked.pop(question)
            if not asked.done():
                asked.set_result(message)
        elif question is not None and question in self._abandoned:
            self._abandoned.remove(question)
        elif self._refuse is not None:
            self._refuse(message)
        else:
            self._messages.append(message)
            self._wake()

    def take(self) -> SpeechAct | None:
        """The next message, None while there is none."""
        return self._messages.popleft() if self._messages else None

    def arrival(self) -> "asyncio.Future[None]":
        """What ends when there may be a message; several readers are served in the order of their asking."""
        reader: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._readers.append(reader)
        reader.add_done_callback(self._passed_over)
        return reader

    def _wake(self) -> None:
        while self._readers:
            reader = self._readers.popleft()
            if not reader.done():
                reader.set_result(None)
                return

    def _passed_over(self, reader: "asyncio.Future[None]") -> None:
        if reader in self._readers:
            self._readers.remove(reader)

    def give_up(self) -> None:
        """A reader was cancelled, perhaps when it had been woken already: the message is for the next one."""
        if self._messages:
            self._wake()

    def ask(self, question: str) -> "asyncio.Future[SpeechAct]":
        """A place for the answer to a question, which `forget` gives up."""
        asked: asyncio.Future[SpeechAct] = asyncio.get_running_loop().create_future()
        self._asked[question] = asked
        return asked

    def forget(self, question: str) -> None:
        """Nobody waits for that answer any more; it is thrown away when it comes."""
        if self._asked.pop(question, None) is not None:
            self._abandoned.add(question)

    def close(self, refuse: Callable[[SpeechAct], None]) -> None:
        """Give to *refuse* what nobody reads any more: the messages that are there, and those to come."""
        self._refuse = refuse
        while self._messages:
            refuse(self._messages.popleft())
