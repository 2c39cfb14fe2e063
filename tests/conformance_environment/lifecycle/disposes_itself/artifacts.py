"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Once(Artifact):
    """Can be used once."""

    def init(self) -> None:
        self.define_property("uses", 0)

    @operation
    def use(self, result: Out) -> None:
        self.update_property("uses", 1)
        self.workspace.dispose_artifact(self.id)
        result.set("done")
