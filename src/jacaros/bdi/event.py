"""Events: what happened to goals and beliefs and may need a plan."""

from typing import Any, NamedTuple

from jacaros.bdi.intention import Intention
from jacaros.compiler.triggers import Trigger
from jacaros.terms.values import Term
from jacaros.trace import Cause


class Event(NamedTuple):
    """An entry of the event queue.

    Attributes:
        goal: a tuple that begins with its `Trigger`, then the arguments.
        intention: the one that posted it, None for an external event.
        annotations: a tuple, or a `FailureReason`.
        cause: why it came, for external events.
    """

    goal: tuple[Any, ...]
    intention: Intention | None
    annotations: Any
    cause: Cause | None = None

    @property
    def trigger(self) -> Trigger:
        """The kind of the event."""
        trigger: Trigger = self.goal[0]
        return trigger


class Posted(NamedTuple):
    """A goal or event with other annotations than ``source(self)``, on its way from a step to the queue."""

    goal: tuple[Any, ...]
    annotations: Any


Annotations = tuple[Term, ...]
