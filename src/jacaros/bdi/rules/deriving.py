"""Derived beliefs: changes of beliefs go through patterns of `jacaros.streams`, and what follows is believed.

Changes are kept until the next look around, and get the time of the run's clock then. A belief that is replaced within one
look (a property with a new value) has not ended in between.
"""

import heapq
import itertools
import math
from collections.abc import Iterable
from typing import Any

from jacaros.asl import nodes
from jacaros.asl.directives.derive import streams_of, values_of
from jacaros.asl.lowering import lower_value
from jacaros.bdi.rules import belief_update
from jacaros.bdi.rules.alarms import cancel_alarm, set_alarm
from jacaros.bdi.rules.past import History, is_kept
from jacaros.bdi.state.belief_base import Item, Row, take_away
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.waiting import Alarm
from jacaros.streams.operator import HIDE, OCCUR, Values
from jacaros.streams.pattern import Pattern
from jacaros.streams.schema import Spec
from jacaros.terms.values import Functor, Term, arguments_of, atom, functor, functor_of
from jacaros.trace import Cause

SOURCE_DERIVED: Term = (functor("source", 1), atom("derived"))
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
    """One declaration at work.

    Attributes:
        pattern: its state.
        scheduled: when it is looked at next.
        row: of the belief that is held, None for none.
    """

    __slots__ = ("name", "namespace", "owner", "pattern", "row", "scheduled")

    def __init__(self, owner: "DerivedBeliefs", declared: nodes.Derivation, start: float) -> None:
        self.owner, self.name, self.namespace = owner, declared.name, declared.namespace
        spec = Spec(declared.operator, streams_of(declared), dict(declared.options), turns=declared.turns)
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
        """Give up the belief, if there is one."""
        if self.row is not None:
            symbol, row = self.row
            self.row = None
            belief_update.disbelieve(self.owner.agent, symbol, row, _ANNOTATIONS)

    def _symbol(self, arity: int) -> Functor:
        return functor(self.name, arity, False, self.namespace)


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
        self._declared: list[nodes.Derivation] = []
        self._all: list[Derived] = []
        self._streams: dict[Functor, dict[str, Stream]] = {}
        self._pending: list[tuple[Stream, Values | None, Cause | None]] = []
        self._histories: dict[Functor, History] = {}
        self._changed: list[tuple[History, Row]] = []
        self._settling = False
        self._queue: list[tuple[float, int, Derived]] = []
        self._numbers = itertools.count()
        self._alarm: Alarm | None = None
        self._due = math.inf
        self._latest, self._offset = agent.architecture.now(), 0.0

    def keep(self, declared: Iterable[nodes.History]) -> None:
        """Begin with histories that are not kept yet; of two for the same beliefs the longer one."""
        for each in declared:
            symbol = functor_of(lower_value(each.belief))
            assert symbol is not None
            history = self._histories.get(symbol)
            if history is None:
                history = self._histories[symbol] = History(symbol, each.window)
                self._look_at(history)
            history.window = max(history.window, each.window)

    def _look_at(self, history: History) -> None:
        """Compare a history with the present beliefs."""
        for row in history.rows(self.agent.beliefs[history.functor]):
            self._change(history, row)

    def _change(self, history: History, row: Row) -> None:
        """Have a belief looked at that may have come or gone."""
        if not self._changed and not self._settling:
            self.agent.do_soon(settle)
        self._changed.append((history, row))

    def _note(self, now: float) -> None:
        """Write the changes that wait into the histories."""
        changed, self._changed = self._changed, []
        for history, row in changed:
            if is_kept(row):
                history.note(self.agent.beliefs[history.functor], row, now)

    def past(self, symbol: Functor, milliseconds: Term) -> list[Item] | None:
        """Return what was believed that time ago, newest first; None if no history of such beliefs is kept."""
        history = self._histories.get(symbol)
        if history is None:
            return None
        now = self._now()
        self._note(now)
        if not isinstance(milliseconds, float) or not 0.0 <= milliseconds <= history.window * 1000.0:
            return []
        return history.at(now - milliseconds / 1000.0)

    def declare(self, declared: Iterable[nodes.Derivation]) -> None:
        """Begin with declarations that are not there yet."""
        start = self._now()
        for each in declared:
            if each in self._declared:
                continue
            self._declared.append(each)
            derived = Derived(self, each, start)
            self._all.append(derived)
            streams = dict(zip(streams_of(each), each.streams, strict=True))
            for number, name in enumerate(derived.pattern.spec.streams):
                stream = Stream(name, streams[name])
                stream = self._streams.setdefault(stream.symbol, {}).setdefault(name, stream)
                stream.listeners.append((derived, number))
            self._schedule(derived)
        self._wait()

    def end(self) -> None:
        """Give up all declarations, with their beliefs."""
        for derived in self._all:
            derived.forget()
        self._declared, self._all, self._streams, self._pending, self._queue = [], [], {}, [], []
        self._histories, self._changed = {}, []
        self._wait()

    def stored(self) -> dict[str, Any]:
        """Return what the past has left, as data."""
        self._note(self._now())
        return {
            "histories": [(symbol, history.state()) for symbol, history in self._histories.items()],
            "latest": self._latest,
            "patterns": [
                (each.pattern.state(), None if each.row is None else (*each.row,)) for each in self._all
            ],
            "pending": [(stream.symbol, stream.name, values) for stream, values, _ in self._pending],
        }

    def resume(self, held: dict[str, Any]) -> None:
        """Continue from what was `stored` of an agent with the same program."""
        self._latest = held["latest"]
        for derived, (state, row) in zip(self._all, held["patterns"], strict=True):
            derived.pattern.resume(state)
            derived.row = row
        for symbol, state in held.get("histories", ()):
            history = self._histories.get(symbol)
            if history is not None:
                history.resume(state)
                self._look_at(history)
        for symbol, name, values in held["pending"]:
            stream = self._streams[symbol][name]
            stream.last = len(self._pending)
            self._pending.append((stream, values, None))
        if self._alarm is not None:
            cancel_alarm(self.agent, self._alarm)
        kept = [each for each in self.agent.waits.alarms.values() if each.function is ring]
        self._alarm = kept[0] if kept else None
        self._due = kept[0].arguments[0] if kept else math.inf
        self._queue = []
        for derived in self._all:
            derived.scheduled = math.inf
            self._schedule(derived)
        self._wait()

    def heard(self, operator: str, symbol: Functor, row: Row, cause: Cause | None) -> None:
        """Hear of a belief that came or went, or of a signal."""
        if self._histories and (history := self._histories.get(symbol)) is not None:
            self._change(history, row)
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
        """Work on the changes that wait, and on what follows from them."""
        now = self._now()
        self._settling = True
        try:
            while self._queue and self._queue[0][0] <= now:
                self._advance(now)
            while self._pending:
                pending, self._pending = self._pending, []
                for place, (stream, values, cause) in enumerate(pending):
                    if values is None and (stream.last != place or stream.believed(self.agent)):
                        continue
                    self.cause = cause
                    for derived, number in stream.listeners:
                        derived.pattern.take(number, now, values)
                        if derived.pattern.deadline < derived.scheduled:
                            self._schedule(derived)
        finally:
            self._settling, self.cause = False, None
            self._note(now)
        self._wait()

    def ring(self, due: float) -> None:
        """The moment *due* has come."""
        if self._alarm is None or due != self._due:
            return  # of a mind that was stored: it has alarms of its own now
        self._alarm = None
        self._latest = max(self._latest, due)
        self.agent.do_soon(settle)
        self.agent.architecture.ready()

    def _now(self) -> float:
        """The time of the run's clock; when that is set back, time goes on from where it was."""
        now = self.agent.architecture.now() + self._offset
        if now < self._latest:
            self._offset += self._latest - now
            now = self._latest
        self._latest = now
        return now

    def _advance(self, now: float) -> None:
        _, _, derived = heapq.heappop(self._queue)
        derived.scheduled = math.inf
        if derived.pattern.deadline <= now:
            derived.pattern.advance(now)
        self._schedule(derived)

    def _schedule(self, derived: Derived) -> None:
        due = derived.pattern.deadline
        if due < derived.scheduled:
            derived.scheduled = due
            heapq.heappush(self._queue, (due, next(self._numbers), derived))

    def _wait(self) -> None:
        """Set one alarm for all; one that rings earlier serves as well."""
        due = self._queue[0][0] if self._queue else math.inf
        if self._alarm is not None:
            if self._due <= due:
                return
            cancel_alarm(self.agent, self._alarm)
            self._alarm = None
        if due < math.inf:
            self._due = due
            self._alarm = set_alarm(self.agent, max(0.0, due - self._latest), ring, due)


