"""The joined workspaces, and the order in which they are searched."""

from collections.abc import Callable, Iterator
from typing import Any

from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, resolve_path
from jacaros.artifacts.env.operation import SUCCEEDED, OperationOutcome, ignore_outcome
from jacaros.artifacts.env.ports import OnOutcome, Workspace
from jacaros.artifacts.env.property import Change, ObservableProperty, Observation, Observer, SlowObserver
from jacaros.artifacts.env.values import Atom, Out, Structure, equal


class JoinedWorkspaces:
    """The joined workspaces of one presence.

    An intention that has joined a workspace stays there; everything else uses the one joined last.

    Args:
        environment: contains the workspaces.
        home: full path of the home workspace, joined from the start.

    Attributes:
        home: the home workspace.
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
        found = self._base(intention)
        if found.path not in self._joined:
            raise not_joined(found.path)
        return found

    def _base(self, intention: int | None) -> Workspace:
        """Return the workspace that paths are relative to: the current one, or home."""
        if self._of_intention and intention is not None:
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
