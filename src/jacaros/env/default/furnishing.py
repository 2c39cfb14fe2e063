"""Which artifacts every workspace has from the beginning."""

from jacaros.env.default.blackboard import Blackboard
from jacaros.env.default.console import Console
from jacaros.env.default.manrepo import ManualRepository
from jacaros.env.default.system import SystemArtifact
from jacaros.env.default.workspace import WorkspaceArtifact
from jacaros.env.tree import WorkspaceTree
from jacaros.env.workspace import Workspace

DEFAULT_TYPES = frozenset(
    each.__name__ for each in (Blackboard, Console, ManualRepository, SystemArtifact, WorkspaceArtifact)
)
"""Names of the types of the artifacts that every workspace has."""


def furnish(workspace: Workspace, tree: WorkspaceTree) -> None:
    """Give a workspace the artifacts that each one has; none of them is made before somebody needs it."""
    workspace.offer("blackboard", Blackboard)
    workspace.offer("console", Console)
    workspace.offer("manrepo", ManualRepository, (workspace, tree))
    workspace.offer("system", SystemArtifact)
    workspace.offer("workspace", WorkspaceArtifact, (workspace, tree))
