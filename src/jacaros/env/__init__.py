"""Workspaces and artifacts as in CArtAgO, usable without agents.

To write artifacts, use `Artifact`, the decorators and the plain values. A host uses `Environment`. To use artifacts from
Python, use a `Session`. This package does not depend on agents, ROS or the language.
"""

from jacaros.env.artifact import Artifact
from jacaros.env.environment import Environment
from jacaros.env.errors import (
    InvalidArtifact,
    OperationFailed,
    UnknownArtifact,
    UnknownArtifactType,
    UnknownProperty,
    UnknownWorkspace,
    WorkspaceError,
)
from jacaros.env.execution import OperationExecution
from jacaros.env.ids import ArtifactId, resolve_path
from jacaros.env.manual import Manual, describe, manual_term
from jacaros.env.observation import Observation, Observer, Signal
from jacaros.env.operation import (
    OperationOutcome,
    OperationRequest,
    initializer,
    internal_operation,
    link,
    operation,
)
from jacaros.env.property import ObservableProperty
from jacaros.env.session.observed import ObservedProperty, PropertyChange
from jacaros.env.session.operation import SessionOperation
from jacaros.env.session.session import Session
from jacaros.env.session.signal_stream import ReceivedSignal, SignalStream
from jacaros.env.values import UNSET, Atom, Out, Structure, plain, text
from jacaros.env.workspace import Workspace

__all__ = [
    "UNSET",
    "Artifact",
    "ArtifactId",
    "Atom",
    "Environment",
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
    "SignalStream",
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
    "manual_term",
    "operation",
    "plain",
    "resolve_path",
    "text",
]
