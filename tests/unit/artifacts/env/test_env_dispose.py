"""The end of an artifact: observers, pending operations, hooks, and closing the environment."""

import asyncio
from contextlib import suppress

import pytest

from jacaros.artifacts import (
    Artifact,
    OperationRequest,
    Structure,
    UnknownArtifact,
    internal_operation,
    operation,
)


class Thing(Artifact):
    def init(self):
        self.define_property("level", 0)
        self.define_property("mode", "idle")
        self.events = []
        self.on_dispose(lambda: self.events.append("first registered"))
        self.on_dispose(lambda: self.events.append("last registered"))

    def dispose(self):
        self.events.append("dispose")

    @operation
    def ping(self):
        pass

    @operation(guard="never")
    def wait(self):
        pass

    def never(self):
        return False

    @operation
    async def run(self):
        try:
            await self.sleep(100.0)
        finally:
            self.events.append("run stopped")

    @operation
    async def run_long(self):
        try:
            await self.sleep(100.0)
        finally:
            await self.sleep(1.0)
            self.update_property("level", 3)
            self.events.append("run stopped late")

    @operation
    async def hold(self):
        self.update_property("level", 7)
        await self.clock.sleep(100.0)

    @operation
    async def stubborn(self):
        try:
            await self.sleep(100.0)
        finally:
            self.fail("will not stop")

    @operation(name="disposeMe")
    def dispose_me(self):
        self.update_property("level", 5)
        self.workspace.dispose_artifact(self.id)
        self.update_property("level", 6)
        self.events.append("still here")

    @operation(name="disposeMeLater")
    async def dispose_me_later(self):
        await self.sleep(1.0)
        self.workspace.dispose_artifact(self.id)
        await self.sleep(1.0)
        self.events.append("still here")

    @operation
    def leave(self):
        self.define_property("last", 1)
        self.workspace.dispose_artifact(self.id)
        self.start(self.process)

    @operation
    async def leave_slowly(self):
        self.workspace.dispose_artifact(self.id)
        await self.sleep(1)
        await self.until(lambda: False)

    @operation(pausable=True)
    async def rest(self):
        while True:
            await self.sleep(1.0)
            await self.pause_point()

    @operation
    async def ignore_the_end(self):
        while self.clock.now() < self.clock.start + 1000:
            with suppress(asyncio.CancelledError):
                await self.sleep(1.0)

    @operation(name="startProcess")
    def start_process(self):
        self.start(self.process)

    @internal_operation
    async def process(self):
        try:
            await self.until(lambda: False)
        finally:
            self.events.append("process stopped")


pytestmark = pytest.mark.makes(it=Thing)
HOOKS = ["dispose", "last registered", "first registered"]
DISPOSED = Structure("artifact_disposed", ("it",))
GONE = Structure("artifact_not_available", ("it",))


async def test_operations_running_or_waiting_fail_with_artifact_disposed(stage, it, made):
    stage.watch(it)
    calls = [stage.call(it, name) for name in ("run", "wait", "run", "hold")]
    await stage.clock.sleep(1.0)
    calls.append(stage.call(it, "ping"))
    stage.story.clear()
    stage.main.dispose_artifact(it)
    await stage.clock.sleep(1.0)
    assert stage.story[0] == ("main", "-level(0) -mode('idle')"), "observers first, as they knew it"
    assert [call.reason for call in calls] == [DISPOSED] * 5
    assert "was disposed before run/0 ended" in calls[0].outcome.message
    assert made.events == ["run stopped", "run stopped", *HOOKS]


async def test_an_operation_that_has_its_first_turn_but_has_not_begun_fails_too(stage, it, made):
    call = stage.call(it, "run")
    stage.main.dispose_artifact(it)
    await call.wait()
    assert call.reason == DISPOSED
    assert "run stopped" not in made.events


async def test_processes_are_stopped_and_the_hook_waits_for_the_last_operation_to_end(stage, it, made):
    call = stage.call(it, "run_long")
    stage.call(it, "startProcess")
    await stage.after(1.0, stage.main.dispose_artifact, it)
    await stage.clock.sleep(0.5)
    assert (made.events, call.outcome) == (["process stopped"], None)
    await stage.clock.sleep(1.0)
    assert made.events == ["process stopped", "run stopped late", *HOOKS]
    assert call.ended_at == 2.0
    assert stage.lines == []


async def test_an_operation_that_fails_while_it_is_stopped_fails_as_disposed(stage, it):
    call = stage.call(it, "stubborn")
    await stage.after(1.0, stage.main.dispose_artifact, it)
    await call.wait()
    assert call.reason == DISPOSED
    assert stage.logged("will not stop")


async def test_a_disposed_artifact_is_not_available_and_its_name_can_be_reused(stage, it):
    stage.main.dispose_artifact(it)
    call = stage.call(it, "ping")
    assert call.reason == GONE
    call.execution.cancel()
    call.execution.pause()
    call.execution.resume()
    for use in (
        lambda: stage.main.dispose_artifact(it),
        lambda: stage.watch(it),
        lambda: stage.main.lookup("it"),
        lambda: stage.main.properties(it),
        lambda: stage.main.observers(it),
        lambda: stage.main.interface(it),
    ):
        with pytest.raises(UnknownArtifact) as caught:
            use()
        assert caught.value.reason == GONE
    new = await stage.make(Thing)
    assert stage.main.lookup("it") is new
    assert stage.call(new, "ping").ok
    assert not stage.call(it, "ping").ok, "the old id does not mean the new artifact"


