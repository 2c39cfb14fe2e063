"""The presence of an agent, a script or a behaviour tree in an environment.

CArtAgO's rules decide which artifact serves an operation. A `Direction` selects it: an artifact by id, or by its name in
the given workspace. With a namespace, the artifacts focused in that namespace come first. Otherwise the workspaces are
searched: the current one, home, then the others (see `jacaros.artifacts.env.workspace` for several candidates in one).
"""

import asyncio
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

from jacaros.artifacts.env.environment import DEFAULT_TYPES, Environment
from jacaros.artifacts.env.errors import (
    ArtifactId,
    OperationFailed,
    UnknownArtifact,
    UnknownProperty,
    resolve_path,
)
from jacaros.artifacts.env.operation import SUCCEEDED, OperationOutcome, ignore_outcome
from jacaros.artifacts.env.ports import ENDED, OnMade, OnOutcome, UnderWay, WaitingRequest, Workspace
from jacaros.artifacts.env.property import (
    Change,
    ObservableProperty,
    Observation,
    Observer,
    SlowObserver,
    fits,
)
from jacaros.artifacts.env.values import Atom, Out, Structure, equal, plain
from jacaros.artifacts.env.workspace import artifact_named, chosen_artifact
from jacaros.runtime.clock import Clock
from jacaros.runtime.files.texts import aside, close_matches

# The joined workspaces, and the order in which they are searched.


class JoinedWorkspaces:
    """The joined workspaces of one presence.

    An intention that has joined a workspace stays there; everything else uses the one joined last.

    Args:
        environment: contains the workspaces.
        home: full path of the home workspace, joined from the start.

    Attributes:
        home: the home workspace.
        here: the current workspace of all intentions. None if they differ, or if none is joined.
        watcher: called with each workspace that is joined (True) or quit (False).

    Raises:
        UnknownWorkspace: the workspace *home* does not exist.
    """

    REMEMBERED_INTENTIONS = 1000
    """The end of intentions is not reported, so only the last ones that joined a workspace are remembered."""

    def __init__(self, environment: Environment, home: str = "/main") -> None:
        self._environment = environment
        self.home = environment.workspace(home)
        self._joined: dict[str, Workspace] = {self.home.path: self.home}
        self._last = self.home
        self.here: Workspace | None = self.home
        self.watcher: Callable[[Workspace, bool], None] | None = None
        self._of_intention: dict[int, Workspace] = {}

    def joined(self) -> tuple[Workspace, ...]:
        """Return the joined workspaces, in the order of joining; the one joined last comes last."""
        return tuple(self._joined.values())

    def has_joined(self, path: str) -> bool:
        """Return whether the workspace with that full path is joined."""
        return path in self._joined

    def at(self, path: str) -> Workspace:
        """Return the joined workspace with that full path.

        Raises:
            OperationFailed: it is not joined.
        """
        if path not in self._joined:
            raise not_joined(path)
        return self._joined[path]

    def current(self, intention: int | None = None) -> Workspace:
        """Return the current workspace, of an intention if given.

        Raises:
            OperationFailed: no workspace is joined.
        """
        found = self._base(intention) if self._of_intention else self._last
        if found.path not in self._joined:
            raise not_joined(found.path)
        return found

    def _base(self, intention: int | None) -> Workspace:
        """Return the workspace that paths are relative to: the current one, or home."""
        if intention is not None:
            found = self._of_intention.get(intention, self._last)
            if found.path in self._joined:
                return found
        return self._last

    def in_order(self, intention: int | None = None) -> Iterator[Workspace]:
        """Yield the workspaces in the order of search: the current one, home, then the others.

        Raises:
            OperationFailed: no workspace is joined.
        """
        current, home = self.current(intention), self.home
        yield current
        if home is not current and home.path in self._joined:
            yield home
        yield from (each for each in self._joined.values() if each is not current and each is not home)

    def find(self, path: str, intention: int | None = None) -> Workspace:
        """Return the workspace at *path*, relative to the current one, or to home.

        Raises:
            UnknownWorkspace: it does not exist.
        """
        return self._environment.workspace(resolve_path(self._base(intention).path, path))

    def named(self, name: str, intention: int | None = None) -> Workspace:
        """Return the joined workspace with that path or plain name.

        Raises:
            OperationFailed: it is not joined.
        """
        full = resolve_path(self._base(intention).path, name)
        for workspace in self.in_order(intention) if self._joined else ():
            if full == workspace.path or workspace.name == name:
                return workspace
        try:
            # The path may contain a link.
            return self._joined[self._environment.workspace(full).path]
        except (KeyError, OperationFailed):
            raise not_joined(name) from None

    def join(self, workspace: Workspace, intention: int | None = None) -> bool:
        """Make a workspace the current one. Return True if it was not joined before."""
        is_new = self._joined.pop(workspace.path, None) is None
        self._joined[workspace.path] = self._last = workspace
        if intention is None and not self._of_intention:
            self.here = workspace
        else:
            self.here = None
        if is_new and self.watcher is not None:
            self.watcher(workspace, True)
        if intention is not None:
            self._of_intention.pop(intention, None)
            self._of_intention[intention] = workspace
            if len(self._of_intention) > self.REMEMBERED_INTENTIONS:
                del self._of_intention[next(iter(self._of_intention))]
        return is_new

    def quit(self, workspace: Workspace) -> None:
        """Leave a joined workspace. When none is left, one must be joined before anything else."""
        del self._joined[workspace.path]
        if self._last is workspace:
            self._last = next(reversed(self._joined.values()), self.home)
        self.here = self._last if self._joined and not self._of_intention else None
        if self.watcher is not None:
            self.watcher(workspace, False)


