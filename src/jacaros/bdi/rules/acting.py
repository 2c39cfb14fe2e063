"""The third part of a reasoning cycle: an intention makes a step, and goes on as long as nothing else wants a cycle.

`execute` does what there is to do in general, `execute_plainly` what there is to do for nearly all agents nearly always.
"""

from typing import Any

from jacaros.bdi.actions.internal_action import Crashed
from jacaros.bdi.rules import failure, meta_events
from jacaros.bdi.rules.deliberation import go_without, is_alone, push
from jacaros.bdi.rules.finishing import pop_finished
from jacaros.bdi.rules.goal_failure import fail_intention, has_room
from jacaros.bdi.rules.outcomes import FAILED, SUSPENDED, Fail
from jacaros.bdi.rules.rescue import note_lack_of_memory
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import Posted
from jacaros.bdi.state.intention import Frame, Intention
from jacaros.bdi.state.waiting import OWN_SUSPENSION
from jacaros.errors import InternalError
from jacaros.terms.unifier import undo
from jacaros.terms.values import BY_SELF


def is_plain(agent: Circumstance) -> bool:
    """Whether `execute_plainly` does all that there is to do."""
    return not (agent.special or agent.event_waits or agent.option_filter.rows or agent.atomic is not None)


def execute(agent: Circumstance, intention: Intention, fuel: int) -> int:
    """Rules ExecInt and ClrInt: steps of one intention while nothing else wants a cycle; gives the fuel left."""
    agent.current = intention
    while True:
        fuel -= 1
        if agent.atomic_over:
            agent.atomic, agent.atomic_over = None, False
        frame: Frame = intention.frames[-1]
        goal = None if frame[0] is None else _step(agent, intention, frame)
        if agent.stopped or intention.dropped:
            break
        if goal is None:
            if frame[0] is None and not pop_finished(agent, intention):
                break
            if fuel <= 0 or intention.suspended is not None or not is_alone(agent) or _is_called(agent):
                if intention.suspended is None:
                    agent.intentions.append(intention)
                else:
                    intention.parked = True
                break
        elif goal is SUSPENDED:
            if agent.meta:
                _tell_waiting(agent, intention)
            break
        elif not _pursue(agent, intention, goal, fuel):
            break
    agent.current = None
    return fuel


def _step(agent: Circumstance, intention: Intention, frame: Frame) -> Any:
    """Make the next step of a plan; what it gives, or the event for its failure.  An intention that nobody saves ends."""
    goal: Any = None
    try:
        goal = frame[0](agent, frame)
    except InternalError:
        raise
    except Exception as fault:
        goal = _failed(agent, intention, fault)
    if goal is FAILED:
        goal = _failed(agent, intention)
    agent.trail.clear()
    return goal


def _pursue(agent: Circumstance, intention: Intention, goal: Any, fuel: int) -> bool:
    """A step has posted a goal or event; True when the intention goes on with it at once."""
    annotations: Any = BY_SELF
    if goal.__class__ is Posted:
        goal, annotations = goal.goal, goal.annotations
    _announce(agent, intention, goal, annotations)
    if agent.urgency is not None:
        agent.urgency.note_goal(goal[0])
    if fuel > 0 and intention.suspended is None and is_alone(agent):
        return push(agent, intention, goal, annotations)
    if agent.atomic is not intention:
        agent.events.append((goal, intention, annotations, None))
    elif push(agent, intention, goal, annotations):
        agent.make_ready(intention)
    return False


