"""How a session tells what it waits for, and what it is at."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Protocol

Observer = Callable[[str, str, object, str], None]
"""Takes the state of something that is pursued (``executing``, ``achieved``, ``failed``, ``dropped``), its text, an object
that is the same for all news of it, and of a failure the reason as people read it."""


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
