"""Percepts become beliefs: changes noticed by the body are added or removed, and raise events, in order.

A sensor that is faster than its agent checks whether the last percept has been handled before it sends another one.
"""

from collections.abc import Iterator
from typing import Any

from jacaros.agents.mind.rules import failure
from jacaros.agents.mind.rules.belief_update import external_change, insert, is_quiet
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.mind.state.belief_base import Row, Table, literal, take_away
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import EVENT_GOAL, EVENT_INTENTION, GOAL, Intention
from jacaros.agents.mind.state.plan import OpenFact
from jacaros.agents.mind.state.triggers import Trigger
from jacaros.agents.terms.collections import detached, holds_collection
from jacaros.agents.terms.substitution import ATOMIC, is_key
from jacaros.agents.terms.values import Functor, Term, arguments_of, functor_of
from jacaros.errors import InternalError

Annotations = tuple[Term, ...]
Kept = tuple[Functor, Row, bool]
Holder = tuple[Annotations, Any]
"""The annotations of a property among several with the same values, and the entry of its belief in the table."""


def take_percepts(agent: Circumstance) -> None:
    """Bring the belief base in line with what was noticed; a fault skips the rest of a step."""
    while agent.incoming.percepts:
        percepts = agent.incoming.percepts.popleft()
        try:
            _take(agent, percepts, is_quiet(agent))
        except InternalError:
            raise
        except Exception as fault:
            failure.report_skipped(agent, "percepts", fault)


def _take(agent: Circumstance, percepts: list[Percept], quiet: bool) -> None:
    """Add or remove the beliefs of percepts, and raise their events; of *quiet* ones only plans want to know.

    Raises:
        InternalError: a literal of a percept is not a literal.
    """
    beliefs, selects, reactions = agent.beliefs, agent.library.selects, agent.library.reactions
    holders, reacts = beliefs.held_percepts, bool(reactions.of)
    for percept in percepts:
        symbol, row, keyed = percept.kept or _keep(percept)
        kind, shown, annotations = percept.kind, percept.literal, percept.annotations
        table = beliefs[symbol]
        trigger = table.added
        if kind == "add" and keyed and shown not in holders and row not in table.rows and not table.late:
            if table.add(row, annotations) is None:
                continue
            holders[shown] = annotations
        elif kind == "remove" and keyed and holders.get(shown) is annotations is table.rows.get(row):
            trigger = table.deleted
            del holders[shown]  # nothing else makes the agent believe it
            table.remove(row)
        elif kind != "signal" or not keyed:
            trigger = table.deleted if kind == "remove" else table.added
            changed = _take_unusual(agent, symbol, row, percept, keyed)
            if changed is None:
                continue
            row = changed
        if not quiet:
            believed = kind != "signal"
            external_change(agent, trigger.operator, symbol, row, annotations, percept.cause, believed)
        elif selects[trigger] is not None or (reacts and reactions[trigger]):
            agent.post(((trigger, *row), None, annotations, percept.cause))


def _take_unusual(
    agent: Circumstance, symbol: Functor, row: Row, percept: Percept, keyed: bool
) -> Row | None:
    """Take a percept that others agree with, or that cannot be looked up; return what it changed."""
    if percept.kind == "add":
        return (_believe if keyed else _believe_unkeyed)(agent, symbol, row, percept)
    if percept.kind == "remove":
        return (_forget if keyed else _forget_unkeyed)(agent, symbol, row, percept)
    return _own_row(row)


def _keep(percept: Percept) -> Kept:
    """Keep functor and arguments of a percept for all minds that share it, and whether it can be looked up by these."""
    literal = percept.literal
    if literal.__class__ is tuple:
        symbol, row = literal[0], literal[1:]
    else:
        symbol, row = functor_of(literal), arguments_of(literal)
    if symbol is None:
        raise InternalError(f"a percept is not a literal: {literal!r}")
    keyed = True
    for argument in row:  # nearly all are numbers, strings and atoms
        if argument.__class__ not in ATOMIC and (not is_key(argument) or holds_collection(argument)):
            keyed = False
    percept.kept = kept = symbol, row, keyed
    return kept


