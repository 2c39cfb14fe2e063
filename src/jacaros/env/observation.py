"""Observations: what an artifact publishes to its observers."""

from typing import NamedTuple, Protocol, runtime_checkable

from jacaros.env.ids import ArtifactId
from jacaros.env.property import Change, ObservableProperty
from jacaros.trace import Cause


class Signal(NamedTuple):
    """A signal of an artifact. It is not stored.

    Attributes:
        name: functor of the event.
        arguments: plain values.
    """

    name: str
    arguments: tuple[object, ...]


class Observation(NamedTuple):
    """Everything that one commit of one artifact publishes. Process the parts in this order.

    Attributes:
        artifact: the source.
        signals: the signals.
        changed: properties with new values, before and after.
        added: new properties; all properties when an observer begins to focus.
        removed: removed properties; all properties when the focus or the artifact ends.
        cause: what led to it. None if unknown.
    """

    artifact: ArtifactId
    signals: tuple[Signal, ...] = ()
    changed: tuple[Change, ...] = ()
    added: tuple[ObservableProperty, ...] = ()
    removed: tuple[ObservableProperty, ...] = ()
    cause: Cause | None = None


class Observer(Protocol):
    """An observer of artifacts. It must be hashable by identity."""

    @property
    def agent(self) -> str:
        """Name of the agent it observes for. `signal_to` finds it by this name."""

    def observe(self, observation: Observation) -> None:
        """Receive an observation, in the order of the commits. Return soon and do not raise."""

    def __hash__(self) -> int: ...


@runtime_checkable
class SlowObserver(Observer, Protocol):
    """An observer that processes observations later than it receives them, and reports whether it has."""

    def has_untaken(self, name: str) -> bool:
        """Return whether a received change of properties called *name* has not been processed yet."""
