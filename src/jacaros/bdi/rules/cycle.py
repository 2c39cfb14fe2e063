"""The reasoning cycle: sense, deliberate, act.

Each cycle takes in new input, handles one event, and lets one intention run one step.
"""

from collections.abc import Iterator
from contextlib import contextmanager

from jacaros.bdi.rules import failure, meta_events, waits
from jacaros.bdi.rules.clr_int import end_achieved_goals
from jacaros.bdi.rules.exec_int import execute, select_intention
from jacaros.bdi.rules.holding import is_held_before_step, take_held_event, take_held_intention
from jacaros.bdi.rules.perceiving import take_percepts
from jacaros.bdi.rules.proc_msg import read_message
from jacaros.bdi.rules.sel_ev import (
    event_of,
    handle_atomic_event,
    handle_event,
    handle_held_event,
    is_ready,
)
from jacaros.bdi.state.circumstance import INTERVAL, Circumstance, HeldEvent
from jacaros.bdi.state.intention import Intention
from jacaros.errors import InternalError
from jacaros.terms.arithmetic import RUNNING


def run(agent: Circumstance, fuel: int) -> bool:
    """Make at most *fuel* cycles; True when there is more to do."""
    if agent.options.search_limit and fuel > 1:
        # Each cycle gets the whole budget of searches.
        return all(run(agent, 1) for _ in range(fuel))
    with turn(agent):
        end = agent.counts.cycles + fuel
        while agent.counts.cycles < end and not agent.stopped:
            if not _cycle(agent):
                return not agent.stopped and has_work(agent)
            if is_done(agent):
                return False
        return not agent.stopped


@contextmanager
def turn(agent: Circumstance) -> Iterator[None]:
    """Mark that an agent has its turn: new input need not wake it, and functions in terms are evaluated for it."""
    begin_turn(agent)
    before = RUNNING.set(agent)  # pyright: ignore[reportArgumentType]
    agent.running = True
    try:
        if agent.sleep == "asleep":
            meta_events.awake(agent)
        yield
    finally:
        agent.running = False
        RUNNING.reset(before)
        if agent.counts.cycles >= agent.counts.next_check:
            look_at_names(agent)


def look_at_names(agent: Circumstance) -> None:
    """Drop the names that the agent no longer uses."""
    agent.beliefs.forget_names()
    agent.counts.next_check = agent.counts.cycles + max(INTERVAL, len(agent.beliefs))


def begin_turn(agent: Circumstance) -> None:
    """Do what is due at the beginning of a turn: renew budgets, and let in the crowd of intentions."""
    options = agent.options
    if options.search_limit and agent.beliefs.budget is not None:
        agent.beliefs.budget.renew()
    if agent.crowd:
        agent.let_in()


def _cycle(agent: Circumstance) -> bool:
    """Run one reasoning cycle; return False if there is nothing to do."""
    if (agent.incoming.called or agent.options.percept_interval != 1) and agent.held is None:
        look_around(agent, agent.counts.cycles)
    return deliberate(agent)


def deliberate(agent: Circumstance) -> bool:
    """Run a reasoning cycle after taking in new input; return False if nothing is left to do, or the agent is held."""
    if agent.held is not None:
        return _continue_held(agent)
    if agent.events:
        _take_up_event(agent)
        if agent.held is not None:
            return False
    return _select_and_execute(agent)


def _continue_held(agent: Circumstance) -> bool:
    """Finish the cycle in which an observer held the agent."""
    if agent.observers.step is not None and agent.observers.step.paused:
        return False
    intention = take_held_intention(agent)
    if intention is not None:
        return _execute(agent, intention)
    ends_cycle = isinstance(agent.held, HeldEvent) and agent.held.ends_cycle
    event = take_held_event(agent)
    if event is not None:
        handle_held_event(agent, event)
        if agent.held is not None:
            return False
    if ends_cycle:
        return True
    return _select_and_execute(agent)


def _select_and_execute(agent: Circumstance) -> bool:
    if agent.features.goal_conditions:
        end_achieved_goals(agent)
    intention = select_intention(agent)
    if intention is None:
        return _waits(agent)
    if is_held_before_step(agent, intention):
        return False
    return _execute(agent, intention)


def _execute(agent: Circumstance, intention: Intention) -> bool:
    try:
        execute(agent, intention)
    except InternalError:
        raise
    except Exception as fault:
        failure.drop_after_error(agent, agent.current or intention, fault)
    agent.counts.cycles += 1
    if agent.waits.requeued:
        agent.events.extendleft(reversed(agent.waits.requeued))
        agent.waits.requeued.clear()
    return True


def _take_up_event(agent: Circumstance) -> None:
    if agent.atomic is not None:
        handle_atomic_event(agent, agent.atomic)
    else:
        handle_event(agent)


def _waits(agent: Circumstance) -> bool:
    """No intention can run a step: return whether one may in the next cycle."""
    if (agent.events and agent.atomic is None) or agent.incoming.messages:
        agent.counts.cycles += 1
        return True
    return bool(agent.incoming or (agent.features.edges and meta_events.fall_asleep(agent)))


def is_done(agent: Circumstance) -> bool:
    """Return whether the next cycle would find nothing to do."""
    return not (
        agent.events or agent.intentions or agent.crowd or agent.incoming.called or agent.features.edges
    )


def has_work(agent: Circumstance) -> bool:
    """Return whether there is something to do."""
    if agent.incoming:
        return True
    if agent.atomic is not None:
        return is_ready(agent, agent.atomic) or event_of(agent, agent.atomic) is not None
    return bool(agent.events or agent.intentions or agent.crowd)


def look_around(agent: Circumstance, cycle: int) -> None:
    """Take in new input: percepts, ends of waits, one message."""
    agent.counts.next_check -= 1  # what comes in may bring new names as any step does
    looks = agent.options.percept_interval == 1 or looks_now(agent, cycle)
    housekeeping(agent, looks)
    if agent.incoming.messages and looks:
        for message in agent.selections.select_messages():
            read_message(agent, message)
    agent.incoming.called = bool(
        agent.incoming
        or agent.waits.conditions.want_a_look()
        or agent.features.special
        or not agent.selections.plain
    )


def looks_now(agent: Circumstance, cycle: int) -> bool:
    """Return whether an agent that does not take in input in every cycle (``nrcbp``) does in this one."""
    if cycle < agent.counts.next_look and (agent.events or agent.intentions or agent.incoming.tasks):
        return False
    agent.counts.next_look = cycle + agent.options.percept_interval
    return True


def housekeeping(agent: Circumstance, looks: bool = True) -> None:
    """Take in input since the last cycle: percepts, ends of waits, conditions that now hold."""
    if agent.incoming.percepts and looks:
        take_percepts(agent)
    do_tasks(agent)
    check_conditions(agent)


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


def check_conditions(agent: Circumstance) -> None:
    """Resume the intentions whose awaited condition now holds."""
    waits.check_conditions(agent)
    do_tasks(agent)
