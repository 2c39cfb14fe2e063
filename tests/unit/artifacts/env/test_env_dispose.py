"""The end of an artifact: observers, pending operations, hooks, and closing the environment."""

import asyncio
from contextlib import suppress

import pytest

from jacaros.artifacts import (
    Artifact,
    OperationRequest,
    Session,
    Structure,
    UnknownArtifact,
    internal_operation,
    operation,
)
from played import played
from stage_lab import play


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

    @operation(name="startProcess")
    def start_process(self):
        self.start(self.process)

    @internal_operation
    async def process(self):
        try:
            await self.until(lambda: False)
        finally:
            self.events.append("process stopped")


def thing_of(stage):
    class Kept(Thing):
        def init(self):
            super().init()
            stage.thing = self

    return stage.make(Kept)


@played(play)
async def test_observers_lose_all_properties(stage):
    thing = await thing_of(stage)
    watcher = stage.watch(thing)
    stage.main.dispose_artifact(thing)
    assert watcher.notes == ["+level(0) +mode('idle')", "-level(0) -mode('idle')"]
    assert stage.thing.events == ["dispose", "last registered", "first registered"]


@played(play)
async def test_operations_running_or_waiting_fail_with_artifact_disposed(stage):
    thing = await thing_of(stage)
    stage.watch(thing)
    calls = [stage.call(thing, name) for name in ("run", "wait", "run", "hold")]
    await stage.clock.sleep(1.0)
    calls.append(stage.call(thing, "ping"))
    stage.story.clear()
    stage.main.dispose_artifact(thing)
    await stage.clock.sleep(1.0)
    assert stage.story[0] == ("main", "-level(0) -mode('idle')"), "observers first, as they knew it"
    assert [call.reason for call in calls] == [Structure("artifact_disposed", ("it",))] * 5
    assert "was disposed before run/0 ended" in calls[0].outcome.message
    assert stage.thing.events == [
        "run stopped",
        "run stopped",
        "dispose",
        "last registered",
        "first registered",
    ]


@played(play)
async def test_an_operation_that_has_its_first_turn_but_has_not_begun_fails_too(stage):
    thing = await thing_of(stage)
    call = stage.call(thing, "run")
    stage.main.dispose_artifact(thing)
    await call.wait()
    assert call.reason == Structure("artifact_disposed", ("it",))
    assert "run stopped" not in stage.thing.events


@played(play)
async def test_the_hook_waits_for_the_last_operation_to_end(stage):
    thing = await thing_of(stage)
    call = stage.call(thing, "run_long")
    await stage.clock.sleep(1.0)
    stage.main.dispose_artifact(thing)
    await stage.clock.sleep(0.5)
    assert (stage.thing.events, call.outcome) == ([], None)
    await stage.clock.sleep(1.0)
    assert stage.thing.events[:2] == ["run stopped late", "dispose"]
    assert call.ended_at == 2.0


@played(play)
async def test_an_operation_that_fails_while_it_is_stopped_fails_as_disposed(stage):
    thing = await thing_of(stage)
    call = stage.call(thing, "stubborn")
    await stage.clock.sleep(1.0)
    stage.main.dispose_artifact(thing)
    await call.wait()
    assert call.reason == Structure("artifact_disposed", ("it",))
    assert stage.logged("will not stop")


@played(play)
async def test_processes_are_stopped(stage):
    thing = await thing_of(stage)
    stage.call(thing, "startProcess")
    await stage.clock.sleep(1.0)
    stage.main.dispose_artifact(thing)
    await stage.clock.sleep(1.0)
    assert stage.thing.events[0] == "process stopped"
    assert stage.lines == []


@played(play)
async def test_new_operations_fail_with_artifact_not_available(stage):
    thing = await thing_of(stage)
    stage.main.dispose_artifact(thing)
    call = stage.call(thing, "ping")
    assert call.reason == Structure("artifact_not_available", ("it",))
    call.execution.cancel()
    call.execution.pause()
    call.execution.resume()


