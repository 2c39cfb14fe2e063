"""Behaviours that receive the signals of focused artifacts."""

from collections.abc import Callable
from typing import Any

from py_trees.common import Status

from jacaros.artifacts.env.values import text
from jacaros.artifacts.presence.presence import ReceivedSignal
from jacaros.behaviour_trees.artifact_behaviour import ArtifactBehaviour, nothing


class OnSignal(ArtifactBehaviour):
    """SUCCESS if the signal arrived since the last tick, otherwise FAILURE.

    It receives signals from `setup` on, ticked or not, so a signal between two ticks is not missed. Several signals
    between two ticks are one SUCCESS, with the arguments of the latest.

    Args:
        signal: name of the signal.
        predicate: called with its arguments; other signals are skipped. If it raises an exception, the behaviour
            fails.
        artifact: name of the artifact; default: any focused one.
        to: blackboard key for the arguments, a tuple.
        name: name of the behaviour; default: the signal's name with an exclamation mark.
    """

    otherwise = Status.FAILURE

    def __init__(
        self,
        signal: str,
        predicate: Callable[..., object] | None = None,
        *,
        artifact: str | None = None,
        to: str | None = None,
        name: str | None = None,
    ) -> None:
        super().__init__(name or f"{signal}!")
        self.signal, self.predicate, self.artifact, self.to = signal, predicate, artifact, to
        self._heard: tuple[object, ...] | None = None
        self._wrong: Exception | None = None
        self._stop_hearing: Callable[[], object] = nothing
        if to is not None:
            self.may_write(to)

    def setup(self, **given: Any) -> None:
        """Start receiving; see `ArtifactBehaviour.setup`."""
        super().setup(**given)
        self.shutdown()
        self._heard = self._wrong = None
        self._stop_hearing = self.session.on_signal(self._hear)

    def shutdown(self) -> None:
        """Stop receiving."""
        self._stop_hearing()
        self._stop_hearing = nothing

    def update(self) -> Status:
        """Return whether the signal arrived."""
        heard, wrong = self._heard, self._wrong
        self._heard = self._wrong = None
        if wrong is not None:
            self.complain("the predicate", wrong)
            return Status.FAILURE
        if heard is None:
            self.feedback_message = f"no {self.signal}"
            return self.otherwise
        shown = ", ".join(text(each, True) for each in heard)
        self.feedback_message = f"{self.signal}({shown})" if heard else self.signal
        if self.to is not None:
            self.board.set(self.to, heard)
        return Status.SUCCESS

    def _hear(self, signal: ReceivedSignal) -> None:
        if signal.name != self.signal or self.artifact not in (None, signal.artifact.name):
            return
        try:
            wanted = self.predicate is None or self.predicate(*signal.arguments)
        except Exception as error:
            self._wrong = error
        else:
            if not wanted:
                return
            self._heard = signal.arguments
        self.wake()


class WaitForSignal(OnSignal):
    """RUNNING until the signal arrives, then SUCCESS; signals from before the first tick do not count.

    The arguments are those of `OnSignal`.
    """

    otherwise = Status.RUNNING

    def initialise(self) -> None:
        """Forget earlier signals."""
        self._heard = self._wrong = None