def not_joined(path: str) -> OperationFailed:
    """Return the failure of a request to a workspace that has not been joined."""
    return OperationFailed(
        f"workspace {path} has not been joined; join it first",
        Structure("workspace_not_joined", (str.__str__(path),)),
    )


# Filters of focused artifacts: the second argument of ``focus`` and ``focusWhenAvailable``.
#
# ============================  ==============================================================================
# filter                        what passes
# ============================  ==============================================================================
# a pattern, ``count(_)``       properties and signals of that name and number of arguments; arguments that are
# not variables must be equal
# an atom, ``tick``             all properties and signals of that name, whatever their arguments
# a list of these               what one of them lets pass
# ============================  ==============================================================================


class Filter:
    """Lets pass what matches a pattern.

    Args:
        patterns: atoms for any arguments, structures with `Out` objects for any value.
    """

    def __init__(self, patterns: list[Atom | Structure]) -> None:
        self._patterns = patterns

    def passes(self, name: str, values: tuple[object, ...]) -> bool:
        """Return whether a property or signal matches one of the patterns."""
        return any(_fits(pattern, name, values) for pattern in self._patterns)


def _fits(pattern: Atom | Structure, name: str, values: tuple[object, ...]) -> bool:
    if isinstance(pattern, Atom):
        return name == str.__str__(pattern)
    if pattern.functor != name or len(pattern.arguments) != len(values):
        return False
    pairs = zip(pattern.arguments, values, strict=True)
    return all(isinstance(wanted, Out) or equal(wanted, value) for wanted, value in pairs)


def filter_of(value: Any) -> Filter | None:
    """Convert a plain value to a filter; None if it is not one."""
    patterns = value if isinstance(value, list) else [value]
    is_filter = patterns and all(isinstance(pattern, (Atom, Structure)) for pattern in patterns)
    return Filter(patterns) if is_filter else None


class FilteredObserver:
    """Forwards to another observer what a filter lets pass.

    Forwarded values of a property are stored, because they are what ends when it changes or disappears.
    """

    def __init__(self, observer: Observer, wanted: Filter) -> None:
        self._observer, self._filter = observer, wanted
        self._slow = observer if isinstance(observer, SlowObserver) else None
        self._shown: dict[int, ObservableProperty] = {}

    @property
    def agent(self) -> str:
        """Name of the observing agent."""
        return self._observer.agent

    def has_untaken(self, name: str) -> bool:
        """Return whether the other observer lags behind."""
        return self._slow is not None and self._slow.has_untaken(name)

    def observe(self, observation: Observation) -> None:
        """Forward what passes."""
        signals = tuple(each for each in observation.signals if self._filter.passes(*each))
        changed: list[Change] = []
        added: list[ObservableProperty] = []
        removed = [self._shown.pop(each.key) for each in observation.removed if each.key in self._shown]
        for _, new in observation.changed:
            self._change(new, changed, added, removed)
        for each in observation.added:
            if self._filter.passes(each.name, each.values):
                added.append(each)
                self._shown[each.key] = each
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
        if self._filter.passes(new.name, new.values):
            self._shown[new.key] = new
            if old is None:
                added.append(new)
            else:
                changed.append((old, new))
        elif old is not None:
            removed.append(self._shown.pop(new.key))


# The focused artifacts, in the order of focusing.


_PERSONAL = ("body_", "session_")
"""Prefixes of the names of artifacts that stand for agents."""


