"""The presence of an agent, a script or a behaviour tree in an environment.

CArtAgO's rules decide which artifact serves an operation. A `Direction` selects it: an artifact by id, or by its name in
the given workspace. With a namespace, the artifacts focused in that namespace come first. Otherwise the workspaces are
searched: the current one, home, then the others (see `jacaros.artifacts.env.workspace` for several candidates in one).
"""

import asyncio
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol, TypeVar

from jacaros.artifacts.env.environment import DEFAULT_TYPES, Environment
from jacaros.artifacts.env.errors import (
    ArtifactId,
    OperationFailed,
    UnknownArtifact,
    UnknownProperty,
    resolve_path,
)
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.artifacts.env.ports import ENDED, OnMade, UnderWay, Waiting, Workspace
from jacaros.artifacts.env.property import ObservableProperty, Observation, fits
from jacaros.artifacts.env.values import Structure, plain
from jacaros.artifacts.env.workspace import artifact_named, chosen_artifact
from jacaros.artifacts.presence.joined import Filter, Focused, JoinedWorkspaces
from jacaros.files.texts import aside, close_matches
from jacaros.runtime.clock import Clock


@dataclass(slots=True)
class Direction:
    """What an operation is directed to, and its time limit.

    Attributes:
        artifact: an artifact, its name, or its path; None if not given. With an id, *workspace* is ignored.
        workspace: a workspace, or its name or path; None if not given.
        timeout: seconds; None: no limit.
    """

    artifact: ArtifactId | str | None = None
    workspace: Workspace | str | None = None
    timeout: float | None = None


ANYWHERE = Direction()
"""The direction of operations without one; immutable by convention."""


class UnknownOperation(OperationFailed):
    """No artifact offers an operation."""


