"""Blocking operations run in a worker thread. Their changes are published when they end."""

import asyncio
import threading

import pytest

from jacaros.artifacts import Artifact, InvalidArtifact, Out, Structure, operation
from jacaros.artifacts.kernel import registry


class Blocking(Artifact):
    def init(self):
        self.define_property("count", 0)
        self.gate = threading.Event()
        self.inside = threading.Event()
        self.threads = []

    @operation(threaded=True)
    def work(self, result: Out):
        self.threads.append(threading.current_thread())
        self.update_property("count", self.value("count") + 1)
        self.signal("half", 1)
        self.signal_to("bob", "psst")
        self.commit()
        self.inside.set()
        assert self.gate.wait(60.0)
        self.update_property("count", self.value("count") + 1)
        self.define_property("done", True)
        self.start("inc")
        result.set([self.caller, 42])

    @operation(threaded=True)
    def fail_late(self):
        self.update_property("count", 99)
        self.signal("never")
        self.fail("no", "no", 1)

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 10)


def blocking_of(stage):
    class Kept(Blocking):
        def init(self):
            super().init()
            stage.it = self

    return stage.make(Kept)


async def until_inside(stage):
    """Wait until the worker thread reaches its gate. Virtual time does not advance meanwhile."""
    await asyncio.get_running_loop().run_in_executor(None, stage.it.inside.wait, 60.0)


def test_it_runs_in_another_thread_and_publishes_once_when_it_ends(play):
    async def scene(stage):
        blocking = await blocking_of(stage)
        alice, bob = stage.watch(blocking, "alice"), stage.watch(blocking, "bob")
        result = Out()
        call = stage.call(blocking, "work", result)
        await until_inside(stage)
        assert alice.notes == ["+count(0)"], "nothing is seen of a step in progress"
        late = stage.watch(blocking, "late")
        assert late.notes == ["+count(0)"]
        assert stage.property(blocking, "count") == (0,)
        waiting = stage.call(blocking, "inc")
        assert waiting.outcome is None
        stage.it.gate.set()
        await waiting.wait()
        await call.wait()
        assert result.value == ["main", 42]
        assert stage.it.threads[0] is not threading.current_thread()
        assert alice.notes[1:] == [
            "~half(1) -count(0) +count(2) +done(True)",
            "-count(2) +count(12)",
            "-count(12) +count(22)",
        ]
        assert bob.notes[1:3] == ["~half(1) -count(0) +count(2) +done(True)", "~psst"]
        assert late.notes[1:] == alice.notes[1:]
        assert stage.elapsed == 0.0, "virtual time stood still"

    play(scene)


def test_a_failure_in_a_thread_is_rolled_back(play):
    async def scene(stage):
        blocking = await blocking_of(stage)
        watcher = stage.watch(blocking)
        call = stage.call(blocking, "fail_late")
        await call.wait()
        assert call.reason == Structure("no", (1,))
        assert watcher.notes == ["+count(0)"]
        assert stage.call(blocking, "inc").ok

    play(scene)


def test_a_thread_cannot_be_cancelled_and_runs_to_its_end_without_an_outcome(play):
    async def scene(stage):
        blocking = await blocking_of(stage)
        call = stage.call(blocking, "work", Out())
        await until_inside(stage)
        call.execution.cancel()
        waiting = stage.call(blocking, "inc")
        stage.it.gate.set()
        await waiting.wait()
        assert call.outcome is None
        assert stage.property(blocking, "done") == (True,)

    play(scene)


def test_disposal_reports_to_the_caller_immediately_and_waits_for_the_thread(play):
    async def scene(stage):
        blocking = await blocking_of(stage)
        watcher = stage.watch(blocking)
        call = stage.call(blocking, "work", Out())
        await until_inside(stage)
        stage.main.dispose_artifact(blocking)
        assert watcher.notes == ["+count(0)", "-count(0)"]
        assert call.reason == Structure("artifact_disposed", ("it",)), (
            "a thread cannot be ended, so there is no wait"
        )
        assert not call.execution.ended
        stage.it.gate.set()
        await stage.environment.close()
        assert call.execution.ended

    play(scene)


def test_a_thread_that_is_not_that_of_the_operation_changes_nothing(play):
    class Odd(Blocking):
        @operation(threaded=True)
        def meddle(self):
            errors = []

            def other():
                try:
                    self.update_property("count", 5)
                except InvalidArtifact as error:
                    errors.append(str(error))

            thread = threading.Thread(target=other)
            thread.start()
            thread.join()
            self.fail(errors[0])

    async def scene(stage):
        odd = await stage.make(Odd)
        call = stage.call(odd, "meddle")
        await call.wait()
        assert "self.external_session()" in call.outcome.message
        assert stage.property(odd, "count") == (0,)

    play(scene)


@pytest.mark.parametrize("raised", [StopIteration, SystemExit, KeyboardInterrupt, GeneratorExit])
def test_whatever_a_thread_raises_fails_its_operation(play, raised):
    class Odd(Blocking):
        @operation(threaded=True)
        def burst(self):
            self.update_property("count", 99)
            raise raised("why")

    async def scene(stage):
        odd = await stage.make(Odd)
        call = stage.call(odd, "burst")
        await call.wait()
        assert call.reason == Structure("operation_error", ("burst/0",))
        assert call.outcome.message == f"{raised.__name__} in operation burst/0 of it: why"
        assert stage.property(odd, "count") == (0,)

    play(scene)


def test_a_thread_that_returns_a_coroutine_fails_with_a_message(play):
    class Odd(Artifact):
        @operation(threaded=True)
        def odd(self):
            async def later(): ...

            return later()

    async def scene(stage):
        call = stage.call(await stage.make(Odd), "odd")
        await call.wait()
        assert "returned a coroutine, which a thread cannot run" in call.outcome.message

    play(scene)


def test_any_thread_may_start_a_process(play):
    async def scene(stage):
        blocking = await blocking_of(stage)
        await asyncio.get_running_loop().run_in_executor(None, stage.it.start, "inc")
        await stage.clock.sleep(0)
        assert stage.property(blocking, "count") == (10,)

    play(scene)


def test_a_callback_may_start_a_process_while_a_thread_has_the_artifact(play):
    async def scene(stage):
        blocking = await blocking_of(stage)
        call = stage.call(blocking, "work", Out())
        await until_inside(stage)
        stage.it.start("inc")
        stage.it.gate.set()
        await call.wait()
        assert stage.property(blocking, "count") == (22,)

    play(scene)


def test_a_thread_that_does_not_return_is_abandoned_when_the_environment_is_closed(play, monkeypatch):
    monkeypatch.setattr(registry, "THREADS", 0.01)

    async def scene(stage):
        calls = [stage.call(await blocking_of(stage), "work", Out())]
        await until_inside(stage)
        gate = stage.it.gate
        await stage.environment.close()
        assert calls[0].reason == Structure("artifact_disposed", ("it",))
        assert stage.lines == [
            "[it] operation work/1 did not stop within 0.01 s of its artifact's disposal; abandoning it"
        ]
        gate.set()

    play(scene)
