"""An intention has its turn and makes a step: rules SelInt and ExecInt."""

from typing import Any

from jacaros.bdi.actions.internal_action import Crashed
from jacaros.bdi.rules import failure, meta_events
from jacaros.bdi.rules.add_im import push
from jacaros.bdi.rules.clr_int import pop_finished
from jacaros.bdi.rules.failure import note_lack_of_memory
from jacaros.bdi.rules.goal_failure import fail_intention
from jacaros.bdi.rules.holding import is_held_before_event
from jacaros.bdi.rules.sel_ev import is_ready
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import Posted
from jacaros.bdi.state.intention import STEP, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import FAILED, SUSPENDED, Fail
from jacaros.bdi.state.triggers import Goal
from jacaros.errors import InternalError
from jacaros.terms.unifier import undo
from jacaros.terms.values import BY_SELF


def select_intention(agent: Circumstance) -> Intention | None:
    """Rule SelInt: return the atomic intention, else one that the agent selects among those that can run."""
    if agent.atomic is not None:
        if not is_ready(agent, agent.atomic):
            return None
        agent.intentions.remove(agent.atomic)
        return agent.atomic
    while agent.intentions or agent.crowd:
        if not agent.intentions:
            agent.let_in()
        intention = agent.selections.select_intention()
        if intention is None or not intention.dropped:
            return intention
    return None


def execute(agent: Circumstance, intention: Intention) -> None:
    """Rules ExecInt and ClrInt: one step of an intention."""
    agent.current = intention
    if agent.atomic_over:
        agent.atomic, agent.atomic_over = None, False
    frame: Frame = intention.frames[-1]
    posted = None if frame[STEP] is None else _step(agent, intention, frame)
    if agent.stopped or intention.dropped or (posted is None and intention.suspended is not None):
        pass  # if it has suspended itself, it goes on after this step, or ends with it, once it is resumed
    elif posted is SUSPENDED:
        if agent.features.meta:
            tell_waiting(agent, intention)
    elif posted is not None:
        _pursue(agent, intention, posted)
    elif frame[STEP] is not None or pop_finished(agent, intention):
        agent.make_ready(intention)
    agent.current = None


def _step(agent: Circumstance, intention: Intention, frame: Frame) -> Any:
    """Run the next step of a plan; return its result, or the event for its failure. An unhandled failure ends the
    intention.
    """
    goal: Any = None
    try:
        goal = frame[0](agent, frame)
    except InternalError:
        raise
    except Exception as fault:
        goal = step_failed(agent, intention, fault) or SUSPENDED
    if goal is FAILED:
        goal = step_failed(agent, intention) or SUSPENDED
    agent.trail.clear()
    return goal


def _pursue(agent: Circumstance, intention: Intention, posted: Any) -> None:
    """Handle the goal or event that a step has posted: in one of the next cycles; that of an atomic intention now."""
    goal, annotations = (posted.goal, posted.annotations) if posted.__class__ is Posted else (posted, BY_SELF)
    announce(agent, intention, goal, annotations)
    if agent.atomic is not intention:
        agent.queue((goal, intention, annotations, None))
    elif agent.observers.step is not None and is_held_before_event(
        agent, (goal, intention, annotations, None), ends_cycle=True
    ):
        return
    elif push(agent, intention, goal, annotations):
        agent.make_ready(intention)


def step_failed(agent: Circumstance, intention: Intention, fault: Exception | None = None) -> Posted | None:
    """A step failed, or raised an exception: return the event for the nearest handler, or None without one."""
    if agent.trail:
        undo(agent.trail, 0)
    if fault is not None and fault.__class__ is not Fail:
        note_lack_of_memory(agent, fault)
        _report(agent, fault)
    frame: Frame = intention.frames[-1]
    return fail_intention(agent, intention, failure.step_failure(frame, fault))


def _report(agent: Circumstance, fault: Exception) -> None:
    """Log Python errors inside internal actions; the plan gets them as well."""
    if isinstance(fault, Crashed):
        agent.architecture.log("error", str(fault))
    elif not isinstance(fault, Fail) and agent.options.verbose > 1:
        agent.architecture.log("debug", f"{type(fault).__name__}: {fault}")


def announce(
    agent: Circumstance, intention: Intention | None, goal: Goal, annotations: EventAnnotations
) -> None:
    """Notify waiting intentions that a goal or event has been posted."""
    if agent.waits.events:
        agent.notify_event_waits((goal, intention, annotations, None))
    if agent.features.meta and goal[0].operator == "+" and goal[0].kind:
        meta_events.goal_state(agent, goal, annotations, "pending")


def tell_waiting(agent: Circumstance, intention: Intention) -> None:
    """Notify observers that an intention waits."""
    waiting = intention.waiting
    if waiting is not None:
        meta_events.top_goal_state(agent, intention, "waiting", waiting.reason)
