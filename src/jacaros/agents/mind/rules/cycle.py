"""The reasoning cycle: sense, deliberate, act.

Each cycle takes in new input, handles one event, and lets one intention run one step.
"""

from typing import Any

from jacaros.agents.mind.actions.internal_action import Crashed
from jacaros.agents.mind.rules import failure, forks, meta_events, needs
from jacaros.agents.mind.rules.add_im import log_inapplicable, push
from jacaros.agents.mind.rules.belief_update import take_percepts
from jacaros.agents.mind.rules.clr_int import end_achieved_goals, pop_finished, remove_event
from jacaros.agents.mind.rules.failure import fail_intention, note_lack_of_memory, unplanned
from jacaros.agents.mind.rules.pending import check_conditions
from jacaros.agents.mind.rules.plan_changes import look_at_plans
from jacaros.agents.mind.rules.proc_msg import RECEIVED, read_message, receive_event
from jacaros.agents.mind.state.belief_base import MANY_NAMES
from jacaros.agents.mind.state.circumstance import Circumstance, HeldEvent, StepObserver
from jacaros.agents.mind.state.intention import EVENT_CAUSE, EVENT_INTENTION, STEP, Event, Frame, Intention
from jacaros.agents.mind.state.plan import FAILED, SUSPENDED, Fail
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal
from jacaros.agents.terms.operators import RUNNING
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import BY_SELF
from jacaros.runtime.errors import InternalError


def run(agent: Circumstance, fuel: int) -> bool:  # noqa: C901 - the whole cycle is here
    """Sense, deliberate and act in at most *fuel* cycles; return whether there is more to do.

    When nothing else needs a cycle, the next one would select the event and the intention of this one. So `execute`
    stays with an intention until something does: another event or intention, or input (`Incoming.called`).
    """
    counts, incoming, always = agent.counts, agent.incoming, agent.options.percept_interval == 1
    end = counts.cycles + fuel
    # New input need not wake the agent meanwhile, and functions in terms are evaluated for it.
    before = RUNNING.set(agent)
    agent.running = True
    try:
        if agent.sleep == "asleep":
            meta_events.awake(agent)
        while counts.cycles < end and not agent.stopped:
            chosen: Intention | bool | None = None
            if agent.held is None:
                if incoming.called or not always:
                    look_around(agent, counts.cycles)
                if agent.events:
                    if agent.atomic is None:
                        chosen = handle_event(agent)
                    else:
                        handle_atomic_event(agent)
            else:
                chosen = _continue_held(agent)
            if chosen is None:
                chosen = _select(agent)
            if chosen is False:
                break
            if chosen is not True:
                try:
                    counts.cycles = end - execute(agent, chosen, end - counts.cycles)
                except Exception as fault:
                    failure.drop_after_error(agent, agent.current or chosen, fault)
                    counts.cycles += 1
                if agent.waits.requeued:
                    agent.events.extendleft(reversed(agent.waits.requeued))
                    agent.waits.requeued.clear()
            if not (agent.events or agent.intentions or incoming.called or agent.features.edges):
                return False  # the next cycle would find nothing to do
        # Without cycles left it was not seen yet that nothing is to be done: that takes another look.
        return not agent.stopped and (counts.cycles >= end or has_work(agent))
    finally:
        agent.running = False
        RUNNING.reset(before)
        if len(agent.beliefs) > counts.many_names:
            agent.beliefs.forget_names()
            counts.many_names = max(MANY_NAMES, 2 * len(agent.beliefs))
        if agent.waits.needs:
            needs.sweep(agent)


def _select(agent: Circumstance) -> Intention | bool:
    """Select the intention that makes a step; without one, return whether there may be one in the next cycle."""
    if agent.held is not None:
        return False
    if agent.conditioned:
        end_achieved_goals(agent)
    intention = select_intention(agent)
    if intention is None:
        return _waits(agent)
    if agent.observers.step is not None and is_held_before_step(agent, intention):
        return False
    return intention


def _continue_held(agent: Circumstance) -> Intention | bool | None:
    """Finish the deliberation in which an observer held the agent; return None if an intention is still to be selected."""
    if agent.observers.step is not None and agent.observers.step.paused:
        return False
    intention = take_held_intention(agent)
    if intention is not None:
        return intention
    ends_cycle = isinstance(agent.held, HeldEvent) and agent.held.ends_cycle
    event = take_held_event(agent)
    if event is not None:
        handle_held_event(agent, event)
    return (agent.held is None) if ends_cycle else None


