"""An event is handled: rule SelEv, and the intention that it begins or continues."""

from jacaros.bdi.rules import failure, meta_events, needs, subplans
from jacaros.bdi.rules.add_im import log_inapplicable, push, select_for_reasons
from jacaros.bdi.rules.clr_int import remove_event
from jacaros.bdi.rules.goal_failure import unplanned
from jacaros.bdi.rules.holding import is_held_before_event
from jacaros.bdi.rules.proc_msg import RECEIVED, receive_event
from jacaros.bdi.state.circumstance import CROWD, Circumstance
from jacaros.bdi.state.event import EVENT_CAUSE, EVENT_INTENTION, Event
from jacaros.bdi.state.intention import PLAN, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.triggers import Goal
from jacaros.errors import InternalError
from jacaros.terms.values import BY_SELF


def handle_event(agent: Circumstance) -> None:
    """Rule SelEv and the rules after it: handle one event; external events without a plan are skipped."""
    while (event := agent.selections.select_event()) is not None:
        if is_held_before_event(agent, event) or _is_handled(agent, event):
            return


def handle_held_event(agent: Circumstance, event: Event) -> None:
    """Handle the event before which the agent was held."""
    if agent.atomic is not None:
        _push_atomic(agent, agent.atomic, event)
    elif not _is_handled(agent, event):
        handle_event(agent)


def _is_handled(agent: Circumstance, event: Event) -> bool:
    try:
        return _is_taken_up(agent, event)
    except InternalError:
        raise
    except Exception as fault:
        skip_event(agent, event, fault)
        return False


def _is_taken_up(agent: Circumstance, event: Event) -> bool:
    goal, intention, annotations, _ = event
    if intention is None:
        return begin_intention(agent, event)
    if intention.dropped:
        return False
    agent.current = intention  # contexts may ask for it
    if push(agent, intention, goal, annotations):
        agent.make_ready(intention)
    agent.current = None
    return True


def handle_atomic_event(agent: Circumstance, intention: Intention) -> None:
    """An atomic intention's own event comes before all others, which wait."""
    event = event_of(agent, intention)
    if event is not None:
        remove_event(agent, event)
        if not is_held_before_event(agent, event):
            _push_atomic(agent, intention, event)


def _push_atomic(agent: Circumstance, intention: Intention, event: Event) -> None:
    goal, _, annotations, _ = event
    try:
        if push(agent, intention, goal, annotations):
            agent.make_ready(intention)
    except InternalError:
        raise
    except Exception as fault:
        skip_event(agent, event, fault)


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
    """Report an exception that escapes while an event is handled; the agent continues with the next event."""
    agent.current = None
    failure.report_skipped(agent, "event", fault)
    intention = event[EVENT_INTENTION]
    if intention is not None:
        failure.drop_after_error(agent, intention, fault)


def begin_intention(agent: Circumstance, event: Event) -> bool:
    """Begin an intention for an external event; False when it has no plan and is dropped silently."""
    goal, _, annotations, cause = event
    reacted = agent.features.subplans and goal[0].kind == "" and _react(agent, event)
    frame, why = select_for_reasons(agent, goal, annotations, None, cause)
    if why is not cause:
        event = (goal, None, annotations, why)
    return begin_with(agent, event, frame, reacted)


def begin_with(agent: Circumstance, event: Event, frame: Frame | None, reacted: bool) -> bool:
    """Begin an intention with the frame of the plan for an external event, if there is one."""
    goal, _, annotations, cause = event
    if frame is None:
        return _begin_without_plan(agent, event, reacted)
    intention = agent.new_intention(cause)
    intention.frames.append(frame)
    if goal[0].failing:
        intention.handlers.append(0)
    if frame[PLAN].atomic:
        agent.atomic, agent.atomic_over = intention, False
    if agent.features.meta:
        meta_events.frame_state(agent, intention, frame, "executing")
    if not agent.features.needs or needs.acquire(agent, intention):
        _take_place(agent, intention, goal, annotations)
    return True


def _begin_without_plan(agent: Circumstance, event: Event, reacted: bool) -> bool:
    """Drop an external event, let a goal fail, or handle a message by default."""
    goal, _, annotations, cause = event
    trigger = goal[0]
    if trigger.kind == "" or trigger.operator == "^":
        if agent.options.verbose > 1 and not reacted and agent.library.selects[trigger] is not None:
            log_inapplicable(agent, goal, annotations)
        if agent.options.events == "requeue" and not reacted and trigger.operator != "^":
            agent.waits.requeued.append(event)
        return reacted
    if trigger is RECEIVED:
        receive_event(agent, goal)
        return True
    intention = agent.new_intention(cause)
    posted = unplanned(agent, intention, goal, annotations)
    if posted is not None:
        agent.post((posted.goal, intention, posted.annotations, None))
    return True


def _take_place(agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations) -> None:
    """A new intention waits for its first turn."""
    if len(agent.intentions) >= CROWD and annotations is BY_SELF and goal[0].kind:
        agent.line_up(intention)
    else:
        agent.make_ready(intention)


def _react(agent: Circumstance, event: Event) -> bool:
    """Every intention whose plans have a sub-plan for an external event reacts to it."""
    goal, _, annotations, cause = event
    reactions = subplans.react(agent, goal, annotations)
    for owner, outer, frame in reactions:
        if agent.observers.mind is not None:
            cause = agent.observers.mind.selected(goal, annotations, None, frame, event[EVENT_CAUSE])
        intention = agent.new_intention(cause)
        intention.frames.append(frame)
        intention.outer = (owner, outer)
        agent.make_ready(intention)
    return bool(reactions)
