"""Artifacts of several cases, which find them by their source path; written from their spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Counter(Artifact):
    """Counts."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)

    @operation
    def inc(self) -> None:
        self.update_property("count", self.value("count") + 1)


class Named(Artifact):
    """Has a text."""

    def init(self, text: str) -> None:
        self._text = text

    @operation
    def whoami(self, text: Out) -> None:
        text.set(self._text)
