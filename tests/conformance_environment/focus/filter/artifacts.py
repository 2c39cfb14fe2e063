"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Counter(Artifact):
    """Counts, and tells of it."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)
        self.define_property("label", "plain")

    @operation
    def inc(self) -> None:
        self.update_property("count", self.value("count") + 1)
        self.signal("tick", self.value("count"))
