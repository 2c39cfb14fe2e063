"""The focused artifacts, in the order of focusing."""

from collections.abc import Callable

from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observer
from jacaros.env.operation import SUCCEEDED, OperationOutcome, ignore_outcome
from jacaros.env.ports import OnOutcome, Workspace
from jacaros.env.presence.filtering import Filter, FilteredObserver

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
