"""Errors of workspaces and artifacts.

WorkspaceError                wrong use of the Python interface
├── InvalidArtifact           an invalid artifact class, or a call outside of an operation
├── UnknownProperty           an artifact reads a property that it does not have
└── UnknownArtifactType       the type given to makeArtifact is unknown

OperationFailed               an agent's request failed; carries the reason term
├── UnknownArtifact           no artifact has this name, or it is gone
└── UnknownWorkspace          no workspace has this path
"""

from collections.abc import Iterable

from jacaros.artifacts.env.values import Atom, Structure
from jacaros.runtime.errors import JacarosError
from jacaros.runtime.files.texts import aside


class WorkspaceError(JacarosError):
    """Wrong use of workspaces and artifacts from Python."""


class InvalidArtifact(WorkspaceError):
    """An invalid artifact class, or a call outside of an operation."""


class UnknownProperty(WorkspaceError):
    """An artifact reads an observable property that it does not have."""


class UnknownArtifactType(WorkspaceError):
    """The type given to ``makeArtifact`` is unknown. Raised by an environment's ``find_type``.

    Args:
        type_name: the unknown type.
        candidates: names of known types, for a suggestion.
        text: a more specific message.
        help: what to do, if the message does not say it.

    Attributes:
        is_explained: the message says what to do.
    """

    def __init__(
        self, type_name: str, candidates: Iterable[str] = (), text: str = "", help: str | None = None
    ) -> None:
        self.type_name = type_name
        self.help = help
        meant = aside(type_name, candidates)
        self.is_explained = bool(text or meant)
        super().__init__((text or f"unknown artifact type `{type_name}`") + meant)


class OperationFailed(Exception):
    """A request of an agent to an artifact or workspace failed.

    Attributes:
        message: text for users (``error_msg``).
        reason: term for programs (inside ``env_failure_reason``), or None.
    """

    def __init__(self, message: str, reason: Structure | Atom | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.reason = reason


class UnknownArtifact(OperationFailed):
    """No artifact has this name, or it is gone."""


class UnknownWorkspace(OperationFailed):
    """No workspace has this path."""


# Identities of artifacts, and paths of workspaces.


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
