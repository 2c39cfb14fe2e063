"""Mailboxes: participants that exchange messages with agents."""

import asyncio
from collections.abc import Sequence
from typing import Any

from jacaros.agents.language.loader import parse_formula, parse_term
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.python.agent import Message
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Term, bare
from jacaros.runtime.mas.embedding.given import Given, by_position, read_given
from jacaros.runtime.mas.embedding.running_agent import values_of
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
        self,
        receiver: str,
        performative: str,
        content: object,
        /,
        *arguments: object,
        reply_to: Message | None = None,
        **values: object,
    ) -> None:
        """Send a message to an agent.

        Args:
            receiver: name of the agent.
            performative: ``tell``, ``achieve``, ``askOne``, ``signal`` …
            content, arguments, values: as for `RunningAgent.add_belief`, but the text is any term, and the content can be
                any plain value. ``"Content", Content=value`` sends a string, too.
            reply_to: the message that this one answers.

        Raises:
            UnknownAgent: no participant has this name.
            AslError, UsageError: as for `RunningAgent.add_belief`.
        """
        arguments, reply_to = by_position(content, arguments, "reply_to", reply_to)
        said = read_given(content, arguments, values, parse_term).term
        self._sender.say(receiver, performative, said, reply_to.id if reply_to is not None else None)

    async def ask(
        self,
        receiver: str,
        literal: object,
        /,
        *arguments: object,
        timeout: float | None = None,
        **values: object,
    ) -> dict[str, Any] | None:
        """Ask an agent for one answer (``askOne``), and wait for it.

        Args:
            receiver: name of the agent.
            literal, arguments, values: the question, such as ``battery(Level)``, as for `RunningAgent.answers`.
            timeout: time limit in seconds of the run's clock.

        Returns:
            Plain values by name of the variables without a value; None if the agent does not know.

        Raises:
            UnknownAgent: no participant has this name.
            TimeoutError: no answer arrived in time.
            RunEnded: the run ended first.
        """
        arguments, timeout = by_position(literal, arguments, "timeout", timeout)
        asked = read_given(literal, arguments, values, parse_formula)

        def wait(answer: "asyncio.Future[SpeechAct]") -> Any:
            missing = f"agent {receiver} did not answer {asked.text}"
            return self._waits.wait(answer, lambda: missing, timeout, receiver)

        message = await self._sender.question(receiver, "askOne", rename(asked.term), wait)
        return None if message.performative == "untell" else _bindings(asked, message.content)

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


def _bindings(asked: Given, told: Term) -> dict[str, Any] | None:
    """Return the values of a question's variables in one answer; None if that is another literal."""
    trail = Trail()
    try:
        return values_of(asked.unknown) if unify(bare(asked.term), bare(rename(told)), trail) else None
    finally:
        undo(trail, 0)
