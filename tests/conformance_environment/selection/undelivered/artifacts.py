"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Named(Artifact):
    """Remembers a text."""

    def init(self, text: str) -> None:
        self._text = text

    @operation
    def whoami(self, text: Out) -> None:
        text.set(self._text)

    @operation
    def two(self, first: Out, second: Out) -> None:
        first.set(1)
        second.set("other")
