"""Calls that are made later: at a moment of the run's clock, at an event, or when a condition holds.

Conditions are found by the beliefs that they ask for, so a change of other beliefs costs them nothing.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.state.belief_base import BeliefTables, Row
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import EVENT_GOAL, Event, event_literal
from jacaros.agents.mind.state.pending import Asked, Pending, PendingCondition, PendingEvent, PendingTimer
from jacaros.agents.mind.state.triggers import Trigger
from jacaros.agents.terms.substitution import ATOMIC, rename
from jacaros.agents.terms.unifier import undo, unify
from jacaros.agents.terms.values import (
    ACTION,
    ARITHMETIC,
    LOGIC,
    PLAIN,
    RELATION,
    Annotated,
    Functor,
    List,
    Term,
    Var,
    arguments_of,
    deref,
    functor_of,
)
from jacaros.runtime.errors import InternalError


def now(agent: Circumstance) -> float:
    """Return the time of the agent: that of the run's clock, continued from its latest value if it was set back."""
    waits = agent.waits
    time = agent.architecture.now() + waits.ahead
    if time < waits.latest:
        waits.ahead += waits.latest - time
        time = waits.latest
    waits.latest = time
    return time


def cancel(agent: Circumstance, pending: Pending) -> None:
    """Cancel a call; no effect if it has been made."""
    waits, number = agent.waits, pending.number
    if isinstance(pending, PendingTimer):
        if waits.alarms.pop(number, None) is not None:
            pending.timer.cancel()
    elif isinstance(pending, PendingEvent):
        _take_out(waits.events, (pending.kind,), number)
    elif isinstance(pending, PendingCondition) and waits.conditions.pop(number, None) is not None:
        waits.restless.pop(number, None)
        waits.due.pop(number, None)
        for place in pending.asked or ():
            _take_out(waits.asked, place, number)


def _take_out(index: dict[Any, Any], place: tuple[Any, ...], number: int) -> None:
    """Take a call out of nested dictionaries; none is left empty."""
    if not place:
        index.pop(number, None)
    elif place[0] in index:
        _take_out(index[place[0]], place[1:], number)
        if not index[place[0]]:
            del index[place[0]]


def _numbered(agent: Circumstance) -> int:
    agent.waits.made += 1
    return agent.waits.made


# --- moments -----------------------------------------------------------------------------------------------


_ROUNDED = 0.001
"""By how many seconds a timer may ring early."""


def set_alarm(
    agent: Circumstance, delay: float, function: Callable[..., None], *arguments: Any
) -> PendingTimer:
    """Call *function* with the agent and the arguments after *delay* seconds of the run's clock."""
    alarm = PendingTimer(_numbered(agent), function, arguments, now(agent) + delay)
    agent.waits.alarms[alarm.number] = alarm
    start_alarm(agent, alarm, delay)
    return alarm


def start_alarm(agent: Circumstance, alarm: PendingTimer, delay: float) -> None:
    """Have the host ring after *delay* seconds."""
    alarm.timer = agent.architecture.set_timer(delay, partial(_ring, agent, alarm))


def _ring(agent: Circumstance, alarm: PendingTimer) -> None:
    del agent.waits.alarms[alarm.number]
    early = alarm.due - now(agent)
    if early > _ROUNDED:
        agent.waits.ahead += early  # the clock was set back: that it rings says how much time has passed
    alarm.function(agent, *alarm.arguments)


# --- events ------------------------------------------------------------------------------------------------


def listen(
    agent: Circumstance, kind: Trigger | None, pattern: Term, function: Callable[..., None], *arguments: Any
) -> PendingEvent:
    """Call *function* with the agent and the arguments at the next event of a kind (None: of any) that matches."""
    listener = PendingEvent(_numbered(agent), function, arguments, kind, pattern)
    agent.waits.events.setdefault(kind, {})[listener.number] = listener
    return listener


def notify_listeners(agent: Circumstance, event: Event) -> None:
    """Make the calls that are pending until this event, in the order in which they were made."""
    events = agent.waits.events
    heard = {**events.get(event[EVENT_GOAL][0], {}), **events.get(None, {})}
    for _, listener in sorted(heard.items()):
        mark = len(agent.trail)
        if unify(listener.pattern, rename(event_literal(event)), agent.trail):
            # The bindings of the pattern are permanent, whatever the search for the event's plan undoes.
            del agent.trail[mark:]
            cancel(agent, listener)
            listener.function(agent, *listener.arguments)
        else:
            undo(agent.trail, mark)


# --- conditions --------------------------------------------------------------------------------------------


