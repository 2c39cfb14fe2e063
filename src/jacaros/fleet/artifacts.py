"""The names by which members call artifacts."""

from collections.abc import Callable

from jacaros.artifacts.env.errors import ArtifactId
from jacaros.fleet.wire import ArtifactName


class ArtifactNames:
    """Artifacts of this run and of others.

    Args:
        run: this run of this member, its incarnation.
        path_of: returns the path at which a workspace of another run is visible here.
    """

    def __init__(self, run: str, path_of: Callable[[str, str], str]) -> None:
        self.run = run
        self._path_of = path_of
        self._count = 0
        self._names: dict[ArtifactId, ArtifactName] = {}
        self._by_number: dict[tuple[str, int], ArtifactId] = {}

    def name(self, artifact: ArtifactId) -> ArtifactName:
        """Return how an artifact is called. One of this run gets its number at the first use."""
        known = self._names.get(artifact)
        if known is None:
            self._count += 1
            known = (self.run, self._count, artifact.name, artifact.type_name, artifact.workspace)
            self._know(known, artifact)
        return known

    def _know(self, name: ArtifactName, artifact: ArtifactId) -> None:
        self._names[artifact] = name
        self._by_number[name[0], name[1]] = artifact

    def number(self, artifact: ArtifactId) -> int:
        """Return the number of an artifact in the run that has it."""
        return self.name(artifact)[1]

    def own(self, number: int) -> ArtifactId | None:
        """Return the artifact of this run with a number, or None if it is gone."""
        return self._by_number.get((self.run, number))

    def announced(self, name: ArtifactName, creator: str | None) -> ArtifactId:
        """Return an artifact that its own member names. Others may have sent it before, under any name."""
        artifact = self.find(name)
        run, _, artifact.name, artifact.type_name, workspace = name
        artifact.workspace, artifact.creator = self._path_of(run, workspace), creator
        self._names[artifact] = name
        return artifact

    def find(self, name: ArtifactName) -> ArtifactId:
        """Return the artifact with a name. One of another run is made at its first use."""
        run, number, plain_name, type_name, workspace = name
        known = self._by_number.get((run, number))
        if known is None:
            path = self._path_of(run, workspace)
            known = ArtifactId(plain_name, type_name, path, number, None)
            if run != self.run:  # otherwise it is gone: an id that nothing knows
                self._know(name, known)
        return known

    def forget(self, artifact: ArtifactId) -> None:
        """Forget an artifact that is gone."""
        name = self._names.pop(artifact, None)
        if name is not None:
            del self._by_number[name[0], name[1]]

    def forget_run(self, run: str) -> None:
        """Forget all artifacts of another run, which will not return."""
        for artifact in [each for (of, _), each in self._by_number.items() if of == run]:
            self.forget(artifact)