class Presence:
    """The joined workspaces and focused artifacts of one agent, script or behaviour tree.

    Args:
        environment: the environment.
        name: name of the agent or session: creator of artifacts, caller of operations.
        home: full path of the workspace that it joins first.
        focused: its focused artifacts.
        own_actions: actions that are not operations, such as ``focus/1``, for suggestions.

    Raises:
        UnknownWorkspace: the workspace *home* does not exist.
    """

    def __init__(
        self,
        environment: Environment,
        name: str,
        home: str,
        focused: Focused,
        own_actions: Iterable[str] = (),
    ) -> None:
        self.environment, self.name, self.focused = environment, name, focused
        self.workspaces = JoinedWorkspaces(environment, home)
        self._own_actions = own_actions

    # ---- workspaces

    def join(self, workspace: Workspace, intention: int | None = None) -> None:
        """Join a workspace and make it the current one."""
        if self.workspaces.join(workspace, intention):
            self.changed(workspace, True)

    def quit(self, workspace: Workspace) -> None:
        """Leave a workspace, and stop focusing its artifacts.

        Raises:
            OperationFailed: it is not joined; reason ``workspace_not_joined(Name)``.
        """
        self.workspaces.at(workspace.path)
        self.focused.end_all(workspace)
        self.workspaces.quit(workspace)
        self.changed(workspace, False)

    def leave(self) -> None:
        """End everything silently: waits for artifacts, too."""
        for workspace in self.workspaces.joined():
            self.focused.end_all(workspace)
            self.workspaces.quit(workspace)

    def changed(self, workspace: Workspace, joined: bool) -> None:
        """Note that a workspace was joined (True) or quit (False)."""

    def base(self, wanted: Workspace | str | None, intention: int | None = None) -> Workspace:
        """Return the joined workspace *wanted*; None means the current one.

        Raises:
            OperationFailed: it is not joined.
        """
        if wanted is None:
            return self.workspaces.current(intention)
        return (
            self.workspaces.named(wanted, intention)
            if isinstance(wanted, str)
            else self.workspaces.at(wanted.path)
        )

    # ---- artifacts

    def artifact(self, wanted: ArtifactId | str, places: Sequence[Workspace]) -> ArtifactId:
        """Return the artifact *wanted*: an id, a name in one of the *places*, or a path relative to the first of them.

        Raises:
            OperationFailed: the artifact does not exist, or its workspace is not joined.
        """
        if isinstance(wanted, ArtifactId):
            self.workspaces.at(wanted.workspace)
            return wanted
        if "/" in wanted:
            above, _, wanted = resolve_path(places[0].path, wanted).rpartition("/")
            places = [self.workspaces.at(above)]
        return artifact_named(places, wanted)

    def artifact_for(
        self,
        operation: str,
        arity: int,
        direction: Direction = ANYWHERE,
        intention: int | None = None,
        namespace: str | None = None,
    ) -> ArtifactId:
        """Return the artifact that serves an operation.

        Raises:
            UnknownOperation: none exists; the message names similar operations and their places.
            UnknownArtifact: the workspace that the operation is directed to has no artifact of that name.
            OperationFailed: that workspace is not joined.
        """
        if direction is ANYWHERE and namespace is None:
            # Nearly always it is the only one of the current workspace.
            candidates = self.workspaces.current(intention).providers(operation, arity)
            if len(candidates) == 1:
                return candidates[0]
        wanted = direction.artifact
        if isinstance(wanted, ArtifactId):
            return self.artifact(wanted, ())
        if direction.workspace is None:
            places = tuple(self.workspaces.in_order(intention))
        else:
            places = (self.base(direction.workspace, intention),)
        if wanted is not None:
            return self.artifact(wanted, places)
        found = None
        if namespace is not None and direction.workspace is None:
            found = self._in_namespace(namespace, operation, arity)
        found = found or chosen_artifact(places, operation, arity, self.name, self.focused.in_order())
        if found is None:
            raise self._unknown(operation, arity, places)
        return found

    def _in_namespace(self, namespace: str, operation: str, arity: int) -> ArtifactId | None:
        """Return the first artifact focused in a namespace that offers the operation.

        If there are only operations of that name with other numbers of arguments, return the first of these, which
        reports the mismatch: after a slip, an action for one robot must not reach another one.
        """
        namesake: ArtifactId | None = None
        for workspace, artifact in self.focused.in_namespace(namespace):
            if artifact in workspace.providers(operation, arity):
                return artifact
            if namesake is None and operation in map(_name, workspace.offers(artifact)):
                namesake = artifact
        return namesake

    # ---- focus

    def focus_when_available(
        self,
        here: Workspace,
        path: str,
        on_done: OnMade,
        namespace: str | None = None,
        only: Filter | None = None,
    ) -> UnderWay:
        """Focus an artifact as soon as one with this name or path exists. See `Focused.begin`.

        Args:
            here: workspace that *path* is relative to.
            path: name or path of the artifact.
            on_done: called with the artifact, or the failure: its workspace was quit meanwhile.
            namespace: namespace of the agent's program.
            only: filter of what is perceived.

        Returns:
            The handle of the wait.

        Raises:
            OperationFailed: its workspace does not exist, or is not joined.
        """
        workspace, name = self.environment.place(here, path)
        self.workspaces.at(workspace.path)

        def begin(artifact: ArtifactId) -> None:
            def focused(outcome: OperationOutcome) -> None:
                on_done(artifact if outcome.ok else None, outcome)

            self.focused.begin(workspace, artifact, namespace, focused, only)

        def look(artifact: ArtifactId, is_there: bool) -> None:
            if not is_there or artifact.name != name:
                return
            try:
                self.workspaces.at(workspace.path)
                begin(artifact)
            except UnknownArtifact:
                return  # it was disposed immediately: wait for the next one
            except OperationFailed as failure:
                on_done(None, OperationOutcome.of(failure))
            waiting.cancel()

        with suppress(UnknownArtifact):
            begin(workspace.lookup(name))
            return ENDED
        waiting = Waiting(workspace.watch(look))
        return waiting

    # ---- unknown operations

    def word_for(self, operation: str) -> str | None:
        """Return a suggestion for the name of an unknown operation that is a word of something else, or None."""

    def _unknown(self, operation: str, arity: int, places: Sequence[Workspace]) -> UnknownOperation:
        where = "workspace" if len(places) == 1 else "the workspaces"
        names, key = ", ".join(workspace.path for workspace in places), f"{operation}/{arity}"
        message = f"no artifact of {where} {names} has an operation {key}{self._hint(operation, key, places)}"
        return UnknownOperation(message, Structure("unknown_operation", (key,)))

    def _hint(self, operation: str, key: str, places: Sequence[Workspace]) -> str:
        """Return a suggestion: another number of arguments, another spelling, a word of something else."""
        offers = dict.fromkeys(self._own_actions, "")
        for place, artifact in _artifacts(places):
            for each in place.offers(artifact):
                offers.setdefault(each, f" of '{artifact.name}'")
        near = [each for each in offers if _name(each) == operation]
        if not near:
            if (word := self.word_for(operation)) is not None:
                return word
            near = close_matches(key, offers, 3)
        if near:
            return f"; did you mean {' or '.join(f'`{each}`{offers[each]}' for each in near[:3])}?"
        own = [
            (place, artifact)
            for place, artifact in _artifacts(places)
            if artifact.type_name not in DEFAULT_TYPES
        ]
        for place, artifact in own:
            if place.has_method(artifact, operation):
                return f"; the method `{operation}` of `{artifact.name}` is not an operation (add @operation)"
        return "" if own else "; the workspace has no artifacts yet (makeArtifact, or --mapping FILE)"


def _artifacts(places: Sequence[Workspace]) -> list[tuple[Workspace, ArtifactId]]:
    return [(place, artifact) for place in places for artifact in place.artifacts()]


def _name(key: str) -> str:
    return key.rpartition("/")[0]


# Ports through which a session reports what it is waiting for and executing.


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


class Account:
    """Counts what a session runs and waits for; this one counts nothing."""

    def begin(self) -> None:
        """Something with an end has begun."""

    def end(self) -> None:
        """It has ended, or was cancelled."""

    def waiting(self) -> AbstractContextManager[None]:
        """Context of a wait that something else must end, such as for a signal."""
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
