"""The workspaces of another member, at the paths at which they are visible here.

A workspace keeps its path where that is free, else it is ``PATH@member``. It gives way to one that is created here later.
"""

import asyncio
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial

from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import OperationFailed
from jacaros.fleet import protocol
from jacaros.fleet.remote import RemoteWorkspace, RemoteWorkspaces


class MountedWorkspaces:
    """The workspaces of one member.

    Args:
        member: its name.
        remote: what all of them share.
        environment: returns the environment of this member, or None if its agents use no artifacts.
        report: writes a warning into the log.
    """

    def __init__(
        self,
        member: str,
        remote: RemoteWorkspaces,
        environment: Callable[[], Environment | None],
        report: Callable[[str], None],
    ) -> None:
        self._member, self._remote, self._environment, self._report = member, remote, environment, report
        self._mounted: dict[str, tuple[RemoteWorkspace, Callable[[], None]]] = {}

    def __iter__(self) -> Iterator[str]:
        """Iterate over their paths there."""
        return iter(tuple(self._mounted))

    def path_of(self, path: str) -> str:
        """Return the path at which a workspace is visible here."""
        known = self._mounted.get(path)
        return known[0].path if known is not None else f"{path}@{self._member}"

    def keep_only(self, paths: Collection[str]) -> None:
        """Remove all other workspaces."""
        for path in self:
            if path not in paths:
                self.remove(path)

    def told_all(self, workspaces: Sequence[tuple[str, Sequence[protocol.ArtifactData]]]) -> None:
        """Hear of all workspaces, with their artifacts."""
        for path, artifacts in workspaces:
            self.add(path)
            if path in self._mounted:
                self._mounted[path][0].told_all(artifacts)

    def told(self, path: str, number: int, data: protocol.ArtifactData | None) -> None:
        """Hear of a change of an artifact. See `RemoteWorkspace.told`."""
        if path in self._mounted:
            self._mounted[path][0].told(number, data)

    def add(self, path: str) -> None:
        """Mount a workspace. Without effect if it is known, or agents here use no artifacts.

        Raises:
            OperationFailed: that is impossible.
        """
        environment = self._environment()
        if path in self._mounted or environment is None:
            return
        seen_as = path
        is_taken = any(each.path == path for each in environment.workspaces())
        if is_taken or "@" in path:  # it may be that of another member, which is not there yet
            seen_as = f"{path}@{self._member}"
            if is_taken and path != "/main":
                self._report(f"its workspace {path} is {seen_as} here, where {path} exists already")
        remote = RemoteWorkspace(seen_as, path, self._member, self._remote)
        # Before it is mounted, so that its artifacts get its path.
        self._mounted[path] = remote, lambda: None
        try:
            self._mounted[path] = remote, environment.mount(remote, partial(self._give_way, path))
        except OperationFailed:
            del self._mounted[path]
            raise

    def remove(self, path: str) -> None:
        """Unmount a workspace that is gone."""
        known = self._mounted.pop(path, None)
        if known is not None:
            remote, unmount = known
            remote.remove_all()
            unmount()

    def _give_way(self, path: str) -> None:
        """Take another path: this system creates a workspace at that of one."""
        artifacts = self._mounted[path][0].data()
        self.remove(path)
        asyncio.get_running_loop().call_soon(self._return, path, artifacts)

    def _return(self, path: str, artifacts: Sequence[protocol.ArtifactData]) -> None:
        if path not in self._mounted and self._remote.present:
            self.add(path)
            self._mounted[path][0].told_all(artifacts)
