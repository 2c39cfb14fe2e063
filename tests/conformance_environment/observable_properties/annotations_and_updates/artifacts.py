"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Structure, operation


class Door(Artifact):
    """A door with annotations."""

    def init(self) -> None:
        self.define_property("door", Atom("closed"), annotations=(Structure("since", (5,)),))

    @operation
    def mark(self, note: Atom) -> None:
        self.annotate_property("door", Structure("note", (note,)))

    @operation(name="set")
    def set_state(self, state: Atom) -> None:
        self.update_property("door", state)
