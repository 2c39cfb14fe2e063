"""Messages between agents: each arrives once, in the order of sending, as a copy of its own."""

from collections.abc import Callable
from contextlib import suppress

from jacaros.bdi.state.plan import Failure
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.mas.ports import Mailbox
from jacaros.terms.collections import detached, holds_collection
from jacaros.terms.substitution import is_ground, rename


class Mailboxes:
    """Delivers what agents say to each other.

    Args:
        find: from an agent's name to where its messages go, None when there is no such agent.
        find_other: the same for participants that are no agents of this run; asked after *find*.
    """

    def __init__(
        self,
        find: Callable[[str], Mailbox | None],
        find_other: Callable[[str], Mailbox | None] = lambda name: None,
    ) -> None:
        self._find = find
        self._find_other = find_other

    def deliver(self, message: SpeechAct) -> bool:
        """Put *message* into the mailbox of its receiver; False when nobody of that name is known.

        Variables are renamed apart, and sets, maps and queues copied: what the receiver binds or changes stays
        unknown to the sender.

        Raises:
            Failure: the mailbox is full; the step that sends fails.
        """
        receiver = self._find(message.receiver)
        if receiver is None:
            receiver = self._find_other(message.receiver)
            if receiver is None:
                return False
        if not message.flat:
            message = _parted(message)
        receiver.receive(message)
        return True

    def returned(self, message: SpeechAct) -> None:
        """Tell the sender of a message that was accepted that it did not reach its receiver.

        It gets a message ``undelivered`` about it.  A question that it waits for fails with ``receiver_not_found``.
        """
        sender = self._find(message.sender)
        if sender is not None:
            id = f"{message.id}_undelivered"
            told = ("undelivered", message.receiver, message.sender, message.content, id, message.id)
            # Whoever reports it runs no step that could fail: a sender whose mailbox is full does not learn of it.
            with suppress(Failure):
                sender.receive(SpeechAct(*told))


def _parted(message: SpeechAct) -> SpeechAct:
    """The message with a content that shares nothing that can be bound or changed."""
    content = message.content
    if not is_ground(content):
        content = rename(content)
    if holds_collection(content):
        content = detached(content)
    return message if content is message.content else message.with_content(content)
