"""The clock, the barrier and the latch."""

from typing import Any

import pytest

from jacaros.artifacts import (
    Artifact,
    ArtifactId,
    Environment,
    Observation,
    OperationOutcome,
    OperationRequest,
)
from jacaros.artifacts.tools import Barrier, Clock, Latch
from jacaros.robots.registry import find_type
from jacaros.runtime.clock import VirtualClock, run
from played import played


class Watcher:
    """Notes what an artifact publishes."""

    agent = "watcher"

    def __init__(self) -> None:
        self.seen: list[object] = []

    def observe(self, observation: Observation) -> None:
        self.seen += [signal.name for signal in observation.signals]
        self.seen += [new.values[0] for _, new in observation.changed]
        self.seen += [new.values[0] for new in observation.added]


class Bench:
    """One artifact, the agents that use it, and what it publishes."""

    def __init__(self, environment: Environment, artifact: ArtifactId, clock: VirtualClock) -> None:
        self.environment, self.artifact, self.clock = environment, artifact, clock
        self.ended: list[str] = []
        self.failed: list[object] = []
        self.watcher = Watcher()
        environment.workspace("/main").focus(artifact, self.watcher)

    def call(self, agents: str, operation: str, *arguments: object) -> None:
        """Each letter is the name of an agent that calls."""
        for agent in agents:
            self._call(agent, operation, arguments)

    def _call(self, agent: str, operation: str, arguments: tuple[object, ...]) -> None:
        def done(outcome: OperationOutcome) -> None:
            self.ended.append(f"{agent} {operation}")
            if not outcome.ok:
                self.failed.append(outcome.reason)

        self.environment.execute(OperationRequest(self.artifact, operation, arguments, agent, None, done))


def play(kind: type[Artifact], *arguments_and_scene: Any) -> None:
    """Run a scene with a bench."""
    *arguments, scene = arguments_and_scene
    clock = VirtualClock()

    async def main() -> None:
        environment = Environment(clock)
        artifact = await environment.workspace("/main").make_artifact("it", kind, arguments)
        await scene(Bench(environment, artifact, clock))
        await environment.close()

    run(main, clock)


@played(play, Clock)
async def test_a_clock_ticks_at_its_start_and_after_each_length(bench: Bench) -> None:
    bench.call("a", "start")
    await bench.clock.sleep(0.025)
    bench.call("a", "stop")
    await bench.clock.sleep(1)
    assert bench.watcher.seen == [0, "tick", 10, "tick", 20, "tick", 30]


@played(play, Clock)
async def test_a_clock_that_is_started_twice_ticks_once(bench: Bench) -> None:
    bench.call("a", "setFrequency", 10)
    bench.call("ab", "start")
    await bench.clock.sleep(0.05)
    bench.call("a", "stop")
    bench.call("a", "start")
    await bench.clock.sleep(0.12)
    assert bench.watcher.seen == [0, "tick", 100, "tick", 200, "tick", 300]


@played(play, Clock)
async def test_a_clock_needs_a_frequency_that_it_can_tick_at(bench: Bench) -> None:
    for hertz in (0, 1001, 0.5):
        bench.call("a", "setFrequency", hertz)
    assert [str(reason) for reason in bench.failed[:2]] == ["wrong_frequency(0)", "wrong_frequency(1001)"]
    assert str(bench.failed[2]).startswith("wrong_op_arguments(")


@played(play, Barrier, 3)
async def test_a_barrier_blocks_until_all_participants_have_hit_it(bench: Bench) -> None:
    for agent in "ab":
        bench.call(agent, "hit")
        bench.call(agent, "waitForAll")
    assert bench.ended == ["a hit", "b hit"]
    bench.call("c", "hit")
    bench.call("c", "waitForAll")
    assert sorted(bench.ended) == ["a hit", "a waitForAll", "b hit", "b waitForAll", "c hit", "c waitForAll"]


@played(play, Barrier, 2)
async def test_a_barrier_starts_again(bench: Bench) -> None:
    bench.call("ab", "hit")
    # Before b has noticed that the first round is over, a is in the second.
    bench.call("a", "waitForAll")
    bench.call("a", "hit")
    bench.call("ab", "waitForAll")
    assert bench.ended == ["a hit", "b hit", "a waitForAll", "a hit", "b waitForAll"]
    bench.call("b", "hit")
    assert bench.ended[5:] == ["a waitForAll", "b hit"] or bench.ended[5:] == ["b hit", "a waitForAll"]


@played(play, Barrier, 2)
async def test_an_agent_that_only_waits_passes_once_per_round(bench: Bench) -> None:
    bench.call("ab", "hit")
    bench.call("oo", "waitForAll")
    assert bench.ended.count("o waitForAll") == 1
    bench.call("ab", "hit")
    assert bench.ended.count("o waitForAll") == 2


@played(play, Latch)
async def test_a_set_latch_blocks_no_agent(bench: Bench) -> None:
    bench.call("a", "waitForSet")
    assert bench.ended == []
    bench.call("b", "set")
    bench.call("c", "waitForSet")
    assert sorted(bench.ended) == ["a waitForSet", "b set", "c waitForSet"]


@pytest.mark.parametrize("cls", [Clock, Barrier, Latch])
def test_tools_are_found_by_their_bare_names_and_as_in_cartago(cls: type[Artifact]) -> None:
    assert find_type(cls.__name__) is cls
    assert find_type(f"cartago.tools.{cls.__name__}") is cls


def test_the_tuple_space_is_the_blackboard() -> None:
    assert find_type("cartago.tools.TupleSpace") is find_type("Blackboard")
