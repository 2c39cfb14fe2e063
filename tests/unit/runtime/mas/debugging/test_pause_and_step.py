"""Pause, continue, step and speed, on the virtual clock and in real time."""

import asyncio
from typing import Any

import pytest

import jacaros
from jacaros import Mas
from jacaros.agents.mind.rules import goals
from jacaros.agents.python.python_agent import PythonAgent
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.debugging import Debugger, DebugState
from jacaros.runtime.mas.embedding.running_agent import literal

TICKER = "!tick(0). +!tick(N) <- .print(N); .wait(1000); !tick(N + 1)."


def quiet(lines: list[str], **options: Any) -> Mas:
    """A system that prints to *lines*."""
    return Mas(seed=1, on_print=lambda agent, text: lines.append(text), on_log=lambda *line: None, **options)


@pytest.mark.real_time
async def test_nothing_moves_in_a_pause_in_real_time(lines: list[str]) -> None:
    async with quiet(lines, world="patrol") as mas:
        frames: list[Any] = []
        assert mas.world is not None
        mas.world.ground_truth.listen(frames.append)
        mas.add_agent("bob", TICKER)
        await asyncio.sleep(2.5)
        assert lines == ["0", "1", "2"]
        assert frames
        debugger = mas.debugger
        debugger.pause()
        before = len(frames), mas.clock.now()
        await asyncio.sleep(60.0)
        assert (lines, (len(frames), mas.clock.now())) == (["0", "1", "2"], before)
        debugger.resume()
        await asyncio.sleep(0.45)
        assert lines == ["0", "1", "2"], "the rest of the wait"
        await asyncio.sleep(0.1)
        assert lines == ["0", "1", "2", "3"]
        assert len(frames) > before[0]


@pytest.mark.real_time
async def test_the_speed_of_a_run_in_real_time_changes_agents_and_world(lines: list[str]) -> None:
    async with quiet(lines) as mas:
        states: list[DebugState] = []
        debugger = mas.debugger
        debugger.listen(states.append)
        mas.add_agent("bob", TICKER)
        await asyncio.sleep(1.5)
        debugger.speed = 10.0
        assert debugger.has_speed
        assert states[-1].speed == debugger.speed == 10.0
        await asyncio.sleep(1.0)
        assert lines == [str(number) for number in range(12)]
        with pytest.raises(UsageError):
            debugger.speed = 0.0


async def test_the_virtual_clock_has_no_speed(debugger: Debugger) -> None:
    assert debugger.speed == 0.0
    assert not debugger.has_speed
    with pytest.raises(UsageError):
        debugger.speed = 2.0


@pytest.mark.program("!go. +!go <- .print(a); .print(b); .print(c); .print(d).")
async def test_a_pause_in_the_middle_of_a_turn_holds_the_agent_before_its_next_step(
    mas: Mas, debugger: Debugger, lines: list[str]
) -> None:
    mas.on_print(lambda agent, text: debugger.pause("in a step") if text == "b" else None)
    state = await debugger.wait_until_paused()
    assert state.why == "in a step"
    assert lines == ["a", "b"]
    debugger.resume()
    await mas.until_idle()
    assert lines == ["a", "b", "c", "d"]


async def test_a_paused_run_is_not_idle_and_its_time_does_not_run_out() -> None:
    async with Mas(seed=1, on_print=lambda *line: None, until_idle=True, seconds=5.0) as mas:
        mas.debugger.pause()
        mas.add_agent("bob", "!go. +!go <- .wait(1000).")
        for _ in range(100):
            await asyncio.sleep(0)
        assert mas.exit_code is None
        mas.debugger.resume()
        assert await mas.ended() == 0
        assert mas.clock.elapsed == 1.0


@pytest.mark.parametrize("clock", ["real", "fast"])
def test_a_paused_run_can_end(clock: Any) -> None:
    async def main() -> None:
        async with Mas(seed=1, on_print=lambda *line: None, world="patrol") as mas:
            mas.add_agent("bob", TICKER)
            await asyncio.sleep(0)
            mas.debugger.pause()
            await asyncio.sleep(0)
            mas.stop(3)
            assert await mas.ended() == 3

    jacaros.run(main(), clock=clock)


