"""The environment of a process, and the standard artifacts of its workspaces."""

from collections.abc import Callable, Mapping
from typing import NoReturn

from jacaros.artifacts.env import ports
from jacaros.artifacts.env.artifact import Artifact, Out, internal_operation, operation
from jacaros.artifacts.env.errors import (
    ArtifactId,
    OperationFailed,
    UnknownArtifact,
    UnknownArtifactType,
    resolve_path,
)
from jacaros.artifacts.env.manual import describe
from jacaros.artifacts.env.operation import OPERATION, OperationRequest
from jacaros.artifacts.env.ports import UnderWay
from jacaros.artifacts.env.values import Structure, equal, plain, text
from jacaros.artifacts.env.workspace import FindType, Workspace, WorkspaceTree
from jacaros.artifacts.kernel.publication import Setting, log_to_stderr
from jacaros.artifacts.kernel.registry import Registry
from jacaros.runtime.clock import Clock

# The artifact ``workspace``: agents' operations on artifacts and workspaces.


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

    @operation(name="createWorkspace")
    async def create_elsewhere(self, path: str, member: str) -> None:
        """Create a workspace at a member of the fleet. It is visible here when this has ended."""
        if self._tree.create_elsewhere is None:
            refuse(self, "this system is in no fleet: run it with --fleet NAME, or use createWorkspace(Path)")
        await self.step(self._tree.create_elsewhere(resolve_path(self._here.path, path), member))

    @operation(name="createWorkspaceWithTopology")
    def create_with_topology(self, path: str, topology: str) -> None:
        """Create a workspace with a topology. Not supported."""
        refuse(self, "workspaces have no topology; use createWorkspace and linkWorkspace")

    @operation(name="linkRemoteWorkspace")
    @operation(name="mountWorkspace")
    def use_remote_workspace(self, *arguments: object) -> None:
        """Make a workspace of another system visible here. Not supported."""
        refuse(
            self,
            "workspaces of a fleet are visible under their own paths; use joinWorkspace, and linkWorkspace for a name",
        )


def refuse(artifact: Artifact, message: str) -> NoReturn:
    """Fail the operation in progress, which is not supported."""
    artifact.fail(message, "not_supported", artifact.current.request.key)


def is_called(wanted: str, type_name: str) -> bool:
    """Return whether the type name of an artifact means the *wanted* type."""
    if wanted == type_name:
        return True
    return ("." in wanted) != ("." in type_name) and wanted.rpartition(".")[2] == type_name.rpartition(".")[2]


# The standard artifacts of every workspace: blackboard, console, system, and manuals of types.


Entry = tuple[object, ...]


class Blackboard(Artifact):
    """A tuple space, as in the coordination language Linda.

    A tuple is a name with any number of arguments. A pattern matches a tuple of the same length if its bound arguments
    are equal. Unbound arguments are outputs and match anything; the same variable twice matches only equal values. The
    oldest matching tuple is used.
    """

    def init(self) -> None:
        """Start without tuples."""
        self._tuples: list[Entry] = []

    @operation
    def out(self, *entry: object) -> None:
        """Add a tuple. Its arguments must be bound."""
        if any(isinstance(item, Out) for item in entry):
            self.fail(
                "a tuple on the blackboard must be ground: it has an unbound variable", "unbound_argument"
            )
        self._tuples.append(tuple(map(plain, entry)))

    @operation(name="in", guard="is_there")
    def take(self, *pattern: object) -> None:
        """Remove a matching tuple. Waits until there is one."""
        taken = self._bind(pattern)
        self._tuples = [entry for entry in self._tuples if entry is not taken]

    @operation(guard="is_there")
    def rd(self, *pattern: object) -> None:
        """Read a matching tuple. Waits until there is one."""
        self._bind(pattern)

    @operation
    def inp(self, *pattern: object) -> None:
        """Remove a matching tuple. Fails with reason ``no_match`` if no tuple matches."""
        self._need(pattern)
        self.take(*pattern)

    @operation
    def rdp(self, *pattern: object) -> None:
        """Read a matching tuple. Fails with reason ``no_match`` if no tuple matches."""
        self._need(pattern)
        self._bind(pattern)

    def is_there(self, *pattern: object) -> bool:
        """Return whether a tuple matches *pattern*."""
        return self._find(pattern) is not None

    def _need(self, pattern: Entry) -> None:
        if not self.is_there(*pattern):
            shown = ",".join("_" if isinstance(item, Out) else text(item, quoted=True) for item in pattern)
            self.fail(f"no tuple on the blackboard matches ({shown})", "no_match")

    def _find(self, pattern: Entry) -> Entry | None:
        return next((entry for entry in self._tuples if _fits(pattern, entry)), None)

    def _bind(self, pattern: Entry) -> Entry:
        entry = self._find(pattern)
        assert entry is not None, "the guard was true"
        for wanted, value in zip(pattern, entry, strict=True):
            if isinstance(wanted, Out):
                wanted.set(value)
        return entry


