"""Stacks of intentions cut from outside, with what they wait for."""

from jacaros.bdi.rules import meta_events
from jacaros.bdi.rules.forks import leave
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import EVENT_INTENTION, Event
from jacaros.bdi.state.intention import GOAL, Intention


def pending_event(agent: Circumstance, intention: Intention) -> Event | None:
    """The event of the queue that an intention waits for, if any."""
    return next(
        (e for e in (*agent.events, *agent.suspended_events) if e[EVENT_INTENTION] is intention), None
    )


def remove_event(agent: Circumstance, event: Event) -> None:
    kept = [e for e in agent.events if e is not event]
    agent.events.clear()
    agent.events.extend(kept)
    agent.suspended_events = [e for e in agent.suspended_events if e is not event]


def cut(agent: Circumstance, intention: Intention, index: int) -> None:
    """Take the frame at *index* and all above off the stack, and whatever the intention waits for."""
    if intention.waiting is not None:
        waiting, intention.waiting = intention.waiting, None
        agent.drop_wait(waiting)
    event = pending_event(agent, intention)
    if event is not None:
        remove_event(agent, event)
    intention.parked = False
    intention.suspended = None
    leave(agent, intention, index)
    del intention.frames[index:]
    while intention.handlers and intention.handlers[-1] >= index:
        intention.handlers.pop()
    if agent.atomic is intention and not intention.is_atomic():
        agent.atomic, agent.atomic_over = None, False


def achieve(agent: Circumstance, intention: Intention, index: int) -> None:
    """Cut a stack at a goal that ends as achieved; the goals that served it are dropped."""
    if agent.meta:
        for place, frame in reversed(list(enumerate(intention.frames))[index:]):
            state = "achieved" if place == index else "dropped"
            tell = meta_events.observe if frame[GOAL][0].failing else meta_events.frame_state
            tell(agent, intention, frame, state)
            tell(agent, intention, frame, "finished")
    cut(agent, intention, index)