def _believe(agent: Circumstance, symbol: Functor, row: Row, percept: Percept) -> Row | None:
    """Add a percept to a belief that is already held, by the agent or for other properties with the same values.

    Return None if the base has no room for it.
    """
    known = agent.beliefs.held_percepts.get(percept.literal)
    if known is not None:
        return _believe_apart(agent, symbol, row, percept, known)
    if insert(agent, symbol, row, percept.annotations) is None and agent.beliefs[symbol].get(row) is None:
        return None
    agent.beliefs.held_percepts[percept.literal] = percept.annotations
    return row


def _believe_apart(
    agent: Circumstance, symbol: Functor, row: Row, percept: Percept, known: Any
) -> Row | None:
    """Add a property beside others with the same values, as a belief of its own with its own annotations.

    Return None if the base has no room for it.
    """
    belief = OpenFact(literal(symbol, row), percept.annotations)
    if agent.beliefs[symbol].add(belief, percept.annotations) is None:
        return None
    holders: list[Holder] = known if known.__class__ is list else [(known, row)]
    holders.append((percept.annotations, belief))
    agent.beliefs.held_percepts[percept.literal] = holders
    return row


def _forget(agent: Circumstance, symbol: Functor, row: Row, percept: Percept) -> Row | None:
    """Remove the belief of one property; others may have the same values.

    Return None if the belief is no longer held.
    """
    known = agent.beliefs.held_percepts.pop(percept.literal, None)
    holders: list[Holder] = known if known.__class__ is list else [] if known is None else [(known, row)]
    # Of two properties of one artifact the annotations are equal, too: either may go.
    place = next((i for i, holder in enumerate(holders) if holder[0] == percept.annotations), None)
    entry = row if place is None else holders.pop(place)[1]
    if holders:
        agent.beliefs.held_percepts[percept.literal] = holders
    return row if _take_away(agent.beliefs[symbol], entry, percept) else None


def _take_away(table: Table, entry: Any, percept: Percept) -> bool:
    """Remove the annotations of a percept from its belief; return False if it is no longer held."""
    held = table.get(entry)
    if held is not None:
        take_away(table, entry, held, percept.annotations)
    return held is not None


# --- percepts that cannot be looked up by what they say --------------------------------------------------------

# Python could not compare or hash very long or deeply nested terms, and of sets and maps every agent needs its own.  Such
# a percept is identified by the argument objects of its property, and is a belief by itself.


def _own_row(row: Row) -> Row:
    """The arguments, with sets and maps of the agent's own."""
    return tuple(map(detached, row))


def _believe_unkeyed(agent: Circumstance, symbol: Functor, row: Row, percept: Percept) -> Row | None:
    own = _own_row(row)
    belief = OpenFact(literal(symbol, own), percept.annotations)
    if agent.beliefs[symbol].add(belief, percept.annotations) is None:
        return None
    # The arguments are kept with it: their identities stay theirs.
    agent.beliefs.held_percepts[_identity(symbol, row)] = belief, row, own
    return own


def _forget_unkeyed(agent: Circumstance, symbol: Functor, row: Row, percept: Percept) -> Row | None:
    belief, _, own = agent.beliefs.held_percepts.pop(_identity(symbol, row), (None, row, row))
    return own if belief is not None and _take_away(agent.beliefs[symbol], belief, percept) else None


def _identity(symbol: Functor, row: Row) -> tuple[object, ...]:
    # No literal begins with None.
    return (None, symbol, *map(id, row))


# --- backpressure: whether an agent has handled its percepts ----------------------------------------------------


def is_untaken(agent: Circumstance, name: str) -> bool:
    """Return whether a change of a belief called *name* has still to be noticed or handled, or its plan has still to
    run.

    A plan that waits (for an action, a time, a condition) has had its turn.
    """
    for percepts in agent.incoming.percepts:
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
    for event in agent.events:
        intention = event[EVENT_INTENTION]
        if intention is not None:
            yield intention
