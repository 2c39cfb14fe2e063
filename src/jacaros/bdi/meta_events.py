"""Changes of goal states: events for plans that ask for them (``^!g[state(S)]``), and news for an observer."""

from collections.abc import Callable
from typing import Any

from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.event import Event
from jacaros.compiler.runtime import annotations_of_event, literal_of
from jacaros.compiler.triggers import trigger
from jacaros.terms.order import annotation_set
from jacaros.terms.text import text
from jacaros.terms.values import atom, structure


def goal_state(agent: Circumstance, goal: tuple[Any, ...], annotations: Any, state: str) -> None:
    """Tell that a goal has got into another state; an event comes one cycle later, before ordinary ones."""
    kind = goal[0]
    if not kind.kind or kind.operator == "^":
        return
    if agent.goal_observer is not None:
        agent.goal_observer(state, kind.kind + text(literal_of(goal, ())), id(goal))
    meta = trigger("^", kind.kind, kind.functor)
    if agent.selects[meta] is None:
        return
    told = structure("state", atom(state))
    event = Event((meta, *goal[1:]), None, annotation_set((told, *annotations_of_event(annotations))))
    agent.tasks.append(lambda: agent.events.appendleft(event))


def observe_goals(agent: Circumstance, observer: Callable[[str, str, int], None]) -> None:
    """Have an observer told of every change of a goal: its state (``executing``, ``achieved``, ``failed``,
    ``suspended``, ``resumed``, ``dropped`` …), the goal as text, and a number that is the same for all news of one goal."""
    agent.goal_observer = observer
    agent.meta = True
