"""A latch: agents wait until it is set, once and for all."""

from jacaros.env import Artifact, operation


class Latch(Artifact):
    """Holds back those who call ``waitForSet`` until somebody calls ``set``; from then on everybody passes."""

    def init(self) -> None:
        """Not be set."""
        self._is_set = False

    @operation(name="set")
    def set_it(self) -> None:
        """Let everybody pass."""
        self._is_set = True

    @operation(name="waitForSet", guard="is_set")
    def wait_for_set(self) -> None:
        """Wait until it is set."""

    def is_set(self) -> bool:
        """Whether everybody passes."""
        return self._is_set
