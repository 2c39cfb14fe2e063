"""Changes of goal states: events for plans that ask for them (``^!g[state(S)]``), and news for an observer."""

from collections.abc import Callable
from typing import Any

from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.event import EVENT_ANNOTATIONS, EVENT_GOAL, Event
from jacaros.bdi.intention import ANNOTATIONS, GOAL, Intention
from jacaros.compiler.literals import annotations_of_event, literal_of
from jacaros.compiler.triggers import trigger
from jacaros.terms.order import annotation_set
from jacaros.terms.text import text
from jacaros.terms.values import Annotated, String, Term, atom, structure

_NO_REASON = String("")


def goal_state(
    agent: Circumstance,
    goal: tuple[Any, ...],
    annotations: Any,
    state: str,
    reason: Term = _NO_REASON,
    why: str = "",
) -> None:
    """Tell that a goal has got into another state, and an observer *why*; an event comes one cycle later, before
    ordinary ones."""
    kind = goal[0]
    if not kind.kind or kind.operator == "^":
        return
    observe(agent, goal, state, why)
    meta = trigger("^", kind.kind, kind.functor)
    if agent.selects[meta] is None:
        return
    told = Annotated(structure("state", atom(state)), (structure("reason", reason),))
    event = ((meta, *goal[1:]), None, annotation_set((told, *annotations_of_event(annotations))), None)
    agent.do_soon(lambda: _insert(agent, event))


def observe(agent: Circumstance, goal: tuple[Any, ...], state: str, why: str = "") -> None:
    """Report a change of a goal to the observer only: plans get no event for it."""
    kind = goal[0].kind
    if agent.goal_observer is not None and kind:
        agent.goal_observer(state, kind + text(literal_of(goal, ())), goal, why)


def post_new_goal(agent: Circumstance, event: Event) -> None:
    """Queue the event of a new goal; it is pending from now on."""
    if agent.meta:
        goal_state(agent, event[EVENT_GOAL], event[EVENT_ANNOTATIONS], "pending")
    agent.post(event)


def top_goal_state(agent: Circumstance, intention: Intention, state: str, reason: Term = _NO_REASON) -> None:
    """The same for the topmost goal of an intention."""
    for frame in reversed(intention.frames):
        if frame[GOAL][0].kind and not frame[GOAL][0].failing:
            goal_state(agent, frame[GOAL], frame[ANNOTATIONS], state, reason)
            return


def _insert(agent: Circumstance, event: Event) -> None:
    """Put a meta event before the ordinary ones, behind those that came earlier."""
    place = 0
    for queued in agent.events:
        if queued[EVENT_GOAL][0].operator != "^":
            break
        place += 1
    agent.events.insert(place, event)


def observe_goals(agent: Circumstance, observer: Callable[[str, str, object, str], None]) -> None:
    """Have an observer told of every change of a goal.

    It gets the state (``executing``, ``achieved``, ``failed``, ``suspended``, ``resumed``, ``dropped``, ``replaced`` …),
    the goal as text, an object that is the same for all news of one goal, and for a failure its reason as people read
    it."""
    agent.goal_observer = observer
    agent.meta = agent.special = agent.called = True
