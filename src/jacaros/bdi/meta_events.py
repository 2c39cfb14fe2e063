"""Events for changes of goal states: ``^!g[state(S)]``, only for agents that have plans for them."""

from typing import Any

from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.event import Event
from jacaros.compiler.runtime import annotations_of_event
from jacaros.compiler.triggers import trigger
from jacaros.terms.order import annotation_set
from jacaros.terms.values import atom, structure


def goal_state(agent: Circumstance, goal: tuple[Any, ...], annotations: Any, state: str) -> None:
    """Tell plans that a goal has got into another state; the event comes one cycle later, before ordinary ones."""
    kind = goal[0]
    if not kind.kind or kind.operator == "^":
        return
    told = structure("state", atom(state))
    meta = trigger("^", kind.kind, kind.functor)
    event = Event((meta, *goal[1:]), None, annotation_set((told, *annotations_of_event(annotations))))
    agent.tasks.append(lambda: agent.events.appendleft(event))
