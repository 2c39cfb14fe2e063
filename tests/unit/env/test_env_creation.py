"""Making artifacts: names, types, ``init`` and what a failed creation leaves behind (nothing)."""

import asyncio

import pytest

from jacaros.env import (
    Artifact,
    Atom,
    InvalidArtifact,
    OperationFailed,
    Out,
    Structure,
    UnknownArtifact,
    initializer,
    internal_operation,
    operation,
)
from jacaros.errors import InternalError
from jacaros.trace import cause


class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)


class Labelled(Artifact):
    def init(self, label: str, size: int):
        self.define_property("label", label)
        self.define_property("size", size)


class Bare(Artifact):
    pass


class Fussy(Artifact):
    def init(self, level: int):
        self.define_property("tmp", 1)
        self.start(self.process)
        self.on_dispose(lambda: self.log("cleaned"))
        if level < 0:
            self.fail("negative")
        if level == 0:
            raise RuntimeError("no level")
        self.define_property("level", level)

    def dispose(self):
        self.log("disposed")

    @internal_operation
    def process(self):
        self.log("process")


class Slow(Artifact):
    async def init(self, fails: bool = False):
        self.start(self.process)
        self.on_dispose(lambda: self.log("cleaned"))
        self.define_property("ready", False)
        await self.sleep(1.0)
        if fails:
            self.fail("too slow")
        self.update_property("ready", True)

    @internal_operation
    async def process(self):
        try:
            await self.sleep(100.0)
        finally:
            self.log("process stopped")


async def why(awaitable):
    with pytest.raises(OperationFailed) as caught:
        await awaitable
    assert caught.value.reason.functor == "makeArtifactFailure"
    return (*caught.value.reason.arguments, caught.value.message)


def types(stage):
    stage.types = {"Counter": Counter, "Labelled": Labelled, "Fussy": Fussy, "Slow": Slow, "Nonsense": int}


def test_init_has_the_arguments_of_make_artifact(play):
    async def scene(stage):
        types(stage)
        a = await stage.main.make_artifact("a", "Counter")
        b = await stage.main.make_artifact(Atom("b"), Atom("Counter"), [7])
        c = await stage.main.make_artifact("c", "Labelled", ("kitchen", 12.0), "bob")
        assert [stage.property(each, "count") for each in (a, b)] == [(0,), (7,)]
        assert (stage.property(c, "label"), stage.property(c, "size")) == (("kitchen",), (12,))
        assert (c.name, c.type_name, c.workspace, c.creator, c.path) == (
            "c",
            "Labelled",
            "/main",
            "bob",
            "/main/c",
        )
        assert type(b.name) is str
        assert stage.main.lookup("b") is b
        assert a.number < b.number < c.number
        assert repr(c) == "</main/c: Labelled>"

    play(scene)


def test_an_artifact_without_init_is_made_without_arguments_only(play):
    async def scene(stage):
        await stage.make(Bare)
        reason, name, message = await why(stage.make(Bare, 1, name="other"))
        assert (reason, name) == ("init_failed", "other")
        assert "its init takes (), not 1 arguments" in message

    play(scene)


def test_without_arguments_an_artifact_is_made_even_if_its_init_wants_some(play):
    async def scene(stage):
        fussy = await stage.make(Fussy)
        assert stage.main.properties(fussy) == ()
        assert stage.lines == []

    play(scene)


def test_a_used_name_is_refused_and_the_artifact_stays(play):
    async def scene(stage):
        counter = await stage.make(Counter, 5)
        reason, name, _ = await why(stage.make(Counter))
        assert (reason, name) == ("artifact_already_present", "it")
        assert stage.main.lookup("it") is counter
        assert stage.property(counter, "count") == (5,)

    play(scene)


def test_an_unknown_type_is_refused_with_a_spelling_hint(play):
    async def scene(stage):
        types(stage)
        reason, name, message = await why(stage.main.make_artifact("d", "Cuonter"))
        assert (reason, name) == ("unknown_artifact_template", "Cuonter")
        assert "did you mean Counter?" in message
        with pytest.raises(UnknownArtifact):
            stage.main.lookup("d")

    play(scene)


