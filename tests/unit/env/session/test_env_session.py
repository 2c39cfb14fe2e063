"""Sessions: anybody uses workspaces and artifacts, with plain values."""

import asyncio

import pytest

from jacaros.env import (
    Artifact,
    Atom,
    OperationFailed,
    Out,
    Session,
    Structure,
    UnknownArtifact,
    UnknownProperty,
    UnknownWorkspace,
    WorkspaceError,
    internal_operation,
    operation,
)


class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)

    @operation
    def inc(self, by: int = 1):
        self.update_property("count", self.value("count") + by)
        self.signal("tick", self.value("count"))

    @operation
    def report(self, *texts: str):
        self.signal("report", self.caller, list(texts))

    @operation
    def report(self, text: str):  # noqa: F811 - replaced on purpose: exact arity
        self.signal("report", self.caller, text)

    @operation
    def never(self):
        self.fail("it never works", "never", 1)


class Wheels(Artifact):
    def init(self):
        self.define_property("pose", 0.0, 0.0)
        self.define_property("speed", 0.0)
        self.define_property("cell", 1, "free")
        self.define_property("cell", 2, "wall")

    @operation(name="moveForward", pausable=True)
    async def move_forward(self, metres: float):
        try:
            for _ in range(round(metres * 10)):
                await self.pause_point()
                self.update_property("speed", 1.0)
                await self.sleep(0.1)
                x, y = self.values("pose")
                self.update_property("pose", round(x + 0.1, 6), y)
        finally:
            self.update_property("speed", 0.0)

    @operation(name="getCurrentPose")
    def get_current_pose(self, x: Out, y: Out):
        x.set(self.value("pose", 0))
        y.set(self.value("pose", 1))

    @operation
    def x(self, out: Out):
        out.set(self.value("pose"))

    @operation
    def nothing(self, out: Out):
        pass

    @operation
    def drop(self):
        self.remove_property("cell", 1, None)

    @operation
    def flash(self):
        self.update_property("speed", 5.0)
        self.commit()
        self.update_property("speed", 0.0)


def session_in(stage, name="painter", **options):
    return Session(stage.environment, name, **options)


def test_an_operation_is_awaited_and_its_result_is_seen(play):
    async def scene(stage):
        session = session_in(stage)
        counter = await session.make_artifact("counter", Counter, [1])
        session.focus(counter)
        assert session.value("count") == 1
        assert await session.act("inc", 2) is None
        assert session.values("count") == (3,)
        assert counter.creator == "painter"

    play(scene)


def test_types_are_found_by_name(play):
    async def scene(stage):
        stage.types["Counter"] = Counter
        session = session_in(stage)
        counter = await session.make_artifact("counter", "Counter", (7,))
        assert session.lookup("counter") is counter
        session.focus("counter")
        assert session.value("count") == 7
        with pytest.raises(OperationFailed) as raised:
            await session.make_artifact("other", "Countr")
        assert raised.value.reason == Structure(
            "makeArtifactFailure", ("unknown_artifact_template", "Countr")
        )

    play(scene)


def test_values_of_out_arguments_are_given(play):
    async def scene(stage):
        session = session_in(stage)
        await session.make_artifact("wheels", Wheels)
        assert await session.act("getCurrentPose", Out(), Out()) == (0.0, 0.0)
        assert await session.act("x", Out()) == 0.0
        assert await session.act("nothing", Out()) is None
        with pytest.raises(WorkspaceError, match=r"an argument of x is the class Out: write Out\(\)"):
            await session.act("x", Out)

    play(scene)


def test_a_failure_is_raised_with_its_reason(play):
    async def scene(stage):
        session = session_in(stage)
        await session.make_artifact("counter", Counter)
        with pytest.raises(OperationFailed, match="it never works") as raised:
            await session.act("never")
        assert raised.value.reason == Structure("never", (1,))
        with pytest.raises(
            OperationFailed, match="has an operation inc/2; counter has inc/0, inc/1"
        ) as raised:
            await session.act("inc", 1, 2)
        assert raised.value.reason == Structure("unknown_operation", ("inc",))
        with pytest.raises(OperationFailed, match=r"has an operation incc/0; did you mean inc"):
            await session.act("incc")
        with pytest.raises(OperationFailed) as raised:
            await session.act("inc", "two")
        assert raised.value.reason.functor == "wrong_op_arguments"

    play(scene)


