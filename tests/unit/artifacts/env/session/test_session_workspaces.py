"""Sessions join workspaces and leave them."""

import asyncio

import pytest
from session_lab import Counter, session_in

from jacaros.artifacts import OperationFailed, Structure, UnknownWorkspace


async def test_workspaces_are_joined_and_left(stage, session):
    stage.environment.create_workspace("/main/lab")
    with pytest.raises(UnknownWorkspace, match="unknown workspace `/main/lob`; did you mean"):
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
    with pytest.raises(UnknownWorkspace):
        session_in(stage, home="/main/lob")
    assert session_in(stage, home="/main/lab").joined == ("/main/lab",), "it begins in its home"


async def test_a_joined_workspace_is_also_meant_by_a_link_to_it(stage, session):
    stage.environment.create_workspace("/main/lab")
    session.join("lab")
    await session.make_artifact("counter", Counter)
    session.join("/main")
    stage.environment.link_workspace("/main/there", "/main/lab")
    await session.act("inc", workspace="there")
    assert session.focus("there/counter").workspace == "/main/lab"
    assert session.value("count") == 1


async def test_outside_all_workspaces_nothing_can_be_done_but_join(session):
    await session.make_artifact("counter", Counter)
    session.quit("main")
    with pytest.raises(OperationFailed) as failure:
        session.quit("main")
    assert failure.value.reason == Structure("workspace_not_joined", ("main",))
    for request in (session.act("inc"), session.act("inc", artifact="counter")):
        with pytest.raises(OperationFailed, match="workspace /main has not been joined; join it first"):
            await request
    session.join("/main")
    await session.act("inc")


async def test_an_operation_does_not_reach_a_workspace_that_was_not_joined_by_a_path(stage, session):
    stage.environment.create_workspace("/main/lab")
    await session.make_artifact("lab/counter", Counter)
    with pytest.raises(OperationFailed) as failure:
        await session.act("inc", artifact="lab/counter")
    assert failure.value.reason == Structure("workspace_not_joined", ("/main/lab",))


async def test_waiting_for_an_artifact_fails_when_its_workspace_was_quit(stage, session):
    stage.environment.create_workspace("/main/lab")
    session.join("lab")
    waiting = asyncio.ensure_future(session.focus_when_available("counter"))
    await asyncio.sleep(0)
    session.quit("lab")
    await session.make_artifact("lab/counter", Counter)
    with pytest.raises(OperationFailed, match="workspace /main/lab has not been joined"):
        await waiting
