"""Causes: why a thing happened, and the port through which a run is observed."""

from contextvars import ContextVar
from typing import Any, NamedTuple, Protocol


class Cause(NamedTuple):
    """One link in the chain from a sensor message to a command.

    Attributes:
        id: number of this link, unique in the run.
        parent: number of the link that led to it, 0 at the beginning of a chain.
        kind: stop of the journey: ``sample``, ``property``, ``signal``, ``event``, ``act``, ``operation`` or ``command``.
        what: short text for people.
    """

    id: int
    parent: int
    kind: str
    what: str


class Tracer(Protocol):
    """Observer of a run; where there is none, no cause is made."""

    def link(self, kind: str, what: str, parent: Cause | None = None, about: object = None) -> Cause:
        """Make the next link of a chain, and take note of it.

        Args:
            kind: stop of the journey, see `Cause`.
            what: short text.
            parent: what led to it, None at the beginning of a chain.
            about: what the link is about; it is read only if the link is recorded.
        """

    def received_message(self, topic: str, message: Any) -> Cause:
        """Make the first link of a chain, of kind ``sample``: our node has received *message*."""

    def sent_message(self, topic: str, message: Any, parent: Cause | None) -> None:
        """Make the last link of a chain, of kind ``command``, if *parent* led to it: our node has sent *message*."""


CURRENT: ContextVar[Cause | None] = ContextVar("CURRENT", default=None)
"""What led to the code that runs now, for messages that it publishes; set for operations while somebody watches."""
