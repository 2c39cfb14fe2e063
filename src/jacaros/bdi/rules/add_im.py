"""A plan for a goal or event becomes part of an intention: rule AddIM."""

from jacaros.bdi.explaining import lost_goals
from jacaros.bdi.rules import meta_events, needs, subplans
from jacaros.bdi.rules.goal_failure import has_room, too_deep, unplanned
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import Event
from jacaros.bdi.state.intention import GOAL, PLAN, STEP, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations, apart
from jacaros.bdi.state.triggers import Goal
from jacaros.trace import Cause


def select_plan(
    agent: Circumstance, goal: Goal, annotations: EventAnnotations, intention: Intention | None = None
) -> Frame | None:
    """Rules RelPl, ApplPl and SelAppl: return the frame of the selected plan; sub-plans of *intention* are tried first."""
    trail = agent.trail
    trail.serial += 1
    if agent.features.subplans and intention is not None:
        inner = subplans.select_in_scope(agent, intention, goal, annotations)
        if inner is not None:
            trail.clear()
            return inner
    frame = agent.selections.select_option(goal, annotations, intention)
    trail.clear()
    return frame


def select_for_reasons(
    agent: Circumstance,
    goal: Goal,
    annotations: EventAnnotations,
    intention: Intention | None,
    cause: Cause | None,
) -> tuple[Frame | None, Cause | None]:
    """Select a plan and notify the observer; return also the cause of what the plan does."""
    observer = agent.observers.mind
    if observer is None:
        return select_plan(agent, goal, annotations, intention), cause
    asked = apart(goal)  # heads of plans bind variables of the goal
    frame = select_plan(agent, goal, annotations, intention)
    return frame, observer.selected(asked, annotations, intention, frame, cause)


def push(agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations) -> bool:
    """Rule AddIM: put a plan for the goal on the intention; return False if the intention cannot continue now."""
    frame, _ = select_for_reasons(agent, goal, annotations, intention, None)
    if frame is None or not add_frame(agent, intention, frame):
        return go_without(agent, intention, goal, annotations, frame)
    return not agent.features.needs or needs.acquire(agent, intention)


def add_frame(agent: Circumstance, intention: Intention, frame: Frame) -> bool:
    """Put the frame of a plan on the stack; it replaces its caller if that has nothing left to do (tail call).

    Return False if it exceeds the limit; it is on the stack then nevertheless.
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
        and not (agent.waits.needs and needs.is_of(agent, intention, len(frames) - 1))
    ):
        frames[-1] = frame
        if agent.features.meta:
            meta_events.observe(agent, intention, caller, "replaced")
        if agent.atomic is intention and not intention.is_atomic():
            agent.atomic_over = True
    else:
        frames.append(frame)
    if plan.atomic:
        agent.atomic, agent.atomic_over = intention, False
    if agent.features.meta and trigger.kind and not trigger.failing:
        meta_events.frame_state(agent, intention, frame, "executing")
    return len(frames) <= agent.options.goal_depth or has_room(agent, intention)


def go_without(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations, frame: Frame | None
) -> bool:
    """Handle a goal or event without a plan, or (if *frame* is given, and on the stack) without room for it.

    Return False if the intention cannot continue now.
    """
    if frame is None and goal[0].kind == "":
        if agent.options.verbose > 1 and agent.library.selects[goal[0]] is not None:
            log_inapplicable(agent, goal, annotations)
        return True
    posted = unplanned(agent, intention, goal, annotations) if frame is None else too_deep(agent, intention)
    if posted is None:
        return False
    event: Event = (posted.goal, intention, posted.annotations, None)
    if not is_alone(agent):
        agent.post(event)
        return False
    agent.note(posted.goal[0])
    if agent.waits.events:
        agent.notify_event_waits(event)
    return push(agent, intention, posted.goal, posted.annotations)


def is_alone(agent: Circumstance) -> bool:
    """Return whether nothing else needs the next cycle."""
    if agent.atomic is not None:
        return not agent.features.goal_conditions
    return not (
        agent.events
        or agent.intentions
        or agent.incoming.messages
        or agent.incoming.tasks
        or agent.incoming.percepts
        or (agent.waits.conditions and agent.waits.conditions.restless)
        or agent.features.goal_conditions
    )


def log_inapplicable(agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> None:
    """Log why no plan was selected for an event, if the agent logs details."""
    agent.architecture.log("debug", lost_goals.inapplicable(agent, goal, annotations).text())