def execute_plainly(agent: Circumstance, intention: Intention, fuel: int) -> int:  # noqa: C901 - see below
    """What `execute` does, for an agent that is plain (`is_plain`).

    This is where an agent spends its time, so what happens in nearly every cycle is written out here: `pop_finished`,
    `is_alone`, `select_plan` and `add_frame`.  A step may make the agent other than plain; then it is left to the next
    cycle to go on, which with empty queues comes to the same.
    """
    agent.current = intention
    frames, handlers, trail, selects = intention.frames, intention.handlers, agent.trail, agent.selects
    events, intentions = agent.events, agent.intentions
    option_filter, depth, tail_calls = agent.option_filter, agent.goal_depth, agent.options.tail_calls
    urgency = agent.urgency
    frame: Frame = frames[-1]
    while True:
        fuel -= 1
        goal: Any = None
        step = frame[0]
        if step is not None:
            try:
                goal = step(agent, frame)
            except InternalError:
                raise
            except Exception as fault:
                goal = _failed(agent, intention, fault)
                if goal is None:
                    break
            if trail:
                if goal is FAILED:
                    undo(trail, 0)
                else:
                    trail.clear()
        if agent.stopped or intention.dropped:
            break

        if goal is None:
            if frame[0] is None:
                if agent.special:
                    if not pop_finished(agent, intention):
                        break
                else:
                    while frames and (top := frames[-1])[0] is None:
                        if handlers and top[1][0].failing:
                            del frames[handlers.pop() :]
                        else:
                            frames.pop()
                    if not frames:
                        if intention.waiting is None:
                            # `finish`, written out.
                            intention.dropped = True
                            agent.alive.pop(intention.id, None)
                        else:
                            agent.finish(intention)
                        break
            if intentions or events or agent.called or fuel <= 0:
                if intention.suspended is None:
                    intentions.append(intention)
                else:
                    intention.parked = True
                break
            frame = frames[-1]
            continue

        annotations: Any = BY_SELF
        if goal.__class__ is not tuple:
            if goal is SUSPENDED:
                if agent.meta:
                    _tell_waiting(agent, intention)
                break
            if goal is FAILED:
                goal = fail_intention(agent, intention, failure.step_failure(frames[-1]))
                if goal is None:
                    break
            goal, annotations = goal.goal, goal.annotations
        if urgency is not None and urgency.by_trigger[goal[0]]:
            urgency.rank()
        if intentions or events or agent.called or option_filter.rows or fuel <= 0:
            _announce(agent, intention, goal, annotations)
            events.append((goal, intention, annotations, None))
            break
        trail.serial += 1
        kind = goal[0]
        select = selects[kind]
        made: Frame | None = None if select is None else select(agent, goal, annotations)
        if trail:
            trail.clear()
        if made is None:
            if not go_without(agent, intention, goal, annotations, None):
                break
            made = frames[-1]
        elif (
            frame[0] is None
            and frames[-1] is frame
            and frame[1][0] is kind
            and kind.on_fail is not None
            and tail_calls
            and frame[4].replaceable
        ):
            frames[-1] = made
        else:
            frames.append(made)
            if len(frames) > depth and not has_room(agent, intention):
                if not go_without(agent, intention, goal, annotations, made):
                    break
                made = frames[-1]
        frame = made
        if frame[4].atomic:
            agent.atomic, agent.atomic_over = intention, False
            agent.make_ready(intention)
            break
    agent.current = None
    return fuel


def _is_called(agent: Circumstance) -> bool:
    """Whether an atomic intention, for which nothing else has its turn, lets what has come in be looked at."""
    return agent.atomic is not None and bool(agent.inbox or agent.tasks or agent.percepts)


def _failed(agent: Circumstance, intention: Intention, fault: Exception | None = None) -> Posted | None:
    """A step failed, or raised an exception: the event for the nearest handler, None when there is none."""
    if agent.trail:
        undo(agent.trail, 0)
    if fault is not None and fault.__class__ is not Fail:
        note_lack_of_memory(agent, fault)
        _report(agent, fault)
    frame: Frame = intention.frames[-1]
    return fail_intention(agent, intention, failure.step_failure(frame, fault))


def _report(agent: Circumstance, fault: Exception) -> None:
    """Python errors inside internal actions are shown to people as well as to the plan."""
    if isinstance(fault, Crashed):
        agent.architecture.log("error", str(fault))
    elif not isinstance(fault, Fail) and agent.options.verbose > 1:
        agent.architecture.log("debug", f"{type(fault).__name__}: {fault}")


def _announce(agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any) -> None:
    if agent.event_waits:
        agent.notify_event_waits((goal, intention, annotations, None))
    if agent.meta and goal[0].operator == "+" and goal[0].kind:
        meta_events.goal_state(agent, goal, annotations, "pending")


def _tell_waiting(agent: Circumstance, intention: Intention) -> None:
    waiting = intention.waiting
    if waiting is not None and waiting.reason is not OWN_SUSPENSION:
        meta_events.top_goal_state(agent, intention, "waiting", waiting.reason)
