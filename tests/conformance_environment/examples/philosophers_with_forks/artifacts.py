"""The artifacts of this case, written from its spec.md."""

from jacaros.artifacts import Artifact, Out, operation


class Fork(Artifact):
    """Is in one hand at a time."""

    def init(self) -> None:
        self._holder: str | None = None
        self._used = 0

    @operation(guard="is_free")
    def grab(self) -> None:
        self._holder = self.caller
        self._used += 1

    def is_free(self) -> bool:
        return self._holder is None

    @operation
    def drop(self) -> None:
        if self._holder != self.caller:
            self.fail("not yours", "not_yours", self.caller)
        self._holder = None

    @operation
    def used(self, times: Out) -> None:
        times.set(self._used)
