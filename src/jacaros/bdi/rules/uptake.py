"""Whether an agent has taken up what it perceived: a sensor that is faster than its agent asks before it tells more."""

from collections.abc import Iterator

from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import EVENT_GOAL, EVENT_INTENTION
from jacaros.bdi.state.intention import GOAL, Intention
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.values import functor_of


def is_untaken(agent: Circumstance, name: str) -> bool:
    """Whether a change of a belief called *name* has still to be noticed or handled, or its plan has still to run.

    A plan that waits (for an action, a time, a condition) has had its turn.
    """
    for percepts in agent.percepts:
        for each in percepts:
            symbol = functor_of(each.literal)
            if symbol is not None and symbol.name == name:
                return True
    for event in agent.events:
        if event[EVENT_INTENTION] is None and _is_change(event[EVENT_GOAL][0], name):
            return True
    if agent.current is not None and agent.current.waiting is None and _handles(agent.current, name):
        return True
    return any(_handles(each, name) for each in _queued(agent)) if agent.intentions or agent.events else False


def _handles(intention: Intention, name: str) -> bool:
    """Whether an intention's first plan is for a change of a belief called *name*."""
    return bool(intention.frames) and _is_change(intention.frames[0][GOAL][0], name)


def _is_change(kind: Trigger, name: str) -> bool:
    return kind.kind == "" and kind.functor.name == name


def _queued(agent: Circumstance) -> Iterator[Intention]:
    """The intentions that wait for nothing but their turn."""
    yield from agent.intentions
    yield from agent.crowd
    for event in agent.events:
        intention = event[EVENT_INTENTION]
        if intention is not None:
            yield intention
