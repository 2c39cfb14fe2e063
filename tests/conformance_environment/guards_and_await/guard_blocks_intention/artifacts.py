"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Store(Artifact):
    """Gives what is there, and makes wait for what is not."""

    def init(self) -> None:
        self.define_property("level", 0)

    @operation
    def fill(self, amount: int) -> None:
        self.update_property("level", self.value("level") + amount)

    @operation(guard="has")
    def take(self, amount: int) -> None:
        self.update_property("level", self.value("level") - amount)

    def has(self, amount: int) -> bool:
        return bool(self.value("level") >= amount)
