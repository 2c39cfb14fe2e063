"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Gate(Artifact):
    """Opens with one key."""

    def init(self) -> None:
        self.define_property("state", "closed")

    @operation
    def open(self, key: int) -> None:
        if key != 7:
            self.fail("wrong key", "wrong_key", key, "gate", True)
        self.update_property("state", "open")

    @operation
    def jam(self) -> None:
        self.fail("jammed")

    @operation
    def plain(self) -> None:
        self.fail("plain", "plain")
