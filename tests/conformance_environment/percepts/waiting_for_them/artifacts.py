"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Stove(Artifact):
    """Heats."""

    def init(self) -> None:
        self.define_property("heat", 0)

    @operation(name="heat")
    def heat_to(self, degree: int) -> None:
        self.update_property("heat", degree)
        if degree > 8:
            self.signal("boils", degree)
