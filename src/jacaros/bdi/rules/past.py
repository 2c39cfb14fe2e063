"""What beliefs were: bounded histories of the beliefs that a program declares, and the answers of ``b(X)[ago(Ms)]``."""

import math
from collections import deque
from typing import Any

from jacaros.bdi.rules.searching import solve_annotated, unify_rows
from jacaros.bdi.state.belief_base import Item, Row, Table
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.rule import Answers
from jacaros.terms.collections import holds_collection
from jacaros.terms.substitution import is_key, resolve
from jacaros.terms.unifier import Trail, each_annotation_match, undo
from jacaros.terms.values import Functor, Term, deref, functor

AGO = functor("ago", 1)
_ROUNDING = 1e-6
"""Seconds that may be lost by rounding on the way to a moment of the past."""


class Span:
    """The time for which a belief had the same annotations.

    Attributes:
        number: the order in which beliefs began; a change of annotations leaves it as it is.
        start: when it began, in seconds.
        row: the arguments.
        annotations: as they were.
        end: when it ended; infinite if it has not.
    """

    __slots__ = ("annotations", "end", "number", "row", "start")

    def __init__(
        self, number: int, start: float, row: Row, annotations: tuple[Term, ...], end: float = math.inf
    ) -> None:
        self.number, self.start, self.row, self.annotations, self.end = number, start, row, annotations, end


class History:
    """What the beliefs of one functor were within a window.

    Args:
        symbol: the functor.
        window: how long ended beliefs are kept, in seconds.
    """

    def __init__(self, symbol: Functor, window: float) -> None:
        self.functor, self.window = symbol, window
        self._ended: deque[Span] = deque()  # by their ends
        self._held: dict[Row, Span] = {}
        self._begun = 0

    def note(self, table: Table, row: Row, now: float) -> None:
        """Take note of whether a belief is held *now*, and drop what is older than the window."""
        span, annotations = self._held.get(row), _annotations(table, row)
        if span is None or annotations != span.annotations:
            number = self._begun
            if span is not None:
                del self._held[row]
                span.end, number = now, span.number
                if span.start < now:
                    self._ended.append(span)
            if annotations is not None:
                self._begun += span is None
                self._held[row] = Span(number, now, row, annotations)
        while self._ended and self._ended[0].end < now - self.window:
            self._ended.popleft()

    def at(self, time: float) -> list[Item]:
        """Return the beliefs of that moment with their annotations, newest first."""
        time += _ROUNDING
        found = [span for span in self._held.values() if span.start <= time]
        for span in reversed(self._ended):
            if span.end <= time:
                break
            if span.start <= time:
                found.append(span)
        found.sort(key=lambda span: -span.number)
        return [(span.row, span.annotations) for span in found]

    def rows(self, table: Table) -> list[Row]:
        """Return the rows that are believed, and those that were when it was last looked."""
        held = [entry for entry, _ in table.entries() if isinstance(entry, tuple)]
        return [*self._held, *reversed(held)]

    def state(self) -> list[Any]:
        """Return all of it as data."""
        spans = [*self._ended, *self._held.values()]
        return [
            (each.number, each.start, each.row, each.annotations, None if each.end == math.inf else each.end)
            for each in spans
        ]

    def resume(self, state: list[Any]) -> None:
        """Continue from a `state`."""
        self._ended.clear()
        self._held.clear()
        self._begun = 0
        for number, start, row, annotations, end in state:
            span = Span(number, start, row, annotations, math.inf if end is None else end)
            self._begun = max(self._begun, number + 1)
            if end is None:
                self._held[row] = span
            else:
                self._ended.append(span)


def is_kept(row: Row) -> bool:
    """Whether the history of a belief is kept: not if it has variables, sets or maps, or is nested too deeply."""
    return all(is_key(argument) and not holds_collection(argument) for argument in row)


def _annotations(table: Table, row: Row) -> tuple[Term, ...] | None:
    """The annotations of a belief that is held; of several properties with the same values those of one."""
    held = table.get(row)
    if held is None and not table.plain:
        entry = table.aside(row)
        return None if entry is None else table.get(entry)
    return held


def solve_past(
    agent: Circumstance,
    table: Any,
    arguments: tuple[Term, ...],
    items: tuple[Term, ...],
    tail: Term,
    trail: Trail,
) -> Answers:
    """Answers of a predicate that is asked with annotations, of which ``ago(Ms)`` names a moment of the past.

    Where no history is kept, ``ago(Ms)`` is an annotation like others.
    """
    derived = agent.observers.derived
    if derived is not None:
        for place, item in enumerate(items):
            moment = deref(item)
            if moment.__class__ is tuple and moment[0] is AGO:
                past = derived.past(table.functor, resolve(moment[1]))
                if past is not None:
                    others = items[:place] + items[place + 1 :]
                    return _past_answers(past, arguments, others, tail, trail)
    return solve_annotated(agent, table, arguments, items, tail, trail)


def _past_answers(
    past: list[Item], arguments: tuple[Term, ...], items: tuple[Term, ...], tail: Term, trail: Trail
) -> Answers:
    for row, annotations in past:
        mark = len(trail)
        if unify_rows(arguments, row, trail):  # type: ignore[arg-type]
            for _ in each_annotation_match(items, tail, annotations, None, trail):
                yield arguments
        undo(trail, mark)
