"""An event is handled: rule SelEv, and the intention that it begins or continues."""

from jacaros.agents.mind.rules import failure, forks
from jacaros.agents.mind.rules.add_im import (
    log_inapplicable,
    push,
)
from jacaros.agents.mind.rules.clr_int import remove_event
from jacaros.agents.mind.rules.failure import unplanned
from jacaros.agents.mind.rules.plan_changes import look_at_plans
from jacaros.agents.mind.rules.proc_msg import RECEIVED, receive_event
from jacaros.agents.mind.state.circumstance import Circumstance, HeldEvent, StepObserver
from jacaros.agents.mind.state.intention import (
    EVENT_CAUSE,
    EVENT_INTENTION,
    Event,
    Intention,
)
from jacaros.errors import InternalError

# An observer holds an agent in the middle of a reasoning cycle: before an event is handled, or before a step is made.


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


def handle_event(agent: Circumstance) -> Intention | None:
    """Rule SelEv and the rules after it: handle one event; external events without a plan are skipped.

    Return the intention that it begins if it is the only one that can run.
    """
    while agent.events:
        event = agent.events.popleft() if agent.selections.plain else agent.selections.select_event()
        if event is None or (agent.observers.step is not None and is_held_before_event(agent, event)):
            return None
        try:
            handled = _handle(agent, event)
        except Exception as fault:
            skip_event(agent, event, fault)
            continue
        if handled:
            return None if handled is True else handled
    return None


def handle_held_event(agent: Circumstance, event: Event) -> None:
    """Handle the event before which the agent was held; the next one if that is skipped."""
    if not _try(agent, event) and agent.atomic is None:
        handle_event(agent)


def _try(agent: Circumstance, event: Event) -> Intention | bool:
    try:
        return _handle(agent, event)
    except Exception as fault:
        skip_event(agent, event, fault)
        return False


def handle_atomic_event(agent: Circumstance) -> None:
    """The atomic intention's own event comes before all others, which wait."""
    intention = agent.atomic
    event = None if intention is None else event_of(agent, intention)
    if intention is not None and event is not None:
        remove_event(agent, event)
        if not is_held_before_event(agent, event):
            _try(agent, event)


def is_ready(agent: Circumstance, intention: Intention) -> bool:
    """Whether an intention is among those that can run; one that has just made a step is the last of them."""
    intentions = agent.intentions
    return bool(intentions) and (intentions[-1] is intention or intention in intentions)


def event_of(agent: Circumstance, intention: Intention) -> Event | None:
    """The event that an intention has in the queue, if it is that what it waits for."""
    if intention.waiting is not None or is_ready(agent, intention):
        return None
    return next((event for event in agent.events if event[EVENT_INTENTION] is intention), None)


def skip_event(agent: Circumstance, event: Event, fault: Exception) -> None:
    """Report an exception that escapes while an event is handled; the agent continues with the next event.

    Raises:
        InternalError: that is what *fault* is.
    """
    if isinstance(fault, InternalError):
        raise fault
    agent.current = None
    failure.report_skipped(agent, "event", fault)
    intention = event[EVENT_INTENTION]
    if intention is not None:
        failure.drop_after_error(agent, intention, fault)


def _handle(agent: Circumstance, event: Event) -> Intention | bool:
    """Continue the intention of an event, or begin one for an external event.

    Return an intention that has begun if no other can run: it need not be queued. Return False for an external event
    without a plan, which is dropped silently, and for one whose intention is over.
    """
    goal, intention, annotations, cause = event
    if intention is not None:
        if intention.dropped:
            return False
        agent.current = intention  # contexts may ask for it
        if push(agent, intention, goal, annotations):
            agent.make_ready(intention)
        agent.current = None
        return True
    reacted = False
    if agent.holders and goal[0].kind == "":
        reacted = _react(agent, event)
    begun = push(agent, None, goal, annotations, cause)
    if begun is False:
        return _begin_without_plan(agent, event, reacted)
    if not begun:
        return True  # it waits for what it needs
    if not (
        agent.intentions
        or agent.conditioned
        or agent.selections.urgencies is not None
        or agent.observers.step is not None
    ):
        return begun
    agent.make_ready(begun)
    return True


def _begin_without_plan(agent: Circumstance, event: Event, reacted: bool) -> bool:
    """Drop an external event, let a goal fail, or handle a message by default."""
    goal, _, annotations, cause = event
    trigger = goal[0]
    if trigger.kind == "" or trigger.operator == "^":
        if not reacted:
            log_inapplicable(agent, goal, annotations)
        if agent.options.events == "requeue" and not reacted and trigger.operator != "^":
            agent.waits.requeued.append(event)
        return reacted
    if trigger is RECEIVED:
        receive_event(agent, goal)
        return True
    intention = Intention(agent, cause)
    agent.post_for(intention, unplanned(agent, intention, goal, annotations))
    return True


def _react(agent: Circumstance, event: Event) -> bool:
    """Every intention with a plan that has sub-plans for an external event reacts to it."""
    goal, _, annotations, cause = event
    reactions = forks.react(agent, goal, annotations, agent.library.reactions[goal[0]])
    for owner, outer, frame in reactions:
        if agent.observers.mind is not None:
            cause = agent.observers.mind.selected(goal, annotations, None, frame, event[EVENT_CAUSE])
        intention = Intention(agent, cause)
        intention.frames.append(frame)
        intention.outer = (owner, outer)
        agent.make_ready(intention)
    return bool(reactions)
