"""All artifacts of an environment, in any workspace, and the links between them."""

from collections.abc import Callable

from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.kernel.declaration import UsageInterface
from jacaros.artifacts.kernel.steps import Steps

Promise = tuple[UsageInterface, Callable[[], Steps]]
"""The operations of an artifact that does not exist yet, and the function that creates it."""
OutPort = tuple[ArtifactId, str]
"""An artifact and the name of one of its out ports."""


class Registry:
    """Finds the artifact with an id, and the artifacts that are linked to an out port.

    An artifact may be promised: it has its id, and is created when more than its operations is needed.

    Attributes:
        when_disposed: called with the id of a disposed artifact, after its observers have been notified.
    """

    def __init__(self) -> None:
        self._steps: dict[ArtifactId, Steps] = {}
        self._promises: dict[ArtifactId, Promise] = {}
        self._forget: dict[ArtifactId, Callable[[ArtifactId], None]] = {}
        self._ending: list[Steps] = []
        self._links: dict[OutPort, dict[ArtifactId, None]] = {}
        self._last_number = 0
        self.when_disposed: list[Callable[[ArtifactId], None]] = []

    def next_number(self) -> int:
        """Return the number for a new artifact."""
        self._last_number += 1
        return self._last_number

    def add(self, steps: Steps, forget: Callable[[ArtifactId], None]) -> None:
        """Add an artifact. *forget* is called when it is removed."""
        self._steps[steps.id] = steps
        self._forget[steps.id] = forget

    def promise(self, artifact_id: ArtifactId, interface: UsageInterface, make: Callable[[], Steps]) -> None:
        """Add an artifact that *make* will create and `add`."""
        self._promises[artifact_id] = (interface, make)

    def withdraw(self, artifact_id: ArtifactId) -> bool:
        """Remove a promise. Return False if the artifact has been created, or there is no promise."""
        return self._promises.pop(artifact_id, None) is not None

    def find(self, artifact_id: ArtifactId) -> Steps | None:
        """Return the artifact with this id, or None if it is gone."""
        found = self._steps.get(artifact_id)
        if found is None and artifact_id in self._promises:
            _, make = self._promises.pop(artifact_id)
            return make()
        return found

    def made(self, artifact_id: ArtifactId) -> Steps | None:
        """Return the artifact with this id, or None if it is gone or only promised."""
        return self._steps.get(artifact_id)

    def interface(self, artifact_id: ArtifactId) -> UsageInterface | None:
        """Return the operations of the artifact with this id, or None if it is gone."""
        if artifact_id in self._promises:
            return self._promises[artifact_id][0]
        found = self._steps.get(artifact_id)
        return found.interface if found is not None else None

    def dispose(self, steps: Steps) -> None:
        """Remove an artifact and all links from and to it, and end its operations."""
        steps.publish_last()
        if steps.id in self._steps:
            self._remove(steps.id)
        steps.dispose()
        self._ending = [each for each in (*self._ending, steps) if not each.ending.over]
        for callback in self.when_disposed:
            callback(steps.id)

    async def ended(self) -> None:
        """Wait until all disposed artifacts have released everything."""
        for steps in self._ending:
            await steps.closed()

    def _remove(self, artifact_id: ArtifactId) -> None:
        del self._steps[artifact_id]
        for port, behind in tuple(self._links.items()):
            behind.pop(artifact_id, None)
            if not behind or port[0] is artifact_id:
                del self._links[port]
        self._forget.pop(artifact_id)(artifact_id)

    def link(self, from_id: ArtifactId, port: str, to_id: ArtifactId) -> None:
        """Link *port* of *from_id* to *to_id*, after the present links. Linking again has no effect."""
        self._links.setdefault((from_id, port), {})[to_id] = None

    def linked(self, from_id: ArtifactId, port: str) -> tuple[ArtifactId, ...]:
        """The artifacts behind *port* of *from_id*, in the order of linking."""
        return tuple(self._links.get((from_id, port), ()))