def test_without_find_type_no_type_name_is_known(play):
    async def scene(stage):
        environment = type(stage.environment)(stage.clock)
        reason, _, message = await why(environment.workspace("/main").make_artifact("d", "Counter"))
        assert reason == "unknown_artifact_template"
        assert "no artifact type is called Counter" in message

    play(scene)


def test_a_type_that_is_no_artifact_or_cannot_be_loaded_is_refused(play):
    async def scene(stage):
        types(stage)
        reason, name, message = await why(stage.main.make_artifact("d", "Nonsense"))
        assert (reason, name) == ("unknown_artifact_template", "Nonsense")
        assert "not a class derived from Artifact" in message

        def broken(name):
            raise SyntaxError("in artifacts.py")

        environment = type(stage.environment)(stage.clock, {}, broken, stage.lines.append)
        reason, _, message = await why(environment.workspace("/main").make_artifact("d", "Counter"))
        assert reason == "unknown_artifact_template"
        assert "SyntaxError: in artifacts.py" in message
        assert stage.logged("SyntaxError: in artifacts.py")

        def defect(name):
            raise InternalError("ours")

        environment = type(stage.environment)(stage.clock, {}, defect)
        with pytest.raises(InternalError):
            await environment.workspace("/main").make_artifact("d", "Counter")

    play(scene)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((-1,), "negative"),
        ((0,), "RuntimeError in operation init/1 of it: no level"),
        (("one",), "parameter level (number 1) wants an integer"),
        ((1, 2), "its init takes (level: an integer), not 2 arguments"),
    ],
)
def test_a_failed_init_leaves_nothing_behind(play, arguments, told):
    async def scene(stage):
        reason, name, message = await why(stage.make(Fussy, *arguments))
        assert (reason, name) == ("init_failed", "it")
        assert told in message
        with pytest.raises(UnknownArtifact):
            stage.main.lookup("it")
        assert not stage.logged("process")
        assert not stage.logged("disposed")
        assert stage.logged("cleaned") == (arguments in ((-1,), (0,)))
        assert stage.property(await stage.make(Fussy, 4), "level") == (4,)

    play(scene)


def test_a_constructor_that_fails_is_an_init_that_fails(play):
    class Odd(Artifact):
        def __init__(self, needed):
            pass

    async def scene(stage):
        reason, _, message = await why(stage.make(Odd))
        assert reason == "init_failed"
        assert "TypeError" in message

    play(scene)


def test_init_may_take_its_time_and_the_artifact_is_there_when_it_has_ended(play):
    async def scene(stage):
        making = asyncio.ensure_future(stage.make(Slow))
        await stage.clock.sleep(0.5)
        with pytest.raises(UnknownArtifact):
            stage.main.lookup("it")
        assert (await why(stage.make(Counter)))[0] == "artifact_already_present"
        slow = await making
        assert stage.elapsed == 1.0
        assert stage.property(slow, "ready") == (True,)

    play(scene)


def test_a_slow_init_that_fails_leaves_nothing_behind(play):
    async def scene(stage):
        assert (await why(stage.make(Slow, True)))[:2] == ("init_failed", "it")
        await stage.clock.sleep(1.0)
        assert sorted(stage.lines) == ["[it] cleaned", "[it] process stopped"]
        await stage.make(Counter)

    play(scene)


def test_the_making_can_be_dropped_and_leaves_nothing_behind(play):
    async def scene(stage):
        making = asyncio.ensure_future(stage.make(Slow))
        await stage.clock.sleep(0.5)
        making.cancel()
        await stage.clock.sleep(0.1)
        assert making.cancelled()
        assert sorted(stage.lines) == ["[it] cleaned", "[it] process stopped"]
        await stage.make(Counter)

    play(scene)


def test_closing_while_an_artifact_is_made_ends_the_making(play):
    async def scene(stage):
        making = asyncio.ensure_future(stage.make(Slow))
        await stage.clock.sleep(0.5)
        await stage.environment.close()
        assert (await why(making))[0] == "init_failed"
        assert stage.elapsed == 0.5

    play(scene)


