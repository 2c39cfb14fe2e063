"""Waits for conditions (``.wait(p(X) & not q)``), found by the beliefs that they ask for."""

from collections.abc import Iterable, Mapping

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.state.belief_base import BeliefTables, Row
from jacaros.bdi.state.intention import Intention
from jacaros.bdi.state.waiting import TimedWait
from jacaros.terms.substitution import ATOMIC
from jacaros.terms.values import (
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

Asked = tuple[Functor, tuple[int, ...], Row]
"""The beliefs that a literal asks for: their functor, the places of the arguments that are known, and these."""


class ConditionWait(TimedWait):
    """Waits for a condition.

    Attributes:
        formula: the condition.
        asked: the beliefs that the condition depends on; None when it may depend on anything.
        number: its place among the waits of the agent.
    """

    __slots__ = ("asked", "formula", "number")

    def __init__(
        self,
        intention: Intention,
        reason: Term,
        elapsed: Term,
        began: float,
        formula: Term,
        asked: list[Asked] | None,
    ) -> None:
        super().__init__(intention, reason, elapsed, began)
        self.formula, self.asked = formula, asked
        self.number = 0


class ConditionObserver:
    """Python code around the agent that waits for a condition: a live object, which no stored mind holds.

    Attributes:
        asked, number: as in `ConditionWait`.
    """

    asked: list[Asked] | None = None
    number = 0

    @property
    def ended(self) -> bool:
        """Whether the wait is over."""
        raise NotImplementedError

    def holds(self) -> bool:
        """Whether the condition holds now."""
        raise NotImplementedError

    def resume(self) -> None:
        """Take note that the condition holds."""
        raise NotImplementedError

    def fail(self, message: str) -> None:
        """Take note that the condition cannot be evaluated."""
        raise NotImplementedError


class ConditionWatch:
    """Watches a condition that must stay true.

    Attributes:
        condition: the condition.
        asked, number: as in `ConditionWait`.
        ended: whether the watch is over.
    """

    __slots__ = ("asked", "condition", "ended", "number")

    def __init__(self, condition: Term, asked: list[Asked] | None) -> None:
        self.condition, self.asked = condition, asked
        self.number = 0
        self.ended = False


AnyWait = ConditionWait | ConditionObserver | ConditionWatch


class ConditionWaits(dict[int, AnyWait]):
    """The waits of one agent, by their numbers.

    Attributes:
        restless: those that may depend on anything: they are looked at in every cycle.
        due: those that a change of beliefs may have made true.
    """

    def __init__(self) -> None:
        super().__init__()
        self.restless: dict[int, AnyWait] = {}
        self.due: dict[int, AnyWait] = {}
        self._index: dict[Functor, dict[tuple[int, ...], dict[Row, dict[int, AnyWait]]]] = {}
        self._count = 0

    def add(self, wait: AnyWait, number: int | None = None) -> None:
        """Begin to wait; the condition is looked at in the next cycle.  *number* is that of a wait that was stored."""
        self._count = wait.number = self._count + 1 if number is None else number
        self[wait.number] = self.due[wait.number] = wait
        if wait.asked is None:
            self.restless[wait.number] = wait
            return
        for symbol, places, values in wait.asked:
            by_values = self._index.setdefault(symbol, {}).setdefault(places, {})
            by_values.setdefault(values, {})[wait.number] = wait

    def remove(self, wait: AnyWait) -> None:
        """End a wait; no effect if it is already over."""
        if self.pop(wait.number, None) is None:
            return
        self.restless.pop(wait.number, None)
        self.due.pop(wait.number, None)
        for symbol, places, values in wait.asked or ():
            by_places = self._index.get(symbol, {})
            by_values = by_places.get(places, {})
            held = by_values.get(values, {})
            held.pop(wait.number, None)
            if not held:
                by_values.pop(values, None)
            if not by_values:
                by_places.pop(places, None)
            if not by_places:
                self._index.pop(symbol, None)

    def changed(self, symbol: Functor, row: Row) -> bool:
        """Take note of a belief that came, went or changed; whether there is a wait to be looked at."""
        for places, by_values in self._index.get(symbol, {}).items():
            values = tuple(row[place] for place in places)
            if ATOMIC.issuperset(map(type, values)):
                self.due.update(by_values.get(values, ()))
            else:
                for held in by_values.values():
                    self.due.update(held)
        return self.want_a_look()

    def want_a_look(self) -> bool:
        """Whether there are waits to look at."""
        return bool(self.due or self.restless)

    def depend_on_rules(self, symbol: Functor) -> None:
        """There is a new rule for a predicate: conditions that ask for it may depend on anything."""
        for by_values in list(self._index.get(symbol, {}).values()):
            for held in list(by_values.values()):
                self.restless.update(held)

    def take_due(self) -> list[AnyWait]:
        """The waits to look at, in the order in which they began."""
        due = {**self.restless, **self.due} if self.due else self.restless
        self.due = {}
        return [due[number] for number in sorted(due)]


def asked_by(
    formula: Term, beliefs: BeliefTables, actions: Mapping[str, InternalAction]
) -> list[Asked] | None:
    """The beliefs that a condition depends on; None when it may depend on anything.

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
    """Whether terms stay what they are: they hold no collections, objects and calls of functions."""
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