@played(play)
async def test_requests_to_a_disposed_artifact_are_refused(stage):
    thing = await thing_of(stage)
    stage.main.dispose_artifact(thing)
    for use in (
        lambda: stage.main.dispose_artifact(thing),
        lambda: stage.watch(thing),
        lambda: stage.main.lookup("it"),
        lambda: stage.main.properties(thing),
        lambda: stage.main.observers(thing),
        lambda: stage.main.interface(thing),
    ):
        with pytest.raises(UnknownArtifact) as caught:
            use()
        assert caught.value.reason == Structure("artifact_not_available", ("it",))


@played(play)
async def test_the_name_can_be_reused_and_the_old_id_does_not_mean_the_new_artifact(stage):
    old = await thing_of(stage)
    stage.main.dispose_artifact(old)
    new = await thing_of(stage)
    assert stage.main.lookup("it") is new
    assert stage.call(new, "ping").ok
    assert not stage.call(old, "ping").ok


@played(play)
async def test_an_artifact_may_dispose_itself_and_the_operation_still_succeeds(stage):
    thing = await thing_of(stage)
    watcher = stage.watch(thing)
    call = stage.call(thing, "disposeMe")
    assert call.ok
    assert stage.thing.events[:2] == ["still here", "dispose"]
    assert watcher.notes[1:] == ["-level(0) +level(5)", "-level(5) -mode('idle')"]


@played(play)
async def test_a_coroutine_may_dispose_its_artifact_and_continue_while_others_fail(stage):
    thing = await thing_of(stage)
    run, call = stage.call(thing, "run"), stage.call(thing, "disposeMeLater")
    await call.wait()
    assert call.ok
    assert (run.ended_at, call.ended_at) == (1.0, 2.0)
    assert stage.thing.events == [
        "run stopped",
        "still here",
        "dispose",
        "last registered",
        "first registered",
    ]


def test_an_error_in_a_hook_is_logged_and_the_other_hooks_run():
    class Bad(Thing):
        def dispose(self):
            raise RuntimeError("hook")

    async def scene(stage):
        kept = []

        class Kept(Bad):
            def init(self):
                super().init()
                kept.append(self)

        thing = await stage.make(Kept)
        stage.main.dispose_artifact(thing)
        assert stage.logged("RuntimeError: hook")
        assert kept[0].events == ["last registered", "first registered"]

    play(scene)


@played(play)
async def test_a_waiting_operation_that_fails_may_dispose_or_call_again(stage):
    thing = await thing_of(stage)
    second = []

    def again(outcome):
        second.append(stage.call(thing, "ping"))

    stage.main.execute(OperationRequest(thing, "wait", (), "main", None, again))
    stage.main.dispose_artifact(thing)
    assert second[0].reason == Structure("artifact_not_available", ("it",))


def test_closing_the_environment_ends_everything_and_waits_for_it():
    kept = []

    class Kept(Thing):
        def init(self):
            super().init()
            kept.append(self)

    async def scene(stage):
        first = await stage.make(Kept)
        lab = stage.environment.create_workspace("/main/lab")
        second = await lab.make_artifact("it", Kept)
        for artifact in (first, second):
            stage.call(artifact, "run_long")
            stage.call(artifact, "startProcess")
        await stage.clock.sleep(1.0)
        await stage.environment.close()
        assert stage.main.artifacts() == ()
        assert stage.elapsed == 3.0, "one workspace after the other, one second each"
        for thing in kept:
            assert thing.events == [
                "process stopped",
                "run stopped late",
                "dispose",
                "last registered",
                "first registered",
            ]

    play(scene)


@played(play)
async def test_closing_waits_for_artifacts_that_are_ending_already(stage):
    thing = await thing_of(stage)
    stage.call(thing, "run_long")
    await stage.clock.sleep(1.0)
    stage.main.dispose_artifact(thing)
    other = await stage.make(Thing, name="other")
    stage.call(other, "ping")
    await stage.clock.sleep(0.5)
    await asyncio.gather(stage.environment.close(), stage.environment.close())
    assert stage.elapsed == 2.0
    assert "dispose" in stage.thing.events


