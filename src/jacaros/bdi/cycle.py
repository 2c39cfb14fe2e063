"""The reasoning cycle: message, event, plan, one step of one intention.

`run` makes cycles while there is something to do.  With empty queues the next cycle would pick the very event and intention
of this one, so it stays with an intention as long as nothing else wants a cycle: that changes nothing a program can see.
"""

from typing import Any

from jacaros.bdi import edge_signals, failure, meta_events, option_selection, rescue, speech_acts, subplans
from jacaros.bdi.belief_update import apply_percepts
from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.event import Event, Posted
from jacaros.bdi.failure import FailureReason
from jacaros.bdi.forks import branch_failed
from jacaros.bdi.intention import ANNOTATIONS, GOAL, PLAN, SERIAL, STEP, Frame, Intention
from jacaros.bdi.internal_action import Crashed
from jacaros.bdi.stack import achieve, remove_event
from jacaros.bdi.waiting import OWN_SUSPENSION, Waiting
from jacaros.compiler.runtime import SUSPENDED, Fail
from jacaros.errors import InternalError
from jacaros.terms.text import text
from jacaros.terms.unifier import undo
from jacaros.terms.values import BY_SELF, atom

_HAS_FAILURE_PLAN = atom("has_failure_plan")


def run(agent: Circumstance, fuel: int) -> bool:
    """Make at most *fuel* cycles; True when there is more to do."""
    begun = fuel
    if agent.asleep:
        edge_signals.awake(agent)
    while fuel > 0 and not agent.stopped:
        looks = agent.options.percept_interval == 1 or _looks_around(agent, agent.cycles + begun - fuel)
        _housekeeping(agent, looks)
        if agent.inbox and looks:
            _read_message(agent)
        if agent.events:
            if agent.atomic is None:
                handle_event(agent)
            else:
                _handle_atomic_event(agent, agent.atomic)
        if agent.goal_conditions:
            _end_achieved_goals(agent)
        intention = _select_intention(agent)
        if intention is not None:
            try:
                fuel = _execute(agent, intention, fuel)
            except InternalError:
                raise
            except Exception as fault:
                fuel -= 1
                rescue.give_up(agent, agent.current or intention, fault)
            if agent.requeued:
                agent.events.extendleft(reversed(agent.requeued))
                agent.requeued.clear()
        elif (agent.events and agent.atomic is None) or agent.inbox:
            fuel -= 1
        elif not (agent.percepts or agent.tasks or edge_signals.fall_asleep(agent)):
            break
    agent.cycles += begun - fuel
    return not agent.stopped and _has_work(agent)


def _has_work(agent: Circumstance) -> bool:
    if agent.inbox or agent.percepts or agent.tasks:
        return True
    if agent.atomic is not None:
        atomic = agent.atomic
        return atomic in agent.intentions or any(e.intention is atomic for e in agent.events)
    return bool(agent.events or agent.intentions)


def _looks_around(agent: Circumstance, cycle: int) -> bool:
    """Whether an agent that does not look at percepts and messages in every cycle (``nrcbp``) does in this one."""
    if cycle < agent.next_look and (agent.events or agent.intentions or agent.tasks):
        return False
    agent.next_look = cycle + agent.options.percept_interval
    return True


def _housekeeping(agent: Circumstance, looks: bool = True) -> None:
    """What came in since the last cycle: percepts, ends of waits, conditions that now hold."""
    while agent.percepts and looks:
        percepts = agent.percepts.popleft()
        try:
            apply_percepts(agent, percepts)
        except InternalError:
            raise
        except Exception as fault:
            rescue.passed_over(agent, "what was perceived", fault)
    _do_tasks(agent)
    if agent.condition_waits:
        _check_conditions(agent)


def _do_tasks(agent: Circumstance) -> None:
    """The housekeeping that is due."""
    while agent.tasks:
        task = agent.tasks.popleft()
        try:
            task()
        except InternalError:
            raise
        except Exception as fault:
            rescue.passed_over(agent, "a delayed change of an intention", fault)


