"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Calc(Artifact):
    """Calculates."""

    @operation
    def add(self, a: int, b: int, total: Out) -> None:
        total.set(a + b)

    @operation
    def divmod(self, a: int, b: int, quotient: Out, remainder: Out) -> None:
        quotient.set(a // b)
        remainder.set(a % b)

    @operation
    def swap(self, first: Out, second: Out, a: object, b: object) -> None:
        first.set(b)
        second.set(a)

    @operation
    def answer(self, number: Out) -> None:
        number.set(42)

    @operation
    def check(self, number: int, most: int) -> None:
        if number > most:
            self.fail("too big", "too_big", number, most)
