"""Ports through which a session reports what it is waiting for and executing."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Protocol

Observer = Callable[[str, str, object, str], None]
"""Takes the state of an operation or goal (``executing``, ``achieved``, ``failed``, ``dropped``), its text, an object that
identifies it, and the reason of a failure as text.
"""


class Activity(Protocol):
    """Counts what runs, so that a run can detect idleness."""

    def begin(self) -> None:
        """Something with an end has begun."""

    def end(self) -> None:
        """It has ended, or was cancelled."""


class Account(Activity, Protocol):
    """Counts also what a session waits for."""

    def waiting(self) -> AbstractContextManager[None]:
        """Context of a wait that something else must end, such as for a signal."""


class NoAccount:
    """Counts nothing."""

    def begin(self) -> None:
        """Do nothing."""

    def end(self) -> None:
        """Do nothing."""

    def waiting(self) -> AbstractContextManager[None]:
        """Do nothing."""
        return nullcontext()
