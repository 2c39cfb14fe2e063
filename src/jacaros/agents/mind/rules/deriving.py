"""Derived beliefs: changes of beliefs go through patterns of `jacaros.artifacts.streams`, and the results are believed.

Changes are collected until the next cycle, and then get the time of the run's clock. A belief that is replaced within
one cycle (a property with a new value) has not ended in between.
"""

import math
from collections.abc import Iterable
from typing import Any

from jacaros.agents.language import nodes
from jacaros.agents.language.derive import format_derivation, streams_of, values_of
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.rules import belief_update
from jacaros.agents.mind.rules.pending import cancel, now, set_alarm
from jacaros.agents.mind.state.belief_base import Row, take_away
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.pending import Alarm
from jacaros.agents.terms.values import SOURCE_DERIVED, Functor, arguments_of, functor, functor_of
from jacaros.artifacts.streams.operators import HIDE, OCCUR, Values
from jacaros.artifacts.streams.pattern import Pattern, Spec
from jacaros.runtime.trace import Cause

_ANNOTATIONS = (SOURCE_DERIVED,)


class Stream:
    """The beliefs that one literal of a declaration matches.

    Attributes:
        name: how the declarations that share it write it.
        symbol: their functor.
        known: places and values of the arguments that are given.
        values: places of the arguments that are the values of an event; None for all, in order.
        listeners: the patterns, with the number of the stream in each.
        last: place of its newest change among those that wait.
    """

    __slots__ = ("known", "last", "listeners", "name", "symbol", "values")

    def __init__(self, name: str, literal: nodes.Literal) -> None:
        term = lower_value(literal)
        symbol = functor_of(term)
        assert symbol is not None
        self.name, self.symbol = name, symbol
        self.known = [
            (place, value)
            for place, (node, value) in enumerate(zip(literal.arguments, arguments_of(term), strict=True))
            if not isinstance(node, nodes.Variable)
        ]
        places = values_of(literal)
        self.values = None if places == list(range(symbol.arity)) else tuple(places)
        self.listeners: list[tuple[Derived, int]] = []
        self.last = -1

    def matches(self, row: Row) -> bool:
        """Whether a belief with these arguments is one of the stream."""
        for place, value in self.known:  # noqa: SIM110 - no generator for each percept
            if row[place] != value:
                return False
        return True

    def event(self, row: Row) -> Values:
        """The values of an event."""
        return row if self.values is None else tuple([row[place] for place in self.values])

    def believed(self, agent: Circumstance) -> bool:
        """Whether such a belief is held."""
        rows = (entry for entry, _ in agent.beliefs[self.symbol].entries())
        return any(isinstance(entry, tuple) and self.matches(entry) for entry in rows)


class Derived:
    """One active declaration.

    Attributes:
        declared: the declaration in the program.
        text: the same as text, equal for equal declarations.
        pattern: its state.
        scheduled: when it is looked at next.
        row: of the belief that is held, or None.
    """

    __slots__ = ("declared", "owner", "pattern", "row", "scheduled", "text")

    def __init__(self, owner: "DerivedBeliefs", declared: nodes.Derivation, start: float) -> None:
        self.owner, self.declared, self.text = owner, declared, format_derivation(declared)
        spec = Spec(declared.operator, streams_of(declared), dict(declared.options))
        self.pattern = Pattern(spec, start, self._emit)
        self.scheduled = math.inf
        self.row: tuple[Functor, Row] | None = None

    def _emit(self, kind: str, values: Values) -> None:
        agent, cause = self.owner.agent, self.owner.cause
        if kind == OCCUR:
            belief_update.external_change(
                agent, "+", self._symbol(0), (), _ANNOTATIONS, cause, believed=False
            )
            return
        self.forget()
        if kind != HIDE:
            row = tuple([float(value) if isinstance(value, int) else value for value in values])
            self.row = self._symbol(len(row)), row
            belief_update.believe(agent, *self.row, _ANNOTATIONS, cause)

    def forget(self) -> None:
        """Remove the belief, if there is one."""
        if self.row is not None:
            symbol, row = self.row
            self.row = None
            belief_update.disbelieve(self.owner.agent, symbol, row, _ANNOTATIONS)

    def _symbol(self, arity: int) -> Functor:
        return functor(self.declared.name, arity, False, self.declared.namespace)