@played(play)
async def test_cancelling_one_wait_for_the_end_does_not_affect_others(stage):
    thing = await thing_of(stage)
    stage.call(thing, "run_long")
    await stage.clock.sleep(1.0)
    first, second = (asyncio.ensure_future(stage.environment.close()) for _ in range(2))
    await stage.clock.sleep(0.5)
    first.cancel()
    await second
    assert stage.elapsed == 2.0


def test_processes_started_after_the_end_do_not_begin():
    class Late(Thing):
        @operation
        def end(self):
            self.workspace.dispose_artifact(self.id)
            self.start(self.process)

    async def scene(stage):
        late = await stage.make(Late)
        assert stage.call(late, "end").ok
        await stage.clock.sleep(1.0)
        assert stage.main.artifacts()[-1].name == "workspace"

    play(scene)


def test_closing_ends_the_artifacts_made_last_first():
    order = []

    class Ordered(Artifact):
        def dispose(self):
            order.append(self.name)

    async def scene(stage):
        for name in ("a", "b", "c"):
            await stage.make(Ordered, name=name)

    play(scene)
    assert order == ["c", "b", "a"]


@played(play)
async def test_an_artifact_can_be_disposed_through_any_workspace(stage):
    lab = stage.environment.create_workspace("/main/lab")
    thing = await lab.make_artifact("it", Thing)
    stage.main.dispose_artifact(thing)
    with pytest.raises(UnknownArtifact):
        lab.lookup("it")


def test_an_operation_that_ignores_cancellation_is_abandoned():
    class Stubborn(Artifact):
        @operation
        async def go_on(self):
            while self.clock.now() < self.clock.start + 1000:
                with suppress(asyncio.CancelledError):
                    await self.sleep(1.0)

        def dispose(self):
            self.log("given back")

    async def scene(stage):
        call = stage.call(await stage.make(Stubborn), "go_on")
        await stage.clock.sleep(1.0)
        await stage.environment.close()
        assert stage.elapsed == 21.0
        assert call.reason == Structure("artifact_disposed", ("it",))
        assert stage.lines == [
            "[it] operation go_on/0 did not stop within 20 s of its artifact's disposal; abandoning it",
            "[it] given back",
        ]
        await stage.environment.close()
        await stage.clock.sleep(2000)

    play(scene)


def test_a_paused_operation_fails_too():
    class Resting(Artifact):
        @operation(pausable=True)
        async def rest(self):
            while True:
                await self.sleep(1.0)
                await self.pause_point()

    async def scene(stage):
        it = await stage.make(Resting)
        call = stage.call(it, "rest")
        call.execution.pause()
        await stage.clock.sleep(5.0)
        call.execution.pause()
        await stage.clock.sleep(5.0)
        stage.main.dispose_artifact(it)
        await call.wait()
        assert (stage.elapsed, call.reason) == (10.0, Structure("artifact_disposed", ("it",)))

    play(scene)


class Farewell(Artifact):
    """Says something, and is gone."""

    @operation
    def leave(self):
        self.define_property("last", 1)
        self.workspace.dispose_artifact(self.id)


@played(play)
async def test_what_changed_before_an_artifact_disposes_itself_is_seen_by_sessions(stage):
    it = await stage.make(Farewell)
    seen = []
    with Session(stage.environment, "s") as session:
        session.focus(it)
        session.on_change(lambda change: seen.append((change.before, change.now)))
        await session.act("leave")
        assert seen == [(None, (1,)), ((1,), None)]
        assert session.focused == ()


class Lonely(Artifact):
    @operation
    async def leave(self):
        self.workspace.dispose_artifact(self.id)
        await self.sleep(1)
        await self.until(lambda: False)


@played(play)
async def test_an_operation_that_disposed_its_own_artifact_does_not_wait_for_others(stage):
    outcome = await stage.call(await stage.make(Lonely), "leave").wait()
    assert outcome.reason == Structure("artifact_disposed", ("it",))
    assert stage.elapsed == 1
