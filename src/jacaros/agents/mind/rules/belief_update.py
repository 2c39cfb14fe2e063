"""Changes of beliefs and the events they raise (Jason's brf and buf), by steps, from outside, and by percepts.

The functions for body formulae return the event to be handled by the same intention, or None when it has no plan.
"""

from collections.abc import Iterator
from typing import Any

from jacaros.agents.mind.rules.pending import note_change, note_rule
from jacaros.agents.mind.rules.searching import unify_rows
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.mind.state.belief_base import Row, Table, literal, parts, take_away, with_source
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import EVENT_GOAL, EVENT_INTENTION, GOAL, Intention, Posted, Raised
from jacaros.agents.mind.state.plan import OpenFact, Rule
from jacaros.agents.mind.state.triggers import Trigger, resolve_all
from jacaros.agents.terms.collections import detached, holds_collection
from jacaros.agents.terms.order import merge_annotations
from jacaros.agents.terms.substitution import ATOMIC, is_key, rename, resolve
from jacaros.agents.terms.unifier import undo, unify_annotations
from jacaros.agents.terms.values import (
    BY_SELF,
    SOURCE_PERCEPT,
    Annotations,
    Functor,
    Term,
    Var,
    arguments_of,
    atom,
    functor,
    functor_of,
)
from jacaros.runtime.errors import InternalError
from jacaros.runtime.trace import Cause

_OBSERVABLE_PROPERTY = (functor("percept_type", 1), atom("obs_prop"))


def add_belief(
    agent: Circumstance,
    symbol: Functor,
    row: Row,
    annotations: Annotations,
    last: bool = False,
    own: bool = True,
) -> Raised:
    """``+b``, and ``+>b`` (*last*), which answers last: the event belongs to the intention that made it.

    That of ``++b`` (not *own*) is an external one.
    """
    table = agent.beliefs[symbol]
    new = insert(table, row, annotations, last)
    return None if new is None else raise_event(agent, table.added, row if own else _copied(row), new, own)


def replace_belief(agent: Circumstance, symbol: Functor, row: Row, annotations: Annotations) -> Raised:
    """``-+b``: the first belief with these annotations goes, whatever its arguments, and the new one comes.

    The event of the first half is external.
    """
    table = agent.beliefs[symbol]
    rows = table.rows
    if annotations is BY_SELF and rows and table.plain and rows[newest := next(reversed(rows))] is BY_SELF:
        table.remove(newest)
        raise_event(agent, table.deleted, newest, BY_SELF)
    else:
        delete_any(agent, symbol, annotations)
    new = insert(table, row, annotations)
    return None if new is None else raise_event(agent, table.added, row, new, True)


def _copied(row: Row) -> Row:
    """The arguments of an external event of a step: they share no variable with the step."""
    names: dict[Var, Var] = {}
    return tuple(rename(argument, names) for argument in row)


def raise_event(
    agent: Circumstance,
    kind: Trigger,
    row: Row,
    annotations: Annotations,
    own: bool = False,
    cause: Cause | None = None,
    believed: bool = True,
) -> Raised:
    """Raise the event of a belief that changed, or (not *believed*) of a signal, if a plan or observer needs it.

    Args:
        agent: whose belief it is.
        kind: of the event.
        row: the arguments of the belief.
        annotations: those that came or went.
        own: a step has changed it: the event is for its intention, and returned. Others are external, and queued.
        cause: why it changed; None for what the agent is doing.
        believed: whether there is such a belief.
    """
    options, waits, observers = agent.options, agent.waits, agent.observers
    if observers.hear_beliefs:
        cause = cause or agent.cause_now()
        if believed and observers.mind is not None:
            observers.mind.changed(kind.operator, kind.functor, row, annotations, cause)
        if observers.step is not None and agent.library.selects[kind] is None:
            observers.step.notes_unhandled(agent, (kind, *row), annotations)
    if waits.conditions:
        note_change(agent, kind.functor, row)
    if (
        agent.library.selects[kind] is None
        and options.events == "discard"
        and not waits.events
        # With nothing in between, the event would only be taken up and skipped.
        and not (own and (agent.events or agent.intentions) and not options.new_focus)
    ):
        return None
    if own and not options.new_focus:
        return (kind, *row) if annotations is BY_SELF else Posted((kind, *row), annotations)
    agent.post(((kind, *(_copied(row) if own else row)), None, annotations, cause))
    return None


def insert(table: Table, row: Row, annotations: Annotations, last: bool = False) -> Annotations | None:
    """Add a belief; return its new annotations, or None (then there is no event)."""
    for argument in row:  # most are numbers, strings and atoms
        if argument.__class__ not in ATOMIC and not is_key(argument):
            return _insert_aside(table, row, annotations, last)
    held = table.rows.get(row) if not table.late else table.get(row)
    return table.add(row, annotations, last) if held is None else _merge(table, row, held, annotations)


