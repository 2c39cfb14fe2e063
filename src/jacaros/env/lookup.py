"""Artifact resolution: which artifact serves an operation, and which one a name means.

If several artifacts offer an operation, CArtAgO's rule decides, for agents and sessions alike.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from jacaros.env.errors import UnknownArtifact
from jacaros.env.ids import ArtifactId
from jacaros.env.ports import Workspace


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
