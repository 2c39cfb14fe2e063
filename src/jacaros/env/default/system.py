"""The artifact ``system``: the process in which everything runs."""

from typing import NoReturn

from jacaros.env.artifact import Artifact, operation


class SystemArtifact(Artifact):
    """The process in which agents and artifacts run."""

    @operation(name="shutdownNode")
    def shut_down(self) -> None:
        """End the run, as ``.stopMAS`` does."""
        stop = self.resources.get("stop")
        if not callable(stop):
            self.fail("nobody here can end the run", "not_supported", "shutdownNode/0")
        stop()

    @operation
    def crash(self) -> None:
        """End the process at once: not supported."""
        self._refuse("a run is not ended without putting things in order; shutdownNode or .stopMAS ends it")

    @operation(name="spawnNode")
    def spawn(self, *arguments: object) -> None:
        """Start another process: not possible yet."""
        self._refuse("other processes cannot be started yet")

    def _refuse(self, message: str) -> NoReturn:
        request = self.current.request
        self.fail(message, "not_supported", f"{request.operation}/{len(request.arguments)}")
