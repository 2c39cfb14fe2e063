"""The scheduler: turns of the agents."""

import asyncio
import socket
from collections.abc import Callable, Coroutine
from itertools import pairwise
from typing import Any

import pytest

from jacaros.runtime.clock import VirtualClock, WallClock, run
from jacaros.runtime.errors import InternalError
from jacaros.runtime.mas.scheduler import Scheduler
from played import played


class Worker:
    """Makes a given number of cycles and notes its turns."""

    def __init__(self, name: str, cycles: int, log: list[str]) -> None:
        self.queued = False
        self.name, self.cycles, self.log = name, cycles, log

    def run(self, fuel: int) -> bool:
        self.log.append(self.name)
        self.cycles -= min(fuel, self.cycles)
        return self.cycles > 0


@pytest.fixture
def clock() -> VirtualClock:
    return VirtualClock()


@pytest.fixture
def log() -> list[str]:
    """The turns of the workers."""
    return []


@pytest.fixture
def told() -> list[object]:
    """Errors of the scheduler, and the number of turns at which it was idle."""
    return []


@pytest.fixture
def scheduler(clock: VirtualClock, log: list[str], told: list[object]) -> Scheduler:
    return Scheduler(clock, on_idle=lambda: told.append(len(log)), on_error=told.append)


@pytest.fixture(autouse=True)
def play(clock: VirtualClock) -> Callable[..., None]:
    return lambda scene: run(scene, clock)


async def test_ready_agents_take_turns_first_come_first_served(
    scheduler: Scheduler, clock: VirtualClock, log: list[str], told: list[object]
) -> None:
    for name, cycles in (("a", 120), ("b", 10), ("c", 60)):
        scheduler.make_ready(Worker(name, cycles, log))
    await clock.sleep(1)
    assert log == ["a", "b", "c", "a", "c", "a"]
    assert told == [6], "idleness is reported when the last agent is done"


async def test_an_agent_is_queued_once_and_not_after_the_stop(
    scheduler: Scheduler, clock: VirtualClock, log: list[str]
) -> None:
    worker = Worker("a", 1, log)
    scheduler.make_ready(worker)
    scheduler.make_ready(worker)
    assert not scheduler.idle
    await clock.sleep(1)
    assert scheduler.idle
    assert log == ["a"]
    scheduler.stop()
    scheduler.make_ready(worker)
    await clock.sleep(1)
    assert log == ["a"]


async def test_an_agent_that_becomes_ready_in_a_turn_queues_behind_waiting_ones(
    scheduler: Scheduler, clock: VirtualClock, log: list[str]
) -> None:
    late = Worker("late", 1, log)

    class Waker(Worker):
        def run(self, fuel: int) -> bool:
            scheduler.make_ready(late)
            scheduler.make_ready(self)
            return super().run(fuel)

    scheduler.make_ready(Waker("a", 60, log))
    scheduler.make_ready(Worker("b", 60, log))
    await clock.sleep(1)
    scheduler.stop()
    assert log[:7] == ["a", "b", "late", "a", "b", "late", "a"]


async def test_callbacks_of_the_loop_have_their_turn_among_busy_agents(scheduler: Scheduler) -> None:
    seen: list[int] = []
    endless = Worker("a", 10**6, [])
    scheduler.make_ready(endless)
    for _ in range(3):
        await asyncio.sleep(0)
        seen.append(10**6 - endless.cycles)
    scheduler.stop()
    assert seen == [Scheduler.CYCLES_PER_ROUND * turns for turns in (1, 2, 3)]


async def test_timers_and_virtual_time_advance_during_endless_cycles(
    scheduler: Scheduler, clock: VirtualClock
) -> None:
    endless = Worker("a", 10**9, [])
    scheduler.make_ready(endless)
    await clock.sleep(0.01)
    scheduler.stop()
    assert clock.elapsed == pytest.approx(0.01)
    assert 10**9 - endless.cycles >= 10 * VirtualClock.CYCLES_PER_MILLISECOND


async def test_virtual_time_advances_during_endless_short_turns(scheduler: Scheduler, clock: VirtualClock):
    class Chatter(Worker):
        def run(self, fuel: int) -> bool:
            scheduler.make_ready(self)
            return False

    scheduler.make_ready(Chatter("a", 1, []))
    await clock.sleep(0.002)
    scheduler.stop()
    assert clock.elapsed >= 0.002


async def test_what_escapes_from_an_agent_ends_all_turns(
    scheduler: Scheduler, clock: VirtualClock, log: list[str], told: list[object]
) -> None:
    class Broken(Worker):
        def run(self, fuel: int) -> bool:
            raise InternalError("broken")

    scheduler.make_ready(Broken("a", 1, []))
    scheduler.make_ready(Worker("b", 1, log))
    await clock.sleep(1)
    assert [str(e) for e in told] == ["broken"]
    assert log == []


async def test_hurry_gives_ready_agents_their_turns_immediately(
    scheduler: Scheduler, clock: VirtualClock, log: list[str], told: list[object]
) -> None:
    scheduler.hurry()
    scheduler.make_ready(Worker("a", 120, log))
    scheduler.make_ready(Worker("b", 1, log))
    scheduler.hurry()
    assert log == ["a", "b", "a", "a"]
    assert scheduler.idle
    await clock.sleep(1)
    assert told == [4], "once, in the next round"


async def test_no_agent_has_a_turn_within_the_turn_of_another(
    scheduler: Scheduler, clock: VirtualClock, log: list[str]
) -> None:
    class Hurrying(Worker):
        def run(self, fuel: int) -> bool:
            log.append("begin")
            scheduler.make_ready(Worker("other", 1, log))
            scheduler.hurry()
            log.append("end")
            return False

    scheduler.make_ready(Hurrying("a", 1, log))
    await clock.sleep(1)
    assert log == ["begin", "end", "other"]


