"""The environment of a process: a tree of workspaces with artifacts."""

from collections.abc import Callable, Mapping

from jacaros.clock import Clock
from jacaros.env import ports
from jacaros.env.artifact import Artifact
from jacaros.env.creation import FindType
from jacaros.env.errors import OperationFailed, UnknownArtifactType
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel.registry import Registry
from jacaros.env.kernel.setting import Setting, log_to_stderr
from jacaros.env.operation import OPERATION, OperationRequest
from jacaros.env.ports import UnderWay
from jacaros.env.resources.resource import Use
from jacaros.env.standard_artifacts import add_standard_artifacts
from jacaros.env.tree import WorkspaceTree
from jacaros.env.values import Structure
from jacaros.env.workspace import Workspace


def knows_no_type(type_name: str) -> type[Artifact]:
    """Reject all type names: artifacts are created from their classes.

    Raises:
        UnknownArtifactType: always.
    """
    raise UnknownArtifactType(type_name)


class Environment(Setting, WorkspaceTree):
    """All workspaces of a process. ``/main`` always exists.

    Args:
        clock: clock of the run.
        resources: services of the host for artifacts, by name.
        find_type: finds the artifact class for a type name. Raises `UnknownArtifactType`.
        log: takes a line of the log.
        on_internal_error: called with defects of JaCaROS itself. Without it they are raised where they arise.
    """

    def __init__(
        self,
        clock: Clock,
        resources: Mapping[str, object] | None = None,
        find_type: FindType = knows_no_type,
        log: Callable[[str], None] = log_to_stderr,
        on_internal_error: Callable[[BaseException], None] | None = None,
    ) -> None:
        Setting.__init__(self, clock, resources or {}, log, None, on_internal_error)
        self._find_type = find_type
        self._registry = Registry()
        self._own: list[Workspace] = []
        WorkspaceTree.__init__(self, self._make)
        self.create_workspace("/main")

    def used_by(self, artifact_id: ArtifactId) -> tuple[Use, ...]:
        """Return the resources that the operations of an artifact use, with the name of its robot.

        Empty if it is gone or remote.
        """
        steps = self._registry.made(artifact_id)
        return () if steps is None else steps.used()

    def artifact(self, artifact_id: ArtifactId) -> object | None:
        """Return the artifact object behind an id, or None if it does not exist yet, is gone or is remote."""
        steps = self._registry.made(artifact_id)
        return steps.artifact if steps is not None else None

    def when_disposed(self, callback: Callable[[ArtifactId], None]) -> None:
        """Call *callback* with the id of every disposed artifact, after its observers have been notified."""
        self._registry.when_disposed.append(callback)

    def _make(self, path: str, above: ports.Workspace | None) -> Workspace:
        if above is not None and above not in self._own:
            message = f"workspace {above.path} is remote: create {path} in the process that serves it"
            raise OperationFailed(message, Structure("not_supported", ("createWorkspace",)))
        workspace = Workspace(path, self._registry, self, self._find_type)
        add_standard_artifacts(workspace, self)
        self._own.append(workspace)
        return workspace

    def execute(self, request: OperationRequest) -> UnderWay:
        """Run an operation for an agent, wherever the artifact is. See `Workspace.execute`."""
        steps = self._registry.find(request.artifact)
        if steps is None:
            return self.at(request.artifact.workspace, self._own[0]).execute(request)
        return steps.execute(request, OPERATION)

    async def close(self) -> None:
        """Dispose all artifacts, those of the newest workspaces first. Remote workspaces do not change."""
        for workspace in reversed(self._own):
            await workspace.close()