def test_own_artifacts_come_before_focused_ones_and_those_before_others(play):
    async def scene(stage):
        first = await stage.make(Counter, name="first", creator="somebody")
        second = await stage.make(Counter, name="second", creator="somebody")
        session = session_in(stage)
        await session.act("inc")
        assert stage.property(first, "count") == (1,)
        session.focus(second)
        await session.act("inc")
        assert stage.property(second, "count") == (1,)
        own = await session.make_artifact("own", Counter)
        await session.make_artifact("younger", Counter)
        await session.act("inc")
        assert stage.property(own, "count") == (1,)

    play(scene)


def test_an_operation_is_directed_to_an_artifact_or_a_workspace(play):
    async def scene(stage):
        session = session_in(stage)
        session.create_workspace("lab")
        await session.make_artifact("counter", Counter)
        session.join("lab")
        in_lab = await session.make_artifact("counter", Counter)
        other = await session.make_artifact("other", Counter)
        assert in_lab.workspace == "/main/lab"
        await session.act("inc", artifact="other")
        await session.act("inc", 5, artifact=in_lab)
        await session.act("inc", 9, workspace="main")
        await session.act("inc", 1, artifact="counter", workspace="/main")
        await session.act("inc", 1, artifact="../counter")
        assert [stage.property(each, "count") for each in (other, in_lab)] == [(1,), (5,)]
        session.focus("/main/counter")
        assert session.value("count") == 11

    play(scene)


def test_workspaces_are_joined_and_left(play):
    async def scene(stage):
        session = session_in(stage)
        assert session.create_workspace("/main/lab") == "/main/lab"
        with pytest.raises(UnknownWorkspace, match="no workspace /main/lob; did you mean"):
            session.join("lob")
        assert session.join("lab") == "/main/lab"
        assert session.joined == ("/main", "/main/lab")
        session.focus(await session.make_artifact("counter", Counter))
        session.join("..")
        assert session.joined == ("/main/lab", "/main")
        session.quit("lab")
        assert session.joined == ("/main",)
        assert session.focused == ()
        assert not session.has_property("count")
        with pytest.raises(OperationFailed, match="has not been joined") as raised:
            session.quit("lab")
        assert raised.value.reason == Structure("workspace_not_joined", ("lab",))
        with pytest.raises(OperationFailed, match="/main/lab has not been joined"):
            session.focus("/main/lab/counter")

    play(scene)


def test_a_session_begins_in_its_home(play):
    async def scene(stage):
        stage.environment.create_workspace("/main/lab")
        with pytest.raises(UnknownWorkspace):
            session_in(stage, home="/main/lob")
        assert session_in(stage, home="/main/lab").joined == ("/main/lab",)

    play(scene)


def test_focusing_again_has_no_effect(play):
    async def scene(stage):
        session = session_in(stage)
        await session.make_artifact("counter", Counter)
        changes = []
        session.on_change(changes.append)
        session.focus("counter")
        session.focus("counter")
        assert [change.name for change in changes] == ["count"]
        session.stop_focus("counter")
        session.stop_focus("counter")
        assert [(change.before, change.now) for change in changes] == [(None, (0,)), ((0,), None)]

    play(scene)


def test_an_artifact_is_focused_as_soon_as_it_is_there(play):
    async def scene(stage):
        session = session_in(stage)
        waiting = asyncio.ensure_future(session.focus_when_available("counter"))
        await asyncio.sleep(1)
        assert not waiting.done()
        counter = await stage.make(Counter)
        counter = await stage.make(Counter, name="counter")
        assert session.value("count") == 0
        assert await waiting is counter
        assert await session.focus_when_available("it") is not counter
        assert session.focused == (counter, session.lookup("it"))

    play(scene)


