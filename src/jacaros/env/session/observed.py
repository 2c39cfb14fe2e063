"""What one observer knows of the artifacts that it focuses: the current values of their properties."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from jacaros.env.errors import UnknownProperty
from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observation
from jacaros.env.ports import Workspace
from jacaros.env.presence.focused import Focused
from jacaros.env.property import ObservableProperty, fits
from jacaros.env.values import plain
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


class Observed(Focused):
    """The focused artifacts of a session, and their properties. It observes for the session itself.

    Args:
        agent: its name.
        tell: called with every observation, after it has been processed.

    Attributes:
        agent: its name.
    """

    def __init__(self, agent: str, tell: Callable[[Observation], None]) -> None:
        super().__init__()
        self.agent = agent
        self._tell = tell
        self._properties: dict[ArtifactId, dict[int, ObservableProperty]] = {}

    def observer(self, namespace: str | None) -> "Observed":
        """Return itself."""
        return self

    def began(self, workspace: Workspace, artifact: ArtifactId) -> None:
        """Prepare for an artifact, if its properties have not arrived."""
        self._properties.setdefault(artifact, {})

    def ended(self, workspace: Workspace, artifact: ArtifactId, disposed: bool) -> None:
        """Forget an artifact, but one that was disposed only with the observation that removes its properties."""
        if not (disposed and self._properties.get(artifact)):
            self._properties.pop(artifact, None)

    def observe(self, observation: Observation) -> None:
        """Process an observation."""
        artifact = observation.artifact
        if observation.added:
            self._properties.setdefault(artifact, {})
        held = self._properties.get(artifact)
        if held is None:
            return
        for new in (*(change[1] for change in observation.changed), *observation.added):
            held[new.key] = new
        for old in observation.removed:
            held.pop(old.key, None)
        if not held and artifact not in self:
            del self._properties[artifact]
        self._tell(observation)

    def find(
        self, name: str, template: tuple[object, ...] = (), artifact: ArtifactId | None = None
    ) -> Iterator[ObservedProperty]:
        """Iterate over the properties called *name*: those of the artifact focused first come first, among them the oldest.

        Args:
            template: as many values as the property has, None for any value. Empty matches every property.
            artifact: None for all focused artifacts.
        """
        for owner, held in self._properties.items():
            if artifact is not None and owner is not artifact:
                continue
            for each in held.values():
                if each.name == name and (not template or fits(template, each.values)):
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
