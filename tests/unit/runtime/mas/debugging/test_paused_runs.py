"""A run that was paused and continued does the same as one that was not."""

import asyncio
from random import Random

import pytest
from debugged_runs import EXAMPLES, Observed, observed

from jacaros import Mas
from jacaros.runtime.mas.debugging.breakpoints import LineBreakpoint, lines_that_stop

PROJECTS = {
    "patrol": (EXAMPLES / "04_patrol" / "patrol.jcm", 25.0),
    "three robots": (EXAMPLES / "09_three_robots" / "three_robots.jcm", 12.0),
    "cleaning": (EXAMPLES / "05_house_cleaning" / "house_cleaning.jcm", 20.0),
}


def pauses_at_random(seed: int, times: int, seconds: float):
    """Pause at random moments, also between simultaneous events, and check that nothing continues."""

    async def during(mas: Mas, found: Observed) -> None:
        random, debugger = Random(seed), mas.debugger
        for _ in range(times):
            await mas.sleep(random.expovariate(times / seconds))
            for _ in range(random.randrange(12)):
                await asyncio.sleep(0)
            if mas.exit_code is not None:
                return
            debugger.pause()
            before = mas.clock.elapsed, len(found.lines), len(found.frames)
            for _ in range(random.randrange(40)):
                await asyncio.sleep(0)
            assert (mas.clock.elapsed, len(found.lines), len(found.frames)) == before
            debugger.resume()

    return during


@pytest.mark.parametrize("name", PROJECTS)
@pytest.mark.parametrize("seed", range(3))
def test_pauses_at_random_moments_change_nothing(name: str, seed: int) -> None:
    project, seconds = PROJECTS[name]
    plain = observed(project, seconds)
    paused = observed(project, seconds, pauses_at_random(seed, 60, seconds))
    assert plain.lines or plain.frames
    assert paused.lines == plain.lines
    assert paused.frames == plain.frames


def test_a_run_without_generated_code_is_paused_the_same_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("JACAROS_PLAIN", "1")
    project, seconds = PROJECTS["cleaning"]
    assert (
        observed(project, seconds, pauses_at_random(4, 60, seconds)).lines == observed(project, seconds).lines
    )


def breakpoints_at_random(seed: int, stops: list[str]):
    """Set and remove breakpoints on lines at random, and pause for a while at each."""

    async def during(mas: Mas, found: Observed) -> None:
        random, debugger = Random(seed), mas.debugger
        plans = [plan for agent in mas.agents for plan in agent.mind.library.plans]
        places = sorted(
            {(plan.file, line) for plan in plans for line in lines_that_stop(plan) if plan.file[0] != "$"}
        )
        ended = asyncio.ensure_future(mas.ended())
        while not ended.done():
            for file, line in random.sample(places, min(8, len(places))):
                debugger.add_breakpoint(LineBreakpoint(file, line))
            if random.random() < 0.5:
                debugger.add_breakpoint(
                    {"event": random.choice(["+battery(_)", "+!patrol(_)", "+!visit(_)"])}
                )
            paused = asyncio.ensure_future(debugger.wait_until_paused())
            await asyncio.wait({paused, ended}, return_when=asyncio.FIRST_COMPLETED)
            paused.cancel()
            stops.append(debugger.state.why)
            for _ in range(random.randrange(10)):
                await asyncio.sleep(0)
            for each in debugger.breakpoints:
                if random.random() < 0.3:
                    debugger.remove_breakpoint(each)
            debugger.resume()

    return during


@pytest.mark.parametrize("name", ["patrol", "cleaning"])
@pytest.mark.parametrize("seed", range(3))
def test_breakpoints_at_random_change_nothing(name: str, seed: int) -> None:
    project, seconds = PROJECTS[name]
    plain = observed(project, seconds)
    stops: list[str] = []
    stopped = observed(project, seconds, breakpoints_at_random(seed, stops))
    assert plain.lines
    assert len({why for why in stops if why}) >= 3, "at several places"
    assert stopped.lines == plain.lines
    assert stopped.frames == plain.frames


@pytest.mark.parametrize("what", ["cycle", "step", "event"])
@pytest.mark.parametrize("name", ["patrol", "three robots"])
def test_a_run_that_is_stepped_does_the_same(name: str, what: str) -> None:
    project, seconds = PROJECTS[name][0], 4.0
    stops = []

    async def during(mas: Mas, found: Observed) -> None:
        debugger = mas.debugger
        debugger.listen(lambda state: stops.append(state.agent) if state.state == "paused" else None)
        ended = asyncio.ensure_future(mas.ended())
        while not ended.done():
            debugger.step(what)  # type: ignore[arg-type]
            paused = asyncio.ensure_future(debugger.wait_until_paused())
            await asyncio.wait({paused, ended}, return_when=asyncio.FIRST_COMPLETED)
            paused.cancel()

    stepped = observed(project, seconds, during)
    plain = observed(project, seconds)
    assert len(stops) > 10
    assert stepped.lines == plain.lines
    assert stepped.frames == plain.frames
