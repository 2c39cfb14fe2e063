"""What can go wrong with workspaces and artifacts.

WorkspaceError                wrong use of the Python interface
├── InvalidArtifact           an artifact class that cannot work, or a call outside of an operation
├── UnknownProperty           an artifact asks for a property that it does not have
└── UnknownArtifactType       nobody knows the type given to makeArtifact
OperationFailed               what an agent asked for failed; carries the reason term
├── UnknownArtifact           no artifact of that name, or it is gone
└── UnknownWorkspace          no workspace of that path
"""

import difflib
from collections.abc import Iterable

from jacaros.env.values import Atom, Structure
from jacaros.errors import JacarosError


class WorkspaceError(JacarosError):
    """Wrong use of workspaces and artifacts from Python."""


class InvalidArtifact(WorkspaceError):
    """An artifact class that cannot work as declared, or a call made outside of an operation."""


class UnknownProperty(WorkspaceError):
    """An artifact asks for an observable property that it does not have."""


class UnknownArtifactType(WorkspaceError):
    """Nobody knows the type given to ``makeArtifact``; raised by an environment's ``find_type``.

    Args:
        type_name: the type that was asked for.
        candidates: names of known types, for a spelling suggestion.
        text: the message, when more can be said than that the type is unknown.
    """

    def __init__(self, type_name: str, candidates: Iterable[str] = (), text: str = "") -> None:
        self.type_name = type_name
        self.candidates = tuple(candidates)
        message = text or f"no artifact type is called {type_name}"
        super().__init__(message + spelling_hint(type_name, self.candidates))


class OperationFailed(Exception):
    """What an agent asked of an artifact or workspace failed.

    Attributes:
        message: text for people (``error_msg``).
        reason: term for programs (inside ``env_failure_reason``), None when the operation gave none.
    """

    def __init__(self, message: str, reason: Structure | Atom | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.reason = reason


class UnknownArtifact(OperationFailed):
    """No artifact of that name is there, or it is there no more."""


class UnknownWorkspace(OperationFailed):
    """No workspace of that path is there."""


def spelling_hint(wrong: str, candidates: Iterable[str]) -> str:
    """Say which of *candidates* may have been meant by *wrong*; empty when none is near."""
    near = difflib.get_close_matches(wrong, dict.fromkeys(candidates), n=3, cutoff=0.6)
    return f"; did you mean {' or '.join(near)}?" if near else ""
