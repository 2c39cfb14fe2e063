"""What one observer knows of the artifacts that it focuses: the current values of their properties."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from jacaros.env.errors import UnknownProperty
from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observation
from jacaros.env.property import ObservableProperty
from jacaros.env.values import equal, plain
from jacaros.suggestions import aside


class ObservedProperty(NamedTuple):
    """A property of a focused artifact, as it is now.

    Attributes:
        name: name of the property.
        values: plain values, a copy.
        artifact: the artifact that has it.
        annotations: annotations that the artifact has added.
    """

    name: str
    values: tuple[object, ...]
    artifact: ArtifactId
    annotations: tuple[object, ...] = ()


class PropertyChange(NamedTuple):
    """A change of one property.

    Attributes:
        name: name of the property.
        before: previous values. None if it is new, or its artifact newly focused.
        now: new values. None if it has been removed, or the focus or artifact has ended.
        artifact: the artifact that has it.
    """

    name: str
    before: tuple[object, ...] | None
    now: tuple[object, ...] | None
    artifact: ArtifactId


class Observed:
    """An observer that keeps the properties of the artifacts it focuses.

    Args:
        agent: its name.
        tell: called with every observation, after it has been processed.
    """

    def __init__(self, agent: str, tell: Callable[[Observation], None]) -> None:
        self._agent = agent
        self._tell = tell
        self._properties: dict[ArtifactId, dict[int, ObservableProperty]] = {}
        self._gone: set[ArtifactId] = set()

    @property
    def agent(self) -> str:
        """Its name."""
        return self._agent

    @property
    def focused(self) -> tuple[ArtifactId, ...]:
        """The focused artifacts, in the order of focusing."""
        return tuple(artifact for artifact in self._properties if artifact not in self._gone)

    def begin(self, artifact: ArtifactId) -> None:
        """Prepare for an artifact. Its properties arrive as its first observation."""
        self._properties.setdefault(artifact, {})

    def end(self, artifact: ArtifactId) -> None:
        """Forget an artifact."""
        self._properties.pop(artifact, None)
        self._gone.discard(artifact)

    def gone(self, artifact: ArtifactId) -> None:
        """Note that an artifact has been disposed. The observation that removes its properties follows, if it has any."""
        if self._properties.get(artifact):
            self._gone.add(artifact)
        else:
            self.end(artifact)

    def observe(self, observation: Observation) -> None:
        """Process an observation."""
        held = self._properties.get(observation.artifact)
        if held is None:
            return
        for _, new in observation.changed:
            held[new.key] = new
        for new in observation.added:
            held[new.key] = new
        for old in observation.removed:
            held.pop(old.key, None)
        if not held and observation.artifact in self._gone:
            self.end(observation.artifact)
        self._tell(observation)

    def find(
        self, name: str, template: tuple[object, ...] = (), artifact: ArtifactId | None = None
    ) -> Iterator[ObservedProperty]:
        """Iterate over the properties called *name*: those of the artifact focused first come first, among them the oldest.

        Args:
            template: as many values as the property has, None for any value. Empty matches every property.
            artifact: None for all focused artifacts.
        """
        template = tuple(map(plain, template))
        for owner, held in self._properties.items():
            if artifact is not None and owner is not artifact:
                continue
            for each in held.values():
                if each.name == name and (not template or _fits(template, each.values)):
                    yield _observed(owner, each)

    def unknown(self, name: str, artifact: ArtifactId | None) -> UnknownProperty:
        """Return the error for an unknown property."""
        owners = [artifact] if artifact is not None else list(self._properties)
        known = {each.name: None for owner in owners for each in self._properties.get(owner, {}).values()}
        if not owners or (artifact is not None and artifact not in self._properties):
            why = "no artifact is focused" if artifact is None else f"artifact {artifact.name} is not focused"
        else:
            which = ", ".join(owner.name for owner in owners)
            why = f"the focused artifacts ({which}) have {', '.join(known) if known else 'none'}"
        return UnknownProperty(f"unknown observable property `{name}`: {why}{aside(name, known)}")


def changes_of(observation: Observation) -> Iterator[PropertyChange]:
    """Iterate over the property changes of an observation, in the order of agents' events."""
    artifact = observation.artifact
    for old, new in observation.changed:
        yield PropertyChange(new.name, _copy(old.values), _copy(new.values), artifact)
    for new in observation.added:
        yield PropertyChange(new.name, None, _copy(new.values), artifact)
    for old in observation.removed:
        yield PropertyChange(old.name, _copy(old.values), None, artifact)


def _observed(artifact: ArtifactId, found: ObservableProperty) -> ObservedProperty:
    return ObservedProperty(found.name, _copy(found.values), artifact, _copy(found.annotations))


def _copy(values: tuple[object, ...]) -> tuple[object, ...]:
    """Return values that share no list or dictionary with those of the artifact."""
    return tuple(map(plain, values))


def _fits(template: tuple[object, ...], values: tuple[object, ...]) -> bool:
    return len(template) == len(values) and all(
        wanted is None or equal(wanted, value) for wanted, value in zip(template, values, strict=True)
    )
