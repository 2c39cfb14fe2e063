"""The first part of a reasoning cycle: what came in since the last one."""

from jacaros.bdi.rules import rescue, waits
from jacaros.bdi.rules.perceiving import take_percepts
from jacaros.bdi.rules.proc_msg import read_message
from jacaros.bdi.rules.urgency import read_urgent_messages
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.errors import InternalError


def look_around(agent: Circumstance, cycle: int) -> None:
    """Take in what has come since the last look: percepts, ends of waits, one message."""
    agent.next_count -= 1  # what comes in may bring new names as any step does
    looks = agent.options.percept_interval == 1 or looks_now(agent, cycle)
    housekeeping(agent, looks)
    if agent.inbox and looks:
        (read_message if agent.urgency is None else read_urgent_messages)(agent)
    agent.called = bool(
        agent.inbox
        or agent.percepts
        or agent.tasks
        or agent.condition_waits.want_a_look()
        or agent.special
        or agent.urgent
    )


def looks_now(agent: Circumstance, cycle: int) -> bool:
    """Whether an agent that does not look at percepts and messages in every cycle (``nrcbp``) does in this one."""
    if cycle < agent.next_look and (agent.events or agent.intentions or agent.tasks):
        return False
    agent.next_look = cycle + agent.options.percept_interval
    return True


def housekeeping(agent: Circumstance, looks: bool = True) -> None:
    """What came in since the last cycle: percepts, ends of waits, conditions that now hold."""
    if agent.percepts and looks:
        take_percepts(agent)
    do_tasks(agent)
    check_conditions(agent)


def do_tasks(agent: Circumstance) -> None:
    """The housekeeping that is due."""
    while agent.tasks:
        function, arguments = agent.tasks.popleft()
        try:
            function(agent, *arguments)
        except InternalError:
            raise
        except Exception as fault:
            rescue.passed_over(agent, "a delayed change of an intention", fault)


def check_conditions(agent: Circumstance) -> None:
    """Resume the intentions whose awaited condition holds now."""
    waits.check_conditions(agent)
    do_tasks(agent)
