"""Workspaces: create, find, focus, link, use and dispose artifacts."""

from collections.abc import Awaitable, Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from types import MappingProxyType

from jacaros.artifacts.env import ports
from jacaros.artifacts.env.artifact import Artifact, ArtifactHost
from jacaros.artifacts.env.errors import (
    ArtifactId,
    InvalidArtifact,
    OperationFailed,
    UnknownArtifact,
    UnknownArtifactType,
    UnknownWorkspace,
    resolve_path,
)
from jacaros.artifacts.env.execution import OperationExecution
from jacaros.artifacts.env.operation import (
    LINK,
    OPERATION,
    SUCCEEDED,
    OperationOutcome,
    OperationRequest,
    ignore_outcome,
    marks_of,
)
from jacaros.artifacts.env.ports import ENDED, OnMade, OnOutcome, UnderWay, ignore_made
from jacaros.artifacts.env.property import ObservableProperty, Observer
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.kernel import faults
from jacaros.artifacts.kernel.declaration import NOTHING, DeclaredOperation, UsageInterface, interface_of
from jacaros.artifacts.kernel.faults import error_text, is_interruption
from jacaros.artifacts.kernel.publication import Publication, Setting, mistakes_in
from jacaros.artifacts.kernel.registry import Registry
from jacaros.artifacts.kernel.steps import Steps
from jacaros.runtime.errors import InternalError
from jacaros.runtime.files.texts import aside
from jacaros.runtime.trace import Cause

# Create artifacts: find the type, connect object and kernel, and report why creation failed.

FindType = Callable[[str], type[Artifact]]
"""Finds the class for a type name. Raises `UnknownArtifactType`."""


def refused(why: str, what: str, message: str) -> OperationFailed:
    """Return the failure with reason ``makeArtifactFailure(why, what)``."""
    return OperationFailed(message, Structure("makeArtifactFailure", (why, what)))


def init_failed(artifact_id: ArtifactId, message: str) -> OperationFailed:
    """Return the failure of an artifact whose ``init`` failed with *message*."""
    what = f"cannot create artifact {artifact_id.name} ({artifact_id.type_name})"
    return refused("init_failed", artifact_id.name, f"{what}: {message}")


def artifact_type_of(
    type_name: str | type[Artifact], find_type: FindType, setting: Setting
) -> type[Artifact]:
    """Return the class for *type_name*.

    Raises:
        OperationFailed: the type is unknown, or its module raises an error.
    """
    if not isinstance(type_name, str):
        return type_name
    name = str.__str__(type_name)
    try:
        found = find_type(name)
    except UnknownArtifactType as unknown:
        raise refused("unknown_artifact_template", name, str(unknown)) from None
    except InternalError:
        raise
    except BaseException as error:
        if is_interruption(error):
            raise
        if isinstance(error, InvalidArtifact):
            setting.log(f"[{name}] cannot load the artifact type: {error}")
        else:
            setting.log_error(name, "cannot load the artifact type:", error)
        message = f"cannot load artifact type {name}: {error_text(error)}"
        raise refused("unknown_artifact_template", name, message) from error
    if not (isinstance(found, type) and issubclass(found, Artifact)):
        raise refused("unknown_artifact_template", name, f"{name} is not a subclass of Artifact")
    return found


def attach(
    artifact_type: type[Artifact], artifact_id: ArtifactId, host: ArtifactHost, setting: Setting
) -> Steps:
    """Create the object of an artifact and connect it with the kernel, which runs its operations.

    Raises:
        OperationFailed: its constructor failed.
    """
    try:
        artifact = artifact_type()
    except BaseException as error:
        if is_interruption(error):
            raise
        setting.log_error(artifact_id.name, f"the constructor of {artifact_type.__qualname__} failed:", error)
        raise init_failed(artifact_id, error_text(error)) from error
    if artifact_type not in setting.told:
        setting.told.add(artifact_type)
        _log_mistakes(artifact_type, setting)
    steps = Steps(artifact_id, artifact, artifact_type.interface, tuple(artifact_type.ports), setting)
    artifact._join(steps, host)
    return steps


