"""Records of messages between agents."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.agents.mind.state.act import SpeechAct
from jacaros.mas.history.words import shown
from jacaros.runtime.trace import Cause, Tracer

KEPT = 5_000
"""Number of messages that are kept until they are read or answered."""


class MessageRecords:
    """Records each message when it is sent, and when it is read.

    Args:
        links: creates the links of causal chains.
        cause: returns the cause of what the agent with a name is doing.
        tell: takes the kind of a record and its data.
    """

    def __init__(
        self,
        links: Tracer,
        cause: Callable[[str], Cause | None],
        tell: Callable[[str, Mapping[str, Any]], None],
    ) -> None:
        self._links, self._cause, self._tell = links, cause, tell
        self._known: dict[str, Cause] = {}

    def sent(self, message: SpeechAct) -> None:
        """Record a delivered message."""
        told = f"{message.sender} -> {message.receiver} {message.performative} {shown(message.content)}"
        link = self._links.link("message", told, self._cause(message.sender))
        self._known[message.id] = link
        if len(self._known) > KEPT:
            del self._known[next(iter(self._known))]
        self._record(message, link, "sent")

    def read(self, message: SpeechAct) -> Cause | None:
        """Record that a message is read. Return its link, or None if its sending was not observed."""
        link = self._known.get(message.id)
        if link is not None:
            self._record(message, link, "read")
        return link

    def _record(self, message: SpeechAct, link: Cause, state: str) -> None:
        question = self._known.get(message.in_reply_to) if message.in_reply_to is not None else None
        self._tell(
            "message",
            {
                "id": link.id,
                "from": message.sender,
                "to": message.receiver,
                "performative": message.performative,
                "content": shown(message.content),
                "reply_to": None if question is None else question.id,
                "state": state,
                "cause": link.parent,
            },
        )
