"""Intentions that have lost a resource to a more urgent claim: suspended, and resumed when they regain it."""

from jacaros.bdi.rules import goals
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Intention
from jacaros.terms.values import Term, atom, structure


def suspend(agent: Circumstance, number: int, resource: str) -> None:
    """Suspend the intentions with an act, or with a plan that needs something, which has lost a resource."""
    owners = _owners(agent, number)
    if not owners:
        return
    reason = structure("preempted", atom(resource))
    agent.waits.preempted[number] = (reason, owners)
    for intention in owners:
        if intention.suspended is None:
            goals.suspend_intention(agent, intention, reason)


def resume(agent: Circumstance, number: int) -> None:
    """Resume the intentions that were suspended because an act had lost a resource."""
    known = agent.waits.preempted.pop(number, None)
    if known is None:
        return
    reason, owners = known
    for intention in owners:
        if not intention.dropped and goals.is_preempted(intention):
            other = _other_reason(agent, intention)
            if other is None:
                goals.resume_intention(agent, intention, by=reason)
            else:
                intention.suspended = other


def _other_reason(agent: Circumstance, intention: Intention) -> Term:
    """Return the reason for another resource that an intention has lost."""
    return next((reason for reason, owners in agent.waits.preempted.values() if intention in owners), None)


def _owners(agent: Circumstance, number: int) -> list[Intention]:
    """Return the intentions with that act, or with the frame that needs it."""
    waiting = agent.waits.acts.get(number)
    if waiting is not None:
        return [waiting.intention]
    need = agent.waits.needs.get(number)
    return [] if need is None else [each for each in agent.alive.values() if need.is_on(each)]
