"""The focused artifacts of an agent, whose properties and signals it perceives."""

from collections.abc import Callable

from jacaros.bdi.state.act import Percept
from jacaros.body.filtering import Filter, FilteredObserver
from jacaros.body.percepts import ADD, REMOVE, PerceptWriter
from jacaros.body.values import References, atom_of
from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observation, Observer
from jacaros.env.operation import SUCCEEDED, OperationOutcome, ignore_outcome
from jacaros.env.ports import OnOutcome, Workspace
from jacaros.terms.values import String, Term

Watcher = Callable[[ArtifactId, bool], None]
"""Called with an artifact that is focused (True) or no longer focused (False)."""

_PERSONAL = ("body_", "session_")
"""Prefixes of the names of artifacts that stand for agents."""

Notice = Callable[[list[Percept]], None]
"""Receives percepts."""

Untaken = Callable[[str], bool]
"""Returns whether percepts about properties of a name are still unprocessed."""


class FocusObserver:
    """Perceives for an agent, in one namespace of its program.

    Attributes:
        agent: name of the agent.
        notice: receives its percepts.
        has_untaken: returns whether the mind still has unprocessed percepts about properties of a name.
    """

    __slots__ = ("_namespace", "_writer", "agent", "has_untaken", "notice")

    def __init__(
        self, agent: str, namespace: str | None, writer: PerceptWriter, notice: Notice, untaken: Untaken
    ) -> None:
        self.agent = agent
        self.has_untaken = untaken
        self.notice = notice
        self._namespace = namespace
        self._writer = writer

    def observe(self, observation: Observation) -> None:
        """Pass an observation to the mind."""
        writer, namespace = self._writer, self._namespace
        # The percepts just written for another observer are the same.
        if observation is writer.newest and namespace is writer.namespace:
            self.notice(writer.written)
        else:
            self.notice(writer.percepts(observation, namespace))


class FocusedArtifacts:
    """The artifacts that one agent focuses on, in the order of focusing.

    For each there is a belief ``focusing(Id,Name,Type,WspId,WspName,WspPath)``. An artifact can be focused in several
    namespaces, with beliefs in each.
    """

    def __init__(
        self,
        agent: str,
        writer: PerceptWriter,
        references: References,
        notice: Notice,
        untaken: Untaken = lambda name: False,
    ) -> None:
        self._agent = agent
        self._untaken = untaken
        self._writer = writer
        self._references = references
        self._notice = notice
        self._observers: dict[str | None, FocusObserver] = {}
        self._focused: dict[ArtifactId, dict[str | None, Workspace]] = {}
        self._watched: dict[tuple[Workspace, bool], Callable[[], None]] = {}
        self._filtered: dict[tuple[ArtifactId, str | None], Observer] = {}
        self._bodies: dict[str, ArtifactId] = {}
        self._watchers: dict[str, Watcher] = {}

    def inhabit(self, workspace: Workspace, body: ArtifactId) -> None:
        """Register the artifact that stands for the agent in a workspace: focused artifacts are a property of it."""
        self._bodies[workspace.path] = body

    def body_in(self, workspace: Workspace) -> ArtifactId:
        """Return the artifact that stands for the agent in a joined workspace."""
        return self._bodies[workspace.path]

    def is_body(self, artifact: ArtifactId) -> bool:
        """Return whether an artifact stands for the agent itself."""
        return self._bodies.get(artifact.workspace) is artifact

    def watch(self, workspace: Workspace, watcher: Watcher) -> Callable[[], None]:
        """Call *watcher* with every artifact of a workspace that is focused (True) or no longer focused (False).
        Return a function that removes it."""
        self._watchers[workspace.path] = watcher
        return lambda: self._watchers.pop(workspace.path, None) and None

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
        namespace: str | None,
        on_done: OnOutcome = ignore_outcome,
        only: Filter | None = None,
    ) -> None:
        """Focus on an artifact, and call *on_done*; no effect if it is already focused in that namespace.

        Args:
            workspace: workspace of the artifact.
            artifact: the artifact.
            namespace: namespace of the agent's program for beliefs and events.
            on_done: called with the outcome.
            only: filter of what is perceived; None: everything.

        Raises:
            OperationFailed: the artifact is known to be disposed.
        """
        if namespace in self._focused.get(artifact, ()):
            on_done(SUCCEEDED)
            return

        observer: Observer = self._observer(namespace)
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
            self._report(ADD, workspace, artifact)

    def end(self, artifact: ArtifactId, namespace: str | None) -> None:
        """Stop focusing on an artifact in a namespace; no effect if it is not focused there."""
        namespaces = self._focused.get(artifact, {})
        workspace = namespaces.pop(namespace, None)
        if workspace is None:
            return
        observer = self._filtered.pop((artifact, namespace), None) or self._observer(namespace)
        workspace.stop_focus(artifact, observer)
        if not namespaces:
            self._lose(workspace, artifact)

    def end_all(self, workspace: Workspace) -> None:
        """Stop focusing on everything in a workspace."""
        for artifact in self.in_workspace(workspace):
            for namespace in tuple(self._focused[artifact]):
                self.end(artifact, namespace)
        for personal in (False, True):
            stop_watching = self._watched.pop((workspace, personal), None)
            if stop_watching is not None:
                stop_watching()

    def fall_silent(self) -> None:
        """Send no more percepts to the mind."""
        self._notice = _ignore
        for observer in self._observers.values():
            observer.notice = _ignore

    def _observer(self, namespace: str | None) -> FocusObserver:
        observer = self._observers.get(namespace)
        if observer is None:
            observer = FocusObserver(self._agent, namespace, self._writer, self._notice, self._untaken)
            self._observers[namespace] = observer
        return observer

    def _watch(self, workspace: Workspace, personal: bool) -> None:
        """Watch for disposed artifacts: their properties end automatically, but ``focusing`` must be removed.

        Watch those that stand for agents only if necessary: there are as many as agents.
        """
        if (workspace, personal) in self._watched:
            return

        def look(artifact: ArtifactId, present: bool) -> None:
            if not present and artifact in self._focused:
                self._lose(workspace, artifact)

        self._watched[workspace, personal] = workspace.watch(look, personal)

    def _lose(self, workspace: Workspace, artifact: ArtifactId) -> None:
        for namespace in self._focused.pop(artifact):
            self._filtered.pop((artifact, namespace), None)
        self._report(REMOVE, workspace, artifact)

    def _report(self, kind: str, workspace: Workspace, artifact: ArtifactId) -> None:
        self._notice([self._focusing(kind, workspace, artifact)])
        watcher = self._watchers.get(workspace.path)
        if watcher is not None:
            watcher(artifact, kind is ADD)

    def _focusing(self, kind: str, workspace: Workspace, artifact: ArtifactId) -> Percept:
        arguments: tuple[Term, ...] = (
            self._references.of(artifact),
            atom_of(artifact.name),
            String(artifact.type_name),
            self._references.of(workspace),
            atom_of(workspace.name),
            String(workspace.path),
        )
        return self._writer.own(kind, self._bodies[workspace.path], "focusing", *arguments)


def _ignore(percepts: list[Percept]) -> None:
    """Discard percepts after the agent's end."""