def test_create_tells_a_plain_init_at_once(play):
    async def scene(stage):
        told = []
        stage.main.create("c", Counter, [3], "bob", lambda *result: told.append(result))
        stage.main.create("c", Counter, [3], "bob", lambda *result: told.append(result))
        (made, outcome), (nothing, refusal) = told
        assert stage.property(made, "count") == (3,)
        assert outcome.ok
        assert nothing is None
        assert refusal.reason == Structure("makeArtifactFailure", ("artifact_already_present", "c"))
        assert stage.main.create("d", Counter).ended
        assert stage.main.create("d", Counter).ended, "a failure that nobody waits for"

    play(scene)


def test_the_cause_of_the_making_is_that_of_its_processes(play):
    class Alive(Artifact):
        def init(self):
            self.start(self.beat)

        @internal_operation
        async def beat(self):
            await self.sleep(1.0)
            self.signal("beat")

    async def scene(stage):
        why, made = cause("act", "make"), []
        stage.main.create("it", Alive, on_done=lambda artifact, _: made.append(artifact), cause=why)
        watcher = stage.watch(made[0])
        await stage.clock.sleep(2.0)
        assert watcher.observations[0].cause == why

    play(scene)


def test_a_name_can_be_used_again_while_a_dropped_making_comes_to_its_end(play):
    class Lingering(Artifact):
        async def init(self):
            try:
                await self.sleep(100.0)
            finally:
                await self.sleep(1.0)

    async def scene(stage):
        first = stage.main.create("it", Lingering)
        await stage.clock.sleep(0.5)
        first.cancel()
        await stage.clock.sleep(0.1)
        assert (await why(stage.make(Counter)))[0] == "artifact_already_present"
        await stage.clock.sleep(2.0)
        await stage.make(Counter)

    play(scene)


def test_a_making_that_is_ended_from_two_sides_ends_once(play):
    class Lingering(Artifact):
        async def init(self):
            try:
                await self.sleep(100.0)
            finally:
                await self.sleep(1.0)

    async def scene(stage):
        making = asyncio.ensure_future(stage.make(Lingering))
        await stage.clock.sleep(0.5)
        closing = asyncio.ensure_future(stage.environment.close())
        await stage.clock.sleep(0.1)
        making.cancel()
        counter = await stage.make(Counter)
        await closing
        assert making.cancelled()
        assert stage.elapsed == 1.5
        assert stage.main.lookup("it") is counter

    play(scene)


def test_the_creator_is_the_caller_in_init(play):
    class Curious(Artifact):
        def init(self):
            self.define_property("maker", self.caller)

    async def scene(stage):
        assert stage.property(await stage.make(Curious, creator="bob"), "maker") == ("bob",)

    play(scene)


def test_artifacts_know_their_surroundings_in_init(play):
    class Curious(Artifact):
        def init(self):
            self.define_property(
                "told", self.name, self.workspace.path, self.workspace.name, self.clock.virtual
            )
            self.define_property("lent", self.resources["lent"])

    async def scene(stage):
        curious = await stage.make(Curious)
        assert stage.property(curious, "told") == ("it", "/main", "main", True)
        assert stage.property(curious, "lent") == ("this",)

    play(scene, lent="this")


def test_an_artifact_can_make_others(play):
    class Maker(Artifact):
        @operation(name="makeOne")
        async def make_one(self, name: str):
            made = await self.step(self.workspace.make_artifact(name, Counter, [9], self.caller))
            self.signal("made", made)

        @operation(name="makeHeld")
        async def make_held(self, name: str):
            await self.workspace.make_artifact(name, Counter)

    async def scene(stage):
        maker = await stage.make(Maker)
        await stage.call(maker, "makeOne", "child").wait()
        assert stage.property(stage.main.lookup("child"), "count") == (9,)
        again = stage.call(maker, "makeOne", "child")
        await again.wait()
        assert again.reason == Structure("makeArtifactFailure", ("artifact_already_present", "child"))
        held = stage.call(maker, "makeHeld", "other")
        await held.wait()
        assert held.ok

    play(scene)


def test_init_cannot_be_called_by_agents(play):
    async def scene(stage):
        counter = await stage.make(Counter)
        assert stage.call(counter, "init", 3).reason == Structure("unknown_operation", (counter, "init"))

    play(scene)