def _fits(pattern: Entry, entry: Entry) -> bool:
    if len(pattern) != len(entry):
        return False
    bound: dict[int, object] = {}
    for wanted, value in zip(pattern, entry, strict=True):
        if isinstance(wanted, Out):
            wanted = bound.setdefault(id(wanted.variable or wanted), value)
        if not equal(wanted, value):
            return False
    return True


class Console(Artifact):
    """Prints lines for agents, one line for each call.

    The lines go to ``resources["console"]``, a function of agent and text, or else to the log. The operations with
    ``AgName`` are equivalent, because the host shows the agent anyway.
    """

    @operation(name="printWithAgName")
    @operation(name="printlnWithAgName")
    @operation(name="print")
    @operation
    def println(self, *arguments: object) -> None:
        """Print the arguments as one line, without separators."""
        write_line(self, "".join(map(text, arguments)))


def write_line(artifact: Artifact, line: str) -> None:
    """Print a line for the agent that called an operation of *artifact*."""
    write = artifact.resources.get("console")
    if callable(write):
        write(artifact.caller, line)
    else:
        artifact.log(line)


class SystemArtifact(Artifact):
    """The process in which agents and artifacts run."""

    @operation(name="shutdownNode")
    def shut_down(self) -> None:
        """End the run, as ``.stopMAS`` does."""
        stop = self.resources.get("stop")
        if not callable(stop):
            refuse(self, "the host does not support ending the run")
        stop()

    @operation
    @operation(name="spawnNode")
    def crash(self, *arguments: object) -> None:
        """Kill this process, or start another one. Not supported."""
        refuse(self, "a run is one process; use shutdownNode or .stopMAS to end it")


class ManualRepository(Artifact):
    """Manuals of artifact types.

    Every type has a manual, generated from its code: operations, properties and signals with their descriptions.
    """

    def init(self, workspace: Workspace) -> None:
        """Know the types of a workspace."""
        self._here = workspace

    @operation(name="getManualContent")
    def give_content(self, type_name: str, content: Out) -> None:
        """Return the manual of a type as a text."""
        content.set(self._content(type_name))

    @operation(name="consultManual")
    def consult(self, type_name: str) -> None:
        """Print the manual of a type."""
        for line in self._content(type_name).splitlines():
            write_line(self, line)

    def _content(self, type_name: str) -> str:
        return str(describe(self._here.artifact_type(type_name)))


DEFAULT_TYPES = frozenset(
    each.__name__ for each in (Blackboard, Console, ManualRepository, SystemArtifact, WorkspaceArtifact)
)
"""Type names of the standard artifacts."""


def add_standard_artifacts(workspace: Workspace, tree: WorkspaceTree) -> None:
    """Add the standard artifacts to a workspace. Each one is created at its first use."""
    workspace.offer("blackboard", Blackboard)
    workspace.offer("console", Console)
    workspace.offer("manrepo", ManualRepository, (workspace,))
    workspace.offer("system", SystemArtifact)
    workspace.offer("workspace", WorkspaceArtifact, (workspace, tree))


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
        self._watchers_of_own: list[Callable[[Workspace], None]] = []
        WorkspaceTree.__init__(self, self._make)
        self.create_workspace("/main")

    def used_by(self, artifact_id: ArtifactId) -> tuple[str, ...]:
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

    def own(self) -> tuple[Workspace, ...]:
        """Return the workspaces of this process, the oldest first."""
        return tuple(self._own)

    def watch_own(self, watcher: Callable[[Workspace], None]) -> Callable[[], None]:
        """Call *watcher* with every workspace that is created. Return a function that ends this."""
        self._watchers_of_own.append(watcher)
        return lambda: self._watchers_of_own.remove(watcher) if watcher in self._watchers_of_own else None

    def _make(self, path: str, above: ports.Workspace | None) -> Workspace:
        if above is not None and above not in self._own:
            message = f"workspace {above.path} is remote: create {path} in the process that serves it"
            raise OperationFailed(message, Structure("not_supported", ("createWorkspace",)))
        workspace = Workspace(path, self._registry, self, self._find_type)
        add_standard_artifacts(workspace, self)
        self._own.append(workspace)
        for watcher in tuple(self._watchers_of_own):
            watcher(workspace)
        return workspace

    def execute(self, request: OperationRequest) -> UnderWay:
        """Run an operation for an agent, wherever the artifact is. See `Workspace.execute`."""
        steps = self._registry.steps.get(request.artifact) or self._registry.find(request.artifact)
        if steps is None:
            return self.at(request.artifact.workspace, self._own[0]).execute(request)
        return steps.execute(request, OPERATION)

    async def close(self) -> None:
        """Dispose all artifacts, those of the newest workspaces first. Remote workspaces do not change."""
        for workspace in reversed(self._own):
            await workspace.close()
