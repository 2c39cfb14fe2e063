"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Typed(Artifact):
    """Takes arguments of certain types."""

    @operation
    def whole(self, number: int) -> None:
        self.signal("ok", "whole")

    @operation
    def flag(self, on: bool) -> None:
        self.signal("ok", "flag")

    @operation
    def word(self, word: str) -> None:
        self.signal("ok", "word")

    @operation
    def numbers(self, numbers: list[float]) -> None:
        self.signal("ok", "numbers")

    @operation
    def result(self, result: Out) -> None:
        result.set(1)
