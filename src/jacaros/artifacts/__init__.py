"""Workspaces and artifacts as in CArtAgO, usable without agents.

To write artifacts, use `Artifact`, the decorators and the plain values. A host uses `Environment`. To use artifacts from
Python, use a `Session`. Each name is loaded on first use. No artifact depends on agents.
"""

from typing import TYPE_CHECKING

from jacaros.runtime.exports import exported

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact
    from jacaros.artifacts.env.environment import Environment
    from jacaros.artifacts.env.errors import (
        ArtifactId,
        InvalidArtifact,
        OperationFailed,
        UnknownArtifact,
        UnknownArtifactType,
        UnknownProperty,
        UnknownWorkspace,
        WorkspaceError,
        resolve_path,
    )
    from jacaros.artifacts.env.execution import OperationExecution
    from jacaros.artifacts.env.expectation import Expect
    from jacaros.artifacts.env.manual import Manual, describe
    from jacaros.artifacts.env.operation import (
        OperationOutcome,
        OperationRequest,
        initializer,
        internal_operation,
        link,
        operation,
    )
    from jacaros.artifacts.env.property import ObservableProperty, Observation, Observer, Signal
    from jacaros.artifacts.env.values import UNSET, Atom, Out, Structure, plain, text
    from jacaros.artifacts.env.workspace import Workspace
    from jacaros.artifacts.presence.presence import ObservedProperty, PropertyChange, ReceivedSignal
    from jacaros.artifacts.presence.session import Session, SessionOperation

__all__ = [
    "UNSET",
    "Artifact",
    "ArtifactId",
    "Atom",
    "Environment",
    "Expect",
    "InvalidArtifact",
    "Manual",
    "ObservableProperty",
    "Observation",
    "ObservedProperty",
    "Observer",
    "OperationExecution",
    "OperationFailed",
    "OperationOutcome",
    "OperationRequest",
    "Out",
    "PropertyChange",
    "ReceivedSignal",
    "Session",
    "SessionOperation",
    "Signal",
    "Structure",
    "UnknownArtifact",
    "UnknownArtifactType",
    "UnknownProperty",
    "UnknownWorkspace",
    "Workspace",
    "WorkspaceError",
    "describe",
    "initializer",
    "internal_operation",
    "link",
    "operation",
    "plain",
    "resolve_path",
    "text",
]

_MODULES = {
    "jacaros.artifacts.env.artifact": "Artifact",
    "jacaros.artifacts.env.environment": "Environment",
    "jacaros.artifacts.env.errors": "ArtifactId InvalidArtifact OperationFailed UnknownArtifact "
    "UnknownArtifactType UnknownProperty UnknownWorkspace WorkspaceError resolve_path",
    "jacaros.artifacts.env.execution": "OperationExecution",
    "jacaros.artifacts.env.expectation": "Expect",
    "jacaros.artifacts.env.manual": "Manual describe",
    "jacaros.artifacts.env.operation": "OperationOutcome OperationRequest initializer "
    "internal_operation link operation",
    "jacaros.artifacts.env.property": "ObservableProperty Observation Observer Signal",
    "jacaros.artifacts.env.values": "Atom Out Structure UNSET plain text",
    "jacaros.artifacts.env.workspace": "Workspace",
    "jacaros.artifacts.presence.presence": "ObservedProperty PropertyChange ReceivedSignal",
    "jacaros.artifacts.presence.session": "Session SessionOperation",
}

__getattr__ = exported(__name__, _MODULES)
