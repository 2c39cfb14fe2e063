"""Causes: why something happened, and the port through which a run is observed."""

from contextvars import ContextVar
from typing import Any, NamedTuple, Protocol


class Cause(NamedTuple):
    """One link in the chain from a sensor message to a command.

    Attributes:
        id: number of this link, unique in the run.
        parent: number of the link that led to it, 0 at the beginning of a chain.
        kind: stage of the chain: ``sample``, ``property``, ``signal``, ``event``, ``act``, ``operation``, ``command``,
            ``remote`` for a step of an agent of another system, or ``request`` of a caller outside.
        what: short description.
    """

    id: int
    parent: int
    kind: str
    what: str


class Origin(NamedTuple):
    """The step of an agent that led to something, as other systems of a fleet hear of it.

    Attributes:
        agent: name of the agent.
        event: what its plan is for, such as ``+!go(dock)``; empty if unknown.
        file, line: location of the step; ``""`` and 0 if unknown.
    """

    agent: str
    event: str = ""
    file: str = ""
    line: int = 0


class Tracer(Protocol):
    """Observer of a run; without one, no causes are made."""

    def link(self, kind: str, what: str, parent: Cause | None = None, about: object = None) -> Cause:
        """Make and record the next link of a chain.

        Args:
            kind: stage of the chain, see `Cause`.
            what: short description.
            parent: the previous link, None at the beginning of a chain.
            about: what the link is about; read only if the link is recorded.
        """

    def origin(self, cause: Cause) -> Origin | None:
        """Return the step of an agent that led to a recent link; None if none did, or it is unknown."""

    def received_message(self, topic: str, message: Any) -> Cause:
        """Make the first link of a chain, of kind ``sample``: our node has received *message*."""

    def sent_message(self, topic: str, message: Any, parent: Cause | None) -> None:
        """Make the last link of a chain, of kind ``command``, if *parent* led to it: our node has sent
        *message*.
        """


CURRENT: ContextVar[Cause | None] = ContextVar("CURRENT", default=None)
"""The cause of the running code, for messages that it publishes; set for operations while a run is observed."""
