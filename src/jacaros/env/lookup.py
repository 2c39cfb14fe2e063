"""Which artifact is meant: who offers an operation in a workspace, and what a name means in the joined ones.

When several artifacts offer an operation, CArtAgO's rule decides, for agents and for sessions alike.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from jacaros.env.errors import OperationFailed, UnknownArtifact
from jacaros.env.ids import ArtifactId, resolve_path
from jacaros.env.ports import Environment, Workspace


class OperationIndex:
    """The artifacts of a workspace that offer one operation with one number of arguments."""

    __slots__ = ("_every", "_exact", "_providers")

    def __init__(self) -> None:
        self._every = _ByAge()
        self._exact = _ByAge()
        self._providers: Providers | None = None

    def add(self, artifact: ArtifactId, exact: bool) -> None:
        """Take in an artifact that is younger than all others.

        Args:
            artifact: the artifact.
            exact: whether it takes exactly so many arguments, and not any number.
        """
        self._every.add(artifact)
        if exact:
            self._exact.add(artifact)
        self._providers = None

    def remove(self, artifact: ArtifactId) -> None:
        """Forget an artifact; nothing happens when it is not there."""
        if artifact in self._every.artifacts:
            self._every.remove(artifact)
            if artifact in self._exact.artifacts:
                self._exact.remove(artifact)
            self._providers = None

    def providers(self) -> "Providers":
        """All of them, the oldest first."""
        if self._providers is None:
            self._providers = Providers(self._every.artifacts)
            self._providers.operation_index = self
        return self._providers

    def is_preferred(self, artifact: ArtifactId) -> bool:
        """Whether an artifact may be chosen: those that take exactly so many arguments come before the others."""
        return artifact in self._preferred.artifacts

    def oldest(self) -> ArtifactId:
        """The oldest that may be chosen; there must be one."""
        return next(iter(self._preferred.artifacts))

    def oldest_of(self, creator: str) -> ArtifactId | None:
        """The oldest that may be chosen of those that *creator* made."""
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


class _ByAge:
    """Artifacts in the order of their making, also by who made them."""

    __slots__ = ("artifacts", "by_creator")

    def __init__(self) -> None:
        self.artifacts: dict[ArtifactId, None] = {}
        self.by_creator: dict[str | None, dict[ArtifactId, None]] = {}

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
    """The artifact that is to serve an operation; None when nobody offers it.

    The first workspace that has one decides.  There, those that take exactly so many arguments come before
    those that take any number; among them the oldest one made by *own*, else the one focused first, else the
    oldest.

    Args:
        places: the workspaces, in the order in which they count.
        operation: its name.
        arity: the number of its arguments.
        own: who asks, as it is noted as the creator of artifacts.
        focused: what they focus, in the order of focusing.
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
    """The artifact of that name in the first workspace that has one.

    Raises:
        UnknownArtifact: none has.
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
        # The workspace is served from elsewhere.
        index = OperationIndex()
        exact = f"{operation}/{arity}"
        for candidate in candidates:
            index.add(candidate, exact in workspace.offers(candidate))
    of_own = index.oldest_of(own)
    if of_own is not None:
        return of_own
    return next((artifact for artifact in focused if index.is_preferred(artifact)), index.oldest())


def in_order(joined: Mapping[str, Workspace], current: Workspace, home: Workspace) -> Iterator[Workspace]:
    """Where things are looked for: the current workspace, home while it is joined, then the others.

    Args:
        joined: the joined workspaces by full path, in the order of joining.
        current: the current one.
        home: the one in which everything began.
    """
    yield current
    if home is not current and home.path in joined:
        yield home
    if len(joined) > 1:
        yield from (w for w in joined.values() if w is not current and w is not home)


def joined_workspace(
    environment: Environment, joined: Mapping[str, Workspace], current: Workspace, home: Workspace, name: str
) -> Workspace | None:
    """The joined workspace with that plain name or path, which starts from the current one; None without one."""
    full = resolve_path(current.path, name)
    for workspace in in_order(joined, current, home):
        if (workspace.path == full or workspace.name == name) and workspace.path in joined:
            return workspace
    try:
        # A link may lead there.
        return joined.get(environment.workspace(full).path)
    except OperationFailed:
        return None
