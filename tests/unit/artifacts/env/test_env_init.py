"""Methods `init`: which one is called, and what it may do."""

import pytest
from creation_lab import Counter

from jacaros.artifacts import (
    Artifact,
    InvalidArtifact,
    OperationFailed,
    Structure,
    initializer,
    internal_operation,
    operation,
)
from jacaros.artifacts.env.ports import ENDED
from jacaros.runtime.trace import Cause
from stage_lab import play


async def test_create_reports_a_plain_init_immediately(stage):
    told = []
    stage.main.create("c", Counter, [3], "bob", lambda *result: told.append(result))
    stage.main.create("c", Counter, [3], "bob", lambda *result: told.append(result))
    (made, outcome), (nothing, refusal) = told
    assert stage.property(made, "count") == (3,)
    assert outcome.ok
    assert nothing is None
    assert refusal.reason == Structure("makeArtifactFailure", ("artifact_already_present", "c"))
    assert stage.main.create("d", Counter).ended
    assert stage.main.create("d", Counter) is ENDED, "a failure without a waiting caller"


async def test_the_cause_of_the_creation_is_that_of_its_processes(stage):
    class Alive(Artifact):
        def init(self):
            self.start(self.beat)

        @internal_operation
        async def beat(self):
            await self.sleep(1.0)
            self.signal("beat")

    why, made = Cause(1, 0, "act", "make"), []
    stage.main.create("it", Alive, on_done=lambda artifact, _: made.append(artifact), cause=why)
    watcher = stage.watch(made[0])
    await stage.clock.sleep(2.0)
    assert watcher.observations[0].cause == why


def test_artifacts_know_their_workspace_in_init():
    class Curious(Artifact):
        def init(self):
            workspace = self.workspace
            self.define_property("told", self.name, workspace.path, workspace.name, self.clock.virtual)
            self.define_property("lent", self.resources["lent"])
            self.define_property("maker", self.caller)

    async def scene(stage):
        curious = await stage.make(Curious, creator="bob")
        assert stage.property(curious, "told") == ("it", "/main", "main", True)
        assert stage.property(curious, "lent") == ("this",)
        assert stage.property(curious, "maker") == ("bob",)

    play(scene, lent="this")


async def test_an_artifact_can_make_others(stage):
    class Maker(Artifact):
        @operation(name="makeOne")
        async def make_one(self, name: str):
            made = await self.step(self.workspace.make_artifact(name, Counter, [9], self.caller))
            self.signal("made", made)

        @operation(name="makeHeld")
        async def make_held(self, name: str):
            await self.workspace.make_artifact(name, Counter)

    maker = await stage.make(Maker)
    await stage.call(maker, "makeOne", "child").wait()
    assert stage.property(stage.main.lookup("child"), "count") == (9,)
    again = await stage.ended(maker, "makeOne", "child")
    assert again.reason == Structure("makeArtifactFailure", ("artifact_already_present", "child"))
    held = await stage.ended(maker, "makeHeld", "other")
    assert held.ok


async def test_init_cannot_be_called_by_agents_unless_it_is_an_operation_too(stage):
    class Restart(Artifact):
        @operation
        def init(self, start: int):
            self.define_property("start", start)

    counter = await stage.make(Counter)
    assert stage.call(counter, "init", 3).reason == Structure("unknown_operation", (counter, "init"))
    restart = await stage.make(Restart, 1, name="restart")
    assert stage.call(restart, "init", 2).ok
    assert len(stage.main.properties(restart)) == 2


def test_two_inits_with_the_same_arity_are_an_error():
    with pytest.raises(InvalidArtifact, match="are both init init with 1 arguments"):

        class Twice(Artifact):
            def init(self, start=0): ...

            @initializer
            def again(self, start): ...


async def test_the_error_for_wrong_init_arguments_lists_the_accepted_ones(stage):
    class Two(Artifact):
        def init(self, a): ...

        @initializer
        def other(self, a, b: int): ...

    with pytest.raises(OperationFailed) as caught:
        await stage.make(Two, 1, 2, 3)
    assert (
        "expected (a: any value) or (a: any value, b: an integer) as arguments of init, found 3 arguments"
        in caught.value.message
    )
