"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, operation


class Dial(Artifact):
    """A dial with marks."""

    def init(self) -> None:
        self.define_property("level", 0)

    @operation
    def turn(self, level: int) -> None:
        self.update_property("level", level)
        self.signal("turned", level)

    @operation
    def mark(self, name: Atom) -> None:
        self.define_property("mark", name)

    @operation
    def first(self, name: Atom) -> None:
        self.update_property("mark", name)

    @operation
    def gone(self, name: Atom) -> None:
        self.remove_property("mark", name)