def _read_message(agent: Circumstance) -> None:
    message = agent.inbox.popleft()
    try:
        speech_acts.process(agent, message)
    except InternalError:
        raise
    except Exception as fault:
        rescue.passed_over(agent, f"a message ({message.performative}) from {message.sender}", fault)
        if message.performative.startswith("ask"):
            speech_acts.answer(agent, message, None)


def _is_achieved(agent: Circumstance, frame: Frame) -> bool:
    """Whether the goal condition of a frame holds; one that cannot be evaluated does not, which is told once."""
    achieved = frame[PLAN].goal_condition
    if achieved is None:
        return False
    try:
        return bool(achieved(agent, frame))
    except InternalError:
        raise
    except Exception as fault:
        undo(agent.trail, 0)
        if frame[PLAN] not in agent.blamed:
            agent.blamed.add(frame[PLAN])
            rescue.passed_over(agent, f"the goal condition of plan {text(frame[PLAN].label)}", fault)
        return False


def _end_achieved_goals(agent: Circumstance) -> None:
    """Goals whose goal condition holds are achieved, whatever their plans are at."""
    for intention in list(agent.alive.values()):
        for index, frame in enumerate(intention.frames):
            if frame[PLAN].goal_condition is not None and _is_achieved(agent, frame):
                queued = intention in agent.intentions
                achieve(agent, intention, index)
                if intention.frames:
                    queued = queued or not pop_finished(agent, intention)
                else:
                    agent.finish(intention)
                    queued = True
                if not queued:
                    agent.make_ready(intention)
                break


def _tell_waiting(agent: Circumstance, intention: Intention) -> None:
    waiting = intention.waiting
    if waiting is not None and waiting.reason is not OWN_SUSPENSION:
        meta_events.top_goal_state(agent, intention, "waiting", waiting.reason)


def _check_conditions(agent: Circumstance) -> None:
    """Resume the intentions whose awaited condition holds now."""
    for entry in list(agent.condition_waits):
        holds, waiting = entry
        if waiting.ended:
            agent.condition_waits.remove(entry)
            continue
        try:
            held = holds()
        except InternalError:
            raise
        except Exception as fault:
            undo(agent.trail, 0)
            agent.condition_waits.remove(entry)
            waiting.fail(rescue.told(fault))
        else:
            if held:
                agent.condition_waits.remove(entry)
                waiting.resume()
    _do_tasks(agent)


def _select_intention(agent: Circumstance) -> Intention | None:
    """Rule SelInt: the atomic one, else round robin."""
    intentions = agent.intentions
    if agent.atomic is not None:
        if agent.atomic in intentions:
            intentions.remove(agent.atomic)
            return agent.atomic
        return None
    while intentions:
        intention = intentions.popleft()
        if intention.dropped:
            continue
        if intention.suspended is not None:
            intention.parked = True
            continue
        return intention
    return None


def handle_event(agent: Circumstance) -> None:
    """Rule SelEv and what follows: one event is handled; external events without plan are passed over."""
    while agent.events:
        event = agent.events.popleft()
        try:
            if _take_up(agent, event):
                return
        except InternalError:
            raise
        except Exception as fault:
            rescue.passed_over(agent, "an event", fault)
            if event.intention is not None:
                rescue.give_up(agent, event.intention, fault)


def _take_up(agent: Circumstance, event: Event) -> bool:
    """Handle one event; False when it is passed over and the next one may have its turn in the same cycle."""
    intention = event.intention
    if intention is None:
        return _external(agent, event)
    if intention.dropped:
        return False
    if push(agent, intention, event.goal, event.annotations):
        agent.make_ready(intention)
    return True


def _handle_atomic_event(agent: Circumstance, intention: Intention) -> None:
    """An atomic intention's own event comes before all others, which wait."""
    event = next((e for e in agent.events if e.intention is intention), None)
    if event is not None:
        remove_event(agent, event)
        try:
            _take_up(agent, event)
        except InternalError:
            raise
        except Exception as fault:
            rescue.passed_over(agent, "an event", fault)
            rescue.give_up(agent, intention, fault)


