"""Messages between agents: each arrives once, in the order of sending, as a copy of its own."""

from collections.abc import Callable
from typing import Protocol

from jacaros.bdi.speech_act import SpeechAct
from jacaros.terms.detaching import detached, holds_collection
from jacaros.terms.unifier import is_ground, rename


class Receiver(Protocol):
    """Where the messages for an agent go."""

    def receive(self, message: SpeechAct) -> None:
        """Take a message in."""


class Mailboxes:
    """Delivers what agents say to each other.

    Args:
        find: from an agent's name to where its messages go, None when there is no such agent.
    """

    def __init__(self, find: Callable[[str], Receiver | None]) -> None:
        self._find = find

    def deliver(self, message: SpeechAct) -> bool:
        """Put *message* into the mailbox of its receiver; False when there is no such agent.

        Variables are renamed apart, and sets, maps and queues copied: what the receiver binds or changes stays
        unknown to the sender.
        """
        receiver = self._find(message.receiver)
        if receiver is None:
            return False
        if not message.flat:
            message = _parted(message)
        receiver.receive(message)
        return True


def _parted(message: SpeechAct) -> SpeechAct:
    """The message with a content that shares nothing that can be bound or changed."""
    content = message.content
    if not is_ground(content):
        content = rename(content)
    if holds_collection(content):
        content = detached(content)
    return message if content is message.content else message.with_content(content)