def _waits(agent: Circumstance) -> bool:
    """No intention can run a step: return whether one may in the next cycle."""
    if (agent.events and agent.atomic is None) or agent.incoming.messages:
        agent.counts.cycles += 1
        return True
    return bool(agent.incoming or (agent.features.edges and meta_events.fall_asleep(agent)))


def has_work(agent: Circumstance) -> bool:
    """Return whether there is something to do."""
    if agent.incoming:
        return True
    if agent.atomic is not None:
        return is_ready(agent, agent.atomic) or event_of(agent, agent.atomic) is not None
    return bool(agent.events or agent.intentions)


def look_around(agent: Circumstance, cycle: int) -> None:
    """Take in new input: percepts, ends of waits, one message."""
    incoming, waits = agent.incoming, agent.waits
    looks = agent.options.percept_interval == 1 or looks_now(agent, cycle)
    while looks and incoming.percepts:
        try:
            take_percepts(agent, incoming.percepts.popleft())
        except InternalError:
            raise
        except Exception as fault:  # the rest of a step of an artifact is skipped
            failure.report_skipped(agent, "percepts", fault)
    if incoming.tasks:
        do_tasks(agent)
    if waits.conditions:
        check_conditions(agent)
        do_tasks(agent)
    if looks and incoming.messages:
        if agent.selections.plain:
            read_message(agent, incoming.messages.popleft())
        else:
            for message in agent.selections.select_messages():
                read_message(agent, message)
    incoming.called = True
    if not (
        incoming.percepts
        or incoming.messages
        or incoming.tasks
        or (waits.conditions and (waits.due or waits.restless))
        or agent.conditioned
        or agent.observers.step is not None
        or not agent.selections.plain
    ):
        incoming.called = False


def looks_now(agent: Circumstance, cycle: int) -> bool:
    """Return whether an agent that does not take in input in every cycle (``nrcbp``) does in this one."""
    if cycle < agent.counts.next_look and (agent.events or agent.intentions or agent.incoming.tasks):
        return False
    agent.counts.next_look = cycle + agent.options.percept_interval
    return True


def do_tasks(agent: Circumstance) -> None:
    """Run the tasks that are due."""
    while agent.incoming.tasks:
        function, arguments = agent.incoming.tasks.popleft()
        try:
            function(agent, *arguments)
        except InternalError:
            raise
        except Exception as fault:
            failure.report_skipped(agent, "delayed change of an intention", fault)


# An event is handled: rule SelEv, and the intention that it begins or continues.

# An observer holds an agent in the middle of a reasoning cycle: before an event is handled, or before a step is made.


def observe_steps(agent: Circumstance, observer: StepObserver | None) -> None:
    """Ask *observer* before each event and each step; None ends this, and lets a held agent continue."""
    agent.observers.step = observer
    agent.look_at_observers()
    if observer is None:
        agent.held = None
    look_at_plans(agent)


def is_held_before_event(agent: Circumstance, event: Event, ends_cycle: bool = False) -> bool:
    """Return whether the observer holds the agent before an event, which is then put back first in the queue."""
    observer = agent.observers.step
    if observer is None or not observer.holds_event(agent, event):
        return False
    agent.held = HeldEvent(event, ends_cycle)
    agent.events.appendleft(event)
    return True


def is_held_before_step(agent: Circumstance, intention: Intention) -> bool:
    """Return whether the observer holds the agent before a step of an intention, which is then put back as the next one."""
    observer = agent.observers.step
    if observer is None or not observer.holds_step(agent, intention):
        return False
    agent.held = intention
    agent.intentions.appendleft(intention)
    return True


def take_held_event(agent: Circumstance) -> Event | None:
    """Take the event before which the agent was held out of its queue; return None if it was not held or the event is
    gone.
    """
    held = agent.held
    if not isinstance(held, HeldEvent):
        return None
    agent.held = None
    place = next((place for place, queued in enumerate(agent.events) if queued is held.event), None)
    if place is None:
        return None
    del agent.events[place]
    return held.event