class Focused:
    """The artifacts that one presence focuses, in the order of focusing.

    An artifact can be focused in several namespaces of an agent's program. A subclass provides the observers.
    """

    def __init__(self) -> None:
        self._focused: dict[ArtifactId, dict[str | None, Workspace]] = {}
        self._watched: dict[tuple[Workspace, bool], Callable[[], None]] = {}
        self._filtered: dict[tuple[ArtifactId, str | None], Observer] = {}

    def observer(self, namespace: str | None) -> Observer:
        """Return the observer for a namespace."""
        raise NotImplementedError

    def began(self, workspace: Workspace, artifact: ArtifactId) -> None:
        """Note that an artifact is focused; its properties may have arrived before."""

    def ended(self, workspace: Workspace, artifact: ArtifactId, disposed: bool) -> None:
        """Note that an artifact is no longer focused; if it is *disposed*, the last observation may follow."""

    def __contains__(self, artifact: ArtifactId) -> bool:
        return artifact in self._focused

    def in_order(self) -> tuple[ArtifactId, ...]:
        """Return the focused artifacts, in the order of focusing."""
        return tuple(self._focused)

    def in_namespace(self, namespace: str) -> list[tuple[Workspace, ArtifactId]]:
        """Return the artifacts focused in a namespace with their workspaces, in the order of focusing."""
        return [
            (namespaces[namespace], artifact)
            for artifact, namespaces in self._focused.items()
            if namespace in namespaces
        ]

    def in_workspace(self, workspace: Workspace) -> tuple[ArtifactId, ...]:
        """Return the focused artifacts of a workspace."""
        return tuple(a for a in self._focused if a.workspace == workspace.path)

    def begin(
        self,
        workspace: Workspace,
        artifact: ArtifactId,
        namespace: str | None = None,
        on_done: OnOutcome = ignore_outcome,
        only: Filter | None = None,
    ) -> None:
        """Focus an artifact, and call *on_done*; no effect if it is already focused in that namespace.

        Args:
            workspace: workspace of the artifact.
            artifact: the artifact.
            namespace: namespace of the agent's program for beliefs and events.
            on_done: called with the outcome.
            only: filter of what is perceived; None: everything.

        Raises:
            UnknownArtifact: the artifact is known to be disposed.
        """
        if namespace in self._focused.get(artifact, ()):
            on_done(SUCCEEDED)
            return
        observer = self.observer(namespace)
        if only is not None:
            observer = FilteredObserver(observer, only)

        def focused(outcome: OperationOutcome) -> None:
            if outcome.ok:
                if only is not None:
                    self._filtered[artifact, namespace] = observer
                self._take(workspace, artifact, namespace)
            on_done(outcome)

        workspace.focus(artifact, observer, focused)

    def _take(self, workspace: Workspace, artifact: ArtifactId, namespace: str | None) -> None:
        is_first = artifact not in self._focused
        self._focused.setdefault(artifact, {})[namespace] = workspace
        self._watch(workspace, artifact.name.startswith(_PERSONAL))
        if is_first:
            self.began(workspace, artifact)

    def end(self, artifact: ArtifactId, namespace: str | None = None) -> None:
        """Stop focusing an artifact in a namespace; no effect if it is not focused there."""
        namespaces = self._focused.get(artifact, {})
        workspace = namespaces.pop(namespace, None)
        if workspace is None:
            return
        observer = self._filtered.pop((artifact, namespace), None) or self.observer(namespace)
        workspace.stop_focus(artifact, observer)
        if not namespaces:
            self._lose(workspace, artifact, False)

    def end_all(self, workspace: Workspace) -> None:
        """Stop focusing everything in a workspace."""
        for artifact in self.in_workspace(workspace):
            for namespace in tuple(self._focused[artifact]):
                self.end(artifact, namespace)
        for personal in (False, True):
            stop_watching = self._watched.pop((workspace, personal), None)
            if stop_watching is not None:
                stop_watching()

    def _watch(self, workspace: Workspace, personal: bool) -> None:
        """Watch for disposed artifacts: their properties end automatically, the focus does not.

        Watch those that stand for agents only if necessary: there are as many as agents.
        """
        if (workspace, personal) in self._watched:
            return

        def look(artifact: ArtifactId, present: bool) -> None:
            if not present and artifact in self._focused:
                self._lose(workspace, artifact, True)

        self._watched[workspace, personal] = workspace.watch(look, personal)

    def _lose(self, workspace: Workspace, artifact: ArtifactId, disposed: bool) -> None:
        for namespace in self._focused.pop(artifact):
            self._filtered.pop((artifact, namespace), None)
        self.ended(workspace, artifact, disposed)


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
        self._when_left: list[Callable[[], None]] = []

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
        while self._when_left:
            self._when_left.pop()()
        for workspace in self.workspaces.joined():
            self.focused.end_all(workspace)
            self.workspaces.quit(workspace)

    def when_left(self, callback: Callable[[], None]) -> None:
        """Call *callback* when everything ends, see `leave`."""
        self._when_left.append(callback)

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
            here = self.workspaces.here or self.workspaces.current(intention)
            candidates = here.known.get((operation, arity)) or here.providers(operation, arity)
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
        waiting = WaitingRequest(workspace.watch(look))
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


OperationObserver = Callable[[str, str, object, str], None]
"""Takes the state of an operation or goal (``executing``, ``achieved``, ``failed``, ``dropped``), its text, an object that
identifies it, and the reason of a failure as text.
"""


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
