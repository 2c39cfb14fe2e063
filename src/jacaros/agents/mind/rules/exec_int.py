"""An intention has its turn and makes a step: rules SelInt and ExecInt."""

from typing import Any

from jacaros.agents.mind.actions.internal_action import Crashed
from jacaros.agents.mind.rules import failure, meta_events
from jacaros.agents.mind.rules.add_im import push
from jacaros.agents.mind.rules.clr_int import pop_finished
from jacaros.agents.mind.rules.failure import fail_intention, note_lack_of_memory
from jacaros.agents.mind.rules.sel_ev import is_held_before_event, is_ready
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import STEP, Frame, Intention
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
    last = 0 if agent.atomic is None else fuel - 1
    if agent.atomic_over:
        agent.atomic, agent.atomic_over = None, False
    frames, trail = intention.frames, agent.trail
    events, intentions, incoming = agent.events, agent.intentions, agent.incoming
    listened = agent.waits.events or agent.features.meta or agent.selections.urgencies is not None
    while True:
        fuel -= 1
        frame: Frame = frames[-1]
        step: Any = frame[STEP]
        posted: Any = None
        if step is not None:
            try:
                posted = step(agent, frame)
            except Exception as fault:
                posted = step_failed(agent, intention, fault)
            if posted is FAILED:
                posted = step_failed(agent, intention)
            if trail:
                trail.clear()
        if agent.stopped or intention.dropped:
            break
        if posted is None:
            # If it has suspended itself, its step, which may be the last one, is over once it is resumed.
            if intention.suspended is not None or (
                frame[STEP] is None and not pop_finished(agent, intention)
            ):
                break
        elif posted is SUSPENDED:
            tell_waiting(agent, intention)
            break
        else:
            goal, annotations = (
                (posted, BY_SELF) if posted.__class__ is tuple else (posted.goal, posted.annotations)
            )
            if listened:
                announce(agent, intention, goal, annotations)
            alone = not (fuel <= last or events or intentions or incoming.called)
            if (push if alone else _post)(agent, intention, goal, annotations):
                if alone and agent.atomic is None:
                    continue  # the next cycle, which would handle this event alone, has begun
                agent.make_ready(intention)
            break
        if fuel <= last or events or intentions or incoming.called:
            agent.make_ready(intention)
            break
    agent.current = None
    return fuel


def _post(agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations) -> bool:
    """Queue a goal or event that a step has posted; that of an atomic intention is handled now.

    Return whether the intention can continue.
    """
    event = (goal, intention, annotations, None)
    if agent.atomic is not intention:
        agent.events.append(event)
        return False
    return not is_held_before_event(agent, event, ends_cycle=True) and push(
        agent, intention, goal, annotations
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