class Several(Artifact):
    def init(self, start: int = 0):
        self.define_property("made", "usual", start)

    @initializer
    def init_in_a_room(self, room: str, start: int):
        self.define_property("made", room, start)

    @initializer
    async def init_of_many(self, *rooms: str):
        await self.sleep(1)
        self.define_property("made", list(rooms))


class Derived(Several):
    def init_in_a_room(self, room: str, start: int):
        self.define_property("made", f"derived {room}", start)


def test_of_several_inits_the_one_with_that_number_of_arguments_runs(play):
    async def scene(stage):
        for kind, args, values in [
            (Several, (), ("usual", 0)),
            (Several, (3,), ("usual", 3)),
            (Several, ("hall", 3), ("hall", 3)),
            (Several, ("a", "b", "c"), (["a", "b", "c"],)),
            (Derived, (1,), ("usual", 1)),
            (Derived, ("hall", 3), ("derived hall", 3)),
        ]:
            it = await stage.make(kind, *args)
            assert stage.property(it, "made") == values
            assert "unknown" in str(stage.call(it, "init", *args).reason), "an init is no operation"
            stage.main.dispose_artifact(it)

    play(scene)


def test_two_inits_with_one_number_of_arguments_are_a_mistake():
    with pytest.raises(InvalidArtifact, match="are both init init with 1 arguments"):

        class Twice(Artifact):
            def init(self, start=0): ...

            @initializer
            def again(self, start): ...


def test_an_init_that_is_an_operation_too_can_be_called_by_agents(play):
    class Restart(Artifact):
        @operation
        def init(self, start: int):
            self.define_property("start", start)

    async def scene(stage):
        it = await stage.make(Restart, 1)
        assert stage.call(it, "init", 2).ok
        assert len(stage.main.properties(it)) == 2

    play(scene)


def test_an_init_whose_arguments_nobody_takes_tells_those_it_takes(play):
    class Two(Artifact):
        def init(self, a): ...

        @initializer
        def other(self, a, b: int): ...

    async def scene(stage):
        with pytest.raises(OperationFailed) as caught:
            await stage.make(Two, 1, 2, 3)
        assert (
            "its init takes (a: any value) or (a: any value, b: an integer), not 3 arguments"
            in caught.value.message
        )

    play(scene)


def test_an_operation_asked_of_an_artifact_in_its_init_waits_for_the_end_of_the_init(play):
    class Early(Artifact):
        async def init(self, keep, fails=False):
            self.define_property("ready", False)
            keep.append(self.id)
            await self.clock.sleep(1)
            self.update_property("ready", True)
            if fails:
                self.fail("no")

        @operation
        def ask(self, ready: Out):
            ready.set(self.value("ready"))

    async def scene(stage):
        for fails in (False, True):
            keep, ready = [], Out()
            made = asyncio.ensure_future(stage.make(Early, keep, fails, name=f"early{int(fails)}"))
            await stage.clock.sleep(0.5)
            call = stage.call(keep[0], "ask", ready)
            await call.wait()
            assert stage.elapsed == 1.0 + fails
            if not fails:
                assert ready.value is True
                await made
                continue
            assert call.reason == Structure("artifact_disposed", ("early1",))
            with pytest.raises(OperationFailed):
                await made
            assert stage.call(keep[0], "ask", ready).reason == Structure(
                "artifact_not_available", ("early1",)
            )

    play(scene)


def test_an_artifact_that_disposes_itself_in_its_init_is_not_made(play):
    class Suicidal(Artifact):
        def init(self):
            self.on_dispose(lambda: self.log("given back"))
            self.workspace.dispose_artifact(self.id)

    async def scene(stage):
        with pytest.raises(OperationFailed, match="cannot be made: its init disposed it"):
            await stage.make(Suicidal)
        assert stage.lines == ["[it] given back"]
        await stage.make(Artifact)

    play(scene)


def test_a_making_that_is_dropped_leaves_no_artifact_behind_its_id(play):
    class Slow(Artifact):
        async def init(self, keep):
            keep.append(self.id)
            await self.sleep(9)

    async def scene(stage):
        keep = []
        execution = stage.main.create("slow", Slow, (keep,))
        await stage.clock.sleep(1)
        execution.cancel()
        await stage.clock.sleep(1)
        assert stage.call(keep[0], "x").reason == Structure("artifact_not_available", ("slow",))

    play(scene)