def _merge(table: Table, entry: Any, held: Annotations, annotations: Annotations) -> Annotations | None:
    """Add what is new to the annotations of a belief."""
    merged, new = merge_annotations(held, annotations)
    if not new:
        return None
    table.set(entry, merged)
    return new


def _insert_aside(table: Table, row: Row, annotations: Annotations, last: bool) -> Annotations | None:
    """Add a belief whose arguments are not keys (variables, annotations, very long lists): found by unification."""
    known = table.aside(row)
    if known is not None:
        held = table.get(known)
        return _merge(table, known, held or (), annotations)
    return table.add(OpenFact(rename(literal(table.functor, row)), annotations), annotations, last)


def delete_belief(
    agent: Circumstance, symbol: Functor, arguments: Row, annotations: Annotations, apart: bool
) -> Raised:
    """``-b`` and ``--b``: remove the given annotations (at least the agent's own source) of the first match."""
    if _is_property(agent, symbol, arguments, annotations):
        return None
    removed = _remove_first(agent, symbol, arguments, annotations, bind=not apart)
    if removed is None:
        return None
    deleted = agent.beliefs[symbol].deleted
    return raise_event(agent, deleted, _copied(removed) if apart else removed, annotations, own=not apart)


def _is_property(agent: Circumstance, symbol: Functor, arguments: Row, annotations: Annotations) -> bool:
    """Return whether ``-b[source(percept)]`` names one observable property: only its artifact may change it.

    As in CArtAgO, only ``-b(_)[source(percept)]`` removes one (and ``.abolish``).
    """
    if SOURCE_PERCEPT not in annotations:
        return False
    row = tuple(map(resolve, arguments))
    if not all(map(is_key, row)):
        return False
    held = agent.beliefs.held_percepts.get((symbol, *row) if row else symbol)
    if held is None:
        return False
    return _OBSERVABLE_PROPERTY in (held[0][0] if held.__class__ is list else held)


def _remove_first(
    agent: Circumstance, symbol: Functor, arguments: Row, annotations: Annotations, bind: bool
) -> Row | None:
    """Remove the first match; return the row of the pattern with variables bound, or None if nothing matches."""
    table, trail = agent.beliefs[symbol], agent.trail
    for entry, held in table.candidates(arguments):
        mark = len(trail)
        row = _row_of(entry)
        if (
            row is not None
            and unify_rows(arguments, row, trail)
            and (held is annotations or unify_annotations(annotations, None, held, None, trail))
        ):
            found = resolve_all(arguments)
            if held is annotations:
                table.remove(entry)
            else:
                take_away(table, entry, held, resolve_all(annotations))
            if not bind:
                undo(trail, mark)
            return found
        undo(trail, mark)
    return None


def _row_of(entry: Any) -> Row | None:
    """The arguments of an entry of a table; None for a rule."""
    if isinstance(entry, OpenFact):
        return arguments_of(entry.head())
    return entry if entry.__class__ is tuple else None


def delete_any(agent: Circumstance, symbol: Functor, annotations: Annotations = BY_SELF) -> None:
    """The first half of ``-+b``: the first belief with these annotations goes, whatever its arguments.

    Its event is external.
    """
    arguments = tuple(Var() for _ in range(symbol.arity))
    removed = _remove_first(agent, symbol, arguments, annotations, bind=False)
    if removed is not None:
        raise_event(agent, agent.beliefs[symbol].deleted, removed, resolve_all(annotations))


# --- from outside ------------------------------------------------------------------------------------------


def tell(agent: Circumstance, term: Term, cause: Cause | None = None) -> bool:
    """Add a belief from outside (a message, the project file); the event is external. Return False if it is not a
    literal.
    """
    symbol, row, annotations = parts(term)
    if symbol is None:
        return False
    believe(agent, symbol, row, with_source(annotations), cause)
    return True


def believe(
    agent: Circumstance, symbol: Functor, row: Row, annotations: Annotations, cause: Cause | None = None
) -> None:
    """The same for a literal in parts, with a source among its annotations."""
    table = agent.beliefs[symbol]
    new = insert(table, row, annotations)
    if new is not None:
        raise_event(agent, table.added, row, new, cause=cause)


def untell(agent: Circumstance, term: Term, cause: Cause | None = None) -> bool:
    """Remove a source of a belief; the event is external."""
    symbol, row, annotations = parts(term)
    if symbol is None:
        return False
    annotations = with_source(annotations)
    removed = _remove_first(agent, symbol, row, annotations, bind=False)
    if removed is not None:
        raise_event(agent, agent.beliefs[symbol].deleted, removed, annotations, cause=cause)
    return removed is not None


