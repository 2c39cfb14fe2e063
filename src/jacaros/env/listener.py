"""The port through which an environment is watched as a whole; `Environment.listener` takes one."""

from typing import Protocol

from jacaros.env.execution import OperationExecution
from jacaros.env.ids import ArtifactId
from jacaros.env.observation import Observation
from jacaros.env.operation import OperationOutcome


class EnvironmentListener(Protocol):
    """Receives what happens in the artifacts of one environment, on the loop.

    Nothing is made for it while there is none.  It returns soon, does not raise and changes nothing.
    """

    def artifact(self, artifact: ArtifactId, present: bool) -> None:
        """An artifact has been made (True) or disposed; those that stand for agents are left out."""

    def focused(self, artifact: ArtifactId, agent: str, on: bool) -> None:
        """An agent begins to focus an artifact (True), or no longer does."""

    def published(self, observation: Observation) -> None:
        """An artifact has changed properties or sent signals."""

    def began(self, execution: OperationExecution) -> None:
        """An operation that somebody asked for is about to begin, or to wait for its turn."""

    def ended(self, execution: OperationExecution, outcome: OperationOutcome | None) -> None:
        """That operation has ended; None: it was cancelled."""
