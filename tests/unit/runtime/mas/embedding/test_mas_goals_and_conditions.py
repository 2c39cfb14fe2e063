"""A Python program gives agents goals and beliefs, and waits for the outcome."""

import asyncio
from typing import Any

import pytest
from embedding_lab import Counter

from jacaros import Atom, GoalFailed, Mas, Structure
from jacaros.agents.language.diagnostics import AslError


async def test_until_waits_for_a_condition(mas: Mas) -> None:
    await mas.make_artifact("counter", Counter)
    bob = mas.add_agent("bob", "big(X) :- count(X) & X > 2.", focus=["counter"])
    painter = mas.session("painter")

    async def count() -> None:
        for _ in range(4):
            await mas.sleep(1)
            await painter.act("inc")

    counting = asyncio.ensure_future(count())
    assert await bob.until("big(X)", timeout=10) == {"X": 3}
    assert mas.clock.elapsed == pytest.approx(3.0)
    assert await bob.until("big(X)") == {"X": 3}
    await counting


async def test_a_timeout_of_a_condition_shows_related_beliefs(mas: Mas) -> None:
    bob = mas.add_agent("bob", "count(1). other(2).")
    told = r"^count\(X\) & X > 2 did not hold for agent bob \(it believes count\(1\)\) within 1.5 s$"
    with pytest.raises(TimeoutError, match=told):
        await bob.until("count(X) & X > 2", timeout=1.5)
    assert mas.clock.elapsed == pytest.approx(1.5)
    assert not bob.mind.waits.conditions
    with pytest.raises(AslError):
        await bob.until("count(X")


async def test_a_cancelled_wait_leaves_nothing_behind(mas: Mas) -> None:
    bob = mas.add_agent("bob", "+!long <- .wait(10000).")
    for waiting in (bob.until("never"), bob.achieve("long").wait()):
        task = asyncio.ensure_future(waiting)
        await mas.sleep(0.1)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
    assert not bob.mind.waits.conditions
    assert bob.goals == ["long"]


async def test_beliefs_percepts_and_signals_can_be_added(mas: Mas, lines: list[str]) -> None:
    bob = mas.add_agent(
        "bob",
        "+door(X)[source(S)] <- .print(door, X, S). +knock <- .print(knock). -door(X) <- .print(gone, X).",
    )
    bob.perceive("door(open)")
    await bob.until("door(open)")
    bob.signal("knock")
    bob.add_belief("door(shut)")
    bob.add_belief("door(red)[source(ann)]")
    assert bob.believes("door(shut)[source(self)] & door(red)[source(ann)]")
    bob.perceive_no_more("door(open)")
    bob.remove_belief("door(shut)")
    await mas.until_idle()
    assert bob.beliefs == ["door(red)[source(ann)]"]
    with pytest.raises(ValueError, match="a percept must be ground"):
        bob.perceive("door(X)")
    said = " ".join(sorted(line.removeprefix("[bob] ") for line in lines))
    assert said == "dooropenpercept doorredann doorshutself goneopen goneshut knock"


async def test_beliefs_can_be_added_while_an_agent_prints(mas: Mas) -> None:
    bob = mas.add_agent("bob", "+!go <- .print(one); ?said(one); .print(two).")
    mas.on_print(lambda agent, text: bob.add_belief(f"said({text})"))
    await bob.achieve("go")
    await bob.until("said(two)", timeout=1)