def abolish(agent: Circumstance, pattern: Term) -> None:
    """``.abolish``: delete all matches, with all their sources, whichever of them the pattern names."""
    symbol, arguments, annotations = parts(pattern)
    for table in list(agent.beliefs.values()) if symbol is None else [agent.beliefs[symbol]]:
        for entry, held in list(table.candidates(arguments) if symbol else table.entries()):
            _abolish_entry(agent, table, entry, held, arguments if symbol else None, annotations)


def _abolish_entry(
    agent: Circumstance,
    table: Table,
    entry: Any,
    held: Annotations,
    arguments: Row | None,
    annotations: Annotations,
) -> None:
    row = _row_of(entry)
    if row is None:
        return
    trail = agent.trail
    mark = len(trail)
    matches = (arguments is None or unify_rows(arguments, row, trail)) and (
        not annotations or unify_annotations(annotations, None, held, None, trail)
    )
    undo(trail, mark)
    if matches:
        table.remove(entry)
        raise_event(agent, table.deleted, row, held)


def add_rule(agent: Circumstance, rule: Rule, head: Functor, last: bool) -> None:
    """Add a rule at run time; rules raise no events."""
    if agent.waits.conditions:
        note_rule(agent, head)
    agent.beliefs[head].add(rule, rule.head_annotations(), last)


# Percepts become beliefs: changes noticed by the body are added or removed, and raise events, in order.
#
# A sensor that is faster than its agent checks whether the last percept has been handled before it sends another one.


Kept = tuple[Functor, Row, bool]
Holder = tuple[Annotations, Any, Row, Row]
"""Of a property among several with the same values: its annotations, its entry, its row in the base, and as perceived."""


def take_percepts(agent: Circumstance, percepts: list[Percept]) -> None:
    """Add or remove the beliefs of percepts, and raise their events.

    Raises:
        InternalError: a literal of a percept is not a literal.
    """
    beliefs, selects = agent.beliefs, agent.library.selects
    holders = beliefs.held_percepts
    # Often nothing but plans for its event needs to know of a belief that changes.
    waits, options, post = agent.waits, agent.options, agent.post
    quiet = options.events == "discard" and not (
        waits.events or waits.conditions or agent.observers.hear_beliefs
    )
    few = (
        len(agent.events) + len(percepts) <= options.event_limit
        and len(agent.alive) < options.intention_limit
    )
    if quiet and few and agent.selections.urgencies is None:
        post = agent.events.append  # type: ignore[assignment]
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
            raise_event(agent, trigger, row, annotations, cause=percept.cause, believed=believed)
        elif selects[trigger] is not None:
            post(((trigger, *row), None, annotations, percept.cause))


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


# Properties with the same values are beliefs of their own, each with its own annotations. Python could not compare or hash
# very long or deeply nested terms, and of sets and maps every agent needs its own: such a percept is identified by the
# argument objects of its property, and is a belief by itself, too.


def _take_unusual(
    agent: Circumstance, symbol: Functor, row: Row, percept: Percept, keyed: bool
) -> Row | None:
    """Take a percept that others agree with, or that cannot be looked up (not *keyed*).

    Return what it changed, with sets and maps of the agent's own; None if the base has no room for the belief, or no
    longer holds it.
    """
    own = row if keyed else tuple(map(detached, row))
    if percept.kind == "signal":
        return own
    # No literal begins with None.
    key = percept.literal if keyed else (None, symbol, *map(id, row))
    held_percepts, table, annotations = (
        agent.beliefs.held_percepts,
        agent.beliefs[symbol],
        percept.annotations,
    )
    known = held_percepts.pop(key, None)
    holders: list[Holder] = (
        known if known.__class__ is list else [] if known is None else [(known, row, own, row)]
    )
    if percept.kind == "remove":
        return _forget(table, key, percept, holders, row, held_percepts)
    entry: Any = row
    if keyed and not holders:
        held = insert(table, row, annotations) is not None or table.get(row) is not None
    else:
        entry = OpenFact(literal(symbol, own), annotations)
        held = table.add(entry, annotations) is not None
    if held:
        # The arguments are kept with it: their identities stay theirs.
        holders.append((annotations, entry, own, row))
    if holders:
        held_percepts[key] = annotations if holders == [(annotations, row, own, row)] else holders
    return own if held else None


def _forget(
    table: Table, key: Any, percept: Percept, holders: list[Holder], row: Row, held_percepts: dict[Term, Any]
) -> Row | None:
    """Remove the belief of one property; others may have the same values."""
    # Of two properties of one artifact the annotations are equal, too: either may go.
    place = next((i for i, holder in enumerate(holders) if holder[0] == percept.annotations), None)
    _, entry, own, _ = (None, row, row, row) if place is None else holders.pop(place)
    if holders:
        held_percepts[key] = holders
    held = table.get(entry)
    if held is None:
        return None
    take_away(table, entry, held, percept.annotations)
    return own


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
