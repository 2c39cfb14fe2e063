"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Giver(Artifact):
    """Gives outputs."""

    @operation
    def give(self, first: Out, second: Out, third: Out) -> None:
        first.set(1)
        first.set(2)
        third.set([1, "a", True])

    @operation
    def same(self, first: Out, second: Out) -> None:
        second.set(5)

    @operation
    def give_and_fail(self, first: Out) -> None:
        first.set(1)
        self.fail("no", "no_way")
