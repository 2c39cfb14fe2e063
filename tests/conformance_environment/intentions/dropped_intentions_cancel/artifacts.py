"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Atom, Out, operation


class Oven(Artifact):
    """Bakes one thing at a time."""

    def init(self) -> None:
        self.define_property("oven", Atom("off"))
        self._baked: list[Atom] = []

    @operation(guard="is_off")
    async def bake(self, what: Atom, milliseconds: int) -> None:
        self.update_property("oven", what)
        try:
            await self.sleep(milliseconds / 1000)
            self._baked.append(what)
        finally:
            self.update_property("oven", Atom("off"))

    def is_off(self, what: Atom, milliseconds: int) -> bool:
        return bool(self.value("oven") == "off")

    @operation
    def baked(self, things: Out) -> None:
        things.set(self._baked)
