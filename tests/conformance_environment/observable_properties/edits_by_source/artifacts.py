"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Dial(Artifact):
    """A dial."""

    def init(self) -> None:
        self.define_property("level", 1)

    @operation
    def turn(self, level: int) -> None:
        self.update_property("level", level)
