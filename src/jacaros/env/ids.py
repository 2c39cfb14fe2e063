"""Identities of artifacts, and paths of workspaces."""


class ArtifactId:
    """The identity of an artifact: an opaque reference that the kernel creates once.

    Ids are compared by identity. A new artifact with the name of a disposed one has a different id.

    Attributes:
        name: unique in its workspace.
        type_name: the type as given to ``makeArtifact``.
        workspace: full path of the workspace, such as ``/main/lab``.
        number: order of creation in the environment, from 1.
        creator: the agent that created it. None for the environment itself.
    """

    __slots__ = ("creator", "name", "number", "type_name", "workspace")

    def __init__(self, name: str, type_name: str, workspace: str, number: int, creator: str | None) -> None:
        self.name, self.type_name, self.workspace = name, type_name, workspace
        self.number, self.creator = number, creator

    @property
    def path(self) -> str:
        """Full name, such as ``/main/lab/lamp``."""
        return f"{self.workspace}/{self.name}"

    def __repr__(self) -> str:
        return f"<{self.path}: {self.type_name}>"


def resolve_path(base: str, path: str) -> str:
    """Return *path* as a full path.

    Args:
        base: full path of the workspace that *path* is relative to.
        path: ``/main/lab``, ``lab``, ``sub/lab``, ``.`` or ``../other``.
    """
    parts = [] if path.startswith("/") else base.strip("/").split("/")
    for part in path.split("/"):
        if part == "..":
            del parts[-1:]
        elif part not in ("", "."):
            parts.append(part)
    return "/" + "/".join(parts)
