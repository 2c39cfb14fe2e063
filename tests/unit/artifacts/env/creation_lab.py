"""Artifact types to create, and the reason of a failed creation."""

import pytest

from jacaros.artifacts import Artifact, OperationFailed, internal_operation


class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)


class Fussy(Artifact):
    def init(self, level: int):
        self.define_property("tmp", 1)
        self.start(self.process)
        self.on_dispose(lambda: self.log("cleaned"))
        if level < 0:
            self.fail("negative")
        if level == 0:
            raise RuntimeError("no level")
        self.define_property("level", level)

    def dispose(self):
        self.log("disposed")

    @internal_operation
    def process(self):
        self.log("process")


class Slow(Artifact):
    async def init(self, fails: bool = False):
        self.start(self.process)
        self.on_dispose(lambda: self.log("cleaned"))
        self.define_property("ready", False)
        await self.sleep(1.0)
        if fails:
            self.fail("too slow")
        self.update_property("ready", True)

    @internal_operation
    async def process(self):
        try:
            await self.sleep(100.0)
        finally:
            self.log("process stopped")


async def why(awaitable):
    with pytest.raises(OperationFailed) as caught:
        await awaitable
    assert caught.value.reason.functor == "makeArtifactFailure"
    return (*caught.value.reason.arguments, caught.value.message)
