"""The workspaces of an environment by their paths, and the links between them."""

from collections.abc import Callable

from jacaros.env.errors import OperationFailed, UnknownWorkspace, spelling_hint
from jacaros.env.ports import Workspace
from jacaros.env.values import Structure

_LINKS_ON_ONE_PATH = 100
"""So many links one behind the other lead in a circle."""


class WorkspaceTree:
    """Workspaces by full path; a link gives one of them a second place.

    Args:
        make: makes the workspace with that full path in another one (None for the first of all).
    """

    def __init__(self, make: Callable[[str, Workspace | None], Workspace]) -> None:
        self._make = make
        self._workspaces: dict[str, Workspace] = {}
        self._links: dict[str, str] = {}
        self._watchers: dict[str, list[Callable[[], None]]] = {}

    def all(self) -> tuple[Workspace, ...]:
        """All workspaces, the oldest first."""
        return tuple(self._workspaces.values())

    def at(self, path: str, otherwise: Workspace) -> Workspace:
        """The workspace with that full path, without regard to links."""
        return self._workspaces.get(path, otherwise)

    def find(self, path: str) -> Workspace:
        """The workspace at a full path, in which names of links may stand.

        Raises:
            UnknownWorkspace: there is none.
        """
        found = self._workspaces.get(path) or self._workspaces.get(self._without_links(path))
        if found is None:
            help = spelling_hint(path, (*self._workspaces, *self._links))
            reason = Structure("unknown_workspace", (str.__str__(path),))
            raise UnknownWorkspace(f"there is no workspace {path}{help}", reason)
        return found

    def _without_links(self, path: str) -> str:
        for _ in range(_LINKS_ON_ONE_PATH):
            link = next((p for p in _beginnings(path) if p in self._links), None)
            if link is None:
                return path
            path = self._links[link] + path[len(link) :]
        return path

    def create(self, path: str) -> Workspace:
        """Make a workspace at a full path; the one that it is a part of must be there.

        Raises:
            OperationFailed: it is there already; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the workspace above it is not there.
        """
        path = self._free(path)
        above = path.rpartition("/")[0]
        workspace = self._workspaces[path] = self._make(path, self.find(above) if above else None)
        self._tell(path)
        return workspace

    def mount(self, workspace: Workspace) -> Callable[[], None]:
        """Have a workspace at its path that was not made here; gives what ends that.

        Raises:
            OperationFailed: something is there already; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the workspace above the path is not there.
        """
        path = self._free(workspace.path)
        self._workspaces[path] = workspace
        self._tell(path)

        def unmount() -> None:
            if self._workspaces.get(path) is workspace:
                del self._workspaces[path]
                self._tell(path)

        return unmount

    def link(self, path: str, target: str) -> None:
        """Let a full path, at which there is nothing yet, lead to the workspace at another one.

        Raises:
            OperationFailed: something is there already; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the target, or the workspace above the path, is not there.
        """
        to = self.find(target)
        path = self._free(path)
        self._links[path] = to.path
        self._tell(path)

    def _free(self, path: str) -> str:
        """A path for something new, without links in it."""
        above, _, name = str.__str__(path).rpartition("/")
        path = f"{self.find(above).path}/{name}" if above else path
        if not name or path in self._workspaces or path in self._links:
            reason = Structure("workspace_already_present", (str.__str__(path),))
            raise OperationFailed(f"there is a workspace {path} already", reason)
        return path

    def children(self, path: str) -> tuple[str, ...]:
        """Names of the workspaces directly below one."""
        return tuple(w.name for w in self._workspaces.values() if w.path.rpartition("/")[0] == path)

    def links(self, path: str) -> tuple[tuple[str, str], ...]:
        """The links in a workspace: their names, and the full paths to which they lead."""
        found = ((at.rpartition("/"), to) for at, to in self._links.items())
        return tuple((name, to) for (above, _, name), to in found if above == path)

    def watch(self, path: str, watcher: Callable[[], None]) -> None:
        """Call *watcher* whenever there is something else directly below a workspace."""
        self._watchers.setdefault(path, []).append(watcher)

    def _tell(self, path: str) -> None:
        for watcher in self._watchers.get(path.rpartition("/")[0], ()):
            watcher()


def _beginnings(path: str) -> list[str]:
    """The full paths with which a path begins, the shortest first."""
    parts = path.split("/")
    return ["/".join(parts[:length]) for length in range(2, len(parts) + 1)]
