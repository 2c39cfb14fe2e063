"""External sessions: other threads and tasks that take a turn in an artifact."""

import asyncio
import threading

import pytest

from jacaros.artifacts import Artifact, InvalidArtifact, OperationFailed, Structure, operation


class Sensor(Artifact):
    def init(self, keep):
        keep.append(self)
        self.define_property("level", 0)

    @operation
    async def hold(self, seconds: float):
        await self.clock.sleep(seconds)
        self.update_property("level", self.value("level") + 1)

    @operation
    async def nested(self):
        async with self.external_session():
            pass

    @operation(threaded=True)
    def nested_in_thread(self):
        with self.external_session():
            pass


async def sensor_of(stage):
    keep = []
    artifact_id = await stage.make(Sensor, keep)
    return artifact_id, keep[0]


def in_a_thread(work, *args):
    return asyncio.get_running_loop().run_in_executor(None, work, *args)


def test_a_thread_changes_properties_and_all_is_published_at_its_end(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)
        watcher = stage.watch(sensor)
        seen = []

        def work():
            with it.external_session():
                it.update_property("level", 1)
                it.signal("tick", it.caller or "no agent")
                it.update_property("level", 2)
                it.define_property("more", 1)
                seen.extend(watcher.notes)
                it.start("hold", 0)
            seen.append(watcher.notes[-1])

        await in_a_thread(work)
        assert seen[0] == "+level(0)", "nothing is seen of a session in progress"
        assert seen[1] == "~tick('no agent') -level(0) +level(2) +more(1)", (
            "it is published before the thread goes on"
        )
        await stage.clock.sleep(0)
        assert stage.property(sensor, "level") == (3,)

    play(scene)


def test_a_thread_waits_until_the_artifact_is_free(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)
        holding = stage.call(sensor, "hold", 5)
        ready = threading.Event()

        def work():
            ready.set()
            with it.external_session():
                it.update_property("level", it.value("level") * 10)

        thread = threading.Thread(target=work)
        thread.start()
        assert ready.wait(60.0)
        await holding.wait()
        await asyncio.get_running_loop().run_in_executor(None, thread.join)
        assert stage.property(sensor, "level") == (10,)

    play(scene)


def test_operations_wait_for_the_end_of_a_session(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)
        inside, go = threading.Event(), threading.Event()

        def work():
            with it.external_session():
                inside.set()
                assert go.wait(60.0)
                it.update_property("level", 7)

        working = in_a_thread(work)
        await in_a_thread(inside.wait, 60.0)
        call = stage.call(sensor, "hold", 0)
        assert call.outcome is None
        go.set()
        await working
        await call.wait()
        assert stage.property(sensor, "level") == (8,)

    play(scene)


def test_an_exception_rolls_back_the_session_and_propagates(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)
        watcher = stage.watch(sensor)

        def work():
            with it.external_session():
                it.update_property("level", 1)
                it.signal("never")
                raise ValueError("broken")

        with pytest.raises(ValueError, match="broken"):
            await in_a_thread(work)

        async def task():
            async with it.external_session():
                it.update_property("level", 1)
                raise KeyError

        with pytest.raises(KeyError):
            await task()
        assert watcher.notes == ["+level(0)"]
        assert (await stage.call(sensor, "hold", 0).wait()).ok

    assert play(scene).lines == [], "its author has the exception"


def test_a_task_of_the_loop_uses_async_with_and_may_end_steps(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)
        watcher = stage.watch(sensor)
        holding = stage.call(sensor, "hold", 5)
        await stage.clock.sleep(1)
        async with it.external_session():
            assert stage.elapsed == 5.0
            assert holding.ok
            it.update_property("level", 2)
            await it.sleep(1)
            it.update_property("level", 3)
        assert watcher.notes[2:] == ["-level(1) +level(2)", "-level(2) +level(3)"]

    play(scene)


def test_a_session_in_the_wrong_place_is_refused(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)
        wrong = r"`with` is for other threads; in a task, use `async with`"
        with pytest.raises(InvalidArtifact, match=wrong), it.external_session():
            pass
        for op in ("nested", "nested_in_thread"):
            call = stage.call(sensor, op)
            await call.wait()
            assert "this is within an operation already" in call.outcome.message

    play(scene)


def test_a_disposed_artifact_has_no_sessions(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)

        def work():
            with it.external_session():
                raise AssertionError

        async def task():
            async with it.external_session():
                raise AssertionError

        stage.call(sensor, "hold", 5)
        await stage.clock.sleep(1)
        waiting = asyncio.ensure_future(task())
        thread = in_a_thread(work)
        while len(stage.main.pending(sensor)) < 3:  # noqa: ASYNC110 - the thread arrives at any time
            await asyncio.sleep(0)
        stage.main.dispose_artifact(sensor)
        for failing in (waiting, thread):
            with pytest.raises(OperationFailed) as caught:
                await failing
            assert caught.value.reason == Structure("artifact_disposed", ("it",))
        for late in (task(), in_a_thread(work)):
            with pytest.raises(OperationFailed) as caught:
                await late
            assert caught.value.reason == Structure("artifact_not_available", ("it",))

    play(scene)


def test_a_session_continues_unobserved_when_its_artifact_is_disposed(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)
        watcher = stage.watch(sensor)
        async with it.external_session():
            stage.main.dispose_artifact(sensor)
            it.update_property("level", 1)
        assert watcher.notes == ["+level(0)", "-level(0)"]

    play(scene)


def test_a_task_that_is_cancelled_while_it_waits_leaves_the_queue(play):
    async def scene(stage):
        sensor, it = await sensor_of(stage)
        stage.call(sensor, "hold", 5)
        await stage.clock.sleep(1)

        async def task():
            async with it.external_session():
                raise AssertionError

        waiting = asyncio.ensure_future(task())
        await asyncio.sleep(0)
        waiting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await waiting
        assert (await stage.call(sensor, "hold", 0).wait()).ok

    play(scene)


def test_a_thread_does_not_wait_for_a_loop_that_has_ended(play):
    kept = []

    async def scene(stage):
        kept.append((await sensor_of(stage))[1])

    play(scene)
    failures = []

    def work():
        try:
            with kept[0].external_session():
                raise AssertionError
        except OperationFailed as failure:
            failures.append(failure.reason)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join(10.0)
    assert failures == [Structure("artifact_not_available", ("it",))]
