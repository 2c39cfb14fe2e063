"""What an artifact publishes, and who receives it."""

from typing import NamedTuple, Protocol, runtime_checkable

from jacaros.env.ids import ArtifactId
from jacaros.env.property import Change, ObservableProperty
from jacaros.trace import Cause


class Signal(NamedTuple):
    """Something that happened in an artifact; it is not kept.

    Attributes:
        name: the functor of the event.
        arguments: plain values.
    """

    name: str
    arguments: tuple[object, ...]


class Observation(NamedTuple):
    """All that one commit of one artifact publishes; its parts are to be handled in this order.

    Attributes:
        artifact: where it comes from.
        signals: what happened.
        changed: properties with new values, as they were and as they are.
        added: new properties; all properties when an observer begins to focus.
        removed: properties that are gone; all properties when the focus or the artifact ends.
        cause: what led to it, None when nothing is known.
    """

    artifact: ArtifactId
    signals: tuple[Signal, ...] = ()
    changed: tuple[Change, ...] = ()
    added: tuple[ObservableProperty, ...] = ()
    removed: tuple[ObservableProperty, ...] = ()
    cause: Cause | None = None


class Observer(Protocol):
    """Who focuses artifacts; it must be hashable by identity."""

    @property
    def agent(self) -> str:
        """Name of the agent it observes for; `signal_to` finds it by this name."""

    def observe(self, observation: Observation) -> None:
        """Receive an observation, in the order of the commits; return soon, and do not raise."""

    def __hash__(self) -> int: ...


@runtime_checkable
class SlowObserver(Observer, Protocol):
    """An observer that takes observations up later than it receives them, and can say so."""

    def has_untaken(self, name: str) -> bool:
        """Whether something that it received about properties called *name* has still to be taken up."""
