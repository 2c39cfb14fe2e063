"""What agents say to each other."""

from dataclasses import dataclass

from jacaros.terms.values import Term


@dataclass(frozen=True, slots=True)
class SpeechAct:
    """A message between agents (KQML).

    Attributes:
        performative: ``tell``, ``achieve``, ``askOne`` … in Jason's spelling.
        sender: name of the agent that says it.
        receiver: name of the agent it is for.
        content: a term; a copy of its own, so that no variable is shared between agents.
        id: number of the message, unique in the system, such as ``mid7``.
        in_reply_to: id of the question that this message answers, or None.
    """

    performative: str
    sender: str
    receiver: str
    content: Term
    id: str
    in_reply_to: str | None = None
