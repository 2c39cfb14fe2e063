"""The clock, the barrier and the latch."""

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


class Watcher:
    """Notes what an artifact publishes."""

    agent = "watcher"

    def __init__(self) -> None:
        self.seen: list[object] = []

    def observe(self, observation: Observation) -> None:
        self.seen += [signal.name for signal in observation.signals]
        self.seen += [new.values[0] for _, new in observation.changed]
        self.seen += [new.values[0] for new in observation.added]

    def __hash__(self) -> int:
        return id(self)


class Bench:
    """One artifact and who uses it."""

    def __init__(self, environment: Environment, artifact: ArtifactId) -> None:
        self.environment, self.artifact = environment, artifact
        self.ended: list[str] = []
        self.failed: list[object] = []

    def call(self, agent: str, operation: str, *arguments: object) -> None:
        def done(outcome: OperationOutcome) -> None:
            self.ended.append(f"{agent} {operation}")
            if not outcome.ok:
                self.failed.append(outcome.reason)

        request = OperationRequest(self.artifact, operation, arguments, agent, None, done)
        self.environment.execute(request)


def on_a_bench(artifact_type: type[Artifact], *arguments: object):
    """Run a test ``async def test(bench, clock)`` with an artifact, on virtual time."""

    def decorate(test):
        def wrapper() -> None:
            clock = VirtualClock()

            async def main() -> None:
                environment = Environment(clock)
                main = environment.workspace("/main")
                artifact = await main.make_artifact("it", artifact_type, arguments)
                await test(Bench(environment, artifact), clock)
                await environment.close()

            run(main, clock)

        wrapper.__name__ = test.__name__
        return wrapper

    return decorate


@on_a_bench(Clock)
async def test_a_clock_ticks_at_its_start_and_after_each_length(bench: Bench, clock: VirtualClock) -> None:
    watcher = Watcher()
    bench.environment.workspace("/main").focus(bench.artifact, watcher)
    bench.call("a", "start")
    await clock.sleep(0.025)
    bench.call("a", "stop")
    await clock.sleep(1)
    assert watcher.seen == [0, "tick", 10, "tick", 20, "tick", 30]


@on_a_bench(Clock)
async def test_a_clock_that_is_started_twice_ticks_once(bench: Bench, clock: VirtualClock) -> None:
    watcher = Watcher()
    bench.environment.workspace("/main").focus(bench.artifact, watcher)
    bench.call("a", "setFrequency", 10)
    bench.call("a", "start")
    bench.call("b", "start")
    await clock.sleep(0.05)
    bench.call("a", "stop")
    bench.call("a", "start")
    await clock.sleep(0.12)
    assert watcher.seen == [0, "tick", 100, "tick", 200, "tick", 300]


@on_a_bench(Clock)
async def test_a_clock_needs_a_frequency_that_it_can_tick_at(bench: Bench, clock: VirtualClock) -> None:
    for hertz in (0, 1001):
        bench.call("a", "setFrequency", hertz)
    bench.call("a", "setFrequency", 0.5)
    assert [str(reason) for reason in bench.failed[:2]] == ["wrong_frequency(0)", "wrong_frequency(1001)"]
    assert str(bench.failed[2]).startswith("wrong_op_arguments(")


@on_a_bench(Barrier, 3)
async def test_a_barrier_blocks_until_all_participants_have_hit_it(bench: Bench, clock: VirtualClock) -> None:
    for agent in ("a", "b"):
        bench.call(agent, "hit")
        bench.call(agent, "waitForAll")
    assert bench.ended == ["a hit", "b hit"]
    bench.call("c", "hit")
    bench.call("c", "waitForAll")
    assert sorted(bench.ended) == ["a hit", "a waitForAll", "b hit", "b waitForAll", "c hit", "c waitForAll"]


@on_a_bench(Barrier, 2)
async def test_a_barrier_starts_again(bench: Bench, clock: VirtualClock) -> None:
    for agent in ("a", "b"):
        bench.call(agent, "hit")
    # Before b has noticed that the first round is over, a is in the second.
    bench.call("a", "waitForAll")
    bench.call("a", "hit")
    bench.call("a", "waitForAll")
    bench.call("b", "waitForAll")
    assert bench.ended == ["a hit", "b hit", "a waitForAll", "a hit", "b waitForAll"]
    bench.call("b", "hit")
    assert bench.ended[5:] == ["a waitForAll", "b hit"] or bench.ended[5:] == ["b hit", "a waitForAll"]


@on_a_bench(Barrier, 2)
async def test_an_agent_that_only_waits_passes_once_per_round(bench: Bench, clock: VirtualClock) -> None:
    for agent in ("a", "b"):
        bench.call(agent, "hit")
    bench.call("observer", "waitForAll")
    bench.call("observer", "waitForAll")
    assert bench.ended.count("observer waitForAll") == 1
    for agent in ("a", "b"):
        bench.call(agent, "hit")
    assert bench.ended.count("observer waitForAll") == 2


@on_a_bench(Latch)
async def test_a_set_latch_blocks_no_agent(bench: Bench, clock: VirtualClock) -> None:
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