def _log_mistakes(artifact_type: type[Artifact], setting: Setting) -> None:
    """Log mistakes that show in a class when its first artifact is created: its module is complete then."""
    for mistake in mistakes_in(artifact_type):
        setting.log(f"[{artifact_type.__name__}] {mistake}")
    if not any(artifact_type.interface.unknown_annotations()):
        return
    artifact_type.interface = interface_of(artifact_type)
    for operation, parameter, written in artifact_type.interface.unknown_annotations():
        setting.log(
            f"[{artifact_type.__name__}] parameter {parameter} of {operation} accepts any value: unknown annotation "
            f"{written!r}; correct it, or import it outside of `if TYPE_CHECKING`"
        )


def init_of(artifact_type: type[Artifact], request: OperationRequest) -> DeclaredOperation:
    """Return the ``init`` of *artifact_type* for the arguments of *request*.

    Without arguments, a type whose ``init`` requires some is created without calling it, as in CArtAgO (conformance case
    ``creation/make_failures``).

    Raises:
        OperationFailed: no ``init`` takes this number of arguments.
    """
    count = len(request.arguments)
    inits = artifact_type.interface.inits
    found = inits.find("init", count)
    if found is not None:
        return found
    if not count:
        return NOTHING
    taken = " or ".join(f"({each.signature})" for each in inits) or "()"
    raise init_failed(request.artifact, f"expected {taken} as arguments of init, found {count} arguments")


# Artifact resolution: which artifact serves an operation, and which one a name means.
#
# If several artifacts offer an operation, CArtAgO's rule decides, for agents and sessions alike.


class OperationIndex:
    """The artifacts of a workspace that offer one operation with one number of arguments.

    Attributes:
        found: the last result of `providers`; None once it is no longer true.
    """

    __slots__ = ("_every", "_exact", "found")

    def __init__(self) -> None:
        self._every = _ByAge()
        self._exact = _ByAge()
        self.found: Providers | None = None

    def add(self, artifact: ArtifactId, exact: bool) -> None:
        """Add an artifact, which must be younger than all others.

        Args:
            artifact: the artifact.
            exact: whether it takes exactly this number of arguments, rather than any number.
        """
        self._every.add(artifact)
        if exact:
            self._exact.add(artifact)
        self.found = None

    def remove(self, artifact: ArtifactId) -> None:
        """Remove an artifact, if present."""
        if artifact in self._every.artifacts:
            self._every.remove(artifact)
            if artifact in self._exact.artifacts:
                self._exact.remove(artifact)
            self.found = None

    def providers(self) -> "Providers":
        """Return all artifacts, the oldest first."""
        if self.found is None:
            self.found = Providers(self._every.artifacts)
            self.found.operation_index = self
        return self.found

    def is_preferred(self, artifact: ArtifactId) -> bool:
        """Return whether an artifact may be chosen. An exact number of arguments has precedence."""
        return artifact in self._preferred.artifacts

    def oldest(self) -> ArtifactId:
        """Return the oldest artifact that may be chosen. At least one must exist."""
        return next(iter(self._preferred.artifacts))

    def oldest_of(self, creator: str) -> ArtifactId | None:
        """Return the oldest artifact that may be chosen and that *creator* created."""
        return next(iter(self._preferred.by_creator.get(creator, ())), None)

    @property
    def _preferred(self) -> "_ByAge":
        return self._exact if self._exact.artifacts else self._every


class Providers(tuple[ArtifactId, ...]):
    """Artifacts that offer an operation, the oldest first.

    Attributes:
        operation_index: the index that they come from.
    """

    operation_index: OperationIndex


