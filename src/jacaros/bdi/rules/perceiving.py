"""Percepts become beliefs: what bodies have noticed is believed or forgotten, and raises events, in its order.

A sensor that is faster than its agent asks whether the last percept has been taken up before it tells more.
"""

from collections.abc import Iterator
from typing import Any

from jacaros.bdi.rules import failure
from jacaros.bdi.rules.belief_update import external_change, insert, look_again
from jacaros.bdi.state import unkeyed_percepts
from jacaros.bdi.state.act import Percept
from jacaros.bdi.state.belief_base import Row, Table, parts, take_away
from jacaros.bdi.state.belief_base import literal as belief_literal
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import EVENT_GOAL, EVENT_INTENTION, Event
from jacaros.bdi.state.intention import GOAL, Intention
from jacaros.bdi.state.rule import OpenFact
from jacaros.bdi.state.triggers import Trigger
from jacaros.errors import InternalError
from jacaros.terms.substitution import ATOMIC
from jacaros.terms.values import Functor, Term, functor_of

Annotations = tuple[Term, ...]
Holder = tuple[Annotations, Any]
"""The annotations of a property among several with the same values, and the entry of its belief in the table."""


def take_percepts(agent: Circumstance) -> None:
    """Bring the belief base in line with what was noticed, and raise the events, in order."""
    beliefs, holders, selects = agent.beliefs, agent.held_percepts, agent.selects
    post = agent.events.append if _has_plain_queue(agent) else agent.post
    watched = bool(agent.event_waits or agent.subplans or agent.options.events != "discard")
    noticed, waits = agent.percepts, agent.condition_waits
    while noticed:
        percepts = noticed.popleft()
        try:
            if waits:
                for percept in percepts:
                    symbol, row, _, _ = percept.taken or _taken(agent, percept)
                    waits.changed(symbol, row)
            if len(percepts) == 2 and not watched:
                # What is usual, for many agents many times a second: one property has another value.
                old, new = percepts
                exchange = old.exchange
                if exchange is None or exchange[0] is not new:
                    exchange = _exchange(agent, old, new)
                _, symbol, row, new_row, removed, added = exchange
                if symbol is not None and new.literal not in holders:
                    annotations = new.annotations
                    held_by = holders.pop(old.literal, None)
                    table = beliefs[symbol]
                    if (
                        held_by is annotations
                        and table.__class__ is Table
                        and table.exchange(row, new_row, annotations)
                    ):
                        holders[new.literal] = annotations
                        if selects[removed] is not None:
                            post(old.event or _event(old, removed, row))
                        if selects[added] is not None:
                            post(new.event or _event(new, added, new_row))
                        continue
                    if held_by is not None:
                        holders[old.literal] = held_by
            _apply(agent, percepts, watched)
        except InternalError:
            raise
        except Exception as fault:
            failure.passed_over(agent, "what was perceived", fault)
    if waits and waits.want_a_look():
        agent.do_soon(look_again)


def _has_plain_queue(agent: Circumstance) -> bool:
    """Whether events need only be put into the queue, and there is room for them."""
    return (
        agent.urgency is None
        and len(agent.events) < agent.event_limit
        and len(agent.alive) < agent.intention_limit
    )


def _apply(agent: Circumstance, percepts: list[Percept], watched: bool) -> None:
    """Bring the belief base in line with what was noticed at once, and raise the events, in order."""
    beliefs, holders, selects = agent.beliefs, agent.held_percepts, agent.selects
    post = agent.events.append if _has_plain_queue(agent) else agent.post
    for percept in percepts:
        literal, annotations, kind = percept.literal, percept.annotations, percept.kind
        symbol, row, is_flat, change = percept.taken or _taken(agent, percept)
        if is_flat is None:
            _take_unkeyed(agent, percept, symbol, row)
            continue
        # Nearly all percepts are structures that only one property shows: that needs a look into two tables.
        if kind == "add":
            table = beliefs[symbol]
            if (
                literal in holders
                or table.__class__ is not Table
                or not is_flat
                or not table.begin(row, annotations)
            ):
                if not _take_percept(agent, symbol, row, literal, annotations):
                    continue
            else:
                holders[literal] = annotations
        elif kind == "remove":
            held_by = holders.pop(literal, None)
            table = beliefs[symbol]
            if (
                held_by is not annotations or table.__class__ is not Table or not table.end(row, annotations)
            ) and not _forget_percept(agent, symbol, row, literal, annotations, held_by):
                continue
        if watched:
            external_change(agent, change.operator, symbol, row, annotations, percept.cause)
        elif selects[change] is not None:
            post(percept.event or _event(percept, change, row))


