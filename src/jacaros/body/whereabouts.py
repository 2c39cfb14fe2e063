"""Where an agent is: the workspaces that it has joined, and the current one of each intention."""

from collections.abc import Callable, Iterator

from jacaros.env.errors import OperationFailed
from jacaros.env.ids import resolve_path
from jacaros.env.joined import in_order, joined_workspace
from jacaros.env.ports import Environment, Workspace
from jacaros.env.values import Structure


class Whereabouts:
    """The workspaces of one agent.

    An intention that has joined a workspace stays there; others use the workspace that the agent joined last.

    Args:
        environment: holds the workspaces.
        home: full path of the workspace that the agent begins in.

    Attributes:
        home: the workspace that the agent begins in.
        watcher: told of each workspace that is joined (True) or quit (False).
    """

    REMEMBERED_INTENTIONS = 1000
    """Intentions are not heard to end, so only the last ones that joined a workspace are remembered."""

    def __init__(self, environment: Environment, home: str = "/main") -> None:
        self._environment = environment
        self.home = environment.workspace(home)
        self._joined: dict[str, Workspace] = {home: self.home}
        self._last = self.home
        self.watcher: Callable[[Workspace, bool], None] | None = None
        self._of_intention: dict[int, Workspace] = {}

    def joined(self) -> tuple[Workspace, ...]:
        """The joined workspaces, in the order of joining."""
        return tuple(self._joined.values())

    def has_joined(self, path: str) -> bool:
        """Whether the agent is in the workspace with that full path."""
        return path in self._joined

    def at(self, path: str) -> Workspace:
        """The joined workspace with that full path.

        Raises:
            OperationFailed: it was not joined.
        """
        if path not in self._joined:
            raise not_joined(path)
        return self._joined[path]

    def current(self, intention: int) -> Workspace:
        """The workspace where an intention acts.

        Raises:
            OperationFailed: the agent has quit all workspaces.
        """
        found = self._of_intention.get(intention, self._last) if self._of_intention else self._last
        if found.path in self._joined:
            return found
        if not self._joined:
            raise not_joined(self.home.path)
        return self._last

    def in_order(self, intention: int) -> Iterator[Workspace]:
        """The workspaces where an intention looks for things: the current one, home, then the others."""
        return in_order(self._joined, self.current(intention), self.home)

    def find(self, path: str, intention: int) -> Workspace:
        """The workspace at *path*, which starts from the intention's current workspace, or from home without one.

        Raises:
            OperationFailed: there is none.
        """
        base = self.current(intention) if self._joined else self.home
        return self._environment.workspace(resolve_path(base.path, path))

    def named(self, name: str, intention: int) -> Workspace:
        """The joined workspace with that path or plain name.

        Raises:
            OperationFailed: no such workspace was joined.
        """
        current = self.current(intention)
        found = joined_workspace(self._environment, self._joined, current, self.home, name)
        if found is None:
            raise not_joined(name)
        return found

    def join(self, workspace: Workspace, intention: int | None = None) -> bool:
        """Make a workspace the current one; True when it was not joined before."""
        is_new = workspace.path not in self._joined
        self._joined[workspace.path] = workspace
        self._last = workspace
        if is_new and self.watcher is not None:
            self.watcher(workspace, True)
        if intention is not None:
            self._of_intention.pop(intention, None)
            self._of_intention[intention] = workspace
            if len(self._of_intention) > self.REMEMBERED_INTENTIONS:
                del self._of_intention[next(iter(self._of_intention))]
        return is_new

    def quit(self, workspace: Workspace) -> bool:
        """Leave a workspace; False when it was not joined.

        When none is left, the agent can only join one again.
        """
        if self._joined.pop(workspace.path, None) is None:
            return False
        if self._last is workspace:
            self._last = next(reversed(self._joined.values()), self.home)
        if self.watcher is not None:
            self.watcher(workspace, False)
        return True


def not_joined(path: str) -> OperationFailed:
    """The failure of an action in a workspace where the agent is not."""
    return OperationFailed(
        f'workspace {path} has not been joined; joinWorkspace("{path}") comes first',
        Structure("workspace_not_joined", (path,)),
    )