async def test_an_artifact_may_dispose_itself_and_the_operation_still_succeeds(stage, it, watcher, made):
    call = stage.call(it, "disposeMe")
    assert call.ok
    assert made.events[:2] == ["still here", "dispose"]
    assert watcher.notes == ["-level(0) +level(5)", "-level(5) -mode('idle')"]


async def test_a_coroutine_may_dispose_its_artifact_and_continue_while_others_fail(stage, it, made):
    run, call = stage.call(it, "run"), await stage.ended(it, "disposeMeLater")
    assert call.ok
    assert (run.ended_at, call.ended_at) == (1.0, 2.0)
    assert made.events == ["run stopped", "still here", *HOOKS]


async def test_an_error_in_a_hook_is_logged_and_the_other_hooks_run(stage):
    class Bad(Thing):
        def dispose(self):
            raise RuntimeError("hook")

    bad = await stage.make(Bad)
    kept = stage.environment.artifact(bad)
    stage.main.dispose_artifact(bad)
    assert stage.logged("RuntimeError: hook")
    assert kept.events == HOOKS[1:]


async def test_a_waiting_operation_that_fails_may_dispose_or_call_again(stage, it):
    second = []

    def again(outcome):
        second.append(stage.call(it, "ping"))

    stage.main.execute(OperationRequest(it, "wait", (), "main", None, again))
    stage.main.dispose_artifact(it)
    assert second[0].reason == GONE


async def test_an_artifact_is_disposed_through_any_workspace_and_closing_the_environment_waits_for_all(
    stage, it
):
    lab = stage.environment.create_workspace("/main/lab")
    second, third = await lab.make_artifact("it", Thing), await lab.make_artifact("third", Thing)
    kept = [stage.environment.artifact(artifact) for artifact in (it, second)]
    stage.main.dispose_artifact(third)
    with pytest.raises(UnknownArtifact):
        lab.lookup("third")
    for artifact in (it, second):
        stage.call(artifact, "run_long")
        stage.call(artifact, "startProcess")
    await stage.clock.sleep(1.0)
    await stage.environment.close()
    assert stage.main.artifacts() == ()
    assert stage.elapsed == 3.0, "one workspace after the other, one second each"
    for thing in kept:
        assert thing.events == ["process stopped", "run stopped late", *HOOKS]


async def test_closing_waits_for_artifacts_that_are_ending_already(stage, it, made):
    stage.call(it, "run_long")
    await stage.after(1.0, stage.main.dispose_artifact, it)
    other = await stage.make(Thing, name="other")
    stage.call(other, "ping")
    await stage.clock.sleep(0.5)
    await asyncio.gather(stage.environment.close(), stage.environment.close())
    assert stage.elapsed == 2.0
    assert "dispose" in made.events


async def test_cancelling_one_wait_for_the_end_does_not_affect_others(stage, it):
    stage.call(it, "run_long")
    await stage.clock.sleep(1.0)
    first, second = (asyncio.ensure_future(stage.environment.close()) for _ in range(2))
    await stage.after(0.5, first.cancel)
    await second
    assert stage.elapsed == 2.0


async def test_processes_started_after_the_end_do_not_begin(stage, it, made):
    assert stage.call(it, "leave").ok
    await stage.clock.sleep(1.0)
    assert stage.main.artifacts()[-1].name == "workspace"
    assert made.events == HOOKS


async def test_closing_ends_the_artifacts_made_last_first(stage):
    class Ordered(Artifact):
        def dispose(self):
            self.log("disposed")

    for name in ("a", "b", "c"):
        await stage.make(Ordered, name=name)
    await stage.environment.close()
    assert stage.lines == ["[c] disposed", "[b] disposed", "[a] disposed"]


async def test_an_operation_that_ignores_cancellation_is_abandoned(stage, it, made):
    call = stage.call(it, "ignore_the_end")
    await stage.clock.sleep(1.0)
    await stage.environment.close()
    assert stage.elapsed == 21.0
    assert call.reason == DISPOSED
    assert stage.lines == [
        "[it] operation ignore_the_end/0 did not stop within 20 s of its artifact's disposal; abandoning it"
    ]
    assert made.events == HOOKS
    await stage.environment.close()
    await stage.clock.sleep(2000)


async def test_a_paused_operation_fails_too(stage, it):
    call = stage.call(it, "rest")
    call.execution.pause()
    await stage.after(5.0, call.execution.pause)
    await stage.after(5.0, stage.main.dispose_artifact, it)
    await call.wait()
    assert (stage.elapsed, call.reason) == (10.0, DISPOSED)


async def test_what_changed_before_an_artifact_disposes_itself_is_seen_by_sessions(stage, session, it):
    seen = []
    session.focus(it)
    session.on_change(lambda change: seen.append((change.name, change.before, change.now)))
    await session.act("leave")
    assert seen == [
        ("last", None, (1,)),
        ("level", (0,), None),
        ("mode", ("idle",), None),
        ("last", (1,), None),
    ]
    assert session.focused == ()


async def test_an_operation_that_disposed_its_own_artifact_does_not_wait_for_others(stage, it):
    call = await stage.ended(it, "leave_slowly")
    assert (call.reason, stage.elapsed) == (DISPOSED, 1)