def test_properties_are_found_by_name_and_values(play):
    async def scene(stage):
        session = session_in(stage)
        wheels = session.focus(await session.make_artifact("wheels", Wheels))
        session.focus(await session.make_artifact("counter", Counter))
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

    play(scene)


def test_an_unknown_property_is_an_error_that_says_what_there_is(play):
    async def scene(stage):
        session = session_in(stage)
        counter = await session.make_artifact("counter", Counter)
        with pytest.raises(UnknownProperty, match="no artifact is focused"):
            session.value("count")
        with pytest.raises(UnknownProperty, match="artifact counter is not focused"):
            session.value("count", artifact=counter)
        session.focus(counter)
        with pytest.raises(
            UnknownProperty, match=r"what is focused \(counter\) has count; did you mean count"
        ):
            session.values("cuont")
        with pytest.raises(UnknownArtifact, match="no artifact cuonter"):
            session.value("count", artifact="cuonter")

    play(scene)


def test_what_is_observed_is_the_sessions_own(play):
    class Route(Artifact):
        def init(self):
            self.define_property("route", ["a", "b"])

    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("route", Route))
        session.value("route").append("c")
        assert session.value("route") == ["a", "b"]

    play(scene)


def test_a_handle_is_paused_resumed_and_awaited(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("wheels", Wheels))
        operation = session.begin("moveForward", 1.0)
        ended = []
        operation.on_end(ended.append)
        await asyncio.sleep(0.55)
        operation.pause()
        await asyncio.sleep(10)
        assert not operation.done
        assert operation.outcome is None
        operation.resume()
        assert await operation is None
        assert operation.outcome.ok
        assert session.value("pose") == 1.0
        operation.on_end(ended.append)
        assert ended == [operation, operation]
        assert 10 < stage.elapsed < 12

    play(scene)


def test_a_cancelled_operation_ends_at_once_and_its_finally_runs(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("wheels", Wheels))
        operation = session.begin("moveForward", 1.0)
        await asyncio.sleep(0.25)
        operation.cancel()
        operation.cancel()
        assert operation.done
        assert operation.outcome.reason == Atom("cancelled")
        with pytest.raises(OperationFailed, match="moveForward was cancelled"):
            await operation
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert session.value("speed") == 0.0
        await asyncio.sleep(1)
        assert session.value("pose") == 0.2

    play(scene)


def test_a_cancelled_task_cancels_the_operation_that_it_awaits(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("wheels", Wheels))
        task = asyncio.ensure_future(session.act("moveForward", 1.0))
        await asyncio.sleep(0.25)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        await asyncio.sleep(1)
        assert session.values("pose") == (0.2, 0.0)
        assert session.value("speed") == 0.0

    play(scene)


def test_an_operation_may_take_so_long(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("wheels", Wheels))
        with pytest.raises(OperationFailed, match="did not end within 250 ms") as raised:
            await session.act("moveForward", 1.0, timeout=0.25)
        assert raised.value.reason == Structure("operation_timeout", ("moveForward/1", 250.0))
        await asyncio.sleep(1)
        assert session.value("pose") == 0.2
        await session.act("moveForward", 0.1, timeout=0.25)
        assert session.value("pose") == 0.3

    play(scene)


def test_an_operation_that_cannot_begin_has_failed(play):
    async def scene(stage):
        session = session_in(stage)
        operation = session.begin("fly")
        assert operation.done
        assert operation.outcome.reason == Structure("unknown_operation", ("fly",))
        counter = await stage.make(Counter)
        stage.main.dispose_artifact(counter)
        assert session.begin("inc", artifact=counter).outcome.reason == Structure(
            "artifact_not_available", ("it",)
        )

    play(scene)