def _external(agent: Circumstance, event: Event) -> bool:
    """Begin an intention for an external event; False when it has no plan and is dropped silently."""
    goal, annotations = event.goal, event.annotations
    trigger = goal[0]
    reacted = agent.subplans and trigger.kind == "" and _react(agent, event)
    frame = select_plan(agent, goal, annotations)
    if frame is None:
        if trigger.kind == "" or trigger.operator == "^":
            if agent.options.events == "requeue" and not reacted and trigger.operator != "^":
                agent.requeued.append(event)
            return reacted
        intention = agent.new_intention(event.cause)
        posted = _unplanned(agent, intention, goal, annotations)
        if posted is not None:
            agent.post(Event(posted.goal, intention, posted.annotations))
        return True
    intention = agent.new_intention(event.cause)
    intention.frames.append(frame)
    if trigger.failing:
        intention.handlers.append(0)
    if frame[PLAN].atomic:
        agent.atomic, agent.atomic_over = intention, False
    if agent.meta:
        meta_events.goal_state(agent, goal, annotations, "executing")
    agent.make_ready(intention)
    return True


def _react(agent: Circumstance, event: Event) -> bool:
    """Every intention whose plans have a sub-plan for an external event reacts to it."""
    reactions = subplans.react(agent, event.goal, event.annotations)
    for owner, outer, frame in reactions:
        intention = agent.new_intention(event.cause)
        intention.frames.append(frame)
        intention.outer = (owner, outer)
        agent.make_ready(intention)
    return bool(reactions)


def select_plan(
    agent: Circumstance, goal: tuple[Any, ...], annotations: Any, intention: Intention | None = None
) -> Frame | None:
    """Rules RelPl, ApplPl and SelAppl: the frame of the first applicable plan, sub-plans of *intention* first."""
    select = agent.selects[goal[0]]
    agent.trail.serial += 1
    if agent.subplans and intention is not None:
        inner = subplans.select_in_scope(agent, intention, goal, annotations)
        if inner is not None:
            agent.trail.clear()
            return inner
    if select is None:
        return None
    if agent.option_filter.rows:
        return option_selection.first_option(agent, goal, annotations, intention)
    frame = select(agent, goal, annotations)
    if agent.trail:
        agent.trail.clear()
    return frame


def push(agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any) -> bool:
    """Rule AddIM: put a plan for the goal on the intention; False when the intention goes no further now."""
    while True:
        trigger = goal[0]
        frame = select_plan(agent, goal, annotations, intention)
        if frame is not None:
            _add_frame(agent, intention, frame)
            if len(intention.frames) <= agent.goal_depth or _has_room(agent, intention):
                return True
            posted = _too_deep(agent, intention)
        elif trigger.kind == "":
            return True
        else:
            posted = _unplanned(agent, intention, goal, annotations)
        if posted is None:
            return False
        if not _alone(agent):
            agent.post(Event(posted.goal, intention, posted.annotations))
            return False
        goal, annotations = posted
        if agent.event_waits:
            agent.notify_event_waits(Event(goal, intention, annotations))


def _has_room(agent: Circumstance, intention: Intention) -> bool:
    """Whether the plan just put on a full stack may stay: handlers have some room of their own, to deal with that."""
    depth = agent.goal_depth
    is_handler = intention.frames[-1][GOAL][0].failing
    return is_handler and len(intention.frames) <= depth + depth // 10 + 100


def _too_deep(agent: Circumstance, intention: Intention) -> Posted | None:
    """The plan just put on a full stack fails before its first step."""
    frame = intention.frames.pop()
    goal, annotations = frame[GOAL], frame[ANNOTATIONS]
    failure.release_bindings(goal, frame[SERIAL])
    reason = failure.too_deep(goal, annotations, intention.frames[-1], agent.goal_depth)
    if goal[0].failing:
        # Handlers of handlers without end: nobody is left who could deal with it.
        intention.handlers.clear()
        del intention.frames[1:]
    return fail_goal(agent, intention, goal, annotations, reason)


def _alone(agent: Circumstance) -> bool:
    """Whether nothing else wants the next cycle."""
    if agent.atomic is not None:
        return not agent.goal_conditions
    return not (
        agent.events
        or agent.intentions
        or agent.inbox
        or agent.tasks
        or agent.percepts
        or agent.condition_waits
        or agent.goal_conditions
    )


