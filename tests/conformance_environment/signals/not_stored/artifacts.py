"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Bell(Artifact):
    """Rings."""

    @operation
    def ring(self, number: int) -> None:
        self.signal("rung", number, "loud")
