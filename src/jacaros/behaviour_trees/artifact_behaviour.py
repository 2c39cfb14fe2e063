"""The common part of all behaviours that use artifacts."""

from collections.abc import Callable
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Access

from jacaros.artifacts import Session
from jacaros.runtime.clock import Clock


def nothing() -> None:
    """Do nothing: no runner waits for a tick."""


def session_of(behaviour: Behaviour, given: dict[str, Any]) -> Session:
    """Return the session that a behaviour is set up with.

    Raises:
        TypeError: none exists.
    """
    session = given.get("session")
    if not isinstance(session, Session):
        raise TypeError(
            f"behaviour `{behaviour.name}` has no session; tick its tree with a TreeRunner, or set the tree up "
            "with tree.setup(session=Session(environment, name))"
        )
    return session


class ArtifactBehaviour(Behaviour):
    """A behaviour that uses artifacts; behaviours of a project may derive from it, too.

    Attributes:
        session: access to the environment; set by `setup`.
        wake: requests a tick soon, because an awaited event has happened.
    """

    session: Session

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.wake: Callable[[], None] = nothing
        self.board = self.attach_blackboard_client()
        self._reported: str | None = None

    def setup(self, **given: Any) -> None:
        """Connect to the environment; called by `TreeRunner`, or with ``tree.setup(session=...)``.

        Args:
            given: ``session``, a `Session`; ``wake``, the function for `wake`, optional.

        Raises:
            TypeError: no session is given.
        """
        self.session = session_of(self, given)
        self.wake = given.get("wake", nothing)
        self._reported = None

    def let_go(self) -> None:
        """Cancel everything immediately: the tree ends, possibly after an exception."""

    @property
    def clock(self) -> Clock:
        """The clock of the behaviour."""
        return self.session.clock

    def may_read(self, key: str) -> None:
        """Register with the blackboard that this behaviour reads *key*, or an attribute of it."""
        self.board.register_key(key.partition(".")[0], Access.READ)

    def may_write(self, key: str) -> None:
        """Register with the blackboard that this behaviour writes *key*."""
        self.board.register_key(key, Access.WRITE)

    def complain(self, what: str, error: Exception) -> None:
        """Show in ``feedback_message`` that the author's own code raised an exception, and log it, but not at every
        tick."""
        self.feedback_message = f"{what} raised {type(error).__name__}: {error}"
        if self._is_news(self.feedback_message):
            where = f"behaviour '{self.name}': {what} failed:"
            self.session.environment.log_error(self.session.name, where, error)

    def warn(self, text: str) -> None:
        """Log a mistake in the tree, but not at every tick."""
        if self._is_news(text):
            self.session.environment.log(f"[{self.session.name}] behaviour '{self.name}': {text}")

    def _is_news(self, text: str) -> bool:
        told, self._reported = self._reported, text
        return told != text
