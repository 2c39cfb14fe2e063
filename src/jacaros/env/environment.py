"""The environment of a process: a tree of workspaces with their artifacts."""

from collections.abc import Callable, Mapping

from jacaros.clock import Clock
from jacaros.env import ports
from jacaros.env.artifact import Artifact
from jacaros.env.creation import FindType
from jacaros.env.errors import OperationFailed, UnknownArtifactType
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel.registry import Registry
from jacaros.env.kernel.setting import Setting, log_to_stderr
from jacaros.env.listener import EnvironmentListener
from jacaros.env.operation import OPERATION, OperationRequest
from jacaros.env.ports import UnderWay
from jacaros.env.resources.arbiter import Arbiter
from jacaros.env.resources.resource import Use
from jacaros.env.standard_artifacts import add_standard_artifacts
from jacaros.env.tree import WorkspaceTree
from jacaros.env.values import Structure
from jacaros.env.workspace import Workspace
from jacaros.trace import Tracer


def knows_no_type(type_name: str) -> type[Artifact]:
    """Know no artifact type: artifacts are made from their classes.

    Raises:
        UnknownArtifactType: always.
    """
    raise UnknownArtifactType(type_name)


class Environment:
    """All workspaces of a process; ``/main`` is there from the beginning.

    Args:
        clock: where artifacts take time from.
        resources: what the host lends to artifacts, by name.
        find_type: finds the artifact class for a type name; raises `UnknownArtifactType`.
        log: takes a line for people.
        on_internal_error: told of defects of JaCaROS itself; without it they are raised where they arise.
    """

    def __init__(
        self,
        clock: Clock,
        resources: Mapping[str, object] | None = None,
        find_type: FindType = knows_no_type,
        log: Callable[[str], None] = log_to_stderr,
        on_internal_error: Callable[[BaseException], None] | None = None,
    ) -> None:
        self._setting = Setting(clock, resources or {}, log, None, on_internal_error)
        self._find_type = find_type
        self._registry = Registry()
        self._own: list[Workspace] = []
        self._tree = WorkspaceTree(self._make)
        self._tree.create("/main")

    @property
    def clock(self) -> Clock:
        """Where artifacts take time from."""
        return self._setting.clock

    @property
    def resources(self) -> Mapping[str, object]:
        """What the host lends to artifacts, by name."""
        return self._setting.resources

    @property
    def arbiter(self) -> Arbiter:
        """Decides who has what operations and plans use."""
        return self._setting.arbiter

    def used_by(self, artifact_id: ArtifactId) -> tuple[Use, ...]:
        """What the operations of an artifact use, with the name of its robot; nothing if it is gone or lives elsewhere."""
        steps = self._registry.made(artifact_id)
        return () if steps is None else steps.used()

    @property
    def tracer(self) -> Tracer | None:
        """Told of every cause that arises, None while nobody watches."""
        return self._setting.tracer

    @tracer.setter
    def tracer(self, tracer: Tracer | None) -> None:
        self._setting.tracer = tracer

    @property
    def listener(self) -> EnvironmentListener | None:
        """Receives what happens in the artifacts of this process, None while nobody watches."""
        listener: EnvironmentListener | None = self._setting.listener
        return listener

    @listener.setter
    def listener(self, listener: EnvironmentListener | None) -> None:
        self._setting.listener = listener

    def artifact(self, artifact_id: ArtifactId) -> object | None:
        """The artifact behind an id, for those who watch it; None when it has not been made, is gone or lives elsewhere."""
        steps = self._registry.made(artifact_id)
        return steps.artifact if steps is not None else None

    def when_disposed(self, callback: Callable[[ArtifactId], None]) -> None:
        """Call *callback* with the id of every artifact that is gone, when all who observed it have been told."""
        self._registry.when_disposed.append(callback)

    def workspaces(self) -> tuple[ports.Workspace, ...]:
        """All workspaces, the oldest first."""
        return self._tree.all()

    def workspace(self, path: str) -> ports.Workspace:
        """The workspace with that full path; names of links may stand in it.

        Raises:
            UnknownWorkspace: there is none.
        """
        return self._tree.find(path)

    def create_workspace(self, path: str) -> ports.Workspace:
        """Make a workspace with its default artifacts.

        Args:
            path: full path; the workspace that it is a part of must be there.

        Raises:
            OperationFailed: it is there already; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the workspace above it is not there.
        """
        return self._tree.create(path)

    def link_workspace(self, path: str, target: str) -> None:
        """Let a full path, at which there is nothing yet, lead to another workspace.

        Raises:
            OperationFailed: something is there already; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the target, or the workspace above the path, is not there.
        """
        self._tree.link(path, target)

    def _make(self, path: str, above: ports.Workspace | None) -> Workspace:
        if above is not None and above not in self._own:
            message = f"workspace {above.path} is served from elsewhere: {path} is to be made there"
            raise OperationFailed(message, Structure("not_supported", ("createWorkspace",)))
        workspace = Workspace(path, self._registry, self._setting, self._find_type)
        add_standard_artifacts(workspace, self._tree)
        self._own.append(workspace)
        return workspace

    def mount(self, workspace: ports.Workspace) -> Callable[[], None]:
        """Make a workspace visible here that is served from elsewhere, under its `path`; gives what ends that.

        Raises:
            OperationFailed: there is one at that path already; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the workspace above it is not there.
        """
        return self._tree.mount(workspace)

    def execute(self, request: OperationRequest) -> UnderWay:
        """Run an operation for an agent, wherever the artifact lives; see `Workspace.execute`."""
        steps = self._registry.find(request.artifact)
        if steps is None:
            return self._tree.at(request.artifact.workspace, self._own[0]).execute(request)
        return steps.execute(request, OPERATION)

    def log(self, text: str) -> None:
        """Write a line for people."""
        self._setting.log(text)

    def log_error(self, who: str, what: str, error: BaseException) -> None:
        """Tell people that *what* went wrong in the code of *who*."""
        self._setting.log_error(who, what, error)

    async def close(self) -> None:
        """Dispose every artifact, the workspaces made last first; those served from elsewhere are left alone."""
        for workspace in reversed(self._own):
            await workspace.close()
