"""The second part of a reasoning cycle: an event is taken up, and a plan for it becomes part of an intention."""

from typing import Any

from jacaros.bdi.explaining import lost_goals
from jacaros.bdi.rules import meta_events, option_selection, rescue, subplans
from jacaros.bdi.rules.goal_failure import has_room, too_deep, unplanned
from jacaros.bdi.rules.stack import remove_event
from jacaros.bdi.state.circumstance import CROWD, Circumstance
from jacaros.bdi.state.event import EVENT_INTENTION, Event
from jacaros.bdi.state.intention import GOAL, PLAN, STEP, Frame, Intention
from jacaros.errors import InternalError
from jacaros.terms.values import BY_SELF


def handle_event(agent: Circumstance) -> Intention | None:  # noqa: C901 - written out for speed
    """Rule SelEv and what follows: one event is handled; external events without plan are passed over.

    When this begins an intention and there is no other, it need not queue: it is given back, and has its turn now.
    """
    events = agent.events
    while events:
        event = events.popleft()
        goal, intention, annotations, cause = event
        try:
            if intention is not None:
                if intention.dropped:
                    continue
                agent.current = intention  # contexts may ask for it
                if push(agent, intention, goal, annotations):
                    if intention.suspended is None:
                        agent.intentions.append(intention)
                    else:
                        intention.parked = True
                agent.current = None
                return None
            if agent.special or agent.option_filter.rows:
                if _external(agent, event):
                    return None
                continue
            # `_external`, written out for what is usual.
            trail, kind = agent.trail, goal[0]
            trail.serial += 1
            select = agent.selects[kind]
            frame: Frame | None = None if select is None else select(agent, goal, annotations)
            if trail:
                trail.clear()
            if frame is None and not kind.kind and agent.usual_events:
                if select is not None and agent.options.verbose > 1:
                    _log_inapplicable(agent, goal, annotations)
                continue
            if frame is None or frame[4].atomic or kind.failing:
                if _begin(agent, event, frame, False):
                    return None
                continue
            agent.intentions_made = number = agent.intentions_made + 1
            agent.alive[number] = intention = Intention(number, cause)
            intention.frames.append(frame)
            intentions = agent.intentions
            if not intentions:
                return intention
            if len(intentions) >= CROWD and annotations is BY_SELF and kind.kind:
                agent.line_up(intention)
            else:
                intentions.append(intention)
            return None
        except InternalError:
            raise
        except Exception as fault:
            _pass_over(agent, event, fault)
    return None


def handle_atomic_event(agent: Circumstance, intention: Intention) -> None:
    """An atomic intention's own event comes before all others, which wait."""
    event = event_of(agent, intention)
    if event is not None:
        remove_event(agent, event)
        goal, _, annotations, _ = event
        try:
            if push(agent, intention, goal, annotations):
                agent.make_ready(intention)
        except InternalError:
            raise
        except Exception as fault:
            _pass_over(agent, event, fault)


def is_ready(agent: Circumstance, intention: Intention) -> bool:
    """Whether an intention is among those that can run; one that has just made a step is the last of them."""
    intentions = agent.intentions
    return bool(intentions) and (intentions[-1] is intention or intention in intentions)


def event_of(agent: Circumstance, intention: Intention) -> Event | None:
    """The event that an intention has in the queue, if it is that what it waits for."""
    if intention.waiting is not None or is_ready(agent, intention):
        return None
    return next((event for event in agent.events if event[EVENT_INTENTION] is intention), None)


def _pass_over(agent: Circumstance, event: Event, fault: Exception) -> None:
    agent.current = None
    rescue.passed_over(agent, "an event", fault)
    intention = event[EVENT_INTENTION]
    if intention is not None:
        rescue.give_up(agent, intention, fault)


def _external(agent: Circumstance, event: Event) -> bool:
    """Begin an intention for an external event; False when it has no plan and is dropped silently."""
    goal, _, annotations, _ = event
    reacted = agent.subplans and goal[0].kind == "" and _react(agent, event)
    return _begin(agent, event, select_plan(agent, goal, annotations), reacted)


def _begin(agent: Circumstance, event: Event, frame: Frame | None, reacted: bool) -> bool:
    """Begin an intention with the frame of the plan for an external event, if there is one."""
    goal, _, annotations, cause = event
    trigger = goal[0]
    if frame is None:
        if trigger.kind == "" or trigger.operator == "^":
            if agent.options.verbose > 1 and not reacted and agent.selects[trigger] is not None:
                _log_inapplicable(agent, goal, annotations)
            if agent.options.events == "requeue" and not reacted and trigger.operator != "^":
                agent.requeued.append(event)
            return reacted
        intention = agent.new_intention(cause)
        posted = unplanned(agent, intention, goal, annotations)
        if posted is not None:
            agent.post((posted.goal, intention, posted.annotations, None))
        return True
    intention = agent.new_intention(cause)
    intention.frames.append(frame)
    if trigger.failing:
        intention.handlers.append(0)
    if frame[PLAN].atomic:
        agent.atomic, agent.atomic_over = intention, False
    if agent.meta:
        meta_events.frame_state(agent, intention, frame, "executing")
    agent.make_ready(intention)
    return True


