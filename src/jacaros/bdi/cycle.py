"""The reasoning cycle: sense, deliberate, act.

`run` makes cycles while there is something to do.  With empty queues the next cycle would pick the very event and intention
of this one, so it stays with an intention as long as nothing else wants a cycle (`jacaros.bdi.acting`): that changes
nothing a program can see.
"""

from jacaros.bdi import edge_signals, rescue
from jacaros.bdi.acting import execute, execute_plainly, is_plain
from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.deliberation import handle_atomic_event, handle_event
from jacaros.bdi.event import EVENT_INTENTION
from jacaros.bdi.finishing import end_achieved_goals
from jacaros.bdi.intention import Intention
from jacaros.bdi.sensing import housekeeping, looks_around
from jacaros.bdi.speech_acts import read_message
from jacaros.bdi.urgency import handle_urgent_event, read_urgent_messages
from jacaros.errors import InternalError


def run(agent: Circumstance, fuel: int) -> bool:  # noqa: C901 - written out for speed
    """Make at most *fuel* cycles; True when there is more to do."""
    begun = fuel
    if agent.asleep:
        edge_signals.awake(agent)
    percepts, tasks, inbox = agent.percepts, agent.tasks, agent.inbox
    events, intentions = agent.events, agent.intentions
    handle, read = (
        (handle_event, read_message) if agent.urgency is None else (handle_urgent_event, read_urgent_messages)
    )
    always = agent.options.percept_interval == 1
    while fuel > 0 and not agent.stopped:
        if agent.called or not always:
            looks = always or looks_around(agent, agent.cycles + begun - fuel)
            if percepts or tasks or agent.condition_waits:
                housekeeping(agent, looks)
                if agent.urgency is not None:
                    # The queues may have been put in order of urgency just now.
                    events, intentions = agent.events, agent.intentions
                    handle, read = handle_urgent_event, read_urgent_messages
            if inbox and looks:
                read(agent)
            agent.called = bool(inbox or percepts or tasks or agent.condition_waits or agent.special)
        if events:
            if agent.atomic is None:
                handle(agent)
            else:
                handle_atomic_event(agent, agent.atomic)
        if agent.goal_conditions:
            end_achieved_goals(agent)
        intention = _select_intention(agent) if intentions else None
        if intention is not None:
            try:
                fuel = (execute_plainly if is_plain(agent) else execute)(agent, intention, fuel)
            except InternalError:
                raise
            except Exception as fault:
                fuel -= 1
                rescue.give_up(agent, agent.current or intention, fault)
            if agent.requeued:
                events.extendleft(reversed(agent.requeued))
                agent.requeued.clear()
        elif (events and agent.atomic is None) or inbox:
            fuel -= 1
        elif not (percepts or tasks or (agent.edges and edge_signals.fall_asleep(agent))):
            break
    agent.cycles += begun - fuel
    if agent.stopped:
        return False
    if inbox or percepts or tasks:
        return True
    if agent.atomic is not None:
        atomic = agent.atomic
        return atomic in intentions or any(e[EVENT_INTENTION] is atomic for e in events)
    return bool(events or intentions)


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