class DerivedBeliefs:
    """All declarations of one agent.

    Args:
        agent: whose they are.

    Attributes:
        cause: of the change that is being worked on.
    """

    def __init__(self, agent: Circumstance) -> None:
        self.agent = agent
        self.cause: Cause | None = None
        self._all: dict[str, Derived] = {}
        self._streams: dict[Functor, dict[str, Stream]] = {}
        self._pending: list[tuple[Stream, Values | None, Cause | None]] = []
        self._settling = False
        self._alarm: Alarm | None = None
        self._due = math.inf

    @property
    def directives(self) -> list[nodes.Derivation]:
        """All declarations."""
        return [each.declared for each in self._all.values()]

    def declare(self, declared: Iterable[nodes.Derivation]) -> None:
        """Start declarations that are not active yet."""
        start = now(self.agent)
        for each in declared:
            derived = Derived(self, each, start)
            if derived.text in self._all:
                continue
            self._all[derived.text] = derived
            streams = dict(zip(streams_of(each), each.streams, strict=True))
            for number, name in enumerate(derived.pattern.spec.streams):
                stream = Stream(name, streams[name])
                stream = self._streams.setdefault(stream.symbol, {}).setdefault(name, stream)
                stream.listeners.append((derived, number))
            derived.scheduled = derived.pattern.deadline
        self._wait()

    def replace(self, old: nodes.Program, new: nodes.Program) -> None:
        """Replace the declarations of *old* by those of *new*; declarations in both keep their past."""
        for text in texts(old) - texts(new):
            if text in self._all:
                self._end(self._all.pop(text))
        self.declare(new.derived)

    def _end(self, derived: Derived) -> None:
        """End a declaration, and remove its belief."""
        for streams in self._streams.values():
            for name, stream in list(streams.items()):
                stream.listeners = [each for each in stream.listeners if each[0] is not derived]
                if not stream.listeners:
                    del streams[name]
        derived.forget()

    def stored(self, program: nodes.Program) -> dict[str, Any]:
        """Return the remains of the past as data, and the declarations that are not those of a program."""
        own = texts(program)
        return {
            "latest": now(self.agent),
            "derived": [
                (text, each.pattern.state(), None if each.row is None else (*each.row,))
                for text, each in self._all.items()
            ],
            "included": [each.declared for text, each in self._all.items() if text not in own],
            "pending": [(stream.symbol, stream.name, values) for stream, values, _ in self._pending],
        }

    def resume(self, held: dict[str, Any]) -> None:
        """Continue from what was `stored` of an agent; undeclared patterns start anew."""
        self.agent.waits.latest = max(self.agent.waits.latest, held["latest"])
        for text, state, row in held["derived"]:
            if text in self._all:
                self._all[text].pattern.resume(state)
                self._all[text].row = row
        for symbol, name, values in held["pending"]:
            stream = self._streams.get(symbol, {}).get(name)
            if stream is not None:
                stream.last = len(self._pending)
                self._pending.append((stream, values, None))
        if self._alarm is not None:
            cancel(self.agent, self._alarm)
        kept = [each for each in self.agent.waits.alarms.values() if each.function is ring]
        self._alarm = kept[0] if kept else None
        self._due = kept[0].arguments[0] if kept else math.inf
        for derived in self._all.values():
            derived.scheduled = derived.pattern.deadline
        self._wait()

    @property
    def rows(self) -> list[tuple[Functor, Row]]:
        """The derived beliefs that are held."""
        return [each.row for each in self._all.values() if each.row is not None]

    def heard(self, operator: str, symbol: Functor, row: Row, cause: Cause | None) -> None:
        """Handle a belief that was added or deleted, or a signal."""
        streams = self._streams.get(symbol)
        if streams is None:
            return
        for stream in streams.values():
            if not stream.known or stream.matches(row):
                pending = self._pending
                if not pending and not self._settling:
                    self.agent.do_soon(settle)
                stream.last = len(pending)
                pending.append((stream, stream.event(row) if operator == "+" else None, cause))

    def settle(self) -> None:
        """Process pending changes and their consequences."""
        time = now(self.agent)
        self._settling = True
        try:
            while (derived := self._next()) is not None and derived.scheduled <= time:
                if derived.pattern.deadline <= time:
                    derived.pattern.advance(time)
                derived.scheduled = derived.pattern.deadline
            while self._pending:
                pending, self._pending = self._pending, []
                for place, (stream, values, cause) in enumerate(pending):
                    if values is None and (stream.last != place or stream.believed(self.agent)):
                        continue
                    self.cause = cause
                    for derived, number in stream.listeners:
                        derived.pattern.take(number, time, values)
                        derived.scheduled = min(derived.scheduled, derived.pattern.deadline)
        finally:
            self._settling, self.cause = False, None
        self._wait()

    def ring(self, due: float) -> None:
        """The moment *due* has come."""
        if self._alarm is None or due != self._due:
            return  # of a mind that was stored: it has alarms of its own now
        self._alarm = None
        self.agent.waits.latest = max(self.agent.waits.latest, due)
        self.agent.do_soon(settle)
        self.agent.architecture.ready()

    def _next(self) -> Derived | None:
        """Return the declaration that is looked at first; None without any."""
        return min(self._all.values(), key=lambda each: each.scheduled, default=None)

    def _wait(self) -> None:
        """Set one alarm for all; one that rings earlier serves as well."""
        derived = self._next()
        due = math.inf if derived is None else derived.scheduled
        if self._alarm is not None:
            if self._due <= due:
                return
            cancel(self.agent, self._alarm)
            self._alarm = None
        if due < math.inf:
            self._due = due
            self._alarm = set_alarm(self.agent, max(0.0, due - now(self.agent)), ring, due)


