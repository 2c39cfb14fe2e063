"""The port through which a whole environment is observed. See `Environment.listener`."""

from typing import Protocol

from jacaros.env.execution import OperationExecution
from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observation
from jacaros.env.operation import OperationOutcome


class EnvironmentListener(Protocol):
    """Receives what happens in the artifacts of one environment, on the event loop.

    Without a listener, this costs nothing. A listener returns soon, does not raise and changes nothing.
    """

    def artifact(self, artifact: ArtifactId, present: bool) -> None:
        """An artifact has been created (True) or disposed. Artifacts that represent agents are left out."""

    def focused(self, artifact: ArtifactId, agent: str, on: bool) -> None:
        """An agent has begun to focus an artifact (True), or stopped."""

    def published(self, observation: Observation) -> None:
        """An artifact has changed properties or sent signals."""

    def began(self, execution: OperationExecution) -> None:
        """A requested operation begins, or waits for its turn."""

    def ended(self, execution: OperationExecution, outcome: OperationOutcome | None) -> None:
        """The operation has ended. None: it was cancelled."""
