"""Errors with ``await`` and ``return`` that Python itself does not report."""

import pytest

from jacaros.artifacts import Artifact, Structure, internal_operation, operation


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


@pytest.mark.parametrize(
    ("name", "method"), [("sleeping", "sleep"), ("plainly", "sleep"), ("waiting", "until")]
)
def test_a_step_boundary_without_await_fails_the_operation(play, name, method):
    async def scene(stage):
        it = await stage.make(Forgetful)
        call = stage.call(it, name)
        outcome = await call.wait()
        assert outcome.reason == Structure("operation_error", (f"{name}/0",))
        assert (
            f"self.{method}(...) has no effect without await; write `await self.{method}(...)`"
            in outcome.message
        )
        assert "test_env_unawaited.py:" in outcome.message
        assert stage.property(it, "count") == ((1,) if name == "waiting" else (0,))

    play(scene)


def test_another_failure_of_the_operation_has_precedence(play):
    async def scene(stage):
        it = await stage.make(Forgetful)
        assert (await stage.call(it, "failing").wait()).reason == "no"

    play(scene)


def test_an_operation_that_awaits_all_step_boundaries_succeeds(play):
    async def scene(stage):
        it = await stage.make(Forgetful)
        call = stage.call(it, "thrice")
        await stage.clock.sleep(1.5)
        assert len(call.execution.asked_for) == 2
        assert (await call.wait()).ok
        assert stage.property(it, "count") == (5,)
        assert stage.elapsed == 3

    play(scene)


def test_a_process_with_a_missing_await_is_reported(play):
    async def scene(stage):
        await stage.call(await stage.make(Forgetful), "begin").wait()
        await stage.clock.sleep(1)

    assert play(scene).logged("self.sleep(...) has no effect without await")


def test_a_lost_return_value_is_reported_once(play):
    async def scene(stage):
        it = await stage.make(Forgetful)
        for name in ("answer", "answer", "late_answer"):
            assert (await stage.call(it, name).wait()).ok

    stage = play(scene)
    assert [line.partition(" is lost")[0] for line in stage.lines if "is lost" in line] == [
        "[it] the return value of Forgetful.answer",
        "[it] the return value of Forgetful.late_answer",
    ]
