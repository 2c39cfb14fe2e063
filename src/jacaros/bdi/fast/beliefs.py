"""Changes of beliefs that are facts, and percepts that change such beliefs.

Replaces `add_belief`, `replace_belief` and `delete_belief` of `jacaros.bdi.rules.belief_update`, and `take_in` of
`jacaros.bdi.rules.perceiving`. Rarer cases are left to these.
"""

from typing import Any

from jacaros.bdi.rules import perceiving
from jacaros.bdi.rules.belief_update import deleted, external_change, own_event
from jacaros.bdi.rules.searching import unify_rows
from jacaros.bdi.state.act import Percept
from jacaros.bdi.state.belief_base import BeliefTables, Row, Table
from jacaros.bdi.state.bounded_beliefs import BoundedBeliefs, BoundedTable
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.engine import Engine
from jacaros.bdi.state.event import Raised
from jacaros.bdi.state.mixed_beliefs import discard
from jacaros.errors import InternalError
from jacaros.terms.substitution import ATOMIC, is_key
from jacaros.terms.unifier import undo
from jacaros.terms.values import BY_SELF, Functor, Term, arguments_of, functor_of

Annotations = tuple[Term, ...]
SMALL = 100_000
"""Limits up to this one are kept from the beginning."""
Kept = list[Any]
"""Functor and arguments of a percept (None unless they are flat), the kind of its event, and the event once it is made."""


def add_belief(agent: Any, symbol: Functor, row: Row, annotations: Annotations) -> Raised:
    """``+b`` of a fact that is not held yet."""
    table = agent.beliefs[symbol]
    if not (table.plain and agent.features.usual_events and _is_keyed(row)) or row in table.rows:
        posted: Raised = agent.add_belief(symbol, row, annotations)
        return posted
    new = table.add(row, annotations)
    if new is not BY_SELF or agent.waits.conditions:
        return own_event(agent, symbol, row, new)
    kind = table.added
    if agent.library.selects[kind] is None and not (
        agent.events or agent.intentions or agent.waits.events or agent.features.subplans
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
    if (
        agent.library.selects[table.deleted] is not None
        or agent.waits.events
        or agent.waits.conditions
        or agent.features.subplans
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


# --- percepts ----------------------------------------------------------------------------------------------------


def take_in(agent: Circumstance, percepts: list[Percept]) -> None:  # noqa: C901 - written out for speed
    """Take in what was noticed in one step, where its events go into the queue as they are."""
    if not _is_usual(agent, len(percepts)):
        perceiving.take_in(agent, percepts)
        return
    beliefs, holders, selects, events = (
        agent.beliefs,
        agent.beliefs.held_percepts,
        agent.library.selects,
        agent.events,
    )
    derived, mind, urgencies = agent.observers.derived, agent.observers.mind, agent.selections.urgencies
    for percept in percepts:
        kept = percept.kept or _keep(agent, percept)
        symbol, row, change, event = kept
        table = beliefs[symbol]
        if row is None or not table.plain or table.indexes or table.__class__ is not Table:
            perceiving.take(agent, percept)
            continue
        # Nearly all percepts are structures shown by one property only: two table lookups.
        rows, literal, annotations = table.rows, percept.literal, percept.annotations
        if percept.kind == "add":
            if literal in holders or row in rows:
                perceiving.take(agent, percept)
                continue
            rows[row] = holders[literal] = annotations
        elif percept.kind == "remove":
            if holders.get(literal) is not annotations or rows.get(row) is not annotations:
                perceiving.take(agent, percept)
                continue
            discard(rows, row)
            del holders[literal]
        if derived is not None:
            derived.heard("-" if percept.kind == "remove" else "+", symbol, row, percept.cause)
        if mind is not None and percept.kind in ("add", "remove"):
            mind.changed("+" if percept.kind == "add" else "-", symbol, row, annotations, percept.cause)
        if selects[change] is not None:
            if event is None:
                event = kept[3] = ((change, *row), None, annotations, percept.cause)
            if urgencies is not None and urgencies[change]:
                agent.selections.rank()
            events.append(event)


def _is_usual(agent: Circumstance, count: int) -> bool:
    """Return whether events need only be queued; derived beliefs and a `MindObserver` must be notified."""
    return (
        not agent.waits.events
        and not agent.waits.conditions
        and not agent.features.subplans
        and agent.observers.step is None
        and agent.options.events == "discard"
        and len(agent.events) + count <= agent.options.event_limit
        and len(agent.alive) < agent.options.intention_limit
    )


def _keep(agent: Circumstance, percept: Percept) -> Kept:
    """What is kept with a percept for all minds that share it."""
    literal = percept.literal
    symbol, row = (
        (literal[0], literal[1:])
        if literal.__class__ is tuple
        else (functor_of(literal), arguments_of(literal))
    )
    if symbol is None:
        raise InternalError(f"a percept is not a literal: {literal!r}")
    table = agent.beliefs[symbol]
    change = table.deleted if percept.kind == "remove" else table.added
    flat: Row | None = row
    for argument in row:
        if argument.__class__ not in ATOMIC:
            flat = None
            break
    percept.kept = kept = [symbol, flat, change, None]
    return kept


# --- limits ------------------------------------------------------------------------------------------------------


def belief_base(engine: Engine, agent: Any, limit: int) -> BeliefTables:
    """Return a belief base that counts only if its limit is small; otherwise `watch` makes it count once it is half
    full.
    """
    return BoundedBeliefs(agent, limit, engine) if limit <= SMALL else BeliefTables(engine)


def watch(agent: Circumstance) -> None:
    """Count the beliefs from now on if half of the limit is reached."""
    beliefs, limit = agent.beliefs, agent.options.belief_limit
    if beliefs.__class__ is not BeliefTables or 2 * sum(map(len, beliefs.values())) < limit:
        return
    for table in beliefs.values():
        if table.__class__ is Table:
            table.__class__ = BoundedTable
    beliefs.__class__ = BoundedBeliefs
    assert isinstance(beliefs, BoundedBeliefs)
    beliefs.bind(agent, limit)
