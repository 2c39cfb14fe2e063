"""Filters of focused artifacts: the second argument of ``focus`` and ``focusWhenAvailable``.

============================  ==============================================================================
filter                        what passes
============================  ==============================================================================
a pattern, ``count(_)``       properties and signals of that name and number of arguments; arguments that are
                              not variables must be equal
an atom, ``tick``             all properties and signals of that name, whatever their arguments
a list of these               what one of them lets pass
a Python object               what its method ``select`` (or the object itself, called) returns true for; it
                              takes ``kind`` ("property" or "signal"), ``name`` and ``values``
============================  ==============================================================================

A Python object filters changes and signals only, as in CArtAgO: all initial properties are perceived.
A pattern filters initial properties, too.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from jacaros.env.observation import Observation, Observer, Signal, SlowObserver
from jacaros.env.property import Change, ObservableProperty
from jacaros.env.values import Atom, Out, Structure, equal

PROPERTY, SIGNAL = "property", "signal"


class Perception(NamedTuple):
    """The argument of a filter.

    Attributes:
        kind: ``property`` or ``signal``.
        name: name of the property or signal.
        values: plain values.
    """

    kind: str
    name: str
    values: tuple[object, ...]


class Filter(Protocol):
    """Decides what passes."""

    from_the_beginning: bool
    """Whether it also filters the properties that exist when the focus begins."""

    def passes(self, perception: Perception) -> bool:
        """Return whether the agent perceives it."""


class Patterns:
    """Lets pass what matches a pattern.

    Args:
        patterns: atoms for any arguments, structures with `Out` objects for any value.
    """

    from_the_beginning = True

    def __init__(self, patterns: list[Atom | Structure]) -> None:
        self._patterns = patterns

    def passes(self, perception: Perception) -> bool:
        """Return whether one of the patterns matches."""
        return any(_fits(pattern, perception) for pattern in self._patterns)


def _fits(pattern: Atom | Structure, perception: Perception) -> bool:
    if isinstance(pattern, Atom):
        return perception.name == str.__str__(pattern)
    if pattern.functor != perception.name or len(pattern.arguments) != len(perception.values):
        return False
    pairs = zip(pattern.arguments, perception.values, strict=True)
    return all(isinstance(wanted, Out) or equal(wanted, value) for wanted, value in pairs)


class Selecting:
    """Lets pass what a function of the user returns true for; if it raises an exception, everything passes.

    Args:
        select: the function.
        complain: called with its exceptions.
    """

    from_the_beginning = False

    def __init__(self, select: Callable[[Perception], object], complain: Callable[[Exception], None]) -> None:
        self._select, self._complain = select, complain

    def passes(self, perception: Perception) -> bool:
        """Return the result of the function."""
        try:
            return bool(self._select(perception))
        except Exception as error:
            self._complain(error)
            return True


def filter_of(value: Any, complain: Callable[[Exception], None]) -> Filter | None:
    """Convert a plain value to a filter; None if it is not one."""
    patterns = value if isinstance(value, list) else [value]
    if patterns and all(isinstance(pattern, (Atom, Structure)) for pattern in patterns):
        return Patterns(patterns)
    select = getattr(value, "select", value)
    return Selecting(select, complain) if callable(select) else None


class FilteredObserver:
    """Forwards to another observer what a filter lets pass.

    Forwarded values of a property are stored, because they are what ends when it changes or disappears.
    """

    def __init__(self, observer: Observer, wanted: Filter) -> None:
        self._observer, self._filter = observer, wanted
        self._slow = observer if isinstance(observer, SlowObserver) else None
        self._shown: dict[int, ObservableProperty] = {}
        self._begun = wanted.from_the_beginning

    @property
    def agent(self) -> str:
        """Name of the observing agent."""
        return self._observer.agent

    def has_untaken(self, name: str) -> bool:
        """Return whether the other observer lags behind."""
        return self._slow is not None and self._slow.has_untaken(name)

    def observe(self, observation: Observation) -> None:
        """Forward what passes."""
        signals = tuple(each for each in observation.signals if self._passes_signal(each))
        changed: list[Change] = []
        added: list[ObservableProperty] = []
        removed = [self._shown.pop(each.key) for each in observation.removed if each.key in self._shown]
        for _, new in observation.changed:
            self._change(new, changed, added, removed)
        for each in observation.added:
            if not self._begun or self._passes(each):
                added.append(each)
                self._shown[each.key] = each
        self._begun = True
        if signals or changed or added or removed:
            cause = observation.cause
            parts = (tuple(changed), tuple(added), tuple(removed))
            self._observer.observe(Observation(observation.artifact, signals, *parts, cause))

    def _change(
        self,
        new: ObservableProperty,
        changed: list[Change],
        added: list[ObservableProperty],
        removed: list[ObservableProperty],
    ) -> None:
        old = self._shown.get(new.key)
        if self._passes(new):
            self._shown[new.key] = new
            if old is None:
                added.append(new)
            else:
                changed.append((old, new))
        elif old is not None and self._filter.from_the_beginning:
            removed.append(self._shown.pop(new.key))

    def _passes(self, each: ObservableProperty) -> bool:
        return self._filter.passes(Perception(PROPERTY, each.name, each.values))

    def _passes_signal(self, each: Signal) -> bool:
        return self._filter.passes(Perception(SIGNAL, each.name, each.arguments))
