"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, initializer


class Box(Artifact):
    """Can be made in three ways."""

    def init(self, size: int = 1) -> None:
        if size < 0:
            self.fail("a box is not smaller than nothing")
        self.define_property("box", "plain", 1 // size * size or size)
        if size == 99:
            self.workspace.dispose_artifact(self.id)

    @initializer
    def init_coloured(self, colour: str, size: int) -> None:
        self.define_property("box", colour, size)