async def test_on_the_virtual_clock_an_action_does_not_end_the_round(scheduler: Scheduler, log: list[str]):
    class Acting(Worker):
        def run(self, fuel: int) -> bool:
            scheduler.poll_soon()
            return super().run(fuel)

    scheduler.make_ready(Acting("a", 1000, log))
    await asyncio.sleep(0)
    log.append("loop")
    scheduler.stop()
    assert log == ["a"] * 20 + ["loop"]


class Bench:
    """An agent whose cycles take a given time on a fake clock, until it has had enough turns."""

    def __init__(self, seconds: float, enough: Callable[["Bench"], bool]) -> None:
        self.queued = False
        self.now, self.seconds, self.enough = 0.0, seconds, enough
        self.turns: list[tuple[float, int]] = []
        self.over = asyncio.Event()

    def run(self, fuel: int) -> bool:
        self.turns.append((self.now, fuel))
        self.now += fuel * self.seconds
        if self.enough(self):
            self.over.set()
        return not self.over.is_set()


async def have_turns(bench: Bench) -> list[float]:
    """Give an agent its turns; the moments at which the loop was free between them."""
    scheduler = Scheduler(WallClock(), real_time=lambda: bench.now)
    loop = asyncio.get_running_loop()
    free = [0.0]

    def note() -> None:
        free.append(bench.now)
        if not bench.over.is_set():
            loop.call_soon(note)

    scheduler.make_ready(bench)
    loop.call_soon(note)
    await bench.over.wait()
    scheduler.stop()
    return free


def asyncio_run(scene: Callable[[list[str]], Coroutine[Any, Any, None]]) -> None:
    """Run a scene on a plain loop, with the list of what happens in it."""
    asyncio.run(scene([]))


def bench_of(microseconds: float, turns: int) -> tuple[list[int], list[float]]:
    """The turns of an agent, and how long each round of them took."""
    bench = Bench(microseconds * 1e-6, lambda bench: len(bench.turns) >= turns)
    free = asyncio.run(have_turns(bench))
    rounds = [later - sooner for sooner, later in pairwise(free) if later > sooner]
    return [fuel for _, fuel in bench.turns], rounds


@pytest.mark.parametrize("microseconds", [1, 2, 5, 20, 100, 400])
def test_in_real_time_a_round_of_turns_is_bounded_in_time(microseconds: int) -> None:
    _, rounds = bench_of(microseconds, 400)
    assert len(rounds) > 10
    assert max(rounds[5:]) <= 0.002


def test_short_cycles_are_made_in_full_turns() -> None:
    turns, _ = bench_of(2, 50)
    assert set(turns) == {Scheduler.QUANTUM}


def test_a_cycle_longer_than_a_round_is_alone_in_it() -> None:
    turns, rounds = bench_of(10_000, 20)
    assert turns[-3:] == [1, 1, 1]
    assert rounds[-3:] == pytest.approx([0.01] * 3)


def test_after_long_cycles_turns_become_full_again() -> None:
    def has_recovered(bench: Bench) -> bool:
        fuel = bench.turns[-1][1]
        if fuel == 1:
            bench.seconds = 1e-6
        return fuel == Scheduler.QUANTUM and bench.seconds == 1e-6

    bench = Bench(0.01, has_recovered)
    asyncio.run(have_turns(bench))
    assert [fuel for _, fuel in bench.turns] == [50, 25, 12, 6, 3, 1, 1, 2, 4, 8, 16, 32, 50]


@played(asyncio_run)
async def test_sockets_are_read_before_the_next_round_of_turns(order: list[str]) -> None:
    ours, theirs = socket.socketpair()

    def make_turn(bench: Bench) -> bool:
        order.append("turn")
        if len(order) == 3:
            theirs.send(b"x")
        return len(order) == 6

    def read() -> None:
        ours.recv(1)
        order.append("message")

    with ours, theirs:
        loop = asyncio.get_running_loop()
        loop.add_reader(ours, read)
        await have_turns(Bench(1.0, make_turn))
        loop.remove_reader(ours)
    assert order == ["turn", "turn", "turn", "message", "turn", "turn"]


@played(asyncio_run)
async def test_a_message_makes_its_hops_to_the_agent_between_two_rounds(order: list[str]) -> None:
    loop = asyncio.get_running_loop()

    def hop(left: int) -> None:
        order.append("hop")
        if left > 1:
            loop.call_soon(hop, left - 1)

    def make_turn(bench: Bench) -> bool:
        order.append("turn")
        if len(order) == 1:
            loop.call_soon(hop, Scheduler.PASSES - 1)
        return order.count("turn") == 2

    await have_turns(Bench(1.0, make_turn))
    assert order == ["turn", "hop", "hop", "hop", "turn"]


@played(asyncio_run)
async def test_an_agent_that_has_begun_an_action_ends_the_round_with_its_turn(order: list[str]) -> None:
    def make_turn(bench: Bench) -> bool:
        if len(bench.turns) == 3:
            scheduler.poll_soon()
            asyncio.get_running_loop().call_soon(lambda: order.append(f"after {len(bench.turns)}"))
        return len(bench.turns) == 6

    bench = Bench(1e-9, make_turn)
    scheduler = Scheduler(WallClock(), real_time=lambda: bench.now)
    scheduler.make_ready(bench)
    await bench.over.wait()
    assert order == ["after 3"]