def declare(agent: Circumstance, program: nodes.Program) -> None:
    """Begin with the declarations of a program; an agent without any has no costs."""
    if not (program.derived or program.histories):
        return
    observers = agent.observers
    if observers.derived is None:
        observers.derived = DerivedBeliefs(agent)
        observers.hear_beliefs = True
        # What is written out for speed tells nobody of changes that no plan handles.
        agent.features.usual_events = observers.usual_events = False
    _derived(agent).keep(program.histories)
    _derived(agent).declare(program.derived)


def begin_anew(agent: Circumstance, program: nodes.Program) -> None:
    """Begin with empty windows, after beliefs of before have been taken over: derived ones among them go."""
    for table in list(agent.beliefs.values()):
        for entry, annotations in list(table.entries()):
            if SOURCE_DERIVED in annotations:
                take_away(table, entry, annotations, _ANNOTATIONS)
    declare(agent, program)


def stored(agent: Circumstance) -> dict[str, Any] | None:
    """Return what the declarations of an agent hold, as data; None without declarations."""
    return None if agent.observers.derived is None else _derived(agent).stored()


def resume(agent: Circumstance, program: nodes.Program, held: dict[str, Any] | None) -> None:
    """Continue from what was `stored`; begin anew if there are other declarations now."""
    if held is None or len(held["patterns"]) != len(set(program.derived)):
        begin_anew(agent, program)
        return
    declare(agent, program)
    if agent.observers.derived is not None:
        _derived(agent).resume(held)


def replace(agent: Circumstance, program: nodes.Program) -> None:
    """Have other declarations than before."""
    if agent.observers.derived is not None:
        _derived(agent).end()
    declare(agent, program)


def settle(agent: Circumstance) -> None:
    """Work on the changes that wait."""
    if agent.observers.derived is not None:
        _derived(agent).settle()


def ring(agent: Circumstance, due: float) -> None:
    """A moment has come for which some pattern waits."""
    if agent.observers.derived is not None:
        _derived(agent).ring(due)


def _derived(agent: Circumstance) -> DerivedBeliefs:
    derived: Any = agent.observers.derived
    assert isinstance(derived, DerivedBeliefs)
    return derived
