"""The workspaces of an environment by path, and the links between them."""

from collections.abc import Callable

from jacaros.env.errors import OperationFailed, UnknownWorkspace
from jacaros.env.ids import resolve_path
from jacaros.env.ports import Workspace
from jacaros.env.values import Structure
from jacaros.suggestions import aside

_LINKS_ON_ONE_PATH = 100
"""A path with more links than this is a cycle."""


class WorkspaceTree:
    """Workspaces by full path. A link gives a workspace a second path.

    Args:
        make: creates the workspace with this full path in a parent workspace (None for the root).
    """

    def __init__(self, make: Callable[[str, Workspace | None], Workspace]) -> None:
        self._make = make
        self._workspaces: dict[str, Workspace] = {}
        self._links: dict[str, str] = {}
        self._watchers: dict[str, list[Callable[[], None]]] = {}

    def workspaces(self) -> tuple[Workspace, ...]:
        """Return all workspaces, the oldest first."""
        return tuple(self._workspaces.values())

    def at(self, path: str, otherwise: Workspace) -> Workspace:
        """Return the workspace with this full path, without following links."""
        return self._workspaces.get(path, otherwise)

    def workspace(self, path: str) -> Workspace:
        """Return the workspace with this full path, which may contain names of links.

        Raises:
            UnknownWorkspace: the workspace does not exist.
        """
        found = self._workspaces.get(path) or self._workspaces.get(self._without_links(path))
        if found is None:
            help = aside(path, (*self._workspaces, *self._links))
            reason = Structure("unknown_workspace", (str.__str__(path),))
            raise UnknownWorkspace(f"unknown workspace `{path}`{help}", reason)
        return found

    def place(self, here: Workspace, path: str) -> tuple[Workspace, str]:
        """Return the workspace and the plain name of an artifact, given its name, or its path relative to *here*.

        Raises:
            UnknownWorkspace: the workspace does not exist.
        """
        if "/" not in path:
            return here, path
        above, _, name = resolve_path(here.path, path).rpartition("/")
        return self.workspace(above), name

    def _without_links(self, path: str) -> str:
        for _ in range(_LINKS_ON_ONE_PATH):
            link = next((p for p in _beginnings(path) if p in self._links), None)
            if link is None:
                return path
            path = self._links[link] + path[len(link) :]
        return path

    def create_workspace(self, path: str) -> Workspace:
        """Create a workspace with its standard artifacts at a full path. Its parent workspace must exist.

        Raises:
            OperationFailed: it already exists; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the parent workspace does not exist.
        """
        path = self._free(path)
        above = path.rpartition("/")[0]
        workspace = self._workspaces[path] = self._make(path, self.workspace(above) if above else None)
        self._tell(path)
        return workspace

    def mount(self, workspace: Workspace) -> Callable[[], None]:
        """Add a remote workspace at its path. Return a function that removes it.

        Raises:
            OperationFailed: the path is in use; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the parent workspace does not exist.
        """
        path = self._free(workspace.path)
        self._workspaces[path] = workspace
        self._tell(path)

        def unmount() -> None:
            if self._workspaces.get(path) is workspace:
                del self._workspaces[path]
                self._tell(path)

        return unmount

    def link_workspace(self, path: str, target: str) -> None:
        """Make an unused full path lead to the workspace at another path.

        Raises:
            OperationFailed: the path is in use; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the target, or the parent workspace of the path, does not exist.
        """
        to = self.workspace(target)
        path = self._free(path)
        self._links[path] = to.path
        self._tell(path)

    def _free(self, path: str) -> str:
        """Return an unused path, with its links resolved."""
        above, _, name = str.__str__(path).rpartition("/")
        path = f"{self.workspace(above).path}/{name}" if above else path
        if not name or path in self._workspaces or path in self._links:
            reason = Structure("workspace_already_present", (str.__str__(path),))
            raise OperationFailed(f"workspace `{path}` already exists", reason)
        return path

    def children(self, path: str) -> tuple[str, ...]:
        """Return the names of the workspaces directly below one."""
        return tuple(w.name for w in self._workspaces.values() if w.path.rpartition("/")[0] == path)

    def links(self, path: str) -> tuple[tuple[str, str], ...]:
        """Return the links in a workspace: their names, and the full paths they lead to."""
        found = ((at.rpartition("/"), to) for at, to in self._links.items())
        return tuple((name, to) for (above, _, name), to in found if above == path)

    def watch(self, path: str, watcher: Callable[[], None]) -> None:
        """Call *watcher* whenever a workspace or link directly below a workspace is added or removed."""
        self._watchers.setdefault(path, []).append(watcher)

    def _tell(self, path: str) -> None:
        for watcher in self._watchers.get(path.rpartition("/")[0], ()):
            watcher()


def _beginnings(path: str) -> list[str]:
    """Return the full paths of the workspaces above a path and of the path itself, the shortest first."""
    parts = path.split("/")
    return ["/".join(parts[:length]) for length in range(2, len(parts) + 1)]
