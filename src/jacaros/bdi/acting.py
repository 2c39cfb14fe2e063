"""The third part of a reasoning cycle: an intention makes a step, and goes on as long as nothing else wants a cycle."""

from typing import Any

from jacaros.bdi import failure, meta_events
from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.deliberation import add_frame, go_without, push
from jacaros.bdi.event import Posted
from jacaros.bdi.finishing import pop_finished
from jacaros.bdi.goal_failure import fail_intention
from jacaros.bdi.intention import Frame, Intention
from jacaros.bdi.internal_action import Crashed
from jacaros.bdi.waiting import OWN_SUSPENSION
from jacaros.compiler.runtime import SUSPENDED, Fail
from jacaros.errors import InternalError
from jacaros.terms.unifier import undo
from jacaros.terms.values import BY_SELF


def execute(agent: Circumstance, intention: Intention, fuel: int) -> int:  # noqa: C901 - written out for speed
    """Rules ExecInt and ClrInt: steps of one intention while nothing else wants a cycle; gives the fuel left.

    What happens in nearly every cycle is written out here; whatever is rarer is called: `pop_finished`, `push`,
    `add_frame`, `go_without` do the same in full.
    """
    agent.current = intention
    frames, trail, selects = intention.frames, agent.trail, agent.selects
    events, intentions, inbox = agent.events, agent.intentions, agent.inbox
    percepts, tasks, waits = agent.percepts, agent.tasks, agent.condition_waits
    filters, depth = agent.option_filter.rows, agent.goal_depth
    while True:
        fuel -= 1
        if agent.atomic_over:
            agent.atomic, agent.atomic_over = None, False
        frame = frames[-1]
        step = frame[0]
        goal: Any = None
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
                trail.clear()
        if agent.stopped or intention.dropped:
            break

        if goal is None:
            if frame[0] is None:
                if agent.meta or agent.goal_conditions or agent.atomic is not None or intention.handlers:
                    if not pop_finished(agent, intention):
                        break
                else:
                    while frames and frames[-1][0] is None:
                        frames.pop()
                    if not frames:
                        agent.finish(intention)
                        break
            if (
                fuel <= 0
                or intentions
                or events
                or inbox
                or percepts
                or tasks
                or waits
                or agent.goal_conditions
                or intention.suspended is not None
            ) and not _stays(agent, intention, fuel, at_goal=False):
                agent.make_ready(intention)
                break
            continue

        if goal is SUSPENDED:
            if agent.meta:
                _tell_waiting(agent, intention)
            break
        annotations: Any = BY_SELF
        if goal.__class__ is Posted:
            goal, annotations = goal
        if agent.meta or agent.event_waits:
            _announce(agent, intention, goal, annotations)
        if (
            fuel <= 0
            or intentions
            or events
            or inbox
            or percepts
            or tasks
            or waits
            or agent.goal_conditions
            or intention.suspended is not None
        ) and not _stays(agent, intention, fuel, at_goal=True):
            if agent.atomic is not intention:
                events.append((goal, intention, annotations, None))
            elif push(agent, intention, goal, annotations):
                agent.make_ready(intention)
            break
        if filters or agent.subplans:
            if push(agent, intention, goal, annotations):
                continue
            break

        # `push` and `add_frame`, written out.
        trail.serial += 1
        kind = goal[0]
        select = selects[kind]
        made: Frame | None = None if select is None else select(agent, goal, annotations)
        if trail:
            trail.clear()
        if made is None:
            if go_without(agent, intention, goal, annotations, None):
                continue
            break
        if agent.meta or made[4].atomic or agent.atomic is not None:
            if add_frame(agent, intention, made) or go_without(agent, intention, goal, annotations, made):
                continue
            break
        caller = frames[-1]
        if (
            caller[0] is None
            and caller[1][0] is kind
            and kind.on_fail is not None
            and agent.options.tail_calls
            and caller[4].replaceable
        ):
            frames[-1] = made
        else:
            frames.append(made)
            if len(frames) > depth:
                frames.pop()
                if add_frame(agent, intention, made) or go_without(agent, intention, goal, annotations, made):
                    continue
                break
    agent.current = None
    return fuel


def _stays(agent: Circumstance, intention: Intention, fuel: int, *, at_goal: bool) -> bool:
    """Whether an intention goes on although there is more to do: an atomic one does."""
    if agent.atomic is None or fuel <= 0 or agent.goal_conditions or intention.suspended is not None:
        return False
    return at_goal or not (agent.inbox or agent.tasks or agent.percepts)


def _failed(agent: Circumstance, intention: Intention, fault: Exception) -> Any:
    """A step raised an exception: the event for the nearest handler, None when there is none."""
    undo(agent.trail, 0)
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
