"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Work(Artifact):
    """Takes long."""

    def init(self) -> None:
        self.define_property("working", 0)

    @operation
    async def long(self) -> None:
        await self.sleep(10.0)

    @operation(guard="never")
    def guarded(self) -> None:
        """Never begin."""

    @operation
    async def until_ready(self) -> None:
        await self.until(self.never)

    def never(self) -> bool:
        return False
