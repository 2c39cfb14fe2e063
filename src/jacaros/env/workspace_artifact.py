"""The artifact ``workspace``: agents' operations on artifacts and workspaces."""

from typing import NoReturn

from jacaros.env.artifact import Artifact, Out, internal_operation, operation
from jacaros.env.errors import UnknownArtifact
from jacaros.env.ids import ArtifactId, resolve_path
from jacaros.env.tree import WorkspaceTree
from jacaros.env.values import Structure
from jacaros.env.workspace import Workspace


class WorkspaceArtifact(Artifact):
    """The workspace itself.

    Paths that do not begin with ``/`` are relative to this workspace.

    Properties:
        artifact(Id, Name, Type): one for each artifact.
        childWsp(Name): one for each workspace directly below this one.
        linkedWsp(Name, Path): one for each link made by ``linkWorkspace``, with the full path it leads to.
    """

    def init(self, workspace: Workspace, tree: WorkspaceTree) -> None:
        """Show the artifacts and workspaces, and follow changes."""
        self._here, self._tree = workspace, tree
        self._children: set[str] = set()
        for artifact in (*workspace.artifacts(), *workspace.personal_artifacts()):
            self._show(artifact, True)
        self._show_places()
        self.on_dispose(workspace.watch(lambda a, present: self.start(self._show, a, present), personal=True))
        tree.watch(workspace.path, lambda: self.start(self._show_places))

    @internal_operation
    def _show(self, artifact: ArtifactId, present: bool) -> None:
        if present:
            self.define_property("artifact", artifact, artifact.name, artifact.type_name)
        elif self.has_property("artifact", artifact, None, None):
            self.remove_property("artifact", artifact, None, None)

    @internal_operation
    def _show_places(self) -> None:
        children = self._tree.children(self._here.path)
        for name in self._children - set(children):
            self.remove_property("childWsp", name)
        for name in children:
            if name not in self._children:
                self.define_property("childWsp", name)
        self._children = set(children)
        for name, path in self._tree.links(self._here.path):
            if not self.has_property("linkedWsp", name, path):
                self.define_property("linkedWsp", name, path)

    # ---- artifacts

    @operation(name="makeArtifact")
    async def make(self, name: str, type_name: str, parameters: list[object] = []) -> None:  # noqa: B006
        """Create an artifact, here or in the workspace at the path before its name."""
        await self._make(name, type_name, parameters)

    @operation(name="makeArtifact")
    async def make_and_tell(self, name: str, type_name: str, parameters: list[object], artifact: Out) -> None:
        """Create an artifact, and return its id."""
        artifact.set(await self._make(name, type_name, parameters))

    async def _make(self, name: str, type_name: str, parameters: list[object]) -> ArtifactId:
        workspace, plain_name = self._tree.place(self._here, name)
        making = workspace.make_artifact(plain_name, type_name, parameters, self.caller)
        return await self.step(making)

    @operation(name="lookupArtifact")
    def look_up(self, name: str, artifact: Out) -> None:
        """Return the artifact with this name or path."""
        workspace, plain_name = self._tree.place(self._here, name)
        artifact.set(workspace.lookup(plain_name))

    @operation(name="lookupArtifactByType")
    def look_up_by_type(self, type_name: str, artifact: Out) -> None:
        """Return the oldest artifact of a type. The package of the type may be left out."""
        for each in self._here.artifacts():
            if is_called(type_name, each.type_name):
                artifact.set(each)
                return
        self._missing(type_name)

    def _missing(self, type_name: str) -> NoReturn:
        message = f"no artifact of type {type_name} in workspace {self._here.path}"
        raise UnknownArtifact(message, Structure("artifact_not_available", (str.__str__(type_name),)))

    @operation(name="getCurrentArtifacts")
    def names(self, names: Out) -> None:
        """Return the names of all artifacts, including the standard ones."""
        names.set([each.name for each in (*self._here.artifacts(), *self._here.personal_artifacts())])

    @operation(name="disposeArtifact")
    def dispose_it(self, artifact: ArtifactId) -> None:
        """Dispose an artifact."""
        self._tree.workspace(artifact.workspace).dispose_artifact(artifact)

    @operation(name="linkArtifacts")
    def link_them(self, source: ArtifactId, port: str, target: ArtifactId) -> None:
        """Link an out port of an artifact to another artifact."""
        self._tree.workspace(source.workspace).link(source, port, target)

    # ---- workspaces

    @operation(name="createWorkspace")
    def create(self, path: str) -> None:
        """Create a workspace."""
        self._tree.create_workspace(resolve_path(self._here.path, path))

    @operation(name="createWorkspace")
    def create_elsewhere(self, path: str, address: str) -> None:
        """Create a workspace on another computer. Not supported yet."""
        refuse(self, f"cannot create workspace {path} at {address}: remote workspaces are not supported yet")

    @operation(name="createWorkspaceWithTopology")
    def create_with_topology(self, path: str, topology: object) -> None:
        """Create a workspace in which agents and artifacts have positions. Not supported."""
        refuse(self, f"cannot create workspace {path} with a topology; use createWorkspace")

    @operation(name="linkWorkspace")
    def link_workspace(self, path: str, local_name: str) -> None:
        """Make a name in this workspace lead to another workspace."""
        here = self._here.path
        self._tree.link_workspace(resolve_path(here, local_name), resolve_path(here, path))

    @operation(name="linkWorkspaces")
    def link_workspaces(self, source: str, target: str, local_name: str) -> None:
        """Make a name in one workspace lead to another one."""
        here = self._here.path
        above = self._tree.workspace(resolve_path(here, source)).path
        self._tree.link_workspace(resolve_path(above, local_name), resolve_path(here, target))

    @operation(name="linkRemoteWorkspace")
    def link_remote_workspace(self, *arguments: object) -> None:
        """Link a workspace of another system. Not supported yet."""
        refuse(
            self, "linking remote workspaces is not supported yet; use linkWorkspace for one of this process"
        )

    @operation(name="mountWorkspace")
    def mount_workspace(self, mas_url: str, remote_path: str, local_path: str) -> None:
        """Mount a workspace of another system. Not supported yet."""
        refuse(
            self,
            f"cannot mount {mas_url}{remote_path} at {local_path}: remote workspaces are not supported yet",
        )


def refuse(artifact: Artifact, message: str) -> NoReturn:
    """Fail the operation in progress, which is not supported."""
    artifact.fail(message, "not_supported", artifact.current.request.key)


def is_called(wanted: str, type_name: str) -> bool:
    """Return whether the type name of an artifact means the *wanted* type."""
    if wanted == type_name:
        return True
    return ("." in wanted) != ("." in type_name) and wanted.rpartition(".")[2] == type_name.rpartition(".")[2]
