"""Copies of a mind: what ``.clone`` gives to the new agent."""

from jacaros.bdi.circumstance import Circumstance
from jacaros.bdi.event import Event
from jacaros.bdi.forks import copied
from jacaros.bdi.intention import Intention
from jacaros.bdi.plan_changes import look_at_plans
from jacaros.terms.unifier import rename


def copy_mind(original: Circumstance, clone: Circumstance) -> None:
    """Give *clone* the beliefs, rules, plans, events and intentions of *original*.

    The clone is new, and made with the same program without its beliefs and goals.
    The running intention is not copied, nor are those that wait or are suspended, and branches of forks: what
    they wait for belongs to the original.
    """
    _copy_beliefs(original, clone)
    clone.functions = dict(original.functions)
    clone.namespace_properties = {name: dict(held) for name, held in original.namespace_properties.items()}
    clone.plans_made = original.plans_made
    clone.library.take_over(original.library)
    look_at_plans(clone)
    for event in original.events:
        if event.intention is None:
            clone.events.append(Event(_copied_goal(event.goal), None, event.annotations, event.cause))
        elif _can_be_copied(original, event.intention):
            owner = _copied_intention(clone, event.intention)
            clone.events.append(Event(_copied_goal(event.goal), owner, event.annotations, event.cause))
    for intention in original.intentions:
        if _can_be_copied(original, intention):
            clone.intentions.append(_copied_intention(clone, intention))


def _copy_beliefs(original: Circumstance, clone: Circumstance) -> None:
    for symbol, table in original.beliefs.items():
        other = clone.beliefs[symbol]
        for entry, annotations in table.rows.items():
            other.add(entry, annotations)
        for entry, annotations in table.late.items():
            other.add(entry, annotations, last=True)


def _copied_goal(goal: tuple[object, ...]) -> tuple[object, ...]:
    return (goal[0], *(rename(argument) for argument in goal[1:]))


def _can_be_copied(agent: Circumstance, intention: Intention) -> bool:
    return not (
        intention is agent.current
        or intention.dropped
        or intention.waiting is not None
        or intention.suspended is not None
        or intention.forks
        or intention.outer is not None
        or intention.on_failed is not None
    )


def _copied_intention(clone: Circumstance, intention: Intention) -> Intention:
    copy = clone.new_intention(intention.cause)
    copy.frames = copied(intention.frames)
    copy.handlers = list(intention.handlers)
    return copy
