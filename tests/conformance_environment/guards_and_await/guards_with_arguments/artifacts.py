"""The artifacts of this case, written from its spec.md."""

from collections import Counter

from jacaros.artifacts import Artifact, Out, operation


class Store(Artifact):
    """Keeps things."""

    def init(self) -> None:
        self.stock: Counter[str] = Counter()

    @operation
    def put(self, what: str, number: int) -> None:
        self.stock[what] += number

    @operation(guard="has")
    def take(self, what: str) -> None:
        self.stock[what] -= 1

    def has(self, what: str) -> bool:
        if what == "bombs":
            raise ValueError("no bombs here")
        return self.stock[what] > 0

    @operation
    async def wait_for(self, what: str, number: int, stock: Out) -> None:
        await self.until(lambda: self.stock[what] >= number)
        stock.set(self.stock[what])
