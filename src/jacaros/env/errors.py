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

from jacaros.env.values import Atom, Structure
from jacaros.errors import JacarosError
from jacaros.suggestions import aside


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

    Attributes:
        is_explained: the message says what to do.
    """

    def __init__(self, type_name: str, candidates: Iterable[str] = (), text: str = "") -> None:
        self.type_name = type_name
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
