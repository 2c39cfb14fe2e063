"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, OperationFailed, Out, Structure, link, operation


class Lamp(Artifact):
    """Can be reached from other artifacts only."""

    def init(self) -> None:
        self.define_property("power", 0)

    @link
    def add(self, amount: int) -> None:
        self.update_property("power", self.value("power") + amount)
        if amount < 0:
            self.fail("negative", "negative", amount)


class Switch(Artifact):
    """Works the lamps behind its port."""

    ports = ("out",)

    @operation
    async def all(self, amount: int) -> None:
        await self.call_linked("out", "add", amount)

    @operation
    async def no_port(self, amount: int) -> None:
        await self.call_linked("in", "add", amount)

    @operation
    async def no_operation(self) -> None:
        await self.call_linked("out", "sing")

    @operation
    async def caught(self, functor: Out) -> None:
        try:
            await self.call_linked("out", "add", -2)
        except OperationFailed as failure:
            if isinstance(failure.reason, Structure):
                functor.set(failure.reason.functor)
