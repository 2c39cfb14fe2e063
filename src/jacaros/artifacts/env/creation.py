"""Create artifacts: find the type, connect object and kernel, and report why creation failed."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

from jacaros.artifacts.env.artifact import Artifact, Host
from jacaros.artifacts.env.errors import (
    ArtifactId,
    InvalidArtifact,
    OperationFailed,
    UnknownArtifact,
    UnknownArtifactType,
    UnknownWorkspace,
    resolve_path,
)
from jacaros.artifacts.env.operation import OperationRequest
from jacaros.artifacts.env.ports import Workspace
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.kernel.declaration import NOTHING, DeclaredOperation, interface_of
from jacaros.artifacts.kernel.faults import error_text, is_interruption
from jacaros.artifacts.kernel.publication import Setting, mistakes_in
from jacaros.artifacts.kernel.steps import Steps
from jacaros.errors import InternalError
from jacaros.files.texts import aside

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


def attach(artifact_type: type[Artifact], artifact_id: ArtifactId, host: Host, setting: Setting) -> Steps:
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
    """The artifacts of a workspace that offer one operation with one number of arguments."""

    __slots__ = ("_every", "_exact", "_providers")

    def __init__(self) -> None:
        self._every = _ByAge()
        self._exact = _ByAge()
        self._providers: Providers | None = None

    def add(self, artifact: ArtifactId, exact: bool) -> None:
        """Add an artifact, which must be younger than all others.

        Args:
            artifact: the artifact.
            exact: whether it takes exactly this number of arguments, rather than any number.
        """
        self._every.add(artifact)
        if exact:
            self._exact.add(artifact)
        self._providers = None

    def remove(self, artifact: ArtifactId) -> None:
        """Remove an artifact, if present."""
        if artifact in self._every.artifacts:
            self._every.remove(artifact)
            if artifact in self._exact.artifacts:
                self._exact.remove(artifact)
            self._providers = None

    def providers(self) -> "Providers":
        """Return all artifacts, the oldest first."""
        if self._providers is None:
            self._providers = Providers(self._every.artifacts)
            self._providers.operation_index = self
        return self._providers

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
    places: Iterable[Workspace], operation: str, arity: int, own: str, focused: Sequence[ArtifactId]
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


def artifact_named(places: Iterable[Workspace], name: str) -> ArtifactId:
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
    workspace: Workspace,
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
    """

    def __init__(self, make: Callable[[str, Workspace | None], Workspace]) -> None:
        self._make = make
        self._workspaces: dict[str, Workspace] = {}
        self._links: dict[str, str] = {}
        self._watchers: dict[str, list[Callable[[], None]]] = {}

    def workspaces(self) -> tuple[Workspace, ...]:
        """Return all workspaces, the oldest first."""
        return tuple(self._workspaces.values())

    def at(self, path: str, otherwise: Workspace) -> Workspace:
        """Return the workspace with this full path, without following links."""
        return self._workspaces.get(path, otherwise)

    def workspace(self, path: str) -> Workspace:
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

    def place(self, here: Workspace, path: str) -> tuple[Workspace, str]:
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

    def create_workspace(self, path: str) -> Workspace:
        """Create a workspace with its standard artifacts at a full path. Its parent workspace must exist.

        Raises:
            OperationFailed: it already exists; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the parent workspace does not exist.
        """
        path = self._free(path)
        above = path.rpartition("/")[0]
        workspace = self._workspaces[path] = self._make(path, self.workspace(above) if above else None)
        self._tell(path)
        return workspace

    def mount(self, workspace: Workspace) -> Callable[[], None]:
        """Add a remote workspace at its path. Return a function that removes it.

        Raises:
            OperationFailed: the path is in use; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the parent workspace does not exist.
        """
        path = self._free(workspace.path)
        self._workspaces[path] = workspace
        self._tell(path)

        def unmount() -> None:
            if self._workspaces.get(path) is workspace:
                del self._workspaces[path]
                self._tell(path)

        return unmount

    def link_workspace(self, path: str, target: str) -> None:
        """Make an unused full path lead to the workspace at another path.

        Raises:
            OperationFailed: the path is in use; reason ``workspace_already_present(Path)``.
            UnknownWorkspace: the target, or the parent workspace of the path, does not exist.
        """
        to = self.workspace(target)
        path = self._free(path)
        self._links[path] = to.path
        self._tell(path)

    def _free(self, path: str) -> str:
        """Return an unused path, with its links resolved."""
        above, _, name = str.__str__(path).rpartition("/")
        path = f"{self.workspace(above).path}/{name}" if above else path
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

    def watch(self, path: str, watcher: Callable[[], None]) -> None:
        """Call *watcher* whenever a workspace or link directly below a workspace is added or removed."""
        self._watchers.setdefault(path, []).append(watcher)

    def _tell(self, path: str) -> None:
        for watcher in self._watchers.get(path.rpartition("/")[0], ()):
            watcher()


def _beginnings(path: str) -> list[str]:
    """Return the full paths of the workspaces above a path and of the path itself, the shortest first."""
    parts = path.split("/")
    return ["/".join(parts[:length]) for length in range(2, len(parts) + 1)]