@dataclass(slots=True, eq=False)
class _ByAge:
    """Artifacts by age, also by creator."""

    artifacts: dict[ArtifactId, None] = field(default_factory=dict)
    by_creator: dict[str | None, dict[ArtifactId, None]] = field(default_factory=dict)

    def add(self, artifact: ArtifactId) -> None:
        self.artifacts[artifact] = None
        self.by_creator.setdefault(artifact.creator, {})[artifact] = None

    def remove(self, artifact: ArtifactId) -> None:
        del self.artifacts[artifact]
        of_creator = self.by_creator[artifact.creator]
        del of_creator[artifact]
        if not of_creator:
            del self.by_creator[artifact.creator]


def chosen_artifact(
    places: Iterable[ports.Workspace], operation: str, arity: int, own: str, focused: Sequence[ArtifactId]
) -> ArtifactId | None:
    """Return the artifact that serves an operation, or None if no artifact offers it.

    The first workspace that has one decides. There, artifacts that take exactly this number of arguments have
    precedence over those that take any number. Of these, the oldest one created by *own* is chosen; else the one
    focused first; else the oldest.

    Args:
        places: the workspaces, in order of precedence.
        operation: its name.
        arity: number of its arguments.
        own: name of the caller, to compare with creators.
        focused: artifacts that the caller focuses, in the order of focusing.
    """
    for workspace in places:
        candidates = workspace.providers(operation, arity)
        if candidates:
            return (
                candidates[0]
                if len(candidates) == 1
                else _preferred(workspace, candidates, operation, arity, own, focused)
            )
    return None


def artifact_named(places: Iterable[ports.Workspace], name: str) -> ArtifactId:
    """Return the artifact with this name in the first workspace that has one.

    Raises:
        UnknownArtifact: no workspace has one.
    """
    failures = []
    for workspace in places:
        try:
            return workspace.lookup(name)
        except UnknownArtifact as failure:
            failures.append(failure)
    raise next((f for f in failures if "did you mean" in f.message), failures[0])


def _preferred(
    workspace: ports.Workspace,
    candidates: Sequence[ArtifactId],
    operation: str,
    arity: int,
    own: str,
    focused: Sequence[ArtifactId],
) -> ArtifactId:
    if isinstance(candidates, Providers):
        index = candidates.operation_index
    else:
        # The workspace is remote.
        index = OperationIndex()
        exact = f"{operation}/{arity}"
        for candidate in candidates:
            index.add(candidate, exact in workspace.offers(candidate))
    of_own = index.oldest_of(own)
    if of_own is not None:
        return of_own
    return next((artifact for artifact in focused if index.is_preferred(artifact)), index.oldest())


# The workspaces of an environment by path, and the links between them.


_LINKS_ON_ONE_PATH = 100
"""A path with more links than this is a cycle."""


