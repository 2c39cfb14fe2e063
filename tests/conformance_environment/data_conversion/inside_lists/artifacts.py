"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Echo(Artifact):
    """Gives back what it gets."""

    def init(self) -> None:
        self.define_property("last", 0)

    @operation
    def echo(self, value: object, same: Out) -> None:
        same.set(value)

    @operation
    def put(self, value: object) -> None:
        self.update_property("last", value)

    @operation
    def size(self, values: list, size: Out) -> None:
        size.set(len(values))

    @operation(name="sum")
    def sum_up(self, values: list[float], total: Out) -> None:
        total.set(sum(values))

    @operation
    def join(self, texts: list[str], text: Out) -> None:
        text.set("+".join(texts))

    @operation
    def rows(self, number: int, rows: Out) -> None:
        rows.set([list(range(row)) for row in range(number)])

    @operation
    def pair(self, pair: Out) -> None:
        pair.set(("key", 1.5))

    @operation
    def half(self, number: float, half: Out) -> None:
        half.set(number / 2)

    @operation
    def nothing(self, value: Out) -> None:
        value.set(None)
