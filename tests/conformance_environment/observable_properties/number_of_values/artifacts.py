"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Pose(Artifact):
    """A property whose number of values changes."""

    def init(self) -> None:
        self.define_property("pose", 1, 2)

    @operation
    def more(self) -> None:
        self.update_property("pose", 1, 2, 3)

    @operation
    def turn(self, angle: float) -> None:
        self.update_value("pose", 2, angle)

    @operation
    def less(self) -> None:
        self.update_property("pose", 1)

    @operation
    def nothing(self) -> None:
        self.update_property("pose")
