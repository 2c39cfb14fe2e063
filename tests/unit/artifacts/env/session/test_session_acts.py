"""Sessions: plain asyncio code creates artifacts and acts on them."""

import asyncio

import pytest
from session_lab import Counter, Wheels, session_in

from jacaros.artifacts import Atom, OperationFailed, Out, Structure, WorkspaceError


async def test_an_operation_is_awaited_and_its_result_is_seen(session):
    counter = await session.make_artifact("counter", Counter, [1])
    session.focus(counter)
    assert session.value("count") == 1
    assert await session.act("inc", 2) is None
    assert session.values("count") == (3,)
    assert counter.creator == "painter"


async def test_types_are_found_by_name(stage):
    stage.types["Counter"] = Counter
    session = session_in(stage)
    counter = await session.make_artifact("counter", "Counter", (7,))
    assert session.lookup("counter") is counter
    session.focus("counter")
    assert session.value("count") == 7
    with pytest.raises(OperationFailed) as raised:
        await session.make_artifact("other", "Countr")
    assert raised.value.reason == Structure("makeArtifactFailure", ("unknown_artifact_template", "Countr"))


async def test_values_of_out_arguments_are_returned(session):
    await session.make_artifact("wheels", Wheels)
    assert await session.act("getCurrentPose", Out(), Out()) == (0.0, 0.0)
    assert await session.act("x", Out()) == 0.0
    assert await session.act("nothing", Out()) is None
    with pytest.raises(WorkspaceError, match=r"expected an Out object as argument of x, found the class Out"):
        await session.act("x", Out)


async def test_a_failure_is_raised_with_its_reason(session):
    await session.make_artifact("counter", Counter)
    with pytest.raises(OperationFailed, match="it never works") as raised:
        await session.act("never")
    assert raised.value.reason == Structure("never", (1,))
    with pytest.raises(
        OperationFailed, match="inc/2; did you mean `inc/0` of 'counter' or `inc/1` of 'counter'"
    ) as raised:
        await session.act("inc", 1, 2)
    assert raised.value.reason == Structure("unknown_operation", ("inc/2",))
    with pytest.raises(
        OperationFailed, match=r"has an operation incc/0; did you mean `inc/1` of 'counter' or"
    ):
        await session.act("incc")
    with pytest.raises(OperationFailed) as raised:
        await session.act("inc", "two")
    assert raised.value.reason.functor == "wrong_op_arguments"


async def test_an_operation_is_directed_to_an_artifact_or_a_workspace(stage, session):
    stage.environment.create_workspace("/main/lab")
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


async def test_a_closed_session_holds_nothing_and_does_nothing(stage):
    with session_in(stage) as session:
        wheels = session.focus(await session.make_artifact("wheels", Wheels))
        operation = session.begin("moveForward", 1.0)
        condition = asyncio.ensure_future(session.until(lambda: session.value("speed") > 9))
        await asyncio.sleep(0.15)
    assert stage.main.observers(wheels) == ()
    assert operation.outcome.reason == Atom("cancelled")
    with pytest.raises(WorkspaceError, match="session painter has been closed"):
        await condition
    with pytest.raises(WorkspaceError):
        await session.act("x", Out())
    with pytest.raises(WorkspaceError):
        session.focus(wheels)
    session.close()
    await asyncio.sleep(1)
    assert stage.property(wheels, "speed") == (0.0,)


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


async def test_waits_are_counted(stage):
    books = Books()
    with session_in(stage, account=books) as session:
        session.focus(await session.make_artifact("wheels", Wheels))
        assert (books.pending, books.passive) == (0, 0)
        operation = session.begin("moveForward", 0.1)
        assert (books.pending, books.passive) == (1, 0)
        await operation
        for wait in (
            session.until(lambda: session.value("speed") > 9),
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
