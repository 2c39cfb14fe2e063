"""Causes: why a thing happened, and the port through which a run is observed."""

import itertools
from typing import NamedTuple, Protocol


class Cause(NamedTuple):
    """One link in the chain from a sensor message to a command.

    Attributes:
        id: number of this link, unique in the process.
        parent: number of the link that led to it, 0 at the beginning of a chain.
        kind: stop of the journey, such as ``sample``, ``property``, ``event``, ``act``, ``operation``.
        what: short text for people.
    """

    id: int
    parent: int
    kind: str
    what: str


_numbers = itertools.count(1)


class Tracer(Protocol):
    """Observer of a run; it is told of every cause as it arises."""

    def record(self, cause: Cause, time: float) -> None:
        """Take note of *cause*, which arose at *time* (seconds of the run's clock)."""


def cause(kind: str, what: str, parent: Cause | None = None) -> Cause:
    """Make the next link of a chain."""
    return Cause(next(_numbers), parent.id if parent is not None else 0, kind, what)
