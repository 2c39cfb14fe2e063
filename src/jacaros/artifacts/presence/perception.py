"""Ports through which a session reports what it is waiting for and executing."""

import asyncio
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from typing import Any, NamedTuple, Protocol, TypeVar

from jacaros.artifacts.env.errors import ArtifactId, UnknownProperty
from jacaros.artifacts.env.ports import Workspace
from jacaros.artifacts.env.property import ObservableProperty, Observation, fits
from jacaros.artifacts.env.values import plain
from jacaros.artifacts.presence.joined import Focused
from jacaros.files.texts import aside
from jacaros.runtime.clock import Clock

Observer = Callable[[str, str, object, str], None]
"""Takes the state of an operation or goal (``executing``, ``achieved``, ``failed``, ``dropped``), its text, an object that
identifies it, and the reason of a failure as text.
"""


class Activity(Protocol):
    """Counts what runs, so that a run can detect idleness."""

    def begin(self) -> None:
        """Something with an end has begun."""

    def end(self) -> None:
        """It has ended, or was cancelled."""


class Account(Activity, Protocol):
    """Counts also what a session waits for."""

    def waiting(self) -> AbstractContextManager[None]:
        """Context of a wait that something else must end, such as for a signal."""


class NoAccount:
    """Counts nothing."""

    def begin(self) -> None:
        """Do nothing."""

    def end(self) -> None:
        """Do nothing."""

    def waiting(self) -> AbstractContextManager[None]:
        """Do nothing."""
        return nullcontext()


# Conditions that tasks wait for, evaluated after every change.


T = TypeVar("T")


class Conditions:
    """The conditions that one session waits for, in the order of waiting."""

    def __init__(self) -> None:
        self._waiting: dict[asyncio.Future[Any], Callable[[], Any]] = {}

    async def wait(
        self, condition: Callable[[], T], clock: Clock | None = None, timeout: float | None = None
    ) -> T:
        """Wait until *condition* is true, at most *timeout* seconds. Return its value.

        Raises:
            TimeoutError: the time limit has passed.
        """
        true: asyncio.Future[T] = asyncio.get_running_loop().create_future()
        self._waiting[true] = condition
        timer = None
        if clock is not None and timeout is not None:
            error = TimeoutError(f"the condition was not true within {timeout:g} s")
            timer = clock.call_later(timeout, lambda: _fail(true, error))
        try:
            return await true
        finally:
            self._waiting.pop(true, None)
            if timer is not None:
                timer.cancel()

    def evaluate(self) -> None:
        """Wake the tasks whose condition is true or raises."""
        for future, condition in tuple(self._waiting.items()):
            if future.done():
                continue
            try:
                value = condition()
            except Exception as error:
                _fail(future, error)
            else:
                if value and not future.done():
                    future.set_result(value)

    def close(self, error: Exception) -> None:
        """Wake all tasks with *error*."""
        for future in tuple(self._waiting):
            _fail(future, error)


def _fail(future: "asyncio.Future[Any]", error: Exception) -> None:
    if not future.done():
        future.set_exception(error)


# What one observer knows of the artifacts that it focuses: the current values of their properties.


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


class ReceivedSignal(NamedTuple):
    """A signal that an observer received.

    Attributes:
        name: name of the signal.
        arguments: plain values.
        artifact: the source.
    """

    name: str
    arguments: tuple[object, ...]
    artifact: ArtifactId
