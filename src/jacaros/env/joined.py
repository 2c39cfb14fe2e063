"""The rules of joined workspaces: in which order things are looked for, and what a name means."""

from collections.abc import Iterator, Mapping

from jacaros.env.errors import OperationFailed
from jacaros.env.ids import resolve_path
from jacaros.env.ports import Environment, Workspace


def in_order(joined: Mapping[str, Workspace], current: Workspace, home: Workspace) -> Iterator[Workspace]:
    """Where things are looked for: the current workspace, home while it is joined, then the others.

    Args:
        joined: the joined workspaces by full path, in the order of joining.
        current: the current one.
        home: the one in which everything began.
    """
    yield current
    if home is not current and home.path in joined:
        yield home
    if len(joined) > 1:
        yield from (w for w in joined.values() if w is not current and w is not home)


def joined_workspace(
    environment: Environment, joined: Mapping[str, Workspace], current: Workspace, home: Workspace, name: str
) -> Workspace | None:
    """The joined workspace with that plain name or path, which starts from the current one; None without one."""
    full = resolve_path(current.path, name)
    for workspace in in_order(joined, current, home):
        if (workspace.path == full or workspace.name == name) and workspace.path in joined:
            return workspace
    try:
        # A link may lead there.
        return joined.get(environment.workspace(full).path)
    except OperationFailed:
        return None
