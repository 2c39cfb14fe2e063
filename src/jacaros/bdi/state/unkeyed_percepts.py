"""Percepts that cannot be looked up by what they say: those with very long or deeply nested terms, which Python could not
compare or hash, and those with sets or maps, of which every agent needs its own.

Such a percept is told from others by the very arguments that its property was written with, and is a belief by itself.
"""

from jacaros.bdi.state.belief_base import Row, literal, take_away
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.rule import OpenFact
from jacaros.terms.detaching import detached, holds_collection
from jacaros.terms.substitution import is_key
from jacaros.terms.values import Functor, Term

Annotations = tuple[Term, ...]


def is_unkeyed(row: Row) -> bool:
    """Whether a percept with these arguments is one of those."""
    return any(not is_key(argument) or holds_collection(argument) for argument in row)


def own_row(row: Row) -> Row:
    """The arguments, with sets and maps of the agent's own."""
    return tuple(map(detached, row))


def take(agent: Circumstance, symbol: Functor, row: Row, annotations: Annotations) -> Row | None:
    """Believe a percept; gives the arguments of the belief, None when the base has no room for it."""
    table = agent.beliefs[symbol]
    own = own_row(row)
    belief = OpenFact(literal(symbol, own), annotations)
    if table.add(belief, annotations) is None:
        return None
    # The arguments are kept with it: their identities stay theirs.
    agent.held_percepts[_key(symbol, row)] = belief, row, own
    return own


def forget(agent: Circumstance, symbol: Functor, row: Row, annotations: Annotations) -> Row | None:
    """Give a percept up; gives the arguments of the belief, None when it is not held any more."""
    known = agent.held_percepts.pop(_key(symbol, row), None)
    if known is None:
        return None
    belief, _, own = known
    table = agent.beliefs[symbol]
    held = table.get(belief)
    if held is None:
        return None
    take_away(table, belief, held, annotations)
    arguments: Row = own
    return arguments


def _key(symbol: Functor, row: Row) -> tuple[object, ...]:
    # No literal begins with None.
    return (None, symbol, *map(id, row))