def declare(agent: Circumstance, program: nodes.Program) -> None:
    """Start the declarations of a program; an agent without any has no costs."""
    if program.derived:
        _begun(agent).declare(program.derived)


def _begun(agent: Circumstance) -> DerivedBeliefs:
    """Return the declarations of an agent; from the first one on it observes all its beliefs."""
    observers = agent.observers
    if observers.derived is None:
        observers.derived = DerivedBeliefs(agent)
        agent.look_at_observers()
    return _derived(agent)


def texts(program: nodes.Program) -> set[str]:
    """Return the declarations of a program as text."""
    return set(map(format_derivation, program.derived))


def directives(agent: Circumstance) -> list[nodes.Derivation]:
    """Return the declarations of an agent, also those of programs that it has included."""
    return [] if agent.observers.derived is None else _derived(agent).directives


def stored(agent: Circumstance, program: nodes.Program) -> dict[str, Any] | None:
    """Return what the declarations of an agent hold, as data; None without declarations."""
    return None if agent.observers.derived is None else _derived(agent).stored(program)


def resume(agent: Circumstance, program: nodes.Program, held: dict[str, Any] | None) -> None:
    """Continue from what was `stored` of an agent, whose beliefs this one has taken over.

    A declaration that only the program has begins with an empty window.  Beliefs that were derived by one that is gone go.
    """
    declare(agent, program)
    if held is not None:
        declare(agent, nodes.Program(derived=tuple(held["included"])))
        _begun(agent).resume(held)
    kept = [] if agent.observers.derived is None else _derived(agent).rows
    for symbol, table in list(agent.beliefs.items()):
        for entry, annotations in list(table.entries()):
            if SOURCE_DERIVED in annotations and (symbol, entry) not in kept:
                take_away(table, entry, annotations, _ANNOTATIONS)


def replace(agent: Circumstance, old: nodes.Program, new: nodes.Program) -> None:
    """Replace the declarations of the old program by those of a changed one; declarations in both keep their past."""
    if agent.observers.derived is not None:
        _derived(agent).replace(old, new)
    else:
        declare(agent, new)


def settle(agent: Circumstance) -> None:
    """Process pending changes."""
    if agent.observers.derived is not None:
        _derived(agent).settle()


def ring(agent: Circumstance, due: float) -> None:
    """Handle the moment for which some pattern waits."""
    if agent.observers.derived is not None:
        _derived(agent).ring(due)


def _derived(agent: Circumstance) -> DerivedBeliefs:
    derived: Any = agent.observers.derived
    assert isinstance(derived, DerivedBeliefs)
    return derived