def test_a_disposed_artifact_fails_what_waits_and_its_properties_are_gone(play):
    async def scene(stage):
        session = session_in(stage)
        wheels = session.focus(await session.make_artifact("wheels", Wheels))
        changes = []
        session.on_change(changes.append)
        operation = session.begin("moveForward", 1.0)
        await asyncio.sleep(0.05)
        changes.clear()
        session.dispose_artifact(wheels)
        with pytest.raises(OperationFailed) as raised:
            await operation
        assert raised.value.reason == Structure("artifact_disposed", ("wheels",))
        assert session.focused == ()
        assert not session.has_property("pose")
        assert [(c.name, c.now) for c in changes] == [
            ("pose", None),
            ("speed", None),
            ("cell", None),
            ("cell", None),
        ]

    play(scene)


def test_signals_are_read_as_a_stream(play):
    async def scene(stage):
        session = session_in(stage)
        counter = session.focus(await session.make_artifact("counter", Counter))
        everything = session.signals()
        got = []

        async def read():
            async for signal in session.signals("tick"):
                got.append(signal)
                if len(got) == 2:
                    break

        reading = asyncio.ensure_future(read())
        await asyncio.sleep(0)
        await session.act("inc", 3)
        await session.act("report", "hello", artifact=counter)
        await session.act("inc", 4)
        await session.act("inc", 5)
        await reading
        assert got == [("tick", (3,), counter), ("tick", (7,), counter)]
        everything.close()
        assert [(s.name, s.arguments) async for s in everything] == [
            ("tick", (3,)),
            ("report", ("painter", "hello")),
            ("tick", (7,)),
            ("tick", (12,)),
        ]

    play(scene)


def test_callbacks_see_what_was_published_together(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("counter", Counter))
        seen = []
        session.on_signal(lambda signal: seen.append((signal.name, session.value("count"))))
        stop = session.on_change(lambda change: seen.append((change.name, change.before, change.now)))
        await session.act("inc")
        assert seen == [("tick", 1), ("count", (0,), (1,))]
        stop()
        stop()
        await session.act("inc")
        assert seen[2:] == [("tick", 2)]

    play(scene)


def test_a_callback_that_raises_harms_nobody(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("counter", Counter))
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
            "[painter] a callback for changes failed",
        ):
            assert stage.logged(what), what

    play(scene)


def test_a_condition_that_holds_for_one_step_only_is_not_missed(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("wheels", Wheels))
        waiting = asyncio.ensure_future(session.until(lambda: session.value("speed") > 4 and "fast"))
        await asyncio.sleep(0)
        await session.act("flash")
        assert await waiting == "fast"
        assert await session.until(lambda: session.has_property("pose")) is True

    play(scene)


def test_a_condition_that_raises_is_told_to_who_waits(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("counter", Counter))
        with pytest.raises(UnknownProperty):
            await session.until(lambda: session.value("battery") < 20)
        waiting = asyncio.ensure_future(session.until(lambda: 1 / (1 - session.value("count")) > 1))
        await asyncio.sleep(0)
        await session.act("inc")
        with pytest.raises(ZeroDivisionError):
            await waiting

    play(scene)


def test_a_condition_is_waited_for_so_long(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("counter", Counter))
        with pytest.raises(TimeoutError, match="within 2 s"):
            await session.until(lambda: session.value("count") > 1, timeout=2.0)
        assert stage.elapsed == 2.0

    play(scene)


def test_a_closed_session_holds_nothing_and_does_nothing(play):
    async def scene(stage):
        with session_in(stage) as session:
            wheels = session.focus(await session.make_artifact("wheels", Wheels))
            operation = session.begin("moveForward", 1.0)
            condition = asyncio.ensure_future(session.until(lambda: session.value("speed") > 9))
            stream = session.signals()
            await asyncio.sleep(0.15)
        assert stage.main.observers(wheels) == ()
        assert operation.outcome.reason == Atom("cancelled")
        assert [each async for each in stream] == []
        with pytest.raises(WorkspaceError, match="session painter has been closed"):
            await condition
        with pytest.raises(WorkspaceError):
            await session.act("x", Out())
        with pytest.raises(WorkspaceError):
            session.focus(wheels)
        session.close()
        await asyncio.sleep(1)
        assert stage.property(wheels, "speed") == (0.0,)

    play(scene)


