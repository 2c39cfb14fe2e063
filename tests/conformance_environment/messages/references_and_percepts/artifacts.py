"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Lamp(Artifact):
    """Shines."""

    def init(self) -> None:
        self.define_property("lit", 0)

    @operation
    def switch(self, brightness: int) -> None:
        self.update_property("lit", brightness)

    @operation
    def brightness(self, brightness: Out) -> None:
        brightness.set(self.value("lit"))
