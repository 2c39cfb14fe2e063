"""Creations of artifacts that take time, fail or are cancelled leave nothing behind."""

import asyncio

import pytest
from creation_lab import Counter, Fussy, Slow, why

from jacaros.artifacts import Artifact, OperationFailed, Out, Structure, UnknownArtifact, operation


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((-1,), "negative"),
        ((0,), "RuntimeError in operation init/1 of it: no level"),
        (("one",), "argument 1 (level): expected an integer"),
        ((1, 2), "expected (level: an integer) as arguments of init, found 2 arguments"),
    ],
)
async def test_a_failed_init_leaves_nothing_behind(stage, arguments, told):
    reason, name, message = await why(stage.make(Fussy, *arguments))
    assert (reason, name) == ("init_failed", "it")
    assert told in message
    with pytest.raises(UnknownArtifact):
        stage.main.lookup("it")
    assert not stage.logged("process")
    assert not stage.logged("disposed")
    assert stage.logged("cleaned") == (arguments in ((-1,), (0,)))
    assert stage.property(await stage.make(Fussy, 4), "level") == (4,)


async def test_a_constructor_that_fails_is_an_init_that_fails(stage):
    class Odd(Artifact):
        def __init__(self, needed):
            pass

    reason, _, message = await why(stage.make(Odd))
    assert reason == "init_failed"
    assert "TypeError" in message


async def test_an_asynchronous_init_makes_the_artifact_available_at_its_end(stage):
    making = asyncio.ensure_future(stage.make(Slow))
    await stage.clock.sleep(0.5)
    with pytest.raises(UnknownArtifact):
        stage.main.lookup("it")
    assert (await why(stage.make(Counter)))[0] == "artifact_already_present"
    slow = await making
    assert stage.elapsed == 1.0
    assert stage.property(slow, "ready") == (True,)


class Lingering(Artifact):
    async def init(self):
        try:
            await self.sleep(100.0)
        finally:
            await self.sleep(1.0)


@pytest.mark.parametrize("end", ["fails", "is cancelled"])
async def test_a_slow_creation_that_does_not_succeed_leaves_nothing_behind(stage, end):
    making = asyncio.ensure_future(stage.make(Slow, end == "fails"))
    await stage.clock.sleep(0.5)
    if end == "fails":
        assert (await why(making))[:2] == ("init_failed", "it")
    else:
        making.cancel()
    await stage.clock.sleep(1.0)
    assert making.cancelled() == (end == "is cancelled")
    assert sorted(stage.lines) == ["[it] cleaned", "[it] process stopped"]
    await stage.make(Counter)


async def test_closing_during_a_creation_cancels_it(stage):
    making = asyncio.ensure_future(stage.make(Slow))
    await stage.clock.sleep(0.5)
    await stage.environment.close()
    assert (await why(making))[0] == "init_failed"
    assert stage.elapsed == 0.5


async def test_a_name_can_be_reused_while_a_cancelled_creation_ends(stage):
    first = stage.main.create("it", Lingering)
    await stage.after(0.5, first.cancel)
    await stage.clock.sleep(0.1)
    assert (await why(stage.make(Counter)))[0] == "artifact_already_present"
    await stage.clock.sleep(2.0)
    await stage.make(Counter)


async def test_a_creation_that_is_ended_twice_ends_once(stage):
    making = asyncio.ensure_future(stage.make(Lingering))
    await stage.clock.sleep(0.5)
    closing = asyncio.ensure_future(stage.environment.close())
    await stage.after(0.1, making.cancel)
    counter = await stage.make(Counter)
    await closing
    assert making.cancelled()
    assert stage.elapsed == 1.5
    assert stage.main.lookup("it") is counter


async def test_an_operation_asked_of_an_artifact_in_its_init_waits_for_the_end_of_the_init(stage):
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

    for fails in (False, True):
        keep, ready = [], Out()
        made = asyncio.ensure_future(stage.make(Early, keep, fails, name=f"early{int(fails)}"))
        await stage.clock.sleep(0.5)
        call = await stage.ended(keep[0], "ask", ready)
        assert stage.elapsed == 1.0 + fails
        if not fails:
            assert ready.value is True
            await made
            continue
        assert call.reason == Structure("artifact_disposed", ("early1",))
        with pytest.raises(OperationFailed):
            await made
        assert stage.call(keep[0], "ask", ready).reason == Structure("artifact_not_available", ("early1",))


async def test_an_artifact_that_disposes_itself_in_its_init_is_not_made(stage):
    class Suicidal(Artifact):
        def init(self):
            self.on_dispose(lambda: self.log("given back"))
            self.workspace.dispose_artifact(self.id)

    with pytest.raises(OperationFailed, match=r"cannot create artifact .*: its init disposed it"):
        await stage.make(Suicidal)
    assert stage.lines == ["[it] given back"]
    await stage.make(Artifact)


async def test_the_id_of_a_cancelled_creation_has_no_artifact(stage):
    class Slow(Artifact):
        async def init(self, keep):
            keep.append(self.id)
            await self.sleep(9)

    keep = []
    execution = stage.main.create("slow", Slow, (keep,))
    await stage.after(1, execution.cancel)
    await stage.clock.sleep(1)
    assert stage.call(keep[0], "x").reason == Structure("artifact_not_available", ("slow",))