async def test_a_failed_goal_raises_with_its_reasons(mas: Mas) -> None:
    await mas.make_artifact("counter", Counter)
    bob = mas.add_agent(
        "bob", '+!go <- .fail(blocked(wall), error_msg("no way")). +!add <- inc(far). +!fly <- soar.'
    )
    mas.add_agent("eve", "+!open(D) : shut(D).")

    async def failure(agent: str, goal: str) -> GoalFailed:
        with pytest.raises(GoalFailed) as failed:
            await mas.agent(agent).achieve(goal)
        return failed.value

    failed = await failure("bob", "go")
    text = "goal !go of agent bob failed: no way (blocked(wall), error(internal_action)), in <bob>:1"
    assert str(failed) == text
    assert (failed.goal, failed.message) == ("go", "no way")
    assert Structure("blocked", (Atom("wall"),)) in failed.reasons
    assert failed.reason("blocked") == "wall"
    assert failed.reason("other") is None
    assert (await failure("eve", "open(hatch)")).__notes__ == [
        "does not fit: +!open(D) (<eve>:1), stops at `shut(D)` with D=hatch: no belief `shut`"
    ]
    with pytest.raises(GoalFailed, match="no relevant plan for !missing"):
        await bob.achieve("missing")
    reason: Any = (await failure("bob", "add")).reason("env_failure_reason")
    assert reason.functor == "wrong_op_arguments"
    told = (await failure("bob", "fly")).message
    assert told == "no artifact of workspace /main has an operation soar/0"


async def test_waiting_forever_on_the_virtual_clock_raises(mas: Mas) -> None:
    bob = mas.add_agent("bob", '+!long <- .wait("+never"). +!later(N) <- .wait(N); +later.')
    bob.achieve("later(5000)")
    assert await bob.until("later") == {}
    for waiting in (bob.achieve("long").wait(), bob.until("p"), mas.mailbox("me").get()):
        with pytest.raises(TimeoutError, match="and never will: all agents are idle"):
            await waiting
    assert await asyncio.to_thread(lambda: 7) == 7


async def test_goals_can_be_dropped_or_time_out(mas: Mas) -> None:
    bob = mas.add_agent("bob", "+!long <- .wait(10000). +!forget <- .drop_intention(long).")
    goal = bob.achieve("long")
    with pytest.raises(TimeoutError, match=r"bob did not achieve !long \(it is waiting\) within 2 s"):
        await goal.wait(timeout=2)
    assert goal.state == "waiting"
    goal.drop()
    with pytest.raises(GoalFailed, match="goal !long of agent bob was dropped"):
        await goal
    waiting = asyncio.ensure_future(bob.achieve("long").wait())
    await mas.sleep(1)
    bob.achieve("forget")
    with pytest.raises(GoalFailed, match="was dropped"):
        await waiting


async def test_until_idle_waits_for_idleness(mas: Mas) -> None:
    await mas.until_idle()
    mas.add_agent("bob", "!go. +!go <- .wait(3000); +done. +!busy <- .wait(1); !busy.")
    await mas.until_idle()
    assert mas.agent("bob").believes("done")
    mas.agent("bob").achieve("busy")
    with pytest.raises(TimeoutError, match="the agents did not become idle within 2 s"):
        await mas.until_idle(timeout=2)


async def test_an_operation_of_a_session_is_under_way(mas: Mas) -> None:
    await mas.make_artifact("counter", Counter)
    driving = mas.session("painter").begin("drive")
    with pytest.raises(TimeoutError, match="did not become idle within 2 s"):
        await mas.until_idle(timeout=2)
    await mas.until_idle(timeout=2000)
    assert driving.done
    assert mas.clock.elapsed == pytest.approx(1000.0)


async def test_a_failed_goal_that_is_not_awaited_is_logged(logs: list[str]) -> None:
    async with Mas(on_log=lambda text, level: logs.append(text)) as mas:
        bob = mas.add_agent("bob", "+!refused <- .fail.")
        bob.achieve("nothing(1)")
        bob.achieve("refused")
        later = asyncio.create_task(bob.achieve("awaited").wait())
        with pytest.raises(GoalFailed):
            await bob.achieve("awaited_too")
        with pytest.raises(GoalFailed):
            await later
    assert [line.partition(" and has")[0] for line in logs] == [
        "[bob] warning: the goal !nothing(1) failed",
        "[bob] warning: the goal !refused failed",
    ]
