"""How a session tells what it waits for."""

from contextlib import AbstractContextManager, nullcontext
from typing import Protocol


class Account(Protocol):
    """Keeps account of what a session waits for, so that a run knows when nothing more will happen."""

    def begin(self) -> None:
        """An operation is under way."""

    def end(self) -> None:
        """It has ended."""

    def waiting(self) -> AbstractContextManager[None]:
        """Surrounds a wait that somebody else has to end, such as for a signal."""


class NoAccount:
    """Keeps no account."""

    def begin(self) -> None:
        """Nothing."""

    def end(self) -> None:
        """Nothing."""

    def waiting(self) -> AbstractContextManager[None]:
        """Nothing."""
        return nullcontext()