@pytest.mark.program(
    "!a. !b. +!a <- .print(a1); .print(a2). +!b <- .print(b1); !c; .print(b2). +!c <- .print(c)."
)
async def test_steps_stop_at_the_right_place(mas: Mas, debugger: Debugger, lines: list[str]) -> None:
    debugger.pause()

    async def step(what: Any) -> list[str]:
        debugger.step(what)
        assert (await debugger.wait_until_paused()).why == "step"
        return list(lines)

    assert await step("event") == []
    assert await step("event") == ["a1"], "a cycle takes up an event and makes a step"
    assert await step("step") == ["a1"]
    assert await step("step") == ["a1", "a2"]
    assert await step("cycle") == ["a1", "a2", "b1"]
    assert await step("event") == ["a1", "a2", "b1"]
    assert await step("step") == ["a1", "a2", "b1"]
    assert await step("cycle") == ["a1", "a2", "b1", "c"]
    debugger.resume()
    await mas.until_idle()
    assert lines[-1] == "b2"


async def test_one_agent_is_stepped_while_others_have_their_turns(
    mas: Mas, debugger: Debugger, lines: list[str]
) -> None:
    mas.add_agent("ann", "!go. +!go <- .print(x); .print(y); .print(z).")
    debugger.step("step", "ann")
    state = await debugger.wait_until_paused()
    assert (state.agent, state.file, state.line, state.intention) == ("ann", "<ann>", 1, 1)
    assert "x" not in lines
    debugger.step("step", "ann")
    await debugger.wait_until_paused()
    assert [line for line in lines if line in "xyz"] == ["x"]
    for wrong in (("step", "other"), ("leap",)):
        with pytest.raises(UsageError):
            debugger.step(*wrong)  # type: ignore[arg-type]


@pytest.mark.program("!go. +!go <- .print(a); .print(b). +hello <- .print(hello).")
async def test_a_held_agent_can_receive_messages_and_its_goal_can_be_dropped(
    mas: Mas, debugger: Debugger, lines: list[str]
) -> None:
    bob = mas.agent("bob")
    for _ in range(2):
        debugger.step("step")
        await debugger.wait_until_paused()
    bob.add_belief("hello")
    mas.add_agent("ann", "!drop. +!drop <- .send(bob, achieve, stop).")
    goals.drop_desire(bob.mind, literal("go"))
    debugger.resume()
    await mas.until_idle()
    assert lines == ["a", "hello"]


class Walker(PythonAgent):
    """Counts seconds."""

    async def run(self) -> None:
        for number in range(5):
            self.print(number)
            await self.sleep(1.0)


@pytest.mark.parametrize("clock", ["fast", pytest.param("real", marks=pytest.mark.real_time)])
async def test_a_python_agent_is_paused_too_and_a_real_graph_lists_what_continues(clock: str) -> None:
    said: list[str] = []
    async with quiet(said) as mas:
        mas.add_agent("walker", Walker)
        await mas.sleep(1.5)
        mas.debugger.pause()
        cannot = mas.debugger.state.cannot
        assert any("walker (Python)" in line for line in cannot) == (clock == "real")
        for _ in range(50):
            await asyncio.sleep(0)
        assert said == ["0", "1"]
        mas.debugger.resume()
        await mas.sleep(2.0)
        assert said == ["0", "1", "2", "3"]


async def test_a_run_without_a_debugger_is_asked_nothing(mas: Mas, debugger: Debugger, lines: list[str]):
    assert debugger.listen(lambda state: None) is not None
    assert mas.system.scheduler.turn_ended is None
    assert mas.agent("bob").mind.observers.step is None
    await mas.until_idle()
    assert not debugger.paused
    assert lines[-1] == "over"
    mas.stop()
    debugger.pause()
    assert not debugger.paused, "a run that has ended is not paused"