class WorkspaceTree:
    """Workspaces by full path. A link gives a workspace a second path.

    Args:
        make: creates the workspace with this full path in a parent workspace (None for the root).

    Attributes:
        create_elsewhere: creates the workspace with this full path at a member of the fleet. None: there is no fleet.
    """

    def __init__(self, make: Callable[[str, ports.Workspace | None], ports.Workspace]) -> None:
        self._make = make
        self.create_elsewhere: Callable[[str, str], Awaitable[None]] | None = None
        self._workspaces: dict[str, ports.Workspace] = {}
        self._links: dict[str, str] = {}
        self._yielding: dict[str, Callable[[], None]] = {}
        self._watchers: dict[str, list[Callable[[], None]]] = {}

    def workspaces(self) -> tuple[ports.Workspace, ...]:
        """Return all workspaces, the oldest first."""
        return tuple(self._workspaces.values())

    def at(self, path: str, otherwise: ports.Workspace) -> ports.Workspace:
        """Return the workspace with this full path, without following links."""
        return self._workspaces.get(path, otherwise)

    def workspace(self, path: str) -> ports.Workspace:
        """Return the workspace with this full path, which may contain names of links.

        Raises:
            UnknownWorkspace: the workspace does not exist.
        """
        found = self._workspaces.get(path) or self._workspaces.get(self._without_links(path))
        if found is None:
            help = aside(path, (*self._workspaces, *self._links))
            reason = Structure("unknown_workspace", (str.__str__(path),))
            raise UnknownWorkspace(f"unknown workspace `{path}`{help}", reason)
        return found

    def place(self, here: ports.Workspace, path: str) -> tuple[ports.Workspace, str]:
        """Return the workspace and the plain name of an artifact, given its name, or its path relative to *here*.

        Raises:
            UnknownWorkspace: the workspace does not exist.
        """
        if "/" not in path:
            return here, path
        above, _, name = resolve_path(here.path, path).rpartition("/")
        return self.workspace(above), name

    def _without_links(self, path: str) -> str:
        for _ in range(_LINKS_ON_ONE_PATH):
            link = next((p for p in _beginnings(path) if p in self._links), None)
            if link is None:
                return path
            path = self._links[link] + path[len(link) :]
        return path

    def create_workspace(self, path: str) -> ports.Workspace:
        """Create a workspace with its standard artifacts at a full path. Its parent workspace must exist.

        Raises:
            OperationFailed: it already exists; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the parent workspace does not exist.
        """
        path = self._free(path, own=True)
        above = path.rpartition("/")[0]
        workspace = self._workspaces[path] = self._make(path, self.workspace(above) if above else None)
        self._tell(path)
        return workspace

    def mount(
        self, workspace: ports.Workspace, give_way: Callable[[], None] | None = None
    ) -> Callable[[], None]:
        """Add a remote workspace at its path. Return a function that removes it.

        Args:
            workspace: the workspace.
            give_way: removes it when one of this process is created at its path. None: that fails.

        Raises:
            OperationFailed: the path is in use; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the parent workspace does not exist.
        """
        path = self._free(workspace.path)
        self._workspaces[path] = workspace
        if give_way is not None:
            self._yielding[path] = give_way
        self._tell(path)

        def unmount() -> None:
            if self._workspaces.get(path) is workspace:
                del self._workspaces[path]
                self._yielding.pop(path, None)
                self._tell(path)

        return unmount

    def link_workspace(self, path: str, target: str) -> None:
        """Make an unused full path lead to the workspace at another path.

        Raises:
            OperationFailed: the path is in use; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the target, or the parent workspace of the path, does not exist.
        """
        to = self.workspace(target)
        path = self._free(path, own=True)
        self._links[path] = to.path
        self._tell(path)

    def _free(self, path: str, own: bool = False) -> str:
        """Return an unused path, with its links resolved. Remote workspaces give way to an *own* one."""
        above, _, name = str.__str__(path).rpartition("/")
        path = f"{self.workspace(above).path}/{name}" if above else path
        if own and path in self._yielding:
            self._yielding[path]()
        if not name or path in self._workspaces or path in self._links:
            reason = Structure("workspace_already_present", (str.__str__(path),))
            raise OperationFailed(f"workspace `{path}` already exists", reason)
        return path

    def children(self, path: str) -> tuple[str, ...]:
        """Return the names of the workspaces directly below one."""
        return tuple(w.name for w in self._workspaces.values() if w.path.rpartition("/")[0] == path)

    def links(self, path: str) -> tuple[tuple[str, str], ...]:
        """Return the links in a workspace: their names, and the full paths they lead to."""
        found = ((at.rpartition("/"), to) for at, to in self._links.items())
        return tuple((name, to) for (above, _, name), to in found if above == path)

    def watch(self, path: str, watcher: Callable[[], None]) -> Callable[[], None]:
        """Call *watcher* whenever a workspace or link directly below a workspace is added or removed.

        Return a function that ends this.
        """
        watchers = self._watchers.setdefault(path, [])
        watchers.append(watcher)
        return lambda: watchers.remove(watcher)

    def _tell(self, path: str) -> None:
        for watcher in tuple(self._watchers.get(path.rpartition("/")[0], ())):
            watcher()


