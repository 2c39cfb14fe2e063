"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, link, operation


class Lamp(Artifact):
    """Can be reached from other artifacts only."""

    def init(self) -> None:
        self.define_property("power", 0)

    @link(name="raise")
    def raise_power(self, amount: int) -> None:
        self.update_property("power", self.value("power") + amount)

    @link
    def read(self, power: Out) -> None:
        power.set(self.value("power"))

    @link
    def refuse(self) -> None:
        self.fail("refused", "refused_by", self.name)

    @link
    def who(self, name: Out) -> None:
        name.set(self.caller)


class Switch(Artifact):
    """Works the lamp behind its port."""

    ports = ("out",)

    def init(self) -> None:
        self.define_property("presses", 0)

    @operation
    async def press(self, amount: int, power: Out) -> None:
        await self.call_linked("out", "raise", amount)
        await self.call_linked("out", "read", power)
        self.update_property("presses", self.value("presses") + 1)

    @operation
    async def owner(self, name: Out) -> None:
        await self.call_linked("out", "who", name)
