"""The observable properties of one artifact, changed in steps that are committed or rolled back."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol, runtime_checkable

from jacaros.artifacts.env.errors import ArtifactId, InvalidArtifact, UnknownProperty
from jacaros.artifacts.env.values import SCALARS, equal, plain
from jacaros.runtime.files.texts import aside
from jacaros.runtime.trace import Cause


@dataclass(slots=True)
class ObservableProperty:
    """An immutable snapshot of one property, as observers receive it.

    Attributes:
        name: functor of the belief.
        values: plain values, the arguments of the belief.
        annotations: further annotations of the belief (atoms and structures).
        key: identity within its artifact. It does not change with the values, and is never reused.
        written: terms that observers have built from it, kept so that they are built once for all observers and for the
            removal. Used by observers only.
    """

    name: str
    values: tuple[object, ...]
    annotations: tuple[object, ...]
    key: int
    written: Any = field(default=None, compare=False, repr=False)


Change = tuple[ObservableProperty, ObservableProperty]
"""A property before and after a step."""


class PropertyChanges(NamedTuple):
    """The changes of one step. Several updates of a property in a step are one change."""

    changed: tuple[Change, ...]
    added: tuple[ObservableProperty, ...]
    removed: tuple[ObservableProperty, ...]


_NONE: dict[int, ObservableProperty] = {}
_FEW = 8
"""Up to this number of properties with one name are searched in turn; beyond it, an index of first values is used."""
_INDEXED = SCALARS | {ArtifactId}
"""Types whose values are equal only to values of these types."""
_OTHERS = object()
"""Key of all properties whose first value is of another type or missing."""
NO_CHANGES = PropertyChanges((), (), ())


class PropertyStore:
    """The properties of one artifact, with a journal of the step in progress.

    Several properties may have one name, even with equal values. "The first" is the oldest.

    Attributes:
        changing: the previous state of the properties that the step in progress has changed, by key.
    """

    __slots__ = ("_by_first", "_by_name", "_last_key", "changing")

    def __init__(self) -> None:
        self._by_name: dict[str, dict[int, ObservableProperty]] = {}
        self._by_first: dict[str, dict[object, dict[int, None]]] = {}
        self.changing: dict[int, tuple[str, ObservableProperty | None]] = {}
        self._last_key = 0

    def define(self, name: str, values: tuple[object, ...], annotations: tuple[object, ...] | None) -> None:
        """Add a property.

        Raises:
            InvalidArtifact: *name* is not a valid name of a belief.
        """
        check_name(name)
        key = self._last_key + 1
        # A value that cannot be converted raises here, before anything has changed.
        if not SCALARS.issuperset(map(type, values)):
            values = tuple(map(plain, values))
        new = ObservableProperty(name, values, plain_annotations(annotations or ()), key)
        self._last_key = key
        self.changing[key] = (name, None)
        self._by_name.setdefault(name, {})[key] = new
        if name in self._by_first:
            self._by_first[name].setdefault(_first(new), {})[key] = None

    def update(
        self,
        name: str,
        values: tuple[object, ...],
        annotations: tuple[object, ...] | None,
        if_new: bool = False,
        where: tuple[object, ...] = (),
        or_define: bool = False,
    ) -> None:
        """Update the first property called *name* that matches *where*. None as annotations keeps the current ones.

        With *if_new*, do nothing if values and annotations are unchanged. With *or_define*, add a property if none of
        that name exists.

        Raises:
            UnknownProperty: no property matches.
            InvalidArtifact: *name* is not a valid name of a belief.
        """
        properties = self._by_name.get(name)
        if not properties:
            if or_define:
                self.define(name, values, annotations)
                return
            raise self._unknown(name)
        old = self.first(name, where) if where else next(iter(properties.values()))
        if not SCALARS.issuperset(map(type, values)):
            values = tuple(map(plain, values))
        kept = old.annotations if annotations is None else plain_annotations(annotations)
        if if_new and _all_equal(values, old.values) and _all_equal(kept, old.annotations):
            return
        key = old.key
        if key not in self.changing:
            self.changing[key] = (name, old)
        properties[key] = new = ObservableProperty(name, values, kept, key)
        if name in self._by_first:
            self._leave_index(old)
            self._by_first[name].setdefault(_first(new), {})[key] = None

    def remove(self, name: str, template: tuple[object, ...]) -> None:
        """Remove the first property called *name* whose values match *template* (see `first`).

        Raises:
            UnknownProperty: no property matches.
        """
        old = self.first(name, template)
        self.changing.setdefault(old.key, (name, old))
        del self._by_name[name][old.key]
        if name in self._by_first:
            self._leave_index(old)

    def _leave_index(self, old: ObservableProperty) -> None:
        index, first = self._by_first[old.name], _first(old)
        del index[first][old.key]
        if not index[first]:
            del index[first]

    def _like(self, name: str, template: tuple[object, ...]) -> Iterable[ObservableProperty]:
        """Return the properties called *name* that may match *template*, the oldest first."""
        properties = self._by_name.get(name, _NONE)
        if not template or len(properties) < _FEW:
            return properties.values()
        first = plain(template[0])
        if first is None or type(first) not in _INDEXED:
            return properties.values()
        index = self._by_first.get(name)
        if index is None:
            index = self._by_first[name] = {}
            for each in properties.values():
                index.setdefault(_first(each), {})[each.key] = None
        keys = {**index.get(first, {}), **index.get(_OTHERS, {})}
        return [properties[key] for key in sorted(keys)]

    def first(self, name: str, template: tuple[object, ...] = ()) -> ObservableProperty:
        """Return the oldest property called *name* whose values match *template*.

        Args:
            template: as many values as the property has, None for any value. Empty matches every property.

        Raises:
            UnknownProperty: no property matches.
        """
        for found in self._like(name, template):
            if not template or fits(template, found.values):
                return found
        raise self._unknown(name, template)

    def all(self, name: str, template: tuple[object, ...] = ()) -> tuple[ObservableProperty, ...]:
        """Return the properties called *name* whose values match *template* (see `first`), the oldest first."""
        return tuple(p for p in self._like(name, template) if not template or fits(template, p.values))

    def _unknown(self, name: str, template: tuple[object, ...] = ()) -> UnknownProperty:
        properties = self._by_name.get(name)
        if properties:
            return UnknownProperty(
                self._unlike(name, template, [len(each.values) for each in properties.values()])
            )
        names = [each for each, properties in self._by_name.items() if properties]
        known = f" (it has {', '.join(names)})" if names else " (it has none)"
        help = aside(name, names) or f'; add it with self.define_property("{name}", ...)'
        return UnknownProperty(f"unknown observable property `{name}`{known}{help}")

    @staticmethod
    def _unlike(name: str, template: tuple[object, ...], counts: list[int]) -> str:
        written = f"({', '.join(map(repr, template))}{',' if len(template) == 1 else ''})"
        if len(template) in counts:
            return f"no property {name} has the values {written}; None matches any value"
        wanted = " or ".join(map(str, sorted(set(counts))))
        return f"expected {wanted} values of property {name}, found {len(template)}: {written}; None matches any value"

    def has(self, name: str, template: tuple[object, ...] = ()) -> bool:
        """Return whether a property called *name* has values that match *template*."""
        return any(not template or fits(template, p.values) for p in self._like(name, template))

    def committed(self) -> tuple[ObservableProperty, ...]:
        """Return the properties as observers know them, in the order of their definition."""
        known = {p.key: p for properties in self._by_name.values() for p in properties.values()}
        for key, (_, before) in self.changing.items():
            if before is None:
                known.pop(key, None)
            else:
                known[key] = before
        return tuple(known[key] for key in sorted(known))

    def commit(self) -> PropertyChanges:
        """End the step and return its changes."""
        if not self.changing:
            return NO_CHANGES
        changed: list[Change] = []
        added: list[ObservableProperty] = []
        removed: list[ObservableProperty] = []
        for key, (name, before) in self.changing.items():
            properties = self._by_name.get(name, _NONE)
            now = properties.get(key)
            if now is None:
                if before is not None:
                    removed.append(before)
                if not properties:
                    self._by_name.pop(name, None)
                    self._by_first.pop(name, None)
            elif before is None:
                added.append(now)
            else:
                changed.append((before, now))
        self.changing.clear()
        return PropertyChanges(tuple(changed), tuple(added), tuple(removed))

    def roll_back(self) -> None:
        """Undo all additions, updates and removals of the step."""
        for name, _ in self.changing.values():
            self._by_first.pop(name, None)
        for key, (name, before) in self.changing.items():
            properties = self._by_name[name]
            if before is None:
                properties.pop(key, None)
            elif key in properties:
                properties[key] = before
            else:
                properties[key] = before
                self._by_name[name] = {each: properties[each] for each in sorted(properties)}
        self.changing.clear()


def check_name(name: str) -> None:
    """Check the name of a property or signal.

    Raises:
        InvalidArtifact: *name* does not begin with a lower-case letter.
    """
    if not isinstance(name, str) or not name[:1].islower():
        raise InvalidArtifact(
            f"the name of a property or signal must begin with a lower-case letter: {name!r}"
        )


def _all_equal(new: tuple[object, ...], old: tuple[object, ...]) -> bool:
    """Return whether values are equal for an agent. Values that differ for Python differ, and that check is faster."""
    return new == old and all(map(equal, new, old))


def plain_annotations(annotations: tuple[object, ...]) -> tuple[object, ...]:
    """Convert annotations to plain values."""
    return tuple(map(plain, annotations))


def _first(each: ObservableProperty) -> object:
    """Return the value that a property is indexed by."""
    return each.values[0] if each.values and type(each.values[0]) in _INDEXED else _OTHERS


def fits(template: tuple[object, ...], values: tuple[object, ...]) -> bool:
    """Return whether values match a template: as many, each equal, or None in the template."""
    return len(template) == len(values) and all(
        wanted is None or equal(plain(wanted), value) for wanted, value in zip(template, values, strict=True)
    )


# Observations: what an artifact publishes to its observers.


class Signal(NamedTuple):
    """A signal of an artifact. It is not stored.

    Attributes:
        name: functor of the event.
        arguments: plain values.
    """

    name: str
    arguments: tuple[object, ...]


class Observation(NamedTuple):
    """Everything that one commit of one artifact publishes. Process the parts in this order.

    Attributes:
        artifact: the source.
        signals: the signals.
        changed: properties with new values, before and after.
        added: new properties; all properties when an observer begins to focus.
        removed: removed properties; all properties when the focus or the artifact ends.
        cause: what led to it. None if unknown.
    """

    artifact: ArtifactId
    signals: tuple[Signal, ...] = ()
    changed: tuple[Change, ...] = ()
    added: tuple[ObservableProperty, ...] = ()
    removed: tuple[ObservableProperty, ...] = ()
    cause: Cause | None = None


class Observer(Protocol):
    """An observer of artifacts. It must be hashable by identity."""

    @property
    def agent(self) -> str:
        """Name of the agent it observes for. `signal_to` finds it by this name."""

    def observe(self, observation: Observation) -> None:
        """Receive an observation, in the order of the commits. Return soon and do not raise."""

    def __hash__(self) -> int: ...


@runtime_checkable
class SlowObserver(Observer, Protocol):
    """An observer that processes observations later than it receives them, and reports whether it has."""

    def has_untaken(self, name: str) -> bool:
        """Return whether a received change of properties called *name* has not been processed yet."""
