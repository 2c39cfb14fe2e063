"""Errors of workspaces and artifacts.

WorkspaceError                wrong use of the Python interface
├── InvalidArtifact           an invalid artifact class, or a call outside of an operation
├── UnknownProperty           an artifact reads a property that it does not have
└── UnknownArtifactType       the type given to makeArtifact is unknown

OperationFailed               an agent's request failed; carries the reason term
├── UnknownArtifact           no artifact has this name, or it is gone
└── UnknownWorkspace          no workspace has this path
"""

import difflib
from collections.abc import Iterable

from jacaros.env.values import Atom, Structure
from jacaros.errors import JacarosError


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
    """

    def __init__(self, type_name: str, candidates: Iterable[str] = (), text: str = "") -> None:
        self.type_name = type_name
        self.candidates = tuple(candidates)
        message = text or f"unknown artifact type `{type_name}`"
        super().__init__(message + suggestion(type_name, self.candidates))


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


def suggestion(wrong: str, candidates: Iterable[str]) -> str:
    """Return a suggestion, such as ``; did you mean …?``, of the *candidates* near *wrong*. Empty if none is near."""
    near = difflib.get_close_matches(wrong, dict.fromkeys(candidates), n=3, cutoff=0.6)
    return f"; did you mean {' or '.join(f'`{name}`' for name in near)}?" if near else ""
