"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Shop(Artifact):
    """Sells what is there."""

    def init(self) -> None:
        self.define_property("waiting", 0)
        self._stock: list[int] = []

    @operation
    def ring(self, text: str) -> None:
        self.update_property("waiting", 1)
        self.signal("sound", text)

    @operation
    def put(self, number: int) -> None:
        self._stock.append(number)
        self.signal("sound", number)

    @operation(guard="has_stock")
    def take(self, number: Out) -> None:
        number.set(self._stock.pop(0))

    def has_stock(self) -> bool:
        return bool(self._stock)

    @operation
    def stock(self, number: Out) -> None:
        number.set(len(self._stock))
