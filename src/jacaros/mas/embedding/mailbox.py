"""Mailboxes of Python code: participants that exchange messages with agents."""

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

from jacaros.agents.body.values import UNKEPT, to_term
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.python.agent import Message
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Term, bare, is_list, list_items
from jacaros.errors import UsageError
from jacaros.mas.embedding.errors import UnknownAgent
from jacaros.mas.embedding.stream import Stream
from jacaros.mas.embedding.waits import Waits
from jacaros.mas.open_mind import question, values_of

Send = Callable[[SpeechAct], bool]
"""Delivers a message. Returns False if the receiver is unknown."""


class Mailbox(Stream[Message]):
    """A participant that is neither an agent nor an artifact. It receives and sends messages.

    ``async for message in mailbox`` iterates over the messages as they arrive; `get` waits for one. Answers to `ask`
    are not among them.

    Args:
        name: its name for agents.
        send: delivers messages.
        names: returns the names of all participants.
        waits: waits of the run.

    Attributes:
        name: its name for agents.
    """

    def __init__(self, name: str, send: Send, names: Callable[[], Sequence[str]], waits: Waits) -> None:
        super().__init__(waits, f"no message for {name}")
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
            receiver: name of the agent.
            performative: ``tell``, ``achieve``, ``askOne``, ``signal`` …
            content: a term in the syntax of the language, as text; or a plain value (see `jacaros.artifacts.env.values`).
            reply_to: the message that this one answers.

        Raises:
            UnknownAgent: no participant has this name.
            AslError: the text is not a term.
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
            receiver: name of the agent.
            literal: the question, such as ``battery(Level)``.
            timeout: time limit in seconds of the run's clock.

        Returns:
            Plain values by variable name; None if the agent does not know.

        Raises:
            UnknownAgent: no participant has this name.
            TimeoutError: no answer arrived in time.
            RunEnded: the run ended first.
        """
        answers = await self._answers("askOne", receiver, literal, timeout)
        return answers[0] if answers else None

    async def ask_all(
        self, receiver: str, literal: str, timeout: float | None = None
    ) -> list[dict[str, Any]]:
        """Ask an agent for all answers (``askAll``). See `ask`."""
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
        """Receive a message. Called by the run."""
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
        """Add a mailbox."""
        self._boxes[mailbox.name] = mailbox

    def names(self) -> Sequence[str]:
        """Return their names, in the order of creation."""
        return tuple(self._boxes)


def term_of(content: object) -> Term:
    """Return the content of a message as a term.

    Raises:
        AslError: the text is not a term.
    """
    if type(content) is str:
        return lower_value(parse_term(content))
    return to_term(content, UNKEPT)


def _bindings(asked: Term, names: Any, told: Term) -> dict[str, Any] | None:
    """Return the values of a question's variables in one answer; None if that is another literal."""
    trail = Trail()
    try:
        return values_of(names) if unify(bare(asked), bare(rename(told)), trail) else None
    finally:
        undo(trail, 0)


def check_name(name: str) -> None:
    """Check the name of a participant.

    Raises:
        UsageError: it is empty.
    """
    if not name:
        raise UsageError("the name of a participant must not be empty")