def _log_inapplicable(agent: Circumstance, goal: tuple[Any, ...], annotations: Any) -> None:
    """Log why no plan was taken for an event, for an agent whose details are wanted."""
    agent.architecture.log("debug", lost_goals.inapplicable(agent, goal, annotations).text())


def _react(agent: Circumstance, event: Event) -> bool:
    """Every intention whose plans have a sub-plan for an external event reacts to it."""
    goal, _, annotations, cause = event
    reactions = subplans.react(agent, goal, annotations)
    for owner, outer, frame in reactions:
        intention = agent.new_intention(cause)
        intention.frames.append(frame)
        intention.outer = (owner, outer)
        agent.make_ready(intention)
    return bool(reactions)


def select_plan(
    agent: Circumstance, goal: tuple[Any, ...], annotations: Any, intention: Intention | None = None
) -> Frame | None:
    """Rules RelPl, ApplPl and SelAppl: the frame of the first applicable plan, sub-plans of *intention* first."""
    trail = agent.trail
    trail.serial += 1
    select = agent.selects[goal[0]]
    if agent.subplans and intention is not None:
        inner = subplans.select_in_scope(agent, intention, goal, annotations)
        if inner is not None:
            trail.clear()
            return inner
    if select is None:
        return None
    if agent.option_filter.rows:
        return option_selection.first_option(agent, goal, annotations, intention)
    frame = select(agent, goal, annotations)
    if trail:
        trail.clear()
    return frame


def push(agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any) -> bool:
    """Rule AddIM: put a plan for the goal on the intention; False when the intention goes no further now."""
    if agent.special or agent.option_filter.rows:
        frame = select_plan(agent, goal, annotations, intention)
        return (frame is not None and add_frame(agent, intention, frame)) or go_without(
            agent, intention, goal, annotations, frame
        )
    # What is usual: `select_plan` and `add_frame`, written out.
    trail = agent.trail
    trail.serial += 1
    kind = goal[0]
    select = agent.selects[kind]
    made: Frame | None = None if select is None else select(agent, goal, annotations)
    if trail:
        trail.clear()
    if made is None:
        return go_without(agent, intention, goal, annotations, None)
    frames = intention.frames
    if agent.atomic is None and not made[4].atomic and len(frames) < agent.goal_depth:
        if (
            frames
            and (caller := frames[-1])[0] is None
            and caller[1][0] is kind
            and kind.on_fail is not None
            and caller[4].replaceable
            and agent.options.tail_calls
        ):
            frames[-1] = made
        else:
            frames.append(made)
        return True
    return add_frame(agent, intention, made) or go_without(agent, intention, goal, annotations, made)


def add_frame(agent: Circumstance, intention: Intention, frame: Frame) -> bool:
    """Put the frame of a plan on the stack, in the place of its caller if that has nothing left to do (tail call).

    False when it is one too many; it is on the stack then nevertheless.
    """
    frames = intention.frames
    plan, trigger = frame[PLAN], frame[GOAL][0]
    if (
        frames
        and (caller := frames[-1])[STEP] is None
        and caller[GOAL][0] is trigger
        and trigger.on_fail is not None
        and agent.options.tail_calls
        and caller[PLAN].replaceable
    ):
        frames[-1] = frame
        if agent.meta:
            meta_events.observe(agent, intention, caller, "replaced")
        if agent.atomic is intention and not intention.is_atomic():
            agent.atomic_over = True
    else:
        frames.append(frame)
    if plan.atomic:
        agent.atomic, agent.atomic_over = intention, False
    if agent.meta and trigger.kind and not trigger.failing:
        meta_events.frame_state(agent, intention, frame, "executing")
    return len(frames) <= agent.goal_depth or has_room(agent, intention)


def go_without(
    agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any, frame: Frame | None
) -> bool:
    """A goal or event has no plan, or (then *frame* is given, and on the stack) no room for it.

    False when the intention goes no further now.
    """
    if frame is None and goal[0].kind == "":
        if agent.options.verbose > 1 and agent.selects[goal[0]] is not None:
            _log_inapplicable(agent, goal, annotations)
        return True
    posted = unplanned(agent, intention, goal, annotations) if frame is None else too_deep(agent, intention)
    if posted is None:
        return False
    event: Event = (posted.goal, intention, posted.annotations, None)
    if not is_alone(agent):
        agent.post(event)
        return False
    if agent.urgency is not None:
        agent.urgency.note_goal(posted.goal[0])
    if agent.event_waits:
        agent.notify_event_waits(event)
    return push(agent, intention, posted.goal, posted.annotations)


def is_alone(agent: Circumstance) -> bool:
    """Whether nothing else wants the next cycle."""
    if agent.atomic is not None:
        return not agent.goal_conditions
    return not (
        agent.events
        or agent.intentions
        or agent.inbox
        or agent.tasks
        or agent.percepts
        or (agent.condition_waits and agent.condition_waits.restless)
        or agent.goal_conditions
    )