def take_held_intention(agent: Circumstance) -> Intention | None:
    """Take the intention before whose step the agent was held out of its queue; None if it was not held or cannot run
    now.
    """
    intention = agent.held
    if not isinstance(intention, Intention):
        return None
    agent.held = None
    if intention.dropped or intention not in agent.intentions:
        return None
    agent.intentions.remove(intention)
    return intention


def handle_event(agent: Circumstance) -> Intention | None:
    """Rule SelEv and the rules after it: handle one event; external events without a plan are skipped.

    Return the intention that it begins if it is the only one that can run.
    """
    while agent.events:
        event = agent.events.popleft() if agent.selections.plain else agent.selections.select_event()
        if event is None or (agent.observers.step is not None and is_held_before_event(agent, event)):
            return None
        try:
            handled = _handle(agent, event)
        except Exception as fault:
            skip_event(agent, event, fault)
            continue
        if handled:
            return None if handled is True else handled
    return None


def handle_held_event(agent: Circumstance, event: Event) -> None:
    """Handle the event before which the agent was held; the next one if that is skipped."""
    if not _try(agent, event) and agent.atomic is None:
        handle_event(agent)


def _try(agent: Circumstance, event: Event) -> Intention | bool:
    try:
        return _handle(agent, event)
    except Exception as fault:
        skip_event(agent, event, fault)
        return False


def handle_atomic_event(agent: Circumstance) -> None:
    """The atomic intention's own event comes before all others, which wait."""
    intention = agent.atomic
    event = None if intention is None else event_of(agent, intention)
    if intention is not None and event is not None:
        remove_event(agent, event)
        if not is_held_before_event(agent, event):
            _try(agent, event)


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
    """Report an exception that escapes while an event is handled; the agent continues with the next event.

    Raises:
        InternalError: that is what *fault* is.
    """
    if isinstance(fault, InternalError):
        raise fault
    agent.current = None
    failure.report_skipped(agent, "event", fault)
    intention = event[EVENT_INTENTION]
    if intention is not None:
        failure.drop_after_error(agent, intention, fault)


def _handle(agent: Circumstance, event: Event) -> Intention | bool:
    """Continue the intention of an event, or begin one for an external event.

    Return an intention that has begun if no other can run: it need not be queued. Return False for an external event
    without a plan, which is dropped silently, and for one whose intention is over.
    """
    goal, intention, annotations, cause = event
    if intention is not None:
        if intention.dropped:
            return False
        agent.current = intention  # contexts may ask for it
        if push(agent, intention, goal, annotations):
            agent.make_ready(intention)
        agent.current = None
        return True
    reacted = False
    if agent.holders and goal[0].kind == "":
        reacted = _react(agent, event)
    begun = push(agent, None, goal, annotations, cause)
    if begun is False:
        return _begin_without_plan(agent, event, reacted)
    if not begun:
        return True  # it waits for what it needs
    if not (
        agent.intentions
        or agent.conditioned
        or agent.selections.urgencies is not None
        or agent.observers.step is not None
    ):
        return begun
    agent.make_ready(begun)
    return True


def _begin_without_plan(agent: Circumstance, event: Event, reacted: bool) -> bool:
    """Drop an external event, let a goal fail, or handle a message by default."""
    goal, _, annotations, cause = event
    trigger = goal[0]
    if trigger.kind == "" or trigger.operator == "^":
        if not reacted:
            log_inapplicable(agent, goal, annotations)
        if agent.options.events == "requeue" and not reacted and trigger.operator != "^":
            agent.waits.requeued.append(event)
        return reacted
    if trigger is RECEIVED:
        receive_event(agent, goal)
        return True
    intention = Intention(agent, cause)
    agent.post_for(intention, unplanned(agent, intention, goal, annotations))
    return True


def _react(agent: Circumstance, event: Event) -> bool:
    """Every intention with a plan that has sub-plans for an external event reacts to it."""
    goal, _, annotations, cause = event
    reactions = forks.react(agent, goal, annotations, agent.library.reactions[goal[0]])
    for owner, outer, frame in reactions:
        if agent.observers.mind is not None:
            cause = agent.observers.mind.selected(goal, annotations, None, frame, event[EVENT_CAUSE])
        intention = Intention(agent, cause)
        intention.frames.append(frame)
        intention.outer = (owner, outer)
        agent.make_ready(intention)
    return bool(reactions)


# An intention has its turn and makes a step: rules SelInt and ExecInt.


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
