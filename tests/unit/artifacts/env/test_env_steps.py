"""Operations of several steps: interleaving, atomicity, publication, roll-back of the failing step."""

import asyncio

import pytest

from jacaros.artifacts import Artifact, InvalidArtifact, Out, Structure, operation
from stage_lab import play


class Lane(Artifact):
    def init(self):
        self.define_property("trace", [])
        self.open = False

    def _append(self, text):
        self.update_property("trace", [*self.value("trace"), text])

    @operation
    async def run(self, name: str, steps: int, pause: float):
        for number in range(1, steps + 1):
            self._append(f"{name}{number}")
            await self.sleep(pause)

    @operation
    def mark(self, name: str):
        self._append(name)

    @operation
    async def hold(self, name: str, pause: float):
        self._append(f"{name} begins")
        await self.clock.sleep(pause)
        self._append(f"{name} ends")

    @operation(name="openGate")
    def open_gate(self):
        self.open = True

    @operation
    async def wait(self, name: str):
        await self.until(lambda: self.open)
        self._append(name)

    @operation
    async def wait_wrong(self):
        await self.until(lambda: 1 / 0 and True)

    @operation
    async def wait_wrong_later(self):
        await self.until(lambda: bool(self.open and 1 / 0))

    @operation
    async def result(self, given: Out):
        given.set(await self.step(self._answer()))

    async def _answer(self):
        await self.clock.sleep(1.0)
        return 42

    @operation
    async def awaiting_fails(self):
        self._append("before")
        try:
            await self.step(self._explode())
        except OSError:
            self._append("caught")

    async def _explode(self):
        await self.clock.sleep(1.0)
        raise OSError("gone")

    @operation
    def sleep_in_a_plain_operation(self):
        self.sleep(1.0).send(None)

    @operation
    async def await_a_cancelled_future(self):
        future = asyncio.get_running_loop().create_future()
        future.cancel()
        await self.step(future)


pytestmark = pytest.mark.makes(it=Lane)


def trace(stage, lane):
    return stage.property(lane, "trace")[0]


async def test_awaiting_without_a_step_boundary_blocks_the_artifact(stage, it, watcher):
    hold = stage.call(it, "hold", "a", 1.0)
    await stage.clock.sleep(0.5)
    mark = stage.call(it, "mark", "x")
    assert mark.outcome is None
    assert watcher.take() == [], "nothing of the step is published"
    await mark.wait()
    assert (hold.ended_at, mark.ended_at) == (1.0, 1.0)
    assert trace(stage, it) == ["a begins", "a ends", "x"]
    assert len(watcher.take()) == 2


async def test_an_operation_that_resumes_queues_behind_waiting_ones(stage, it):
    run = stage.call(it, "run", "r", 2, 1.0)
    await stage.clock.sleep(0.9)
    stage.call(it, "hold", "h", 1.0)
    stage.call(it, "mark", "x")
    await run.wait()
    assert trace(stage, it) == ["r1", "h begins", "h ends", "x", "r2"]


async def test_until_continues_when_a_step_of_another_operation_makes_it_true(stage, it):
    first, second = stage.call(it, "wait", "1"), stage.call(it, "wait", "2")
    await stage.clock.sleep(1.0)
    stage.call(it, "mark", "x")
    assert first.outcome is None
    stage.call(it, "openGate")
    await second.wait()
    assert trace(stage, it) == ["x", "1", "2"]
    third = await stage.ended(it, "wait", "3")
    assert third.ended_at == 1.0, "a condition that is true at once does not delay"


async def test_an_error_in_a_condition_fails_the_operation(stage, it):
    now, later = stage.call(it, "wait_wrong"), stage.call(it, "wait_wrong_later")
    await now.wait()
    assert now.reason == Structure("operation_error", ("wait_wrong/0",))
    stage.call(it, "openGate")
    await later.wait()
    assert later.reason == Structure("operation_error", ("wait_wrong_later/0",))
    assert stage.call(it, "mark", "x").ok


async def test_anything_can_be_awaited_in_a_step_of_its_own(stage, it):
    given = Out()
    result = stage.call(it, "result", given)
    await stage.clock.sleep(0.5)
    assert stage.call(it, "mark", "meanwhile").ok
    await result.wait()
    assert given.value == 42


async def test_an_error_in_an_awaitable_is_raised_in_the_operation_on_its_turn(stage, it):
    call = await stage.ended(it, "awaiting_fails")
    assert call.ok
    assert trace(stage, it) == ["before", "caught"]


async def test_an_agent_that_focuses_in_mid_step_sees_what_is_committed(stage, it):
    stage.call(it, "hold", "a", 1.0)
    await stage.clock.sleep(0.5)
    watcher = stage.watch(it)
    assert watcher.notes == ["+trace([])"]
    await stage.clock.sleep(1.0)
    assert watcher.notes[-1] == "-trace([]) +trace(['a begins', 'a ends'])"


async def test_only_a_coroutine_may_end_its_step_in_the_middle(stage, it):
    call = stage.call(it, "sleep_in_a_plain_operation")
    assert call.reason == Structure("operation_error", ("sleep_in_a_plain_operation/0",))
    assert "async def" in call.outcome.message


async def test_callbacks_cannot_pretend_to_be_the_operation_that_has_the_turn(stage, it, made):
    stage.call(it, "hold", "a", 1.0)
    await stage.clock.sleep(0.5)
    with pytest.raises(InvalidArtifact, match=r"self\.start"):
        made.update_property("trace", 1)
    with pytest.raises(InvalidArtifact, match=r"self\.start"):
        await made.sleep(1.0)
    with pytest.raises(InvalidArtifact, match=r"self\.start"):
        await made.step(asyncio.get_running_loop().create_future())


async def test_a_cancelled_future_that_is_awaited_is_an_error_of_the_operation_only(stage, it):
    call = await stage.ended(it, "await_a_cancelled_future")
    assert call.reason == Structure("operation_error", ("await_a_cancelled_future/0",))


def test_many_operations_on_many_artifacts_run_in_the_same_order_each_time():
    traces = []

    async def scene(stage):
        lanes = [await stage.make(Lane, name=f"lane{i}") for i in range(5)]
        for number in range(20):
            for index, lane in enumerate(lanes):
                stage.call(lane, "run", f"{index}.{number}.", 3, 0.01 * (number % 7 + 1))
        await stage.clock.sleep(10.0)
        traces.append([trace(stage, lane) for lane in lanes])

    play(scene)
    play(scene)
    assert traces[0] == traces[1]
