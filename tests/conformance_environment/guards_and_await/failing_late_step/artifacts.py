"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, operation


class Two(Artifact):
    """Fails in its second step."""

    def init(self) -> None:
        self.define_property("n", 0)

    @operation
    async def go(self) -> None:
        self.update_property("n", 1)
        await self.sleep(0.05)
        self.update_property("n", 2)
        self.fail("late", "late", 2)