def test_artifacts_are_linked(play):
    class Door(Artifact):
        ports = ("out",)

    async def scene(stage):
        session = session_in(stage)
        door = await session.make_artifact("door", Door)
        counter = await session.make_artifact("counter", Counter)
        session.link_artifacts("door", "out", counter)
        assert stage.main.linked(door, "out") == (counter,)
        with pytest.raises(OperationFailed) as raised:
            session.link_artifacts(door, "in", counter)
        assert raised.value.reason == Structure("unknown_port", ("in",))

    play(scene)


def test_what_an_artifact_does_by_itself_is_observed(play):
    class Clock(Artifact):
        def init(self):
            self.define_property("nticks", 0)
            self.start(self.go)

        @internal_operation
        async def go(self):
            while True:
                await self.sleep(1)
                self.update_property("nticks", self.value("nticks") + 1)

    async def scene(stage):
        with session_in(stage) as session:
            session.focus(await session.make_artifact("clock", Clock))
            await session.until(lambda: session.value("nticks") == 3)
            assert stage.elapsed == 3

    play(scene)


class Books:
    def __init__(self):
        self.pending, self.passive, self.told = 0, 0, []

    def begin(self):
        self.pending += 1

    def end(self):
        self.pending -= 1

    def waiting(self):
        return self

    def __enter__(self):
        self.passive += 1

    def __exit__(self, *error):
        self.passive -= 1


def test_account_is_kept_of_what_is_waited_for(play):
    async def scene(stage):
        books = Books()
        with session_in(stage, account=books) as session:
            session.focus(await session.make_artifact("wheels", Wheels))
            assert (books.pending, books.passive) == (0, 0)
            operation = session.begin("moveForward", 0.1)
            assert (books.pending, books.passive) == (1, 0)
            await operation
            for wait in (
                session.until(lambda: session.value("speed") > 9),
                anext(session.signals()),
                session.focus_when_available("other"),
            ):
                waiting = asyncio.ensure_future(wait)
                await asyncio.sleep(0)
                assert (books.pending, books.passive) == (0, 1)
                waiting.cancel()
                await asyncio.sleep(0)
                assert (books.pending, books.passive) == (0, 0)
            waiting = asyncio.ensure_future(session.until(lambda: False, timeout=1))
            await asyncio.sleep(0)
            assert (books.pending, books.passive) == (1, 0)
            waiting.cancel()
            await asyncio.sleep(0)
        assert (books.pending, books.passive) == (0, 0)

    play(scene)


def test_streams_get_a_signal_in_the_order_of_their_making_and_go_when_nobody_reads_them(play):
    async def scene(stage):
        session = session_in(stage)
        session.focus(await session.make_artifact("counter", Counter))
        woken = []

        async def read(number):
            async for _ in session.signals("tick"):
                woken.append(number)
                break

        reading = [asyncio.ensure_future(read(number)) for number in range(50)]
        await asyncio.sleep(0)
        await session.act("inc")
        await asyncio.gather(*reading)
        assert woken == list(range(50))
        del reading
        kept = session.signals("tick")
        await session.act("inc")
        assert session._streams[-1]() is kept
        assert len(session._streams) == 1

    play(scene)


def test_a_joined_workspace_is_also_meant_by_a_link_to_it(play):
    async def scene(stage):
        session = session_in(stage)
        session.create_workspace("lab")
        session.join("lab")
        await session.make_artifact("counter", Counter)
        session.join("/main")
        stage.environment.link_workspace("/main/there", "/main/lab")
        await session.act("inc", workspace="there")
        assert session.focus("there/counter").workspace == "/main/lab"
        assert session.value("count") == 1

    play(scene)


def test_what_was_quit_cannot_be_quit_again(play):
    async def scene(stage):
        session = session_in(stage)
        session.quit("main")
        with pytest.raises(OperationFailed) as failure:
            session.quit("main")
        assert failure.value.reason == Structure("workspace_not_joined", ("main",))

    play(scene)
