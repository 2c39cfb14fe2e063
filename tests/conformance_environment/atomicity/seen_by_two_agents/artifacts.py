"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Ledger(Artifact):
    """Two accounts."""

    def init(self) -> None:
        self.define_property("from", 100)
        self.define_property("to", 0)

    def move(self, amount: int) -> None:
        self.update_property("from", self.value("from") - amount)
        self.update_property("to", self.value("to") + amount)

    @operation
    def transfer(self, amount: int) -> None:
        self.move(amount)

    @operation
    async def slow(self, amount: int) -> None:
        self.move(10)
        await self.sleep(0.04)
        self.move(10)
        self.move(10)
        await self.sleep(0.04)
        self.move(amount)
        if self.value("from") < 0:
            self.fail("nothing left", "overdrawn", self.value("from"))

    @operation
    def crash(self, amount: int) -> None:
        self.move(amount)
        raise RuntimeError("power cut")
