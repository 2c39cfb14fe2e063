"""An event is handled: rule SelEv, and the intention that it begins or continues."""

from collections.abc import Sequence

from jacaros.bdi.rules import failure, subplans
from jacaros.bdi.rules.add_im import begin_plan, log_inapplicable, push, select_for_reasons, select_plan
from jacaros.bdi.rules.clr_int import remove_event
from jacaros.bdi.rules.goal_failure import unplanned
from jacaros.bdi.rules.holding import is_held_before_event
from jacaros.bdi.rules.proc_msg import RECEIVED, receive_event
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import EVENT_ANNOTATIONS, EVENT_CAUSE, EVENT_GOAL, EVENT_INTENTION, Event
from jacaros.bdi.state.intention import PLAN, Intention
from jacaros.bdi.state.plan import Plan
from jacaros.errors import InternalError


def handle_event(agent: Circumstance, event: Event | None = None) -> None:
    """Rule SelEv and the rules after it: handle one event; external events without a plan are skipped.

    *event* is the one before which an observer held the agent, if it did.
    """
    selections, step = agent.selections, agent.observers.step
    while event is not None or agent.events:
        if event is None:
            event = agent.events.popleft() if selections.plain else selections.select_event()
            if event is None or (step is not None and is_held_before_event(agent, event)):
                return
        try:
            intention = event[EVENT_INTENTION]
            if intention is None:
                if begin_intention(agent, event):
                    return
            elif _continue_intention(agent, intention, event):
                return
        except InternalError:
            raise
        except Exception as fault:
            skip_event(agent, event, fault)
        event = None


def _continue_intention(agent: Circumstance, intention: Intention, event: Event) -> bool:
    if intention.dropped:
        return False
    agent.current = intention  # contexts may ask for it
    if push(agent, intention, event[EVENT_GOAL], event[EVENT_ANNOTATIONS]):
        agent.make_ready(intention)
    agent.current = None
    return True


def handle_held_event(agent: Circumstance, event: Event) -> None:
    """Handle the event before which the agent was held."""
    if agent.atomic is not None:
        _push_atomic(agent, agent.atomic, event)
    else:
        handle_event(agent, event)


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
    kind, observer, reactions, reacted = goal[0], agent.observers.mind, agent.library.reactions, False
    if reactions.of and kind.kind == "" and reactions[kind]:
        reacted = _react(agent, event, reactions[kind])
    if observer is None:
        frame = select_plan(agent, goal, annotations)
    else:
        frame, cause = select_for_reasons(agent, observer, goal, annotations, None, cause)
    if frame is None:
        return _begin_without_plan(agent, (goal, None, annotations, cause), reacted)
    intention = agent.new_intention(cause)
    intention.frames.append(frame)
    if kind.failing:
        intention.handlers.append(0)
    # A goal that needs something has annotations beside its source.
    plain = not kind.kind or (annotations.__class__ is tuple and len(annotations) == 1)
    if (plain and not (frame[PLAN].special or agent.features.meta)) or begin_plan(agent, intention, frame):
        if agent.selections.urgencies is None:
            agent.intentions.append(intention)
        else:
            agent.make_ready(intention)
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
    agent.post_for(intention, unplanned(agent, intention, goal, annotations))
    return True


def _react(agent: Circumstance, event: Event, plans: Sequence[Plan]) -> bool:
    """Every intention with one of *plans*, which have sub-plans for an external event, reacts to it."""
    goal, _, annotations, cause = event
    reactions = subplans.react(agent, goal, annotations, plans)
    for owner, outer, frame in reactions:
        if agent.observers.mind is not None:
            cause = agent.observers.mind.selected(goal, annotations, None, frame, event[EVENT_CAUSE])
        intention = agent.new_intention(cause)
        intention.frames.append(frame)
        intention.outer = (owner, outer)
        agent.make_ready(intention)
    return bool(reactions)
