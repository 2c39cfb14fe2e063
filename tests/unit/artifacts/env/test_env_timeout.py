"""Operations with a time limit: after it they are cancelled, and fail with ``operation_timeout``."""

import pytest

from jacaros.artifacts import Artifact, Structure, link, operation


class Slow(Artifact):
    ports = ("out",)

    def init(self):
        self.define_property("state", "idle")

    @operation
    async def work(self, seconds: float):
        self.update_property("state", "working")
        try:
            await self.sleep(seconds)
            self.update_property("state", "done")
        finally:
            if self.current.stopped:
                self.update_property("state", "stopped")

    @operation
    async def hold(self, seconds: float):
        await self.clock.sleep(seconds)

    @operation
    def quick(self):
        self.update_property("state", "quick")

    @operation(guard="never")
    def guarded(self): ...

    def never(self):
        return False

    @operation
    async def through(self, seconds: float):
        await self.call_linked("out", "slowly", seconds)

    @link
    async def slowly(self, seconds: float):
        try:
            await self.sleep(seconds)
        finally:
            self.update_property("state", "linked stopped")

    @operation(pausable=True)
    async def pausable(self):
        while True:
            await self.sleep(0.1)
            await self.pause_point()


pytestmark = pytest.mark.makes(it=Slow)


async def test_an_operation_that_ends_in_time_succeeds(stage, it):
    assert stage.call(it, "quick", timeout=1.0).ok
    assert (await stage.call(it, "work", 0.9, timeout=1.0).wait()).ok
    assert stage.clock.pending() == [], "no timer is left behind"


async def test_one_that_takes_longer_is_stopped_and_its_finally_runs(stage, it, watcher):
    call = await stage.ended(it, "work", 60, timeout=0.5)
    assert stage.elapsed == 0.5
    assert call.reason == Structure("operation_timeout", ("work/1", 500.0))
    assert call.outcome.message == "operation work/1 of artifact it did not end within 500 ms"
    assert watcher.notes == ["-state('idle') +state('working')", "-state('working') +state('stopped')"]
    assert call.execution.ended
    assert stage.clock.pending() == []


@pytest.mark.parametrize("op", ["guarded", "quick", "pausable"])
async def test_waiting_for_a_guard_the_artifact_or_the_end_of_a_pause_counts(stage, it, op):
    if op == "quick":
        stage.call(it, "hold", 10)
        await stage.clock.sleep(0)
    call = stage.call(it, op, timeout=2)
    if op == "pausable":
        call.execution.pause()
    await call.wait()
    assert (stage.elapsed, call.reason) == (2.0, Structure("operation_timeout", (f"{op}/0", 2000)))
    assert call.outcome.message.endswith("did not end within 2 s")


async def test_a_linked_call_is_stopped_with_its_caller(stage):
    it, target = await stage.make(Slow), await stage.make(Slow, name="target")
    stage.main.link(it, "out", target)
    call = await stage.ended(it, "through", 10, timeout=1)
    assert call.reason == Structure("operation_timeout", ("through/1", 1000))
    assert stage.property(target, "state") == ("linked stopped",)


async def test_cancelled_and_disposed_before_the_time_limit(stage, it):
    dropped, waiting = stage.call(it, "work", 60, timeout=5), stage.call(it, "guarded", timeout=5)
    gone = stage.call(it, "work", 60, timeout=5)
    await stage.after(1, dropped.execution.cancel)
    waiting.execution.cancel()
    await stage.after(1, stage.main.dispose_artifact, it)
    await gone.wait()
    assert gone.reason == Structure("artifact_disposed", ("it",))
    assert (dropped.outcome, waiting.outcome) == (None, None)
    assert stage.clock.pending() == []
