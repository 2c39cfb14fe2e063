"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Failing(Artifact):
    """Fails."""

    @operation
    def quiet(self, number: int) -> None:
        self.fail("hush")

    @operation
    def loud(self) -> None:
        self.fail("too loud", "too_loud", 90, "dB")
