"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Board(Artifact):
    """Shows one note."""

    @operation
    def post(self, text: str) -> None:
        self.define_property("note", text)

    @operation
    def edit(self, text: str) -> None:
        self.update_property("note", text)

    @operation
    def wipe(self) -> None:
        self.remove_property("note")
