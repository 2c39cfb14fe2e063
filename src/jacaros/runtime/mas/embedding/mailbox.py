"""Mailboxes: participants that exchange messages with agents."""

import asyncio
from collections.abc import Sequence
from typing import Any

from jacaros.agents.body.values import UNKEPT, to_term
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.python.agent import Message
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Term, bare
from jacaros.runtime.mas.embedding.running_agent import question, values_of
from jacaros.runtime.mas.embedding.waits import RunEnded, RunWaits
from jacaros.runtime.mas.messaging import Arrivals, Correspondent, ListNames, Send


class Mailbox(Arrivals[Message]):
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

    def __init__(self, name: str, send: Send, names: ListNames, waits: RunWaits) -> None:
        super().__init__()
        self.name, self._waits = name, waits
        self._sender = Correspondent(name, send, names)

    async def get(self, timeout: float | None = None) -> Message:
        """Return the next message, waiting until it arrives.

        Args:
            timeout: time limit in seconds of the run's clock. None: no limit.

        Raises:
            TimeoutError: no message arrived in time.
            RunEnded: the run has ended, so none will arrive.
        """
        return await self.next(
            lambda arrival: self._waits.wait(arrival, lambda: f"no message for {self.name}", timeout)
        )

    def __bool__(self) -> bool:
        return True

    def __aiter__(self) -> "Mailbox":
        return self

    async def __anext__(self) -> Message:
        try:
            return await self.get()
        except RunEnded:
            raise StopAsyncIteration from None

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
        answered = reply_to.id if reply_to is not None else None
        self._sender.say(receiver, performative, term_of(content), answered)

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
        asked, names = question(literal)

        def wait(answer: "asyncio.Future[SpeechAct]") -> Any:
            missing = f"agent {receiver} did not answer {literal}"
            return self._waits.wait(answer, lambda: missing, timeout, receiver)

        message = await self._sender.question(receiver, "askOne", rename(asked), wait)
        return None if message.performative == "untell" else _bindings(asked, names, message.content)

    def receive(self, message: SpeechAct) -> None:
        """Receive a message. Called by the run."""
        if not self._sender.takes_answer(message):
            self.put(Message(message))

    def __repr__(self) -> str:
        return f"<mailbox {self.name}, {len(self)} messages>"


class PythonMailboxes(dict[str, Mailbox]):
    """The mailboxes of a run by name: its `jacaros.runtime.mas.directory.Participants`."""

    def find(self, name: str) -> Mailbox | None:
        """Return the mailbox of a name, or None."""
        return self.get(name)

    def names(self) -> Sequence[str]:
        """Return their names, in the order of creation."""
        return tuple(self)


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