def _add_frame(agent: Circumstance, intention: Intention, frame: Frame) -> None:
    frames = intention.frames
    trigger = frame[GOAL][0]
    if frames and trigger.operator == "+" and trigger.kind and agent.options.tail_calls:
        caller = frames[-1]
        if caller[STEP] is None and caller[GOAL][0] is trigger and _may_be_replaced(caller):
            frames[-1] = frame
            if agent.atomic is intention and not intention.is_atomic():
                agent.atomic_over = True
        else:
            frames.append(frame)
    else:
        frames.append(frame)
    if frame[PLAN].atomic:
        agent.atomic, agent.atomic_over = intention, False
    if agent.meta and trigger.kind and not trigger.failing:
        meta_events.goal_state(agent, frame[GOAL], frame[2], "executing")


def _may_be_replaced(caller: Frame) -> bool:
    """Whether nothing is left for a plan to do once its last formula is called."""
    plan = caller[PLAN]
    return plan.goal_condition is None and not plan.subplans


def _unplanned(
    agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any
) -> Posted | None:
    """A goal has no plan: its own handler, or one further down, or the end of the intention."""
    trigger = goal[0]
    if trigger.failing:
        _lost_in_handler(agent, intention, goal, annotations)
        return None
    caller = intention.frames[-1] if intention.frames else None
    reason = failure.no_plan(agent, goal, annotations, caller)
    return fail_goal(agent, intention, goal, annotations, reason)


def fail_goal(
    agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any, reason: FailureReason
) -> Posted | None:
    """A goal that has no frame failed: post its handler, or look further down."""
    trigger = goal[0]
    if agent.meta:
        meta_events.goal_state(agent, goal, annotations, "failed", atom(reason.error()))
    if trigger.on_fail is not None and subplans.handles(
        agent, intention, len(intention.frames), trigger.on_fail
    ):
        intention.handlers.append(len(intention.frames))
        if agent.meta:
            meta_events.goal_state(agent, goal, annotations, "executing", _HAS_FAILURE_PLAN)
        return Posted((trigger.on_fail, *goal[1:]), reason.with_goal(annotations))
    return fail_intention(agent, intention, reason)


def fail_intention(agent: Circumstance, intention: Intention, reason: FailureReason) -> Posted | None:
    """The nearest handler down the stack takes over; without one the intention ends with a warning."""
    while intention.forks and not failure.has_handler(agent, intention, intention.forks[-1][0].depth):
        if not branch_failed(agent, intention):
            agent.finish(intention)
            return None
    posted = failure.handler_event(agent, intention, reason)
    if posted is not None:
        if agent.meta:
            failed = intention.frames[intention.handlers[-1]]
            meta_events.goal_state(agent, failed[GOAL], failed[2], "failed", atom(reason.error()))
            meta_events.goal_state(agent, failed[GOAL], failed[2], "executing", _HAS_FAILURE_PLAN)
        return posted
    if intention.on_failed is not None:
        intention.on_failed(reason)
    else:
        _warn_lost(agent, intention, reason)
    if agent.meta:
        _tell_failed(agent, intention, reason)
    agent.finish(intention)
    return None


def _tell_failed(agent: Circumstance, intention: Intention, reason: FailureReason) -> None:
    """All goals of an intention that nobody saved have failed, and are over."""
    for frame in reversed(intention.frames):
        if not frame[GOAL][0].failing:
            meta_events.goal_state(agent, frame[GOAL], frame[2], "failed", atom(reason.error()))
            meta_events.goal_state(agent, frame[GOAL], frame[2], "finished")


def _warn_lost(agent: Circumstance, intention: Intention, reason: FailureReason) -> None:
    bottom = next((frame[GOAL] for frame in intention.frames if frame[GOAL][0].kind), None)
    what = "an intention" if bottom is None else f"the goal !{failure.goal_text(bottom)}"
    where = reason.where()
    place = f" ({where})" if where else ""
    told = f"{what} failed and has no plan for its failure: {reason.error()}, {reason.message()}{place}"
    agent.architecture.log("warning", told)
    if agent.probe is not None:
        agent.probe.lost(told, reason.span())


