"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Show(Artifact):
    """Names the version of the operation that ran."""

    @operation(name="show")
    def show_one(self, a: int, shown: Out) -> None:
        shown.set(f"one {a}")

    @operation(name="show")
    def show_two(self, a: int, b: int, shown: Out) -> None:
        shown.set(f"two {a} {b}")

    @operation(name="sum")
    def sum_any(self, *numbers_and_total: int | Out) -> None:
        *numbers, total = numbers_and_total
        assert isinstance(total, Out)
        total.set(sum(number for number in numbers if isinstance(number, int)))

    @operation(name="sum")
    def sum_one(self, a: int, total: Out) -> None:
        total.set(f"exact {a}")
