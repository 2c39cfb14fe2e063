"""Who offers an operation in a workspace, found without a look at all artifacts."""

from jacaros.env.ids import ArtifactId


class Offering:
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
            self._providers.offering = self
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
        offering: where they are from.
    """

    offering: Offering


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
