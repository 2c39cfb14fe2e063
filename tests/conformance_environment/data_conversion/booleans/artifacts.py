"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Tester(Artifact):
    """Tells what is true."""

    def init(self) -> None:
        self.define_property("last", False)

    @operation
    def even(self, number: int, result: Out) -> None:
        result.set(number % 2 == 0)

    @operation
    def negate(self, value: bool, result: Out) -> None:
        result.set(not value)
        self.update_property("last", not value)
