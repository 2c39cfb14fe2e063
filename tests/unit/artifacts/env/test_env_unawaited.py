"""Errors with ``await`` and ``return`` that Python itself does not report."""

import pytest

from jacaros.artifacts import Artifact, internal_operation, operation


class Forgetful(Artifact):
    def init(self):
        self.define_property("count", 0)

    @operation
    async def sleeping(self):
        self.update_property("count", 1)
        self.sleep(1)

    @operation
    def plainly(self):
        self.update_property("count", 1)
        self.sleep(1)

    @operation
    async def waiting(self):
        await self.sleep(1)
        self.update_property("count", 1)
        self.until(lambda: False)
        await self.sleep(1)
        self.update_property("count", 2)

    @operation
    async def thrice(self):
        later = self.sleep(1)
        for _ in range(2):
            await self.sleep(1)
        await later
        self.update_property("count", 5)

    @operation
    async def failing(self):
        self.sleep(1)
        self.fail("no", "no")

    @operation
    def answer(self):
        return 3

    @operation
    async def late_answer(self):
        await self.sleep(1)
        return 3

    @operation
    def begin(self):
        self.start(self.process)

    @internal_operation
    async def process(self):
        self.sleep(1)


pytestmark = pytest.mark.makes(it=Forgetful)


async def test_coroutines_without_await_are_logged_when_the_first_artifact_is_created(stage, it):
    await stage.make(Forgetful, name="another")
    found = [line for line in stage.lines if "without await" in line]
    assert [line.partition(" (line ")[0].rpartition(".")[2] for line in found] == [
        "sleeping",
        "plainly",
        "waiting",
        "failing",
        "process",
    ]
    assert found[0].startswith("[Forgetful] in Forgetful.sleeping (line ")
    assert found[0].endswith(
        "): self.sleep(1) has no effect without await: write `await self.sleep(...)` in an async def"
    )
    assert "self.until(lambda: False) has no effect" in found[2]


async def test_a_coroutine_that_is_awaited_later_has_its_effect(stage, it):
    assert (await stage.call(it, "thrice").wait()).ok
    assert stage.property(it, "count") == (5,)
    assert stage.elapsed == 3


async def test_a_lost_return_value_is_reported_once(stage, it):
    for name in ("answer", "answer", "late_answer"):
        assert (await stage.call(it, name).wait()).ok
    assert [line.partition(" is lost")[0] for line in stage.lines if "is lost" in line] == [
        "[it] the return value of Forgetful.answer",
        "[it] the return value of Forgetful.late_answer",
    ]
