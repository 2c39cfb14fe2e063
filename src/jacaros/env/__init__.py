"""The environment: workspaces and artifacts in the manner of CArtAgO, usable without agents.

Authors of artifacts need `Artifact`, the decorators and the plain values; a host needs `Environment`.
Nothing here knows of agents, ROS or the language.
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
from jacaros.env.manual import Manual, describe
from jacaros.env.observation import Observation, Observer, Signal
from jacaros.env.operation import (
    OperationOutcome,
    OperationRequest,
    internal_operation,
    link,
    operation,
)
from jacaros.env.property import ObservableProperty
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
    "Observer",
    "OperationExecution",
    "OperationFailed",
    "OperationOutcome",
    "OperationRequest",
    "Out",
    "Signal",
    "Structure",
    "UnknownArtifact",
    "UnknownArtifactType",
    "UnknownProperty",
    "UnknownWorkspace",
    "Workspace",
    "WorkspaceError",
    "describe",
    "internal_operation",
    "link",
    "operation",
    "plain",
    "resolve_path",
    "text",
]
