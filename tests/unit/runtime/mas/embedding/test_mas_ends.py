"""How a system in a Python program ends, and what has to end with it."""

import asyncio
from contextlib import nullcontext
from pathlib import Path

import pytest
from embedding_lab import Counter

from jacaros import Mas
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.mind.mind import Mind
from jacaros.artifacts import Artifact, operation
from jacaros.runtime.errors import InternalError
from jacaros.runtime.mas.embedding.waits import AgentEnded, GoalFailed, RunEnded, UnknownAgent


@pytest.mark.parametrize(
    ("how", "expected"), [("ends", None), ("raises", KeyError), ("is cancelled", asyncio.CancelledError)]
)
async def test_the_end_of_the_block_ends_everything(
    how: str, expected: type[BaseException] | None, lines: list[str]
) -> None:
    async def block(mas: Mas) -> None:
        await mas.make_artifact("counter", Counter)
        mas.add_agent("bob", "!go. +!go <- drive.", focus=["counter"])
        mas.session("painter").begin("drive")
        await mas.sleep(1)
        if how == "raises":
            raise KeyError("of the user")
        if how == "is cancelled":
            asyncio.current_task().cancel()  # type: ignore[union-attr]
            await mas.sleep(1)

    before = asyncio.all_tasks()
    with pytest.raises(expected) if expected else nullcontext():
        async with Mas(on_print=lambda agent, text: lines.append(text)) as mas:
            await block(mas)
    assert asyncio.all_tasks() == before
    assert lines == ["standing", "standing"]
    assert mas.exit_code == 0


async def test_a_wait_that_can_no_longer_end_raises(mas: Mas) -> None:
    bob = mas.add_agent("bob", "+!stop <- .stopMAS(0, 5). +!long <- .wait(100000).")
    ann = mas.add_agent("ann", "")
    waits = [
        asyncio.ensure_future(each)
        for each in (ann.until("p"), bob.achieve("long").wait(), mas.mailbox("m").get())
    ]
    await mas.sleep(1)
    ann.kill()
    with pytest.raises(AgentEnded, match="agent ann has ended"):
        await waits[0]
    assert ann.ended
    with pytest.raises(AgentEnded, match="agent ann has ended"):
        ann.add_belief("p")
    with pytest.raises(UnknownAgent):
        mas.agent("ann")
    bob.achieve("stop")
    for waiting in waits[1:]:
        with pytest.raises(RunEnded, match="the run ended with exit code 5"):
            await waiting
    assert await mas.ended() == mas.exit_code == 5
    with pytest.raises(RunEnded):
        await bob.until("p")


async def test_a_goal_of_an_agent_or_a_run_that_has_ended_is_not_waited_for(mas: Mas) -> None:
    bob, ann = (mas.add_agent(name, "+!long <- .wait(100000).") for name in ("bob", "ann"))
    lost, dropped, unfinished = bob.achieve("long"), bob.achieve("long"), ann.achieve("long")
    await mas.sleep(1)
    dropped.drop()
    bob.kill()
    with pytest.raises(AgentEnded, match="agent bob has ended"):
        await lost
    with pytest.raises(GoalFailed, match="was dropped"):
        await dropped
    mas.stop()
    with pytest.raises(RunEnded, match="the run ended with exit code 0"):
        await unfinished
    assert mas.exit_code == 0


async def test_the_system_can_be_stopped_from_python(mas: Mas, lines: list[str]) -> None:
    mas.add_agent("bob", "!go. +!go <- .wait(100); .print(tick); !go.")
    await mas.sleep(0.35)
    mas.stop(7)
    assert mas.exit_code == 7
    await mas.sleep(1)
    assert await mas.ended() == 7
    assert lines == ["[bob] tick"] * 3


async def test_a_project_that_cannot_start_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text("+!go <- .print(", encoding="utf-8")
    before = asyncio.all_tasks()
    with pytest.raises(AslError, match=r"a.asl:1"):
        async with Mas(tmp_path / "a.asl"):
            pytest.fail("it began")
    assert asyncio.all_tasks() == before


async def test_a_defect_of_jacaros_is_raised_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(self: Mind, fuel: int) -> bool:
        raise InternalError("broken")

    monkeypatch.setattr(Mind, "run", broken)
    with pytest.raises(InternalError, match="broken"):
        async with Mas() as mas:
            await mas.add_agent("bob", "").until("p")


class Door(Artifact):
    """Is opened once."""

    def init(self) -> None:
        self.define_property("open", False)

    @operation(name="openIt")
    def open_it(self) -> None:
        self.update_property("open", True)

    @operation
    async def stay(self) -> None:
        while True:
            try:
                await self.sleep(1)
            except asyncio.CancelledError:
                self.log("not yet")


async def test_an_observer_notified_later_sees_the_change_before_the_end(mas: Mas, lines: list[str]) -> None:
    """An observer that disposes an artifact as soon as it is notified of it."""
    door = await mas.make_artifact("door", Door)
    first, second = mas.session("first"), mas.session("second")
    first.focus(door)
    second.focus(door)
    program = "+open(X) <- .print(open(X)). -open(X) <- .print(no_more(X))."
    bob = mas.add_agent("bob", program, focus=[door])
    seen: list[object] = []
    second.on_change(lambda change: seen.append((change.before, change.now)))
    first.on_change(lambda change: first.begin("disposeArtifact", door) if change.now else None)
    await second.act("openIt")
    await mas.until_idle()
    assert seen == [((False,), (True,)), ((True,), None)]
    assert bob.ask("open(_)") is None
    assert [line[6:] for line in lines] == ["open(false)", "no_more(false)", "open(true)", "no_more(true)"]


async def test_waiting_continues_if_an_artifact_is_disposed_as_soon_as_it_exists(mas: Mas) -> None:
    once = [True]
    first, second = mas.session("first"), mas.session("second")
    first.on_change(
        lambda change: first.begin("disposeArtifact", change.artifact) if change.now and once else None
    )
    tasks = [asyncio.create_task(each.focus_when_available("door")) for each in (first, second)]
    goal = mas.add_agent("bob", '+!see <- focusWhenAvailable("door"); ?open(X).').achieve("see")
    await mas.sleep(1)
    await mas.make_artifact("door", Door)
    once.clear()
    await mas.sleep(1)
    assert [task.done() for task in tasks] == [True, False]
    assert goal.state == "waiting"
    await mas.make_artifact("door", Door)
    await goal
    assert second.focused == (await tasks[1],)


async def test_a_run_ends_although_an_operation_ignores_cancellation(logs: list[str]) -> None:
    async with Mas(on_log=lambda text, level: logs.append(text)) as mas:
        session = mas.session("s")
        await session.make_artifact("door", Door)
        session.begin("stay")
        await mas.sleep(3)
    assert "abandoning it" in logs[-1]
