"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Counter(Artifact):
    """Counts."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)

    @operation
    def inc(self) -> None:
        self.update_property("count", self.value("count") + 1)
