"""The ports of a run: who is there, where messages go, who provides which service.

The agents of this process stand behind them, and whatever else takes part: agents of other processes, Python code with a
mailbox of its own.  Nothing here waits: what is asked of another process is sent, what is asked about it is answered from
what is known here.
"""

from collections.abc import Sequence
from typing import Protocol

from jacaros.bdi.state.speech_act import SpeechAct


class Mailbox(Protocol):
    """Where the messages for one participant go."""

    def receive(self, message: SpeechAct) -> None:
        """Take a message in, or send it on its way; return soon.

        A message that turns out later not to reach its receiver is given to `Mailboxes.returned`.

        Raises:
            Failure: the mailbox is full.
        """


class Participants(Protocol):
    """Participants of the system that are not agents of this run; their names are those of no agent of it."""

    def names(self) -> Sequence[str]:
        """The names known by now, in an order that stays."""

    def find(self, name: str) -> Mailbox | None:
        """Where the messages for a name go; None when it is not among the `names`."""


class Services(Protocol):
    """The directory facilitator: who provides which service."""

    def register(self, name: str, service: str) -> None:
        """An agent provides a service; its subscribers are told."""

    def deregister(self, name: str, service: str) -> None:
        """It does not any more."""

    def providers(self, service: str) -> Sequence[str]:
        """The agents that provide a service, as far as is known by now, in the order of their registration."""

    def subscribe(self, name: str, service: str) -> None:
        """An agent wants to be told of all providers of a service, by messages."""
