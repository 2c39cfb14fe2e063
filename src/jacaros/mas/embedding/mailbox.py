"""Mailboxes of Python code: participants that agents send messages to, and that send to agents."""

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import lower_value
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import UNKEPT, to_term
from jacaros.errors import UsageError
from jacaros.extension.views import Message
from jacaros.mas.embedding.errors import UnknownAgent
from jacaros.mas.embedding.stream import Stream
from jacaros.mas.embedding.waits import Waits
from jacaros.mas.open_mind import question, values_of
from jacaros.terms.substitution import rename
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import Term, bare, is_list, list_items

Send = Callable[[SpeechAct], bool]
"""Delivers a message; False when there is no such receiver."""


class Mailbox(Stream[Message]):
    """A participant of the system that is neither agent nor artifact: it gets messages, and sends them.

    ``async for message in mailbox`` goes through the messages as they come, `get` waits for one.  Answers to `ask` do not
    come among them.

    Args:
        name: under which agents know it.
        send: delivers messages.
        names: the names of all participants.
        waits: of the run.

    Attributes:
        name: under which agents know it.
    """

    def __init__(self, name: str, send: Send, names: Callable[[], Sequence[str]], waits: Waits) -> None:
        super().__init__(waits, f"no message came for {name}")
        self.name = name
        self._send = send
        self._names = names
        self._count = 0
        self._asked: dict[str, asyncio.Future[SpeechAct]] = {}

    def send(
        self, receiver: str, performative: str, content: object, reply_to: Message | None = None
    ) -> None:
        """Send a message to an agent.

        Args:
            receiver: its name.
            performative: ``tell``, ``achieve``, ``askOne``, ``signal`` …
            content: a term in the syntax of the language, as text; or a plain value (see `jacaros.env.values`).
            reply_to: the message that this one answers.

        Raises:
            UnknownAgent: nobody of that name takes part.
            AslError: the text is no term.
        """
        self._say(receiver, performative, term_of(content), reply_to.id if reply_to is not None else None)

    def _say(self, receiver: str, performative: str, content: Term, in_reply_to: str | None = None) -> str:
        self._count += 1
        message = SpeechAct(performative, self.name, receiver, content, self._count, in_reply_to)
        if not self._send(message):
            raise UnknownAgent(receiver, self._names())
        return message.id

    async def ask(self, receiver: str, literal: str, timeout: float | None = None) -> dict[str, Any] | None:
        """Ask an agent for one answer (``askOne``), and wait for it.

        Args:
            receiver: its name.
            literal: what is asked, such as ``battery(Level)``.
            timeout: seconds of the run's clock.

        Returns:
            The values of the variables by name, as plain values; None when the agent does not know.

        Raises:
            UnknownAgent: nobody of that name takes part.
            TimeoutError: no answer came in time.
            RunEnded: the run ended before.
        """
        answers = await self._answers("askOne", receiver, literal, timeout)
        return answers[0] if answers else None

    async def ask_all(
        self, receiver: str, literal: str, timeout: float | None = None
    ) -> list[dict[str, Any]]:
        """Ask an agent for all answers (``askAll``); as `ask`."""
        return await self._answers("askAll", receiver, literal, timeout)

    async def _answers(
        self, performative: str, receiver: str, literal: str, timeout: float | None
    ) -> list[dict[str, Any]]:
        asked, names = question(literal)
        answer: asyncio.Future[SpeechAct] = asyncio.get_running_loop().create_future()
        number = self._say(receiver, performative, rename(asked))
        self._asked[number] = answer
        try:
            message = await self._waits.wait(
                answer, lambda: f"agent {receiver} did not answer {literal}", timeout, receiver
            )
        finally:
            del self._asked[number]
        if message.performative == "undelivered":
            raise UnknownAgent(receiver, self._names())
        if message.performative == "untell":
            return []
        content = message.content
        told = list(list_items(content)) if is_list(content) else [content]
        return [values for each in told if (values := _bindings(asked, names, each)) is not None]

    def receive(self, message: SpeechAct) -> None:
        """Take a message in; for the run."""
        waiting = self._asked.get(message.in_reply_to or "")
        if waiting is None:
            self.put(Message(message))
        elif not waiting.done():
            waiting.set_result(message)

    def __repr__(self) -> str:
        return f"<mailbox {self.name}, {len(self)} messages>"


class PythonMailboxes:
    """The mailboxes of a run by name: its `jacaros.mas.directory.Participants`."""

    def __init__(self) -> None:
        self._boxes: dict[str, Mailbox] = {}
        self.find: Callable[[str], Mailbox | None] = self._boxes.get

    def add(self, mailbox: Mailbox) -> None:
        """Enter a mailbox."""
        self._boxes[mailbox.name] = mailbox

    def names(self) -> Sequence[str]:
        """Their names, in the order of their making."""
        return tuple(self._boxes)


def term_of(content: object) -> Term:
    """The term that the content of a message is.

    Raises:
        AslError: a text that is no term.
    """
    if type(content) is str:
        return lower_value(parse_term(content))
    return to_term(content, UNKEPT)


def _bindings(asked: Term, names: Any, told: Term) -> dict[str, Any] | None:
    """The values of the variables of a question in one answer; None when that is another literal."""
    trail = Trail()
    try:
        return values_of(names) if unify(bare(asked), bare(rename(told)), trail) else None
    finally:
        undo(trail, 0)


def check_name(name: str) -> None:
    """Refuse a name that agents could not write.

    Raises:
        UsageError: it is empty.
    """
    if not name:
        raise UsageError("a participant needs a name")