def watch(
    agent: Circumstance, condition: Term, function: Callable[..., None], *arguments: Any
) -> PendingCondition:
    """Call *function* once a condition holds, with its bindings, or cannot be evaluated.

    Its arguments are the agent, None or the exception if it cannot be evaluated, and *arguments*.
    """
    asked = asked_by(condition, agent.beliefs, agent.engine.actions)
    waits, number = agent.waits, _numbered(agent)
    made = PendingCondition(number, function, arguments, condition, asked)
    waits.conditions[number] = waits.due[number] = made
    if asked is None:
        waits.restless[number] = made
    for symbol, places, values in asked or ():
        waits.asked.setdefault(symbol, {}).setdefault(places, {}).setdefault(values, {})[number] = made
    agent.incoming.called = True
    return made


def note_change(agent: Circumstance, symbol: Functor, row: Row) -> None:
    """Note that a belief changed: conditions that depend on such beliefs are tested again."""
    waits = agent.waits
    for places, by_values in waits.asked.get(symbol, {}).items():
        values = tuple(row[place] for place in places)
        if ATOMIC.issuperset(map(type, values)):
            waits.due.update(by_values.get(values, ()))
        else:
            for held in by_values.values():
                waits.due.update(held)
    if waits.due or waits.restless:
        agent.do_soon(look_again)


def look_again(_: Circumstance) -> None:
    """Do nothing: a task that makes the agent test conditions again."""


def note_rule(agent: Circumstance, symbol: Functor) -> None:
    """Note that there is a new rule for a predicate: conditions that ask for it may depend on anything."""
    for by_values in agent.waits.asked.get(symbol, {}).values():
        for held in by_values.values():
            agent.waits.restless.update(held)
    agent.do_soon(look_again)


def check_conditions(agent: Circumstance) -> None:
    """Make the calls whose conditions now hold, in the order in which they were made."""
    waits = agent.waits
    due, waits.due = {**waits.restless, **waits.due}, {}
    for number, made in sorted(due.items()):
        if number not in waits.conditions:
            continue
        held, fault = is_true(agent, made.condition)
        if held:
            cancel(agent, made)
            made.function(agent, fault, *made.arguments)


def is_true(agent: Circumstance, condition: Term) -> tuple[bool, Exception | None]:
    """Return whether a condition holds, with lasting bindings; True and the fault if it cannot be evaluated."""
    try:
        held = agent.context.succeeds(condition)
    except InternalError:
        raise
    except Exception as fault:
        undo(agent.trail, 0)
        return True, fault
    del agent.trail[:]
    return held, None


def asked_by(
    formula: Term, beliefs: BeliefTables, actions: Mapping[str, InternalAction]
) -> list[Asked] | None:
    """Return the beliefs that a condition depends on; None when it may depend on anything.

    Facts alone are followed: rules, internal actions and functions may look at whatever they like.
    """
    asked: list[Asked] = []
    todo = [formula]
    while todo:
        term = deref(todo.pop())
        symbol, arguments = functor_of(term), arguments_of(term)
        if symbol is None:
            return None
        if symbol.kind == LOGIC:
            todo.extend(arguments)
        elif symbol.kind == ACTION:
            action = actions.get(symbol.name)
            if action is None or not action.is_collecting(len(arguments)):
                return None
            *template, inner, result = arguments
            todo.append(inner)
            if not _is_passive((*template, result)):
                return None
        elif symbol.kind == PLAIN:
            if not (_is_passive((term,)) and beliefs[symbol].holds_facts_only()):
                return None
            known = [(place, deref(value)) for place, value in enumerate(arguments)]
            known = [(place, value) for place, value in known if value.__class__ in ATOMIC]
            asked.append((symbol, tuple(place for place, _ in known), tuple(value for _, value in known)))
        elif symbol.kind != RELATION or not _is_passive(arguments):
            return None
    return asked


def _is_passive(terms: Iterable[Term]) -> bool:
    """Return whether terms stay what they are: they hold no collections, objects and calls of functions."""
    todo = list(terms)
    while todo:
        term = todo.pop()
        kind = term.__class__
        if kind is tuple:
            if term[0].kind not in (PLAIN, ARITHMETIC):
                return False
            todo.extend(term[1:])
        elif kind is List:
            todo.extend(term.from_bottom())
        elif kind is Annotated:
            todo.append(term.term)
            todo.extend(term.annotations)
            if term.tail is not None:
                todo.append(term.tail)
        elif kind is Var:
            if term.ref is not None:
                todo.append(term.ref)
        elif kind not in ATOMIC:
            return False
    return True
