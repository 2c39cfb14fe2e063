"""An observer holds an agent in the middle of a reasoning cycle: before an event is handled, or before a step is made."""

from jacaros.bdi.rules.plan_changes import look_at_plans
from jacaros.bdi.state.circumstance import Circumstance, HeldEvent, StepObserver
from jacaros.bdi.state.event import Event
from jacaros.bdi.state.intention import Intention


def observe_steps(agent: Circumstance, observer: StepObserver | None) -> None:
    """Ask *observer* before each event and each step; None ends this, and lets a held agent continue."""
    agent.observers.step = observer
    agent.look_at_observers()
    if observer is None:
        agent.held = None
    look_at_plans(agent)


def is_held_before_event(agent: Circumstance, event: Event, ends_cycle: bool = False) -> bool:
    """Return whether the observer holds the agent before an event, which is then put back first in the queue."""
    observer = agent.observers.step
    if observer is None or not observer.holds_event(agent, event):
        return False
    agent.held = HeldEvent(event, ends_cycle)
    agent.events.appendleft(event)
    return True


def is_held_before_step(agent: Circumstance, intention: Intention) -> bool:
    """Return whether the observer holds the agent before a step of an intention, which is then put back as the next one."""
    observer = agent.observers.step
    if observer is None or not observer.holds_step(agent, intention):
        return False
    agent.held = intention
    agent.intentions.appendleft(intention)
    return True


def take_held_event(agent: Circumstance) -> Event | None:
    """Take the event before which the agent was held out of its queue; return None if it was not held or the event is
    gone.
    """
    held = agent.held
    if not isinstance(held, HeldEvent):
        return None
    agent.held = None
    place = next((place for place, queued in enumerate(agent.events) if queued is held.event), None)
    if place is None:
        return None
    del agent.events[place]
    return held.event


def take_held_intention(agent: Circumstance) -> Intention | None:
    """Take the intention before whose step the agent was held out of its queue; None if it was not held or cannot run
    now.
    """
    intention = agent.held
    if not isinstance(intention, Intention):
        return None
    agent.held = None
    if intention.dropped or intention not in agent.intentions:
        return None
    agent.intentions.remove(intention)
    return intention
