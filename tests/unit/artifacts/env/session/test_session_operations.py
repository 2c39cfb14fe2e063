"""Operations of sessions while they run: paused, cancelled, timed out."""

import asyncio

import pytest
from session_lab import Counter

from jacaros.artifacts import Atom, OperationFailed, Structure


async def test_a_handle_is_paused_resumed_and_awaited(stage, session, wheels):
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


async def test_a_cancelled_operation_ends_at_once_and_its_finally_runs(session, wheels):
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


async def test_a_cancelled_task_cancels_the_operation_that_it_awaits(session, wheels):
    task = asyncio.ensure_future(session.act("moveForward", 1.0))
    await asyncio.sleep(0.25)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    await asyncio.sleep(1)
    assert session.values("pose") == (0.2, 0.0)
    assert session.value("speed") == 0.0


async def test_an_operation_may_take_so_long(session, wheels):
    with pytest.raises(OperationFailed, match="did not end within 250 ms") as raised:
        await session.act("moveForward", 1.0, timeout=0.25)
    assert raised.value.reason == Structure("operation_timeout", ("moveForward/1", 250.0))
    await asyncio.sleep(1)
    assert session.value("pose") == 0.2
    await session.act("moveForward", 0.1, timeout=0.25)
    assert session.value("pose") == 0.3


async def test_an_operation_that_cannot_begin_has_failed(stage, session):
    operation = session.begin("fly")
    assert operation.done
    assert operation.outcome.reason == Structure("unknown_operation", ("fly/0",))
    counter = await stage.make(Counter)
    stage.main.dispose_artifact(counter)
    assert session.begin("inc", artifact=counter).outcome.reason == Structure(
        "artifact_not_available", ("it",)
    )


async def test_a_disposed_artifact_fails_what_waits_and_its_properties_are_gone(stage, session, wheels):
    changes = []
    session.on_change(changes.append)
    operation = session.begin("moveForward", 1.0)
    await asyncio.sleep(0.05)
    changes.clear()
    stage.main.dispose_artifact(wheels)
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
