"""Sessions observe: properties, signals, changes and conditions."""

import asyncio

import pytest
from session_lab import Counter, session_in

from jacaros.artifacts import Artifact, Atom, UnknownArtifact, UnknownProperty, internal_operation


async def test_focusing_again_has_no_effect(session):
    await session.make_artifact("counter", Counter)
    changes = []
    session.on_change(changes.append)
    session.focus("counter")
    session.focus("counter")
    assert [change.name for change in changes] == ["count"]
    session.stop_focus("counter")
    session.stop_focus("counter")
    assert [(change.before, change.now) for change in changes] == [(None, (0,)), ((0,), None)]


async def test_an_artifact_is_focused_as_soon_as_it_exists(stage, session):
    waiting = asyncio.ensure_future(session.focus_when_available("counter"))
    await asyncio.sleep(1)
    assert not waiting.done()
    counter = await stage.make(Counter)
    counter = await stage.make(Counter, name="counter")
    assert session.value("count") == 0
    assert await waiting is counter
    assert await session.focus_when_available("it") is not counter
    assert session.focused == (counter, session.lookup("it"))


async def test_properties_are_found_by_name_and_values(session, wheels, counter):
    assert [each.values for each in session.properties("cell")] == [(1, "free"), (2, "wall")]
    assert session.properties("cell", None, "wall")[0].artifact is wheels
    assert session.has_property("cell", 2, None)
    assert session.has_property("cell", 2, Atom("wall"))
    assert not session.has_property("cell", 3, None)
    assert not session.has_property("cell", artifact="counter")
    assert session.value("cell", 1) == "free"
    await session.act("drop")
    assert session.values("cell") == (2, "wall")
    assert session.value("battery", default=100) == 100


async def test_the_error_for_an_unknown_property_lists_known_ones(session):
    counter = await session.make_artifact("counter", Counter)
    with pytest.raises(UnknownProperty, match="no artifact is focused"):
        session.value("count")
    with pytest.raises(UnknownProperty, match="artifact counter is not focused"):
        session.value("count", artifact=counter)
    session.focus(counter)
    with pytest.raises(
        UnknownProperty, match=r"the focused artifacts \(counter\) have count; did you mean `count`"
    ):
        session.values("cuont")
    with pytest.raises(UnknownArtifact, match="unknown artifact `cuonter`"):
        session.value("count", artifact="cuonter")


async def test_observed_values_are_copies(stage):
    class Route(Artifact):
        def init(self):
            self.define_property("route", ["a", "b"])

    session = session_in(stage)
    session.focus(await session.make_artifact("route", Route))
    session.value("route").append("c")
    assert session.value("route") == ["a", "b"]


async def test_callbacks_see_what_was_published_together(session, counter):
    seen = []
    session.on_signal(lambda signal: seen.append((signal.name, session.value("count"))))
    stop = session.on_change(lambda change: seen.append((change.name, change.before, change.now)))
    await session.act("inc")
    assert seen == [("tick", 1), ("count", (0,), (1,))]
    stop()
    stop()
    await session.act("inc")
    assert seen[2:] == [("tick", 2)]


async def test_a_callback_that_raises_has_no_other_effect(stage, session, counter):
    session.on_change(lambda change: 1 / 0)
    session.on_signal(lambda signal: {}["no"])
    operation = session.begin("inc")
    operation.on_end(lambda _: tuple(range(1))[1])
    assert operation.outcome.ok
    assert session.value("count") == 1
    for what in (
        "ZeroDivisionError",
        "KeyError: 'no'",
        "IndexError",
        "[painter] an on_change callback raised",
    ):
        assert stage.logged(what), what


async def test_a_condition_that_holds_for_one_step_only_is_not_missed(session, wheels):
    waiting = asyncio.ensure_future(session.until(lambda: session.value("speed") > 4 and "fast"))
    await asyncio.sleep(0)
    await session.act("flash")
    assert await waiting == "fast"
    assert await session.until(lambda: session.has_property("pose")) is True


async def test_a_condition_that_raises_raises_in_the_waiting_task(session, counter):
    with pytest.raises(UnknownProperty):
        await session.until(lambda: session.value("battery") < 20)
    waiting = asyncio.ensure_future(session.until(lambda: 1 / (1 - session.value("count")) > 1))
    await asyncio.sleep(0)
    await session.act("inc")
    with pytest.raises(ZeroDivisionError):
        await waiting


async def test_a_condition_is_waited_for_so_long(stage, session, counter):
    with pytest.raises(TimeoutError, match="within 2 s"):
        await session.until(lambda: session.value("count") > 1, timeout=2.0)
    assert stage.elapsed == 2.0


async def test_what_an_artifact_does_by_itself_is_observed(stage):
    class Clock(Artifact):
        def init(self):
            self.define_property("nticks", 0)
            self.start(self.go)

        @internal_operation
        async def go(self):
            while True:
                await self.sleep(1)
                self.update_property("nticks", self.value("nticks") + 1)

    with session_in(stage) as session:
        session.focus(await session.make_artifact("clock", Clock))
        await session.until(lambda: session.value("nticks") == 3)
        assert stage.elapsed == 3


async def test_a_personal_artifact_that_was_disposed_is_no_longer_focused(stage):
    body = stage.main.offer("body_bob", Counter, personal=True)
    session = session_in(stage)
    session.focus("body_bob")
    assert session.focused == (body,)
    stage.main.dispose_artifact(body)
    assert session.focused == ()
    assert not session.has_property("count")
