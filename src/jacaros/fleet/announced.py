"""What this member tells all others of itself: agents, services, workspaces, artifacts."""

from collections.abc import Callable

from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId, UnknownArtifact
from jacaros.artifacts.env.ports import Workspace
from jacaros.fleet import protocol
from jacaros.fleet.artifacts import ArtifactNames
from jacaros.look.records.records import MemberRecord
from jacaros.runtime.mas.directory import NAME as DIRECTORY_NAME
from jacaros.runtime.mas.directory import ServiceDirectory
from jacaros.runtime.mas.system import System


class Announced:
    """The picture that others have of this member, and its changes.

    Args:
        system: the system of this member.
        names: names of artifacts.
        tell: passes a change to all other members.
    """

    def __init__(self, system: System, names: ArtifactNames, tell: Callable[[protocol.Said], None]) -> None:
        self.page = ""
        self._system, self._names, self._tell = system, names, tell
        self._services: dict[tuple[str, str], None] = {}
        self._workspaces: dict[str, Workspace] = {}
        self._ends: list[Callable[[], None]] = [system.directory.watch(self._agent)]
        if isinstance(system.services, ServiceDirectory):
            self._ends.append(system.services.watch(self._service))
        self._ends.append(system.when_situated(self._situated))

    def end(self) -> None:
        """Tell nothing more."""
        for end in self._ends:
            end()

    def picture(self, epoch: int, knows: int) -> protocol.Here:
        """Return everything, for one other member."""
        workspaces = [
            (path, [self._data(each, workspace) for each in workspace.artifacts()])
            for path, workspace in self._workspaces.items()
        ]
        return protocol.Here(epoch, knows, self._agents(), list(self._services), workspaces, self.page)

    def _agents(self) -> list[str]:
        return [host.name for host in self._system.directory if host.name != DIRECTORY_NAME]

    def record(self, member: str) -> MemberRecord:
        """Return what the recording of this member says of itself."""
        return MemberRecord(member, "self", self._agents(), [*self._workspaces], page=self.page)

    def watched(self) -> protocol.Watched:
        """Return whether the run of this member is recorded, and the address of its page."""
        return protocol.Watched(self._system.tracer is not None, self.page)

    def _agent(self, name: str, present: bool) -> None:
        if name != DIRECTORY_NAME:
            self._tell(protocol.AgentNews(name, present))

    def _service(self, agent: str, service: str, provides: bool) -> None:
        if self._system.directory.find(agent) is None and (agent, service) not in self._services:
            return  # of another member
        if provides:
            self._services[agent, service] = None
        else:
            self._services.pop((agent, service), None)
        self._tell(protocol.ServiceNews(agent, service, provides))

    def _situated(self, environment: Environment) -> None:
        for workspace in environment.own():
            self._workspace(workspace)
        self._ends.append(environment.watch_own(self._workspace))
        environment.when_disposed(self._names.forget)

    def _workspace(self, workspace: Workspace) -> None:
        self._workspaces[workspace.path] = workspace
        self._tell(protocol.WorkspaceNews(workspace.path, True))
        self._ends.append(workspace.watch(lambda a, present: self._artifact(workspace, a, present)))
        for each in workspace.artifacts():
            self._artifact(workspace, each, True)

    def _artifact(self, workspace: Workspace, artifact: ArtifactId, present: bool) -> None:
        data = self._data(artifact, workspace) if present else None
        self._tell(protocol.ArtifactNews(workspace.path, self._names.number(artifact), data))

    def _data(self, artifact: ArtifactId, workspace: Workspace) -> protocol.ArtifactData:
        try:
            offers = list(workspace.offers(artifact))
        except UnknownArtifact:
            offers = []
        return self._names.number(artifact), artifact.name, artifact.type_name, artifact.creator, offers
