"""The joined workspaces, and the order in which they are searched."""

from collections.abc import Callable, Iterator

from jacaros.env.environment import Environment
from jacaros.env.errors import OperationFailed
from jacaros.env.ids import resolve_path
from jacaros.env.ports import Workspace
from jacaros.env.values import Structure


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
