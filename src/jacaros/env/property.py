"""The observable properties of one artifact, changed in steps that are committed or rolled back."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from jacaros.env.errors import InvalidArtifact, UnknownProperty, spelling_hint
from jacaros.env.ids import ArtifactId
from jacaros.env.values import SCALARS, Structure, equal, plain, text


@dataclass(slots=True)
class ObservableProperty:
    """What observers see of one property at one moment; nobody changes it.

    Attributes:
        name: the functor of the belief.
        values: plain values, the arguments of the belief.
        annotations: further annotations of the belief (atoms and structures).
        key: identity within its artifact; it stays when the values change, and is never used again.
        written: what the observers of a run have made of it, kept so that it is made once for all of them and for the
            end of the value too; theirs alone.
    """

    name: str
    values: tuple[object, ...]
    annotations: tuple[object, ...]
    key: int
    written: Any = field(default=None, compare=False, repr=False)


def histories_of(artifact_type: type) -> Mapping[str, float]:
    """Return the properties whose past observers of an artifact keep: seconds by name."""
    found: Mapping[str, float] = getattr(artifact_type, "property_histories", {})
    return found


class PropertySnapshot:
    """A property at one moment, as the operation ``observeProperty`` gives it: an opaque object for agents.

    The methods with the names of Java are there for ``cartago.invoke_obj`` in programs written for CArtAgO.

    Attributes:
        name: the name of the property.
        values: its plain values.
        annotations: its annotations.
    """

    __slots__ = ("annotations", "name", "values")

    def __init__(self, of: ObservableProperty) -> None:
        self.name, self.values, self.annotations = of.name, of.values, of.annotations

    def value(self, index: int = 0) -> object:
        """One of the values."""
        return plain(self.values[index])

    def getName(self) -> str:  # noqa: N802 - Java's name
        """The name of the property."""
        return self.name

    def getValue(self, index: int = 0) -> object:  # noqa: N802 - Java's name
        """One of the values."""
        return self.value(int(index))

    def getValues(self) -> list[object]:  # noqa: N802 - Java's name
        """All values."""
        return [plain(value) for value in self.values]

    def intValue(self, index: int = 0) -> int:  # noqa: N802 - Java's name
        """One of the values as an integer."""
        return int(self.values[int(index)])  # type: ignore[call-overload,no-any-return]  # it raises if it is none

    def doubleValue(self, index: int = 0) -> float:  # noqa: N802 - Java's name
        """One of the values as a real number."""
        return float(self.values[int(index)])  # type: ignore[arg-type]  # it raises if it is none

    def stringValue(self, index: int = 0) -> str:  # noqa: N802 - Java's name
        """One of the values as a text."""
        return text(self.values[int(index)])

    def booleanValue(self, index: int = 0) -> bool:  # noqa: N802 - Java's name
        """One of the values as a truth value."""
        return bool(self.values[int(index)])

    def __str__(self) -> str:
        return text(Structure(self.name, self.values)) if self.values else self.name

    toString = __str__  # noqa: N815 - Java's name

    def __repr__(self) -> str:
        return f"<property {self}>"


Change = tuple[ObservableProperty, ObservableProperty]
"""A property before and after a step."""


class PropertyChanges(NamedTuple):
    """The difference that one step made: several updates of a property in it are one change."""

    changed: tuple[Change, ...]
    added: tuple[ObservableProperty, ...]
    removed: tuple[ObservableProperty, ...]


_NONE: dict[int, ObservableProperty] = {}
_FEW = 8
"""So many properties of one name are gone through; more are found by their first value."""
_INDEXED = SCALARS | {ArtifactId}
"""Types of values that only values of these types are equal to."""
_OTHERS = object()
"""The key of all properties that have another first value, or none."""
NO_CHANGES = PropertyChanges((), (), ())


class PropertyStore:
    """The properties of one artifact, and a journal of the step in progress.

    Several properties may have one name, even with equal values; "the first" is the oldest.

    Attributes:
        changing: how the properties were that the step in progress has touched, by key; empty when there are none.
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
            InvalidArtifact: *name* cannot be the name of a belief.
        """
        check_name(name)
        key = self._last_key + 1
        # What cannot be converted raises here, before anything has changed.
        new = ObservableProperty(name, _plain(values), plain_annotations(annotations or ()), key)
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
    ) -> None:
        """Give the first property called *name* that fits *where* new values; None as annotations keeps the old ones.

        With *if_new* nothing happens when values and annotations are equal to the old ones.

        Raises:
            UnknownProperty: there is none.
        """
        properties = self._by_name.get(name)
        if not properties:
            raise self._unknown(name)
        old = self.first(name, where) if where else next(iter(properties.values()))
        values = _plain(values)
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

    def put(self, name: str, values: tuple[object, ...]) -> None:
        """Give the first property called *name* new values; if there is none, add one.

        Raises:
            InvalidArtifact: *name* cannot be the name of a belief.
        """
        if self._by_name.get(name):
            self.update(name, values, None)
        else:
            self.define(name, values, None)

    def remove(self, name: str, template: tuple[object, ...]) -> None:
        """Remove the first property called *name* whose values fit *template* (see `first`).

        Raises:
            UnknownProperty: there is none.
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
        """The properties called *name* that may fit *template*, the oldest first."""
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
        """The oldest property called *name* whose values fit *template*.

        Args:
            template: as many values as the property has, None for any value; empty fits every property.

        Raises:
            UnknownProperty: there is none.
        """
        for found in self._like(name, template):
            if not template or _fits(template, found.values):
                return found
        raise self._unknown(name, template)

    def all(self, name: str, template: tuple[object, ...] = ()) -> tuple[ObservableProperty, ...]:
        """The properties called *name* whose values fit *template* (see `first`), the oldest first."""
        return tuple(p for p in self._like(name, template) if not template or _fits(template, p.values))

    def _unknown(self, name: str, template: tuple[object, ...] = ()) -> UnknownProperty:
        properties = self._by_name.get(name)
        if properties:
            return UnknownProperty(
                self._unlike(name, template, [len(each.values) for each in properties.values()])
            )
        names = [each for each, properties in self._by_name.items() if properties]
        known = f" (it has {', '.join(names)})" if names else " (it has none)"
        help = spelling_hint(name, names) or f'; self.define_property("{name}", ...) makes one'
        return UnknownProperty(f"no observable property {name}{known}{help}")

    @staticmethod
    def _unlike(name: str, template: tuple[object, ...], counts: list[int]) -> str:
        written = f"({', '.join(map(repr, template))}{',' if len(template) == 1 else ''})"
        if len(template) in counts:
            return f"no observable property {name} has the values {written}; None stands for any value"
        wanted = " or ".join(map(str, sorted(set(counts))))
        return f"property {name} has {wanted} values, not {len(template)} as {written}: give all, None for any value"

    def has(self, name: str, template: tuple[object, ...] = ()) -> bool:
        """True when there is a property called *name* whose values fit *template*."""
        if not template:
            return bool(self._by_name.get(name))
        return any(_fits(template, p.values) for p in self._like(name, template))

    def committed(self) -> tuple[ObservableProperty, ...]:
        """The properties as observers know them, in the order of their definition."""
        known = {p.key: p for properties in self._by_name.values() for p in properties.values()}
        for key, (_, before) in self.changing.items():
            if before is None:
                known.pop(key, None)
            else:
                known[key] = before
        return tuple(known[key] for key in sorted(known))

    def commit(self) -> PropertyChanges:
        """End the step: forget how it was before and tell what is different now."""
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
        """Undo the step: additions, updates and removals alike."""
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
    """Refuse what cannot be the functor of a belief or the name of a signal.

    Raises:
        InvalidArtifact: *name* does not begin with a lower-case letter.
    """
    if not isinstance(name, str) or not name[:1].islower():
        raise InvalidArtifact(f"{name!r} cannot name a property or signal: begin with a lower-case letter")


def _plain(values: tuple[object, ...]) -> tuple[object, ...]:
    """Make values plain; numbers and texts, which most are, are so already."""
    for value in values:
        if type(value) not in SCALARS:
            return tuple(map(plain, values))
    return values


def _all_equal(new: tuple[object, ...], old: tuple[object, ...]) -> bool:
    """Whether values are equal to an agent; what is not equal to Python is not, and that is found sooner."""
    return new == old and all(map(equal, new, old))


def plain_annotations(annotations: tuple[object, ...]) -> tuple[object, ...]:
    """Make annotations plain values."""
    return tuple(map(plain, annotations))


def _first(each: ObservableProperty) -> object:
    """What a property is indexed by."""
    return each.values[0] if each.values and type(each.values[0]) in _INDEXED else _OTHERS


def _fits(template: tuple[object, ...], values: tuple[object, ...]) -> bool:
    return len(template) == len(values) and all(
        wanted is None or equal(plain(wanted), value) for wanted, value in zip(template, values, strict=True)
    )
