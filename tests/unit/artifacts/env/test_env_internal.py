"""Internal processes of an artifact, started by its operations, by ``init`` and by callbacks."""

import pytest

from jacaros.artifacts import Artifact, InvalidArtifact, OperationFailed, internal_operation, operation
from jacaros.runtime.trace import Cause


class Clock(Artifact):
    def init(self, pause: float = 0.1):
        self.define_property("running", "no")
        self.define_property("ticks", 0)
        self._pause = pause

    @operation(name="startBroken")
    def start_broken(self):
        self.start("work", 3)
        self.fail("changed my mind")

    @internal_operation
    async def work(self, most: int):
        tick = 1
        while self.value("running") == "yes" and tick <= most:
            await self.sleep(self._pause)
            if self.value("running") == "yes":
                self.signal("tick", tick)
            tick += 1
        self.update_property("running", "no")

    @internal_operation
    def count(self, by: int = 1):
        self.update_property("ticks", self.value("ticks") + by)

    @operation
    def twice(self):
        self.start(self.count, 10)
        self.start("count", 100)
        self.update_property("ticks", self.value("ticks") + 1)

    @internal_operation
    def breaks(self):
        self.update_property("ticks", -1)
        raise ValueError("inside")

    @internal_operation
    async def refuses(self):
        self.update_property("ticks", 5)
        await self.sleep(1.0)
        self.update_property("ticks", -1)
        raise OperationFailed("no way")

    @operation(name="startAll")
    def start_all(self):
        self.start(self.breaks)
        self.start(self.refuses)
        self.start(self.count, 3)

    @operation
    def wrong(self):
        self.start("no_such")

    @operation(name="wrongMethod")
    def wrong_method(self):
        self.start(self.has_ticks)

    @operation
    async def early(self):
        self.start(self.count)
        self.signal("started")
        self.fail("after the commit")

    @internal_operation(guard="has_ticks")
    def guarded(self):
        self.signal("guarded")

    def has_ticks(self):
        return self.value("ticks") > 0

    def on_sample(self, sample):
        self.start(self.receive, sample)

    @internal_operation
    def receive(self, sample: int):
        self.update_property("ticks", sample)

    @operation
    async def hold(self):
        await self.clock.sleep(1.0)

    @operation
    def note(self):
        self.update_property("ticks", self.value("ticks") + 1)

    @operation
    def note_later(self):
        self.start(self.note)
        self.start("note")

    @operation(name="startGuarded")
    def start_guarded(self):
        self.start(self.guarded)


pytestmark = pytest.mark.makes(it=Clock)


async def test_a_process_is_not_started_by_a_step_that_fails(stage, it, watcher):
    assert not stage.call(it, "startBroken").ok
    await stage.clock.sleep(1.0)
    assert watcher.take() == []


async def test_a_process_started_before_a_commit_is_started_even_if_the_step_fails_later(stage, it):
    call = await stage.ended(it, "early")
    assert not call.ok
    assert stage.property(it, "ticks") == (1,)


async def test_processes_begin_after_the_step_that_starts_them_in_their_order(stage, it, watcher):
    stage.story.clear()
    stage.call(it, "twice")
    assert stage.story == [
        ("main", "-ticks(0) +ticks(1)"),
        ("twice", "ok"),
        ("main", "-ticks(1) +ticks(11)"),
        ("main", "-ticks(11) +ticks(111)"),
    ]


async def test_a_failing_process_is_rolled_back_and_logged_without_other_effects(stage, it):
    assert stage.call(it, "startAll").ok
    await stage.clock.sleep(2.0)
    assert stage.property(it, "ticks") == (8,), "refuses committed 5, count added 3"
    assert stage.logged("[it] error in operation breaks/0")
    assert stage.logged("ValueError: inside")
    assert stage.logged("[it] operation refuses/0 failed: no way")


async def test_a_guarded_process_waits(stage, it, watcher):
    stage.call(it, "startGuarded")
    watcher.take()
    stage.call(it, "twice")
    assert watcher.take() == [
        "-ticks(0) +ticks(1)",
        "~guarded",
        "-ticks(1) +ticks(11)",
        "-ticks(11) +ticks(111)",
    ]


async def test_an_unknown_process_is_an_error_of_the_artifact(stage, it):
    call = stage.call(it, "wrong")
    assert "unknown internal operation `no_such/0`" in call.outcome.message
    call = stage.call(it, "wrongMethod")
    assert "add @internal_operation above def has_ticks" in call.outcome.message


async def test_agents_cannot_call_internal_operations(stage, it):
    call = stage.call(it, "work", 3)
    assert call.reason.functor == "unknown_operation"
    assert "its internal operation of this name is for the artifact itself only" in call.outcome.message


async def test_a_process_started_in_init_begins_when_the_artifact_exists(stage):
    class Alive(Artifact):
        def init(self):
            self.define_property("beats", 0)
            self.start(self.beat)

        @internal_operation
        async def beat(self):
            assert self.workspace.lookup(self.name) is self.id
            assert self.caller is None
            while True:
                await self.sleep(1.0)
                self.update_property("beats", self.value("beats") + 1)

    alive = await stage.make(Alive)
    await stage.clock.sleep(3.5)
    assert stage.property(alive, "beats") == (3,)
    assert stage.lines == []


async def test_a_process_started_by_a_callback_runs_immediately_if_the_artifact_is_free(
    stage, it, made, watcher
):
    made.on_sample(7)
    assert stage.property(it, "ticks") == (7,)
    stage.call(it, "hold")
    await stage.clock.sleep(0.5)
    made.on_sample(8)
    made.on_sample(9)
    assert stage.property(it, "ticks") == (7,)
    await stage.clock.sleep(1.0)
    assert watcher.notes == ["-ticks(0) +ticks(7)", "-ticks(7) +ticks(8)", "-ticks(8) +ticks(9)"]
    stage.main.dispose_artifact(it)
    made.on_sample(10)
    made.start("receive", 11, cause=Cause(1, 0, "sample", "late"))
    with pytest.raises(InvalidArtifact, match="unknown internal operation `receive/0`"):
        made.start("receive")


async def test_an_overridden_process_is_found_by_its_method(stage):
    class Old(Artifact):
        def init(self):
            self.define_property("p", "")

        @internal_operation(name="work")
        def work_hard(self):
            self.update_property("p", "old")

        @operation
        def go(self):
            self.start(self.work_hard)

    class New(Old):
        def work_hard(self):
            self.update_property("p", "new")

    new = await stage.make(New)
    stage.call(new, "go")
    assert stage.property(new, "p") == ("new",)


async def test_an_artifact_may_start_its_ordinary_operations_too(stage, it):
    stage.call(it, "note_later")
    assert stage.property(it, "ticks") == (2,)
