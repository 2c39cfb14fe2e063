"""A plan for a goal or event becomes part of an intention: rule AddIM."""

from jacaros.bdi.explaining import lost_goals
from jacaros.bdi.rules import meta_events, needs, subplans
from jacaros.bdi.rules.goal_failure import has_room, too_deep, unplanned
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import Event
from jacaros.bdi.state.intention import ANNOTATIONS, GOAL, PLAN, STEP, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations, apart
from jacaros.bdi.state.observing import MindObserver
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.values import BY_SELF
from jacaros.trace import Cause


def select_plan(
    agent: Circumstance, goal: Goal, annotations: EventAnnotations, intention: Intention | None = None
) -> Frame | None:
    """Rules RelPl, ApplPl and SelAppl: return the frame of the selected plan; sub-plans of *intention* are tried first."""
    trail, selections, frame = agent.trail, agent.selections, None
    trail.serial += 1
    if intention is not None and intention.frames and intention.frames[-1][PLAN].nested:
        frame = subplans.select_in_scope(agent, intention, goal, annotations)
    if frame is None:
        if selections.chooses or selections.option_filter.rows:
            frame = selections.select_option(goal, annotations, intention)
        else:
            select = agent.library.selects[goal[0]]
            frame = None if select is None else select(agent, goal, annotations)
    if trail:
        trail.clear()
    return frame


def select_for_reasons(
    agent: Circumstance,
    observer: MindObserver,
    goal: Goal,
    annotations: EventAnnotations,
    intention: Intention | None,
    cause: Cause | None,
) -> tuple[Frame | None, Cause | None]:
    """Select a plan and notify the observer; return also the cause of what the plan does."""
    asked = apart(goal)  # heads of plans bind variables of the goal
    frame = select_plan(agent, goal, annotations, intention)
    return frame, observer.selected(asked, annotations, intention, frame, cause)


def push(agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations) -> bool:
    """Rule AddIM: put a plan for the goal on the intention; return False if the intention cannot continue now.

    The plan replaces its caller if that has nothing left to do (tail call).
    """
    observer = agent.observers.mind
    if observer is None:
        frame = select_plan(agent, goal, annotations, intention)
    else:
        frame, _ = select_for_reasons(agent, observer, goal, annotations, intention, None)
    if frame is None:
        return go_without(agent, intention, goal, annotations, None)
    frames, kind = intention.frames, goal[0]
    if (
        frames
        and (caller := frames[-1])[STEP] is None
        and caller[GOAL][0] is kind
        and caller[PLAN].replaceable
        and kind.on_fail is not None
        and agent.options.tail_calls
        and not any(need.is_of(caller) for need in agent.waits.needs.values())
    ):
        frames[-1] = frame
        if agent.features.meta:
            meta_events.observe(agent, intention, caller, "replaced")
        if agent.atomic is intention and not intention.is_atomic():
            agent.atomic_over = True
    else:
        frames.append(frame)
    usual = (annotations is BY_SELF or kind.failing) and len(frames) <= agent.options.goal_depth
    return (usual and not (frame[PLAN].special or agent.features.meta)) or begin_plan(agent, intention, frame)


def begin_plan(agent: Circumstance, intention: Intention, frame: Frame) -> bool:
    """Do what comes before the first step of a plan on the stack; return False if the intention cannot continue now."""
    plan: Plan = frame[PLAN]
    if plan.special:
        if plan.atomic:
            agent.atomic, agent.atomic_over = intention, False
        agent.note_plan(intention, plan)
    if agent.features.meta:
        kind = frame[GOAL][0]
        if kind.kind and not kind.failing:
            meta_events.frame_state(agent, intention, frame, "executing")
    if len(intention.frames) > agent.options.goal_depth and not has_room(agent, intention):
        return go_without(agent, intention, frame[GOAL], frame[ANNOTATIONS], frame)
    return needs.acquire(agent, intention)


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
    if agent.conditioned or (
        agent.atomic is None and (agent.events or agent.intentions or agent.incoming.called)
    ):
        agent.post(event)
        return False
    agent.note(posted.goal[0])
    if agent.waits.events:
        agent.notify_listeners(event)
    return push(agent, intention, posted.goal, posted.annotations)


def log_inapplicable(agent: Circumstance, goal: Goal, annotations: EventAnnotations) -> None:
    """Log why no plan was selected for an event, if the agent logs details."""
    agent.architecture.log("debug", lost_goals.inapplicable(agent, goal, annotations).text())