def _beginnings(path: str) -> list[str]:
    """Return the full paths of the workspaces above a path and of the path itself, the shortest first."""
    parts = path.split("/")
    return ["/".join(parts[:length]) for length in range(2, len(parts) + 1)]


ArtifactWatcher = Callable[[ArtifactId, bool], None]
"""Called with an artifact that is added (True) or removed (False)."""


class Workspace(ports.Workspace):
    """A named place for artifacts, created by `Environment.create_workspace`.

    Ids are valid in the whole environment: methods that take an id accept artifacts of other workspaces, too.

    Attributes:
        path: full path, such as ``/main/lab``.
        name: last part of the path.
    """

    def __init__(self, path: str, registry: Registry, setting: Setting, find_type: FindType) -> None:
        self.path = path
        self.name = path.rpartition("/")[2]
        self._registry, self._setting, self._find_type = registry, setting, find_type
        self._artifacts: dict[str, ArtifactId] = {}
        self._personal: dict[str, ArtifactId] = {}
        self._making: dict[str, Steps] = {}
        self._indexes: dict[tuple[str, int], OperationIndex] = {}
        self._known: dict[tuple[str, int], tuple[ArtifactId, ...]] = {}
        self.known: Mapping[tuple[str, int], tuple[ArtifactId, ...]] = MappingProxyType(self._known)
        self._watchers: dict[object, ArtifactWatcher] = {}
        self._watchers_of_all: dict[object, ArtifactWatcher] = {}
        self._telling: tuple[Iterator[ArtifactWatcher], ArtifactId, bool] | None = None

    # ---- artifacts come and go

    def offer(
        self, name: str, artifact_type: type[Artifact], args: Sequence[object] = (), personal: bool = False
    ) -> ArtifactId:
        """Add an artifact of JaCaROS itself. It is created at its first use or focus.

        Args:
            name: unique in the workspace.
            artifact_type: its ``init`` is a plain ``def``.
            args: arguments of ``init``.
            personal: it belongs to one agent: it can be looked up by name, but serves only actions that name it.
        """
        artifact_id = self._new_id(name, artifact_type, None)
        make = partial(self._keep_promise, artifact_id, artifact_type, tuple(args))
        self._registry.promise(artifact_id, artifact_type.interface, make)
        if personal:
            self._personal[name] = artifact_id
            self._tell(tuple(self._watchers_of_all.values()), artifact_id, True)
        else:
            self._artifacts[name] = artifact_id
            self._changed(artifact_id, True)
        return artifact_id

    def _keep_promise(
        self, artifact_id: ArtifactId, artifact_type: type[Artifact], args: tuple[object, ...]
    ) -> Steps:
        steps = attach(artifact_type, artifact_id, self, self._setting)
        # Add it first: its ``init`` may look up artifacts.
        self._registry.add(steps, self._forget)
        request = OperationRequest(artifact_id, "init", args)
        steps.initialise(init_of(artifact_type, request), request)
        steps.initialised = True
        return steps

    def take_back(self, artifact_id: ArtifactId) -> None:
        """Dispose an artifact that was added with `offer`, if it still exists."""
        name = artifact_id.name
        if artifact_id in (self._artifacts.get(name), self._personal.get(name)):
            self.dispose_artifact(artifact_id)

    def create(
        self,
        name: str,
        type_name: str | type[Artifact],
        args: Sequence[object] = (),
        creator: str | None = None,
        on_done: OnMade = ignore_made,
        cause: Cause | None = None,
    ) -> UnderWay:
        """Create an artifact like `make_artifact`, and report to *on_done*.

        An ``init`` that is a plain ``def`` has ended when this returns. Cancelling the returned execution abandons the
        creation, and nothing remains of the artifact.
        """
        name = str.__str__(name)
        request = OperationRequest(
            self._new_id(name, type_name, creator), "init", tuple(args), creator, cause
        )
        try:
            artifact_type, steps = self._prepare(request.artifact, type_name)
            declared = init_of(artifact_type, request)
        except OperationFailed as failure:
            on_done(None, OperationOutcome.of(failure))
            return ENDED
        self._making[name] = steps
        self._registry.add(steps, self._forget)
        steps.abandon = partial(self._registry.dispose, steps)
        request.on_done = partial(self._made, steps, on_done)
        return steps.initialise(declared, request)

    def _new_id(self, name: str, type_name: str | type[Artifact], creator: str | None) -> ArtifactId:
        kind = type_name if isinstance(type_name, str) else type_name.__name__
        return ArtifactId(name, str.__str__(kind), self.path, self._registry.next_number(), creator)

    def _prepare(
        self, artifact_id: ArtifactId, type_name: str | type[Artifact]
    ) -> tuple[type[Artifact], Steps]:
        name = artifact_id.name
        making = self._making.get(name)
        is_there = name in self._artifacts or name in self._personal
        if is_there or (making is not None and not making.disposed):
            raise refused(
                "artifact_already_present", name, f"artifact `{name}` already exists in workspace {self.path}"
            )
        artifact_type = artifact_type_of(type_name, self._find_type, self._setting)
        return artifact_type, attach(artifact_type, artifact_id, self, self._setting)

    def _made(self, steps: Steps, on_done: OnMade, outcome: OperationOutcome) -> None:
        name = steps.id.name
        if self._making.get(name) is steps:
            del self._making[name]
        if not outcome.ok or steps.disposed:
            self._registry.dispose(steps)
            failure = init_failed(steps.id, outcome.message or "its init disposed it")
            on_done(None, OperationOutcome.of(failure))
            return
        steps.initialised = True
        self._artifacts[name] = steps.id
        self._changed(steps.id, True)
        on_done(steps.id, SUCCEEDED)

    def dispose_artifact(self, artifact_id: ArtifactId, on_done: OnOutcome = ignore_outcome) -> None:
        """Dispose an artifact: its observers lose its properties, and its operations fail.

        `Artifact.dispose` runs when the last operation has ended, possibly after this returns.

        Raises:
            UnknownArtifact: it is gone.
        """
        if self._registry.withdraw(artifact_id):
            self._forget(artifact_id)
        else:
            self._registry.dispose(self._steps_of(artifact_id))
        on_done(SUCCEEDED)

    def _forget(self, artifact_id: ArtifactId) -> None:
        if self._personal.get(artifact_id.name) is artifact_id:
            del self._personal[artifact_id.name]
            self._tell(tuple(self._watchers_of_all.values()), artifact_id, False)
        elif self._artifacts.get(artifact_id.name) is artifact_id:
            del self._artifacts[artifact_id.name]
            self._changed(artifact_id, False)

    async def close(self) -> None:
        """Dispose all artifacts, the newest first, and wait until they have released everything."""
        for steps in tuple(self._making.values()):
            self._registry.dispose(steps)
        for artifact_id in reversed((*self.artifacts(), *self.personal_artifacts())):
            self.dispose_artifact(artifact_id)
        await self._registry.ended()

    # ---- artifacts are found

    def artifacts(self) -> tuple[ArtifactId, ...]:
        """Return all artifacts, the oldest first. The standard artifacts come first."""
        return tuple(self._artifacts.values())

    def personal_artifacts(self) -> tuple[ArtifactId, ...]:
        """Return the artifacts that represent agents in this workspace."""
        return tuple(self._personal.values())

    def lookup(self, name: str) -> ArtifactId:
        """Return the artifact with this name.

        Raises:
            UnknownArtifact: it does not exist, or its ``init`` has not ended.
        """
        found = self._artifacts.get(name) or self._personal.get(name)
        if found is None:
            help = aside(name, self._artifacts)
            message = f"unknown artifact `{name}` in workspace {self.path}{help}"
            raise UnknownArtifact(message, Structure("artifact_not_available", (str.__str__(name),)))
        return found

    def watch(self, watcher: ArtifactWatcher, personal: bool = False) -> Callable[[], None]:
        """Call *watcher* with every artifact that is added (True) or removed (False). Return a function that ends this.

        Args:
            watcher: called immediately, in the same turn of the event loop.
            personal: include `personal_artifacts`.
        """
        watchers = self._watchers_of_all if personal else self._watchers
        watch = object()
        watchers[watch] = watcher
        return lambda: watchers.pop(watch, None) and None

    def providers(self, operation: str, arity: int) -> tuple[ArtifactId, ...]:
        """Return the artifacts that offer *operation* with *arity* arguments to agents, the oldest first."""
        index = self._indexes.get((operation, arity))
        if index is None:
            index = self._indexes[operation, arity] = OperationIndex()
            for artifact_id in self._artifacts.values():
                self._offer_of(artifact_id, operation, arity, index)
        found = self._known[operation, arity] = index.found or index.providers()
        return found

    def _offer_of(self, artifact_id: ArtifactId, operation: str, arity: int, index: OperationIndex) -> None:
        """Add an artifact to the index of an operation, if it offers it."""
        declared = self.interface(artifact_id).operations.find(operation, arity)
        if declared is not None:
            index.add(artifact_id, not declared.common and declared.signature.rest is None)

    def offers(self, artifact_id: ArtifactId) -> Collection[str]:
        """Return the operations of an artifact for agents, such as ``inc/1`` and ``sum/any``.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self.interface(artifact_id).operations.keys()

    def artifact_type(self, type_name: str) -> type[Artifact]:
        """Return the class that `make_artifact` would use.

        Raises:
            OperationFailed: the type is unknown.
        """
        return artifact_type_of(type_name, self._find_type, self._setting)

    def operations_changed(self, artifact_id: ArtifactId) -> None:
        """Update the indexes after an artifact has changed its operations."""
        if self._artifacts.get(artifact_id.name) is artifact_id:
            self._indexes.clear()
            self._known.clear()

    def interface(self, artifact_id: ArtifactId) -> UsageInterface:
        """Return the operations of an artifact.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._registry.interface(artifact_id) or self._steps_of(artifact_id).interface

    def has_method(self, artifact_id: ArtifactId, name: str) -> bool:
        """Return whether the class of an artifact has a public user-defined method of this name that is not an operation.

        Raises:
            UnknownArtifact: it is gone.
        """
        method = vars(type(self._steps_of(artifact_id).artifact)).get(name)
        if name.startswith("_") or not callable(method):
            return False
        # `Artifact.remove_operation` has removed a method that is marked but not offered.
        return all(mark.kind != OPERATION or mark.name not in (None, name) for mark in marks_of(method))

    def properties(self, artifact_id: ArtifactId) -> tuple[ObservableProperty, ...]:
        """Return the observable properties of an artifact, as observers know them.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).publication.committed()

    def of_same_robot(self, artifact_id: ArtifactId) -> list[Publication]:
        """Return the artifacts of the same robot in this workspace, *artifact_id* first, as observers see them."""
        own = self._steps_of(artifact_id)
        made = [self._registry.made(each) for each in self._artifacts.values()]
        others = [each for each in made if each is not None and each is not own and each.robot == own.robot]
        return [each.publication for each in (own, *others)]

    def observers(self, artifact_id: ArtifactId) -> tuple[Observer, ...]:
        """Return the observers that focus an artifact, in the order of focusing.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).publication.observers

    def pending(self, artifact_id: ArtifactId) -> tuple[OperationExecution, ...]:
        """Return the operations of an artifact that run (including internal ones) or wait to begin.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).pending()

    # ---- artifacts are used

    def execute(self, request: OperationRequest) -> UnderWay:
        """Run an operation for an agent.

        A plain ``def`` of a free artifact has ended when this returns: its changes are committed, observers have
        received them, and ``request.on_done`` has been called.
        """
        steps = self._registry.find(request.artifact)
        if steps is None:
            return self._gone(request)
        return steps.execute(request, OPERATION)

    def execute_linked(self, request: OperationRequest) -> UnderWay:
        """Run a linked operation for another artifact. See `Artifact.call_linked`."""
        steps = self._registry.find(request.artifact)
        if steps is None:
            return self._gone(request)
        return steps.execute(request, LINK)

    def _gone(self, request: OperationRequest) -> UnderWay:
        request.on_done(faults.not_available(request.artifact))
        return ENDED

    def focus(self, artifact_id: ArtifactId, observer: Observer, on_done: OnOutcome = ignore_outcome) -> None:
        """Let *observer* receive what an artifact publishes, beginning with all its properties.

        Focusing again has no effect.

        Raises:
            UnknownArtifact: it is gone.
        """
        self._steps_of(artifact_id).publication.add(observer)
        on_done(SUCCEEDED)

    def stop_focus(self, artifact_id: ArtifactId, observer: Observer) -> None:
        """Stop sending observations to *observer*. The last one removes all properties.

        Without effect if it does not focus the artifact, or the artifact is gone.
        """
        steps = self._registry.find(artifact_id)
        if steps is not None:
            steps.publication.remove(observer)

    def link(
        self, from_id: ArtifactId, port: str | None, to_id: ArtifactId, on_done: OnOutcome = ignore_outcome
    ) -> None:
        """Link an out port of an artifact to another artifact, in addition to present links. None means its first port.

        Raises:
            UnknownArtifact: one of them is gone.
            OperationFailed: *from_id* has no such port; reason ``unknown_port(Port)``.
        """
        ports = self._steps_of(from_id).ports
        self._steps_of(to_id)
        if port is None and ports:
            port = ports[0]
        if port is None or port not in ports:
            known = f"; its ports are {', '.join(ports)}" if ports else "; it has none"
            wanted = "any" if port is None else str.__str__(port)
            message = f"unknown out port `{wanted}` of artifact {from_id.name} ({from_id.type_name}){known}"
            raise OperationFailed(message, Structure("unknown_port", (wanted,)))
        self._registry.link(from_id, port, to_id)
        on_done(SUCCEEDED)

    def linked(self, from_id: ArtifactId, port: str) -> tuple[ArtifactId, ...]:
        """Return the artifacts that are linked to an out port, in the order of linking."""
        return self._registry.linked(from_id, port)

    def _steps_of(self, artifact_id: ArtifactId) -> Steps:
        steps = self._registry.find(artifact_id)
        if steps is None:
            gone = faults.not_available(artifact_id)
            raise UnknownArtifact(gone.message or "", gone.reason)
        return steps

    def _changed(self, artifact_id: ArtifactId, present: bool) -> None:
        self._known.clear()
        for (operation, arity), index in self._indexes.items():
            if present:
                self._offer_of(artifact_id, operation, arity, index)
            else:
                index.remove(artifact_id)
        if self._setting.listener is not None:
            self._setting.listener.artifact(artifact_id, present)
        self._tell((*self._watchers.values(), *self._watchers_of_all.values()), artifact_id, present)

    def _tell(self, watchers: tuple[ArtifactWatcher, ...], artifact_id: ArtifactId, present: bool) -> None:
        # A watcher may dispose the new artifact: notify the others of its creation first.
        self._tell_rest()
        self._telling = iter(watchers), artifact_id, present
        self._tell_rest()

    def _tell_rest(self) -> None:
        if self._telling is None:
            return
        untold, artifact_id, present = self._telling
        for watcher in untold:
            try:
                watcher(artifact_id, present)
            except Exception as error:
                self._setting.report(error)
        self._telling = None
