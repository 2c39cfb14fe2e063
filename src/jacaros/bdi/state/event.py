"""Events: what happened to goals and beliefs and may need a plan."""

from typing import Final

from jacaros.bdi.state.intention import Intention
from jacaros.bdi.state.literals import EventAnnotations, literal_of
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.values import Term
from jacaros.trace import Cause

Event = tuple[Goal, Intention | None, EventAnnotations, Cause | None]
"""``(goal, intention, annotations, cause)``: an entry of the event queue.

goal: a tuple that begins with its `Trigger`, then the arguments.
intention: the one that posted it, None for an external event.
annotations: a tuple, or a `FailureReason`.
cause: why it came, for external events.

A plain tuple: with several intentions nearly every cycle makes one, and an object with names costs five times as much.
"""

EVENT_GOAL: Final = 0
EVENT_INTENTION: Final = 1
EVENT_ANNOTATIONS: Final = 2
EVENT_CAUSE: Final = 3


class Posted:
    """A goal or event with other annotations than ``source(self)``, on its way from a step to the queue."""

    __slots__ = ("annotations", "goal")

    def __init__(self, goal: Goal, annotations: EventAnnotations) -> None:
        self.goal, self.annotations = goal, annotations


Raised = Goal | Posted | None
"""The goal or event that a step raises for its own intention, if any."""
Annotations = tuple[Term, ...]


def event_literal(event: Event) -> Term:
    """The belief or goal of an event, with its annotations."""
    return literal_of(event[EVENT_GOAL], event[EVENT_ANNOTATIONS])
