"""Events at the edges of an agent's life: it falls asleep, awakes, is to be shut down.

They are raised only when there are plans for them.
"""

from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.triggers import trigger
from jacaros.terms.values import BY_SELF, functor

SLEEPING = trigger("+", "", functor("jag_sleeping", 0))
AWAKING = trigger("+", "", functor("jag_awaking", 0))
SHUTTING_DOWN = trigger("+", "", functor("jag_shutting_down", 1))


def fall_asleep(agent: Circumstance) -> bool:
    """There is nothing to do: True when a plan for ``+jag_sleeping`` is to be tried before the agent sleeps."""
    if agent.drowsy or not agent.is_idle():
        agent.asleep = agent.drowsy
        return False
    agent.drowsy = agent.asleep = True
    if not agent.may_handle(SLEEPING):
        return False
    agent.asleep = False
    agent.post(((SLEEPING,), None, BY_SELF, None))
    return True


def awake(agent: Circumstance) -> None:
    """Something has come up: ``+jag_awaking``."""
    if agent.asleep and not agent.is_idle():
        agent.asleep = agent.drowsy = False
        if agent.may_handle(AWAKING):
            agent.post(((AWAKING,), None, BY_SELF, None))


def shutting_down(agent: Circumstance, milliseconds: float) -> None:
    """The agent will be ended after so many milliseconds: ``+jag_shutting_down(Ms)``."""
    if agent.may_handle(SHUTTING_DOWN):
        agent.post(((SHUTTING_DOWN, milliseconds), None, BY_SELF, None))
        agent.architecture.ready()
