"""State changes of goals: events for plans that react to them (``^!g[state(S)]``), and notifications of observers.

Also events about the agent itself: it falls asleep, awakes, or is about to be shut down.
"""

from collections.abc import Callable, Iterator

from jacaros.agents.mind.rules.failure_reason import FailureReason
from jacaros.agents.mind.state.act import MindObserver
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import (
    ANNOTATIONS,
    EVENT_ANNOTATIONS,
    EVENT_GOAL,
    GOAL,
    SERIAL,
    Event,
    Frame,
    Intention,
)
from jacaros.agents.mind.state.pending import is_pause
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, annotations_of_event, trigger
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.values import BY_SELF, Annotated, String, Term, atom, functor, structure

_NO_REASON = String("")


GoalObserver = Callable[[str, Goal, int, int, str], None]
"""Called with a goal's state, the goal, its number, that of its intention, and for a failure the reason as text."""


def goal_state(
    agent: Circumstance,
    goal: Goal,
    annotations: EventAnnotations,
    state: str,
    reason: Term = _NO_REASON,
    *details: Term,
) -> None:
    """Notify plans of a state change of a goal: the event comes one cycle later, before ordinary ones."""
    kind = goal[0]
    if not kind.kind or kind.operator == "^":
        return
    meta = trigger("^", kind.kind, kind.functor)
    if agent.library.selects[meta] is None:
        return
    told = Annotated(structure("state", atom(state)), annotation_set((structure("reason", reason), *details)))
    event = ((meta, *goal[1:]), None, annotation_set((told, *annotations_of_event(annotations))), None)
    agent.do_soon(_insert, event)


def frame_state(
    agent: Circumstance, intention: Intention, frame: Frame, state: str, reason: Term = _NO_REASON
) -> None:
    """Notify plans and the observer of a state change of a frame's goal."""
    observe(agent, intention, frame, state)
    goal_state(agent, frame[GOAL], frame[ANNOTATIONS], state, reason)


def observe(agent: Circumstance, intention: Intention, frame: Frame, state: str, why: str = "") -> None:
    """Notify only the observer."""
    if agent.observers.goal is not None:
        number = _goal_number(frame)
        if number is not None:
            observe_goal(agent, intention, frame[GOAL], number, state, why)


def observe_goal(
    agent: Circumstance, intention: Intention, goal: Goal, number: int, state: str, why: str = ""
) -> None:
    """Notify only the observer, of a goal that may have no frame."""
    kind = goal[0]
    if agent.observers.goal is not None and kind.kind and kind.operator != "^":
        agent.observers.goal(state, goal, number, intention.id, why)


def _goal_number(frame: Frame) -> int | None:
    """Return the number of a frame's goal, equal in all branches of a fork; None if the goal has a frame below, or
    pauses.
    """
    if not frame[GOAL][0].failing:
        number: int = frame[SERIAL]
        return None if is_pause(frame) else number
    return failed_number(frame[ANNOTATIONS])


def failed_number(annotations: EventAnnotations) -> int | None:
    """Return the number of the goal of a failure event that failed without a frame."""
    return annotations.goal_number if isinstance(annotations, FailureReason) else None


def observe_rest(agent: Circumstance, intention: Intention) -> None:
    """Notify the observer that goals are over because their intention is."""
    for frame in reversed(intention.frames[shared(agent, intention) :]):
        observe(agent, intention, frame, "finished")


def shared(agent: Circumstance, intention: Intention) -> int:
    """Return the number of frames, from the bottom of the stack, whose goals other branches of a fork pursue, too."""
    for point, _ in reversed(intention.forks):
        for other in agent.alive.values():
            if other is not intention and any(each is point for each, _ in other.forks):
                depth: int = point.depth
                return depth + 1
    return 0


def post_new_goal(agent: Circumstance, event: Event) -> None:
    """Queue the event of a new goal, which is pending from now on."""
    if agent.features.meta:
        goal_state(agent, event[EVENT_GOAL], event[EVENT_ANNOTATIONS], "pending")
    agent.post(event)


def top_goal_state(agent: Circumstance, intention: Intention, state: str, reason: Term = _NO_REASON) -> None:
    """Notify plans and the observer of a state change of an intention's topmost goal."""
    for frame in live_frames(intention):
        if frame[GOAL][0].kind and not frame[GOAL][0].failing:
            frame_state(agent, intention, frame, state, reason)
            return


def live_frames(intention: Intention) -> Iterator[Frame]:
    """Yield the frames of the pursued goals, the top one first.

    Failed goals stay on the stack below the plan that handles the failure. For such a plan, the frame of the goal that
    it handles is yielded, or its own if that goal failed without a frame.
    """
    index, handlers = len(intention.frames) - 1, len(intention.handlers)
    while index >= 0:
        if intention.frames[index][GOAL][0].failing and handlers:
            handlers -= 1
            index = intention.handlers[handlers]
        yield intention.frames[index]
        index -= 1


def _insert(agent: Circumstance, event: Event) -> None:
    """Insert a meta event before the ordinary events, after earlier meta events."""
    place = 0
    for queued in agent.events:
        if queued[EVENT_GOAL][0].operator != "^":
            break
        place += 1
    agent.events.insert(place, event)


def observe_goals(agent: Circumstance, observer: GoalObserver) -> None:
    """Notify an observer of every state change of goals that have begun.

    The states are ``executing``, ``waiting``, ``suspended``, ``resumed``, ``achieved``, ``failed``, ``recovered``,
    ``dropped``, ``replaced``, and last ``finished``. A goal keeps its number when its variables are bound, and in all
    branches of a fork.
    """
    agent.observers.goal = observer
    agent.features.meta = agent.features.ends = True
    agent.look_at_observers()


def observe_mind(agent: Circumstance, observer: MindObserver | None) -> None:
    """Notify an observer of selected plans, beliefs and messages; None ends that."""
    agent.observers.mind = observer
    agent.look_at_observers()


SLEEPING = trigger("+", "", functor("jag_sleeping", 0))
AWAKING = trigger("+", "", functor("jag_awaking", 0))
SHUTTING_DOWN = trigger("+", "", functor("jag_shutting_down", 1))


def fall_asleep(agent: Circumstance) -> bool:
    """Handle an idle agent; return True if a plan for ``+jag_sleeping`` has to be tried before it sleeps."""
    if agent.sleep != "awake" or not agent.is_idle():
        agent.sleep = "awake" if agent.sleep == "awake" else "asleep"
        return False
    if not agent.may_handle(SLEEPING):
        agent.sleep = "asleep"
        return False
    agent.sleep = "drowsy"
    agent.post(((SLEEPING,), None, BY_SELF, None))
    return True


def awake(agent: Circumstance) -> None:
    """Handle new work of a sleeping agent: ``+jag_awaking``."""
    if agent.sleep == "asleep" and not agent.is_idle():
        agent.sleep = "awake"
        if agent.may_handle(AWAKING):
            agent.post(((AWAKING,), None, BY_SELF, None))


def shutting_down(agent: Circumstance, milliseconds: float) -> None:
    """Announce that the agent will end after that number of milliseconds: ``+jag_shutting_down(Ms)``."""
    if agent.may_handle(SHUTTING_DOWN):
        agent.post(((SHUTTING_DOWN, milliseconds), None, BY_SELF, None))
        agent.architecture.ready()
