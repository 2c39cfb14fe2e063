"""Copies of a mind: what ``.clone`` gives to the new agent."""

from typing import Any

from jacaros.bdi.rules.forks import copied
from jacaros.bdi.rules.plan_changes import look_at_plans
from jacaros.bdi.rules.searching import Remaining
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import FIRST_SLOT, GOAL, Intention
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.detaching import detached
from jacaros.terms.substitution import rename
from jacaros.terms.values import Term


def copy_mind(original: Circumstance, clone: Circumstance) -> None:
    """Give *clone* the beliefs, rules, plans, events and intentions of *original*.

    The clone is new, and made with the same program without its beliefs and goals.
    The running intention is not copied, nor are those that wait or are suspended, and branches of forks: what
    they wait for belongs to the original.
    """
    copies: dict[int, Term] = {}
    _copy_beliefs(original, clone, copies)
    clone.functions = dict(original.functions)
    clone.namespace_properties = {
        name: {key: detached(value, copies) for key, value in held.items()}
        for name, held in original.namespace_properties.items()
    }
    clone.plans_made = original.plans_made
    clone.library.take_over(original.library)
    look_at_plans(clone)
    for goal, intention, annotations, cause in original.events:
        if intention is None:
            clone.events.append((_copied_goal(goal, copies), None, annotations, cause))
        elif _can_be_copied(original, intention):
            owner = _copied_intention(clone, intention, copies)
            clone.events.append((_copied_goal(goal, copies), owner, annotations, cause))
    for intention in (*original.intentions, *original.crowd):
        if _can_be_copied(original, intention):
            clone.intentions.append(_copied_intention(clone, intention, copies))


def _copy_beliefs(original: Circumstance, clone: Circumstance, copies: dict[int, Term]) -> None:
    for symbol, table in original.beliefs.items():
        other = clone.beliefs[symbol]
        for entry, annotations in table.rows.items():
            other.add(_copied_entry(entry, copies), annotations)
        for entry, annotations in table.late.items():
            other.add(_copied_entry(entry, copies), annotations, last=True)


def _copied_entry(entry: Any, copies: dict[int, Term]) -> Any:
    """A row with collections of its own; rules and open facts do not change."""
    return tuple(detached(a, copies) for a in entry) if entry.__class__ is tuple else entry


def _copied_goal(goal: Goal, copies: dict[int, Term]) -> Goal:
    return (goal[0], *(detached(rename(argument), copies) for argument in goal[1:]))


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


def _copied_intention(clone: Circumstance, intention: Intention, copies: dict[int, Term]) -> Intention:
    copy = clone.new_intention(intention.cause)
    copy.frames = copied(intention.frames)
    for frame in copy.frames:
        frame[GOAL] = _copied_goal(frame[GOAL], copies)
        frame[FIRST_SLOT:] = [
            value if isinstance(value, Remaining) else detached(value, copies) for value in frame[FIRST_SLOT:]
        ]
    copy.handlers = list(intention.handlers)
    return copy
