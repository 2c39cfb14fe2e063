"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Counter(Artifact):
    """Counts."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)

    @operation
    def inc(self) -> None:
        self.update_property("count", self.value("count") + 1)


class Labelled(Artifact):
    """Has a label and a size."""

    def init(self, label: str, size: int) -> None:
        self.define_property("label", label)
        self.define_property("size", size)
