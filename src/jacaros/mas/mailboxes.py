"""Messages between agents: each arrives once, in the order of sending, as a copy of its own."""

from collections.abc import Callable
from dataclasses import replace

from jacaros.bdi.speech_act import SpeechAct
from jacaros.terms.detaching import detached, holds_collection
from jacaros.terms.unifier import is_ground, rename


class Mailboxes:
    """Delivers what agents say to each other.

    Args:
        find: from an agent's name to where its messages go, None when there is no such agent.
    """

    def __init__(self, find: Callable[[str], Callable[[SpeechAct], None] | None]) -> None:
        self._find = find

    def deliver(self, message: SpeechAct) -> bool:
        """Put *message* into the mailbox of its receiver; False when there is no such agent.

        Variables are renamed apart, and sets, maps and queues copied: what the receiver binds or changes stays
        unknown to the sender.
        """
        receive = self._find(message.receiver)
        if receive is None:
            return False
        content = message.content
        if not is_ground(content):
            content = rename(content)
        if holds_collection(content):
            content = detached(content)
        if content is not message.content:
            message = replace(message, content=content)
        receive(message)
        return True
