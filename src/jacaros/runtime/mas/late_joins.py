"""Workspaces that an agent of a project joins when they appear, such as those of other nodes."""

from collections.abc import Collection, Sequence

from jacaros.artifacts.env.errors import OperationFailed, UnknownWorkspace
from jacaros.artifacts.env.ports import UnderWay, Workspace, ignore_made
from jacaros.artifacts.presence.presence import Presence
from jacaros.runtime.mas.deployment import FocusSpec


class LateJoin:
    """Joins a workspace and focuses its artifacts whenever the workspace appears, until the agent leaves.

    After a workspace has vanished and returned, its artifacts are focused again, unless the agent has quit it meanwhile.

    Args:
        presence: the presence of the agent.
        path: full path of the workspace.
        focus: artifacts to focus.
        before: full paths of the workspaces that the project lists before it. As if all had been there from the start, it
            becomes the current workspace only if one of them, or home, is the current one.
    """

    def __init__(
        self, presence: Presence, path: str, focus: Sequence[FocusSpec], before: Collection[str]
    ) -> None:
        self._presence, self._path, self._focus = presence, path, focus
        self._before = {presence.workspaces.home.path, path, *before}
        self._seen: Workspace | None = None
        self._has_joined = False
        self._waits: list[UnderWay] = []
        presence.when_left(presence.environment.watch(path.rpartition("/")[0], self._look))
        self._look()

    def _look(self) -> None:
        before, self._seen = self._seen, self._find()
        if self._seen is None or self._seen is before:
            return
        if not self._has_joined or self._presence.workspaces.has_joined(self._path):
            self._has_joined = True
            self._enter(self._seen)

    def _find(self) -> Workspace | None:
        try:
            return self._presence.environment.workspace(self._path)
        except UnknownWorkspace:
            return None

    def _enter(self, workspace: Workspace) -> None:
        presence, current = self._presence, self._current()
        presence.join(workspace)
        if current is not None and current.path not in self._before:
            presence.join(current)
        for wait in self._waits:
            wait.cancel()
        self._waits = [
            presence.focus_when_available(workspace, each.artifact, ignore_made, each.namespace)
            for each in self._focus
        ]

    def _current(self) -> Workspace | None:
        try:
            return self._presence.workspaces.current()
        except OperationFailed:
            return None