def _lost_in_handler(
    agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any
) -> None:
    if intention.on_failed is not None:
        intention.on_failed(annotations if isinstance(annotations, FailureReason) else None)
        agent.finish(intention)
        return
    shown = f"-{goal[0].kind}{failure.goal_text(goal)}"
    told = (
        f": {annotations.error()}, {annotations.message()}" if isinstance(annotations, FailureReason) else ""
    )
    lost = f"no applicable plan for the failure event {shown}; the intention is dropped{told}"
    agent.architecture.log("warning", lost)
    if agent.probe is not None:
        agent.probe.lost(lost, annotations.span() if isinstance(annotations, FailureReason) else None)
    agent.finish(intention)


def _execute(agent: Circumstance, intention: Intention, fuel: int) -> int:  # noqa: C901 - written out for speed
    """Rules ExecInt and ClrInt: steps of one intention while nothing else wants a cycle; gives the fuel left."""
    agent.current = intention
    frames = intention.frames
    trail = agent.trail
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
                undo(trail, 0)
                _report(agent, fault)
                goal = fail_intention(agent, intention, failure.step_failure(frames[-1], fault))
                if goal is None:
                    break
            if trail:
                trail.clear()
        if agent.stopped or intention.dropped:
            break
        if goal is None:
            if frame[0] is None and not pop_finished(agent, intention):
                break
            if fuel <= 0 or intention.suspended is not None or not _alone(agent):
                agent.make_ready(intention)
                break
            if agent.atomic is not None and (agent.inbox or agent.tasks or agent.percepts):
                agent.make_ready(intention)
                break
        elif goal is SUSPENDED:
            if agent.meta:
                _tell_waiting(agent, intention)
            break
        else:
            annotations: Any = BY_SELF
            if goal.__class__ is Posted:
                goal, annotations = goal
            if agent.event_waits or agent.meta:
                _announce(agent, intention, goal, annotations)
            if fuel <= 0 or intention.suspended is not None or not _alone(agent):
                if agent.atomic is intention:
                    if push(agent, intention, goal, annotations):
                        agent.make_ready(intention)
                else:
                    agent.events.append(Event(goal, intention, annotations))
                break
            if not push(agent, intention, goal, annotations):
                break
            frames = intention.frames
    agent.current = None
    return fuel


def _report(agent: Circumstance, fault: Exception) -> None:
    """Python errors inside internal actions are shown to people as well as to the plan."""
    if isinstance(fault, Crashed):
        agent.architecture.log("error", str(fault))
    elif not isinstance(fault, Fail) and agent.options.verbose > 1:
        agent.architecture.log("debug", f"{type(fault).__name__}: {fault}")


def _announce(agent: Circumstance, intention: Intention, goal: tuple[Any, ...], annotations: Any) -> None:
    if agent.event_waits:
        agent.notify_event_waits(Event(goal, intention, annotations))
    if agent.meta and goal[0].operator == "+" and goal[0].kind:
        meta_events.goal_state(agent, goal, annotations, "pending")


def pop_finished(agent: Circumstance, intention: Intention) -> bool:
    """Rule ClrInt: take finished plans off the stack; False when nothing is left."""
    frames = intention.frames
    while frames:
        frame = frames[-1]
        if frame[0] is not None:
            break
        if frame[PLAN].goal_condition is not None and not _is_achieved(agent, frame):
            Waiting(agent, intention, atom("goal_condition")).attach(frame, None)
            return False
        trigger = frame[GOAL][0]
        if trigger.failing:
            index = intention.handlers.pop()
            frame = frames[index]
            del frames[index:]
        else:
            frames.pop()
        if agent.meta and trigger.kind:
            if not trigger.failing:
                meta_events.goal_state(agent, frame[GOAL], frame[2], "achieved")
            meta_events.goal_state(agent, frame[GOAL], frame[2], "finished")
        if agent.atomic is intention and not intention.is_atomic():
            agent.atomic_over = True
    if frames:
        return True
    agent.finish(intention)
    return False
