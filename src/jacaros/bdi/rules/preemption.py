"""Intentions that have lost a resource to a more urgent claim: suspended, and resumed when they regain it."""

from jacaros.bdi.rules import goals, needs
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Intention
from jacaros.terms.values import Term


def preempted(agent: Circumstance, number: int, resource: str) -> None:
    """Note that an act, or what a plan needs, has lost a resource; its intention is suspended in the next cycle."""
    agent.do_soon(_suspend, number, needs.reason_of(resource))
    agent.architecture.ready()


def regained(agent: Circumstance, number: int) -> None:
    """Note that the act, or the plan, has it again, or no longer waits for it."""
    agent.do_soon(resume, number)
    agent.architecture.ready()


def _suspend(agent: Circumstance, number: int, reason: Term) -> None:
    owners = _owners(agent, number)
    if not owners:
        return
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
