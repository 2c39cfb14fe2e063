"""Changes of beliefs that are facts.

Replaces `add_belief`, `replace_belief` and `delete_belief` of `jacaros.bdi.rules.belief_update`. Rarer cases are left to
these.
"""

from typing import Any

from jacaros.bdi.rules.belief_update import deleted, external_change, own_event
from jacaros.bdi.rules.searching import unify_rows
from jacaros.bdi.state.belief_base import Row
from jacaros.bdi.state.event import Raised
from jacaros.terms.substitution import ATOMIC, is_key
from jacaros.terms.unifier import undo
from jacaros.terms.values import BY_SELF, Functor, Term

Annotations = tuple[Term, ...]


def add_belief(agent: Any, symbol: Functor, row: Row, annotations: Annotations) -> Raised:
    """``+b`` of a fact that is not held yet."""
    table = agent.beliefs[symbol]
    if not (table.plain and agent.features.usual_events and _is_keyed(row)) or row in table.rows:
        posted: Raised = agent.add_belief(symbol, row, annotations)
        return posted
    new = table.add(row, annotations)
    if new is not BY_SELF or agent.waits.conditions:
        return own_event(agent, symbol, row, new)
    kind, library = table.added, agent.library
    if library.selects[kind] is None and not (
        agent.events
        or agent.intentions
        or agent.waits.events
        or (library.reactions.of and library.reactions[kind])
    ):
        return None
    return (kind, *row)


def replace_belief(agent: Any, symbol: Functor, row: Row, annotations: Annotations) -> Raised:
    """``-+b`` where the newest belief is one of the agent's own."""
    table = agent.beliefs[symbol]
    rows = table.rows
    if not (annotations is BY_SELF and rows and table.plain and agent.features.usual_events) or (
        rows[newest := next(reversed(rows))] is not BY_SELF
    ):
        posted: Raised = agent.replace_belief(symbol, row, annotations)
        return posted
    table.remove(newest)
    library = agent.library
    if (
        library.selects[table.deleted] is not None
        or agent.waits.events
        or agent.waits.conditions
        or library.reactions.of
    ):
        external_change(agent, "-", symbol, newest, BY_SELF)
    return add_belief(agent, symbol, row, annotations)


def delete_belief(
    agent: Any, symbol: Functor, arguments: Row, annotations: Annotations, apart: bool
) -> Raised:
    """``-b`` and ``--b`` where all facts that may match are the agent's own: the first match goes as a whole."""
    table = agent.beliefs[symbol]
    if annotations is BY_SELF and table.plain and agent.features.usual_events:
        trail = agent.trail
        for fact in table.rows_like(arguments):
            if table.rows[fact] is not BY_SELF:
                break
            mark = len(trail)
            if unify_rows(arguments, fact, trail):
                table.remove(fact)
                if apart:
                    undo(trail, mark)
                return deleted(agent, symbol, fact, BY_SELF, apart)
            undo(trail, mark)
        else:
            return None
    posted: Raised = agent.delete_belief(symbol, arguments, annotations, apart)
    return posted


def _is_keyed(row: Row) -> bool:
    """Whether a belief is found by its arguments; most are numbers, strings and atoms."""
    for argument in row:  # noqa: SIM110 - `all` would make a generator for every belief
        if argument.__class__ not in ATOMIC and not is_key(argument):
            return False
    return True
