"""An intention has its turn and makes a step: rules SelInt and ExecInt."""

from typing import Any

from jacaros.agents.mind.actions.internal_action import Crashed
from jacaros.agents.mind.rules import failure, meta_events
from jacaros.agents.mind.rules.add_im import push
from jacaros.agents.mind.rules.clr_int import pop_finished
from jacaros.agents.mind.rules.failure import fail_intention, note_lack_of_memory
from jacaros.agents.mind.rules.sel_ev import is_held_before_event, is_ready
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import STEP, Event, Frame, Intention
from jacaros.agents.mind.state.plan import FAILED, SUSPENDED, Fail
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import BY_SELF
from jacaros.errors import InternalError


def select_intention(agent: Circumstance) -> Intention | None:
    """Rule SelInt: return the atomic intention, else one that the agent selects among those that can run."""
    if agent.atomic is not None:
        if not is_ready(agent, agent.atomic):
            return None
        agent.intentions.remove(agent.atomic)
        return agent.atomic
    intentions, plain = agent.intentions, agent.selections.plain
    while intentions:
        intention = intentions.popleft() if plain else agent.selections.select_intention()
        if intention is None or not intention.dropped:
            return intention
        intentions = agent.intentions
    return None


def execute(agent: Circumstance, intention: Intention, fuel: int) -> int:  # noqa: C901 - the two rules alternate
    """Rules ExecInt and ClrInt: one step of an intention, and further ones while nothing else needs a cycle.

    Return what is left of *fuel*, the number of steps that it may make. An atomic intention makes one.
    """
    agent.current = intention
    last = 0
    if agent.atomic is not None:
        last = fuel - 1
        if agent.atomic_over:
            agent.atomic, agent.atomic_over = None, False
    frames, trail = intention.frames, agent.trail
    events, intentions, incoming = agent.events, agent.intentions, agent.incoming
    while True:
        fuel -= 1
        frame: Frame = frames[-1]
        step: Any = frame[STEP]
        posted: Any
        if step is None:
            posted = None  # the event of the last step had no plan
        else:
            try:
                posted = step(agent, frame)
            except Exception as fault:
                posted = step_failed(agent, intention, fault)
            if trail:
                if posted is FAILED:
                    undo(trail, 0)
                trail.clear()
        if agent.stopped or intention.dropped:
            break
        if posted is None:
            # If it has suspended itself, its step, which may be the last one, is over once it is resumed.
            if frame[STEP] is None and (
                intention.suspended is not None or not pop_finished(agent, intention)
            ):
                break
            if fuel == last or events or intentions or incoming.called:
                agent.make_ready(intention)
                break
            continue
        goal, annotations = posted, BY_SELF
        if posted.__class__ is not tuple:
            if posted is FAILED:
                posted = step_failed(agent, intention)
            if posted is SUSPENDED:
                tell_waiting(agent, intention)
                break
            goal, annotations = posted.goal, posted.annotations
        if agent.unusual or agent.waits.events:
            announce(agent, intention, goal, annotations)
        if fuel == last or events or intentions or incoming.called:
            if agent.atomic is None:
                events.append((goal, intention, annotations, None))
            elif _handle_now(agent, (goal, intention, annotations, None)):
                agent.make_ready(intention)
            break
        # The next cycle, which would handle this event alone, begins.
        if not push(agent, intention, goal, annotations):
            break
        if agent.atomic is not None:
            agent.make_ready(intention)
            break
    agent.current = None
    return fuel


def _handle_now(agent: Circumstance, event: Event) -> bool:
    """Handle an event of the atomic intention, for which all others wait; return whether the intention can continue."""
    goal, intention, annotations, _ = event
    return not is_held_before_event(agent, event, ends_cycle=True) and bool(
        push(agent, intention, goal, annotations)
    )


def step_failed(agent: Circumstance, intention: Intention, fault: Exception | None = None) -> object:
    """A step failed, or raised an exception: return the event for the nearest handler, or `SUSPENDED` without one."""
    if isinstance(fault, InternalError):
        raise fault
    if agent.trail:
        undo(agent.trail, 0)
    if fault is not None and fault.__class__ is not Fail:
        note_lack_of_memory(agent, fault)
        _report(agent, fault)
    frame: Frame = intention.frames[-1]
    return fail_intention(agent, intention, failure.step_failure(frame, fault)) or SUSPENDED


def _report(agent: Circumstance, fault: Exception) -> None:
    """Log Python errors inside internal actions; the plan gets them as well."""
    if isinstance(fault, Crashed):
        agent.architecture.log("error", str(fault))
    elif not isinstance(fault, Fail) and agent.options.verbose > 1:
        agent.architecture.log("debug", f"{type(fault).__name__}: {fault}")


def announce(
    agent: Circumstance, intention: Intention | None, goal: Goal, annotations: EventAnnotations
) -> None:
    """Notify waiting intentions, plans for goal states and queues that a goal or event has been posted."""
    if agent.waits.events:
        agent.notify_listeners((goal, intention, annotations, None))
    if agent.atomic is not intention:
        agent.note(goal[0])
    if agent.features.meta and goal[0].operator == "+" and goal[0].kind:
        meta_events.goal_state(agent, goal, annotations, "pending")


def tell_waiting(agent: Circumstance, intention: Intention) -> None:
    """Notify observers that an intention waits."""
    waiting = intention.waiting if agent.features.meta else None
    if waiting is not None:
        meta_events.top_goal_state(agent, intention, "waiting", waiting.reason)
