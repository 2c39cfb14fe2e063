"""Messages between agents."""

from jacaros.terms.values import Term


class SpeechAct:
    """A message between agents (KQML). Never changed once it has been sent.

    Attributes:
        performative: ``tell``, ``achieve``, ``askOne`` … in Jason's spelling.
        sender: name of the sending agent, ``self`` in messages to oneself.
        receiver: name of the receiving agent.
        content: a term; a copy, so that agents share no variables.
        in_reply_to: id of the question that this message answers, or None.
        flat: the content is known to be an atom, or a structure of atoms, numbers and strings: it need not be
            copied or searched; False if this has not been checked.
    """

    __slots__ = ("_id", "content", "flat", "in_reply_to", "performative", "receiver", "sender")

    def __init__(
        self,
        performative: str,
        sender: str,
        receiver: str,
        content: Term,
        id: str | int,
        in_reply_to: str | None = None,
        flat: bool = False,
    ) -> None:
        """Make a message.

        Args:
            id: unique in the system; or the number of the message among those of its sender, from which the id is made
                on demand.
        """
        self.performative = performative
        self.sender = sender
        self.receiver = receiver
        self.content = content
        self._id = id
        self.in_reply_to = in_reply_to
        self.flat = flat

    @property
    def id(self) -> str:
        """Id of the message, unique in the system, such as ``mid7_ann``."""
        if isinstance(self._id, int):
            self._id = message_id(self._id, self.receiver if self.sender == "self" else self.sender)
        return str(self._id)

    def with_content(self, content: Term) -> "SpeechAct":
        """Return the same message with another content."""
        return SpeechAct(self.performative, self.sender, self.receiver, content, self._id, self.in_reply_to)

    def __repr__(self) -> str:
        return f"SpeechAct({self.performative!r}, {self.sender!r}, {self.receiver!r}, {self.content!r}, {self.id!r})"


def message_id(number: int, sender: str) -> str:
    """Return the id of a message; numbers are unique for its sender."""
    return f"mid{number}_{sender}"
