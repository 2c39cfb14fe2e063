"""The reasoning cycle: sense, deliberate, act.

`run` makes cycles while there is something to do.  With empty queues the next cycle would pick the very event and intention
of this one, so it stays with an intention as long as nothing else wants a cycle (`jacaros.bdi.rules.acting`): that changes
nothing a program can see.
"""

from jacaros.bdi.rules import edge_signals, rescue
from jacaros.bdi.rules.acting import execute, execute_plainly, is_plain
from jacaros.bdi.rules.deliberation import event_of, handle_atomic_event, handle_event, is_ready
from jacaros.bdi.rules.finishing import end_achieved_goals
from jacaros.bdi.rules.sensing import look_around
from jacaros.bdi.rules.urgency import handle_urgent_event
from jacaros.bdi.state.bounded_beliefs import INTERVAL, watch
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Intention
from jacaros.errors import InternalError
from jacaros.terms.arithmetic import RUNNING


def run(agent: Circumstance, fuel: int) -> bool:  # noqa: C901 - written out for speed
    """Make at most *fuel* cycles; True when there is more to do."""
    options = agent.options
    if options.search_limit and agent.beliefs.budget is not None:
        # Each cycle has the whole budget of searches.
        if fuel > 1:
            return all(run(agent, 1) for _ in range(fuel))
        agent.beliefs.budget.renew()
    if agent.crowd:
        agent.let_in()
    # Calls inside terms are evaluated for this agent meanwhile.
    before = RUNNING.set(agent)
    agent.running = True
    try:
        begun = fuel
        if agent.asleep:
            edge_signals.awake(agent)
        events, intentions = agent.events, agent.intentions
        always = options.percept_interval == 1
        while fuel > 0 and not agent.stopped:
            if agent.called or not always:
                look_around(agent, agent.cycles + begun - fuel)
                if agent.urgent:
                    agent.urgency.settle()
                    events, intentions = agent.events, agent.intentions
            intention: Intention | None = None
            if events:
                if agent.atomic is not None:
                    handle_atomic_event(agent, agent.atomic)
                elif agent.urgent:
                    handle_urgent_event(agent)
                else:
                    intention = handle_event(agent)
            if agent.goal_conditions:
                end_achieved_goals(agent)
            if intention is None and (intentions or agent.crowd):
                intention = _select_intention(agent)
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
                elif not (events or intentions or agent.crowd or agent.called or agent.edges):
                    # That was all: the next cycle would find nothing to do.
                    agent.cycles += begun - fuel
                    return False
            elif (events and agent.atomic is None) or agent.inbox:
                fuel -= 1
            elif not (agent.percepts or agent.tasks or (agent.edges and edge_signals.fall_asleep(agent))):
                if not events and agent.atomic is None:
                    agent.cycles += begun - fuel
                    return False
                break
        agent.cycles += begun - fuel
        # Without fuel it was not seen yet that nothing is left to do: that takes another look.
        return not agent.stopped and (fuel <= 0 or _has_work(agent))
    finally:
        agent.running = False
        RUNNING.reset(before)
        if agent.cycles >= agent.next_count:
            _look_at_names(agent)


def _look_at_names(agent: Circumstance) -> None:
    """Drop the names that the agent no longer uses, and bound a belief base that is half full."""
    agent.beliefs.forget_names()
    watch(agent.beliefs, agent, agent.options.belief_limit)
    agent.next_count = agent.cycles + max(INTERVAL, len(agent.beliefs))


def _has_work(agent: Circumstance) -> bool:
    if agent.inbox or agent.percepts or agent.tasks:
        return True
    if agent.atomic is not None:
        return is_ready(agent, agent.atomic) or event_of(agent, agent.atomic) is not None
    return bool(agent.events or agent.intentions or agent.crowd)


def _select_intention(agent: Circumstance) -> Intention | None:
    """Rule SelInt: the atomic one, else round robin."""
    intentions = agent.intentions
    if agent.atomic is not None:
        atomic = agent.atomic
        if not is_ready(agent, atomic):
            return None
        if intentions[-1] is atomic:
            intentions.pop()
        else:
            intentions.remove(atomic)
        return atomic
    while intentions or agent.crowd:
        if not intentions:
            agent.let_in()
        intention = intentions.popleft()
        if intention.dropped:
            continue
        if intention.suspended is not None:
            intention.parked = True
            continue
        return intention
    return None