Taken = tuple[Functor, Row, bool | None, Trigger]


def _taken(agent: Circumstance, percept: Percept) -> Taken:
    """Functor and arguments of a percept, whether these are flat (None: not even to be looked up), and the kind of its
    event; kept with it for all who share it."""
    literal = percept.literal
    if literal.__class__ is tuple:
        symbol, row = literal[0], literal[1:]
    else:
        symbol, row, _ = parts(literal)
        if symbol is None:
            raise InternalError(f"a percept is no literal: {literal!r}")
    table = agent.beliefs[symbol]
    change = table.deleted if percept.kind == "remove" else table.added
    is_flat: bool | None = True
    for argument in row:
        if argument.__class__ not in ATOMIC:
            is_flat = None if unkeyed_percepts.is_unkeyed(row) else False
            break
    taken: Taken = (symbol, row, is_flat, change)
    percept.taken = taken
    return taken


def _event(percept: Percept, change: Trigger, row: Row) -> Event:
    """The event of a percept, kept with it for all who share it."""
    event: Event = ((change, *row), None, percept.annotations, percept.cause)
    percept.event = event
    return event


def _exchange(
    agent: Circumstance, old: Percept, new: Percept
) -> tuple[Percept, Functor | None, Row, Row, Trigger, Trigger]:
    """Two percepts as one change of a belief: the second, functor, both rows, and the kinds of the events; kept with the
    first.  Without a functor they are something else."""
    symbol, row, is_flat, removed = old.taken or _taken(agent, old)
    new_symbol, new_row, new_is_flat, added = new.taken or _taken(agent, new)
    alike = new_symbol is symbol and is_flat and new_is_flat and old.annotations is new.annotations
    is_one = alike and old.kind == "remove" and new.kind == "add"
    exchange = (new, symbol if is_one else None, row, new_row, removed, added)
    old.exchange = exchange
    return exchange


def _take_unkeyed(agent: Circumstance, percept: Percept, symbol: Functor, row: Row) -> None:
    """Take in a percept that cannot be looked up by what it says."""
    annotations = percept.annotations
    own: Row | None
    if percept.kind == "add":
        own = unkeyed_percepts.take(agent, symbol, row, annotations)
    elif percept.kind == "remove":
        own = unkeyed_percepts.forget(agent, symbol, row, annotations)
    else:
        own = unkeyed_percepts.own_row(row)
    if own is not None:
        operator = "-" if percept.kind == "remove" else "+"
        external_change(agent, operator, symbol, own, annotations, percept.cause)


def _take_percept(
    agent: Circumstance, symbol: Functor, row: Row, literal: Term, annotations: Annotations
) -> bool:
    """Add a percept whose literal may be held already, by the agent or for other properties with the same values.

    False when the base has no room for it.
    """
    known = agent.held_percepts.get(literal)
    if known is not None:
        return _believe_apart(agent, symbol, row, literal, annotations, known)
    refusals = agent.beliefs.refusals
    insert(agent, symbol, row, annotations)
    if agent.beliefs.refusals != refusals:
        return False
    agent.held_percepts[literal] = annotations
    return True


def _believe_apart(
    agent: Circumstance, symbol: Functor, row: Row, literal: Term, annotations: Annotations, known: Any
) -> bool:
    """Believe a property beside others with the same values: a belief of its own, with its own annotations.

    False when the base has no room for it.
    """
    belief = OpenFact(belief_literal(symbol, row), annotations)
    if agent.beliefs[symbol].add(belief, annotations) is None:
        return False
    holders: list[Holder] = known if known.__class__ is list else [(known, row)]
    holders.append((annotations, belief))
    agent.held_percepts[literal] = holders
    return True


def _forget_percept(
    agent: Circumstance, symbol: Functor, row: Row, literal: Term, annotations: Annotations, known: Any
) -> bool:
    """Give up the belief of one property; others may have the same values.

    False when the belief is not held any more.
    """
    holders: list[Holder] = known if known.__class__ is list else [] if known is None else [(known, row)]
    # Of two properties of one artifact the annotations are equal, too: either may go.
    place = next((i for i, holder in enumerate(holders) if holder[0] == annotations), None)
    entry = row if place is None else holders.pop(place)[1]
    if holders:
        agent.held_percepts[literal] = holders
    table = agent.beliefs[symbol]
    held = table.get(entry)
    if held is None:
        return False
    take_away(table, entry, held, annotations)
    return True


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
