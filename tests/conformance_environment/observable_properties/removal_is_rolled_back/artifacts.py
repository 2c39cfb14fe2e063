"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Rooms(Artifact):
    """Rooms that are known."""

    def init(self) -> None:
        self.define_property("room", "kitchen")
        self.define_property("room", "hall")

    @operation
    def tidy_up(self) -> None:
        self.remove_property("room", "kitchen")
        self.update_property("room", "big hall")
        self.define_property("room", "new")
        self.fail("too tired", "tired", 3)

    @operation
    def clear(self, room: str) -> None:
        self.remove_property("room", room)
