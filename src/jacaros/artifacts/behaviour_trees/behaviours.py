"""Behaviours that use and observe artifacts."""

from collections.abc import Callable, Sequence
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Access, Status

from jacaros.artifacts import Session
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, UnknownProperty
from jacaros.artifacts.env.values import equal, plain, text
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


def _call(name: str, values: Sequence[object]) -> str:
    return f"{name}({', '.join(text(value, True) for value in values)})" if values else name


class PropertyCheck(ArtifactBehaviour):
    """SUCCESS if a property has matching values, otherwise FAILURE; of several with one name, one is enough.

    Args:
        property_name: its name.
        predicate: called with the values of the property, such as ``lambda level: level > 20``; default: any values
            match. If it raises an exception, the behaviour fails.
        artifact: the artifact with the property; default: any focused one.
        name: name of the behaviour; default: the property's name with a question mark.
    """

    def __init__(
        self,
        property_name: str,
        predicate: Callable[..., object] | None = None,
        *,
        artifact: ArtifactId | str | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(name or f"{property_name}?")
        self.property_name, self.predicate, self.artifact = property_name, predicate, artifact

    def update(self) -> Status:
        """Check the property."""
        try:
            seen = self.session.properties(self.property_name, artifact=self.artifact)
            if not seen:
                self.session.value(self.property_name, artifact=self.artifact)
        except (OperationFailed, UnknownProperty) as unknown:
            self.feedback_message = str(unknown)
            return Status.FAILURE
        self.feedback_message = ", ".join(_call(each.name, each.values) for each in seen)
        try:
            fits = any(self.predicate is None or self.predicate(*each.values) for each in seen)
        except Exception as error:
            self.complain("the predicate", error)
            return Status.FAILURE
        return Status.SUCCESS if fits else Status.FAILURE


class HasProperty(PropertyCheck):
    """SUCCESS if a property has these values, otherwise FAILURE.

    Args:
        property_name: its name.
        values: all its values; default: any.
        artifact: the artifact with the property; default: any focused one.
        name: name of the behaviour; default: such as ``holder(driver)?``.
    """

    def __init__(
        self,
        property_name: str,
        *values: object,
        artifact: ArtifactId | str | None = None,
        name: str | None = None,
    ) -> None:
        wanted = [plain(value) for value in values]
        predicate = (lambda *found: equal(list(found), wanted)) if wanted else None
        shown = f"{property_name}({', '.join(map(text, wanted))})" if wanted else property_name
        super().__init__(property_name, predicate, artifact=artifact, name=name or f"{shown}?")
