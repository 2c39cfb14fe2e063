"""The reasoning cycle: sense, deliberate, act.

Each cycle takes in new input, handles one event, and lets one intention run one step.
"""

from jacaros.agents.mind.rules import failure, meta_events, needs
from jacaros.agents.mind.rules.belief_update import take_percepts
from jacaros.agents.mind.rules.clr_int import end_achieved_goals
from jacaros.agents.mind.rules.exec_int import execute, select_intention
from jacaros.agents.mind.rules.pending import check_conditions
from jacaros.agents.mind.rules.proc_msg import read_message
from jacaros.agents.mind.rules.sel_ev import (
    event_of,
    handle_atomic_event,
    handle_event,
    handle_held_event,
    is_held_before_step,
    is_ready,
    take_held_event,
    take_held_intention,
)
from jacaros.agents.mind.state.belief_base import MANY_NAMES
from jacaros.agents.mind.state.circumstance import Circumstance, HeldEvent
from jacaros.agents.mind.state.intention import Intention
from jacaros.agents.terms.arithmetic import RUNNING
from jacaros.errors import InternalError


def run(agent: Circumstance, fuel: int) -> bool:  # noqa: C901 - the whole cycle is here
    """Sense, deliberate and act in at most *fuel* cycles; return whether there is more to do.

    When nothing else needs a cycle, the next one would select the event and the intention of this one. So `execute`
    stays with an intention until something does: another event or intention, or input (`Incoming.called`).
    """
    counts, incoming, always = agent.counts, agent.incoming, agent.options.percept_interval == 1
    end = counts.cycles + fuel
    # New input need not wake the agent meanwhile, and functions in terms are evaluated for it.
    before = RUNNING.set(agent)  # pyright: ignore[reportArgumentType]
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
    if looks and incoming.percepts:
        take_percepts(agent)
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
