"""The workspaces that a session has joined, and the order of lookup."""

from jacaros.env.environment import Environment
from jacaros.env.errors import OperationFailed
from jacaros.env.ids import ArtifactId, resolve_path
from jacaros.env.lookup import in_order, joined_workspace
from jacaros.env.ports import Workspace
from jacaros.env.values import Structure


class SessionWorkspaces:
    """The joined workspaces. The one joined last is the current one.

    Args:
        environment: contains the workspaces.
        home: full path of the first one.

    Raises:
        UnknownWorkspace: the workspace *home* does not exist.
    """

    def __init__(self, environment: Environment, home: str) -> None:
        self._environment = environment
        self._home = environment.workspace(home)
        self._joined: dict[str, Workspace] = {self._home.path: self._home}

    @property
    def joined(self) -> tuple[str, ...]:
        """Full paths, in the order of joining. The current one comes last."""
        return tuple(self._joined)

    @property
    def current(self) -> Workspace:
        """The one joined last, or home if none is left."""
        return next(reversed(self._joined.values()), self._home)

    def in_order(self) -> tuple[Workspace, ...]:
        """Return the workspaces in the order of lookup: the current one, home, then the others in the order of joining."""
        return tuple(in_order(self._joined, self.current, self._home))

    def join(self, path: str) -> Workspace:
        """Make the workspace at *path*, relative to the current one, the current one.

        Raises:
            UnknownWorkspace: the workspace does not exist.
        """
        workspace = self._environment.workspace(resolve_path(self.current.path, path))
        self._joined.pop(workspace.path, None)
        self._joined[workspace.path] = workspace
        return workspace

    def quit(self, name: str) -> Workspace:
        """Leave a joined workspace.

        Raises:
            OperationFailed: it is not joined.
        """
        workspace = self.named(name)
        del self._joined[workspace.path]
        return workspace

    def named(self, name: str) -> Workspace:
        """Return the joined workspace with this path or name.

        Raises:
            OperationFailed: it is not joined.
        """
        found = joined_workspace(self._environment, self._joined, self.current, self._home, name)
        if found is None:
            raise _not_joined(name)
        return found

    def of(self, artifact: ArtifactId) -> Workspace:
        """Return the joined workspace of an artifact.

        Raises:
            OperationFailed: it is not joined.
        """
        workspace = self._joined.get(artifact.workspace)
        if workspace is None:
            raise _not_joined(artifact.workspace)
        return workspace

    def place(self, path: str) -> tuple[Workspace, str]:
        """Return the workspace and the plain name that the name or path of an artifact means.

        Raises:
            UnknownWorkspace: the workspace does not exist.
        """
        if "/" not in path:
            return self.current, path
        above, _, name = resolve_path(self.current.path, path).rpartition("/")
        return self._environment.workspace(above), name


def _not_joined(path: str) -> OperationFailed:
    return OperationFailed(
        f"workspace {path} has not been joined; join it first",
        Structure("workspace_not_joined", (str.__str__(path),)),
    )
