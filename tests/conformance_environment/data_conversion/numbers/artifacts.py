"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Echo(Artifact):
    """Gives values back."""

    @operation
    def echo(self, value: object, same: Out) -> None:
        same.set(value)

    @operation
    def kind(self, value: object, kind: Out) -> None:
        kinds = {bool: "boolean", int: "number", float: "number", str: "text", list: "list"}
        kind.set(kinds.get(type(value), "other"))

    @operation
    def half(self, number: int, half: Out) -> None:
        half.set(number / 2)

    @operation
    def trunc(self, number: float, whole: Out) -> None:
        whole.set(int(number))

    @operation
    def big(self, number: Out) -> None:
        number.set(12345678901)

    @operation
    def small(self, number: Out) -> None:
        number.set(0.0000001)

    @operation
    def whole(self, number: Out) -> None:
        number.set(3.0)
