"""A simulated week with a fault each day: the memory of a member does not grow."""

import asyncio
import gc
import tracemalloc
from collections import deque
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

import pytest
from queues import SimulatedNetwork

import jacaros
from jacaros import Mas
from jacaros.artifacts import Artifact, operation
from jacaros.fleet import member
from jacaros.fleet.joining import joining
from jacaros.fleet.member import Member
from jacaros.runtime.clock import clock_of

DAY = 86_400.0
GROWTH = 40_000
"""Bytes that may be more after the second half of the week: caches of the interpreter."""

ANN = """
weather(fine).
+!day(N)
  <- .send("bob@there", tell, day(N)); .send("bob@there", untell, day(N));
     .send("bob@there", askOne, weather(_), W, 5000);
     .df_register("mop"); .wait(1000); .df_deregister("mop").
-!day(N).
+!ask <- .send("bob@there", askOne, silence, _, 100).
-!ask.
"""
BOB = """
weather(fine).
+?silence <- .wait(30000000).
+!day
  <- joinWorkspace("/main/lab", W); lookupArtifact("counter", Id); focus(Id); inc;
     makeArtifact("box", "Counter", [], Box); focus(Box); disposeArtifact(Box); stopFocus(Id).
-!day.
+!wait <- await.
-!wait.
"""


class Counter(Artifact):
    """Counts."""

    def init(self) -> None:
        self.define_property("count", 0)

    @operation
    def inc(self) -> None:
        self.update_property("count", self.value("count") + 1)

    @operation(name="await")
    async def wait_long(self) -> None:
        await self.sleep(DAY / 2)


class Week:
    """Two members and their days. One of them may be restarted."""

    def __init__(self) -> None:
        self.network = SimulatedNetwork(clock_of(asyncio.get_running_loop()))
        self.members: dict[str, Member] = {}
        self.here = self._mas("here")
        self.there = self._mas("there")
        self._programs = {"here": ("ann", ANN), "there": ("bob", BOB)}
        self.agents: dict[str, Any] = {}

    def _mas(self, name: str) -> Mas:
        def joined(each: Member) -> None:
            self.members[name] = each

        join = joining(self.network.carrier(), name, silence=300.0, joined=joined)
        return Mas(name=name, join=join, on_log=lambda line, level: None)

    async def begin(self, mas: Mas, name: str) -> None:
        """Start a member and its agent."""
        await mas.__aenter__()
        agent, program = self._programs[name]
        self.agents[agent] = mas.add_agent(agent, program)

    async def day(self, number: int, fault: Callable[["Week"], Awaitable[None]]) -> None:
        """Let all agents work, then something fail, and go on until the next day."""
        begin = self.here.clock.elapsed
        for goal in (f"day({number})", "ask"):
            self.agents["ann"].achieve(goal)
        for goal in ("day", "wait"):
            self.agents["bob"].achieve(goal)
        await self.here.sleep(60)
        self.agents["ann"].achieve("ask")
        await fault(self)
        await self.here.sleep(begin + DAY - self.here.clock.elapsed)


async def cut(week: Week) -> None:
    """Cut the link for an hour, while both try to go on."""
    week.network.cut("here", "there")
    week.agents["ann"].achieve("day(0)")
    await week.here.sleep(3600)
    week.agents["bob"].achieve("day")
    week.network.heal("here", "there")


async def restart(week: Week) -> None:
    """Kill the other member, and start it again."""
    for _ in range(3):
        week.network.kill("there")
        await week.there.__aexit__(None, None, None)
        week.there = week._mas("there")
        await week.begin(week.there, "there")
        await week.here.sleep(900)


def _entries(part: object, seen: set[int]) -> Iterator[int]:
    """Return how many entries everything has that a part of the fleet keeps."""
    if id(part) in seen:
        return
    seen.add(id(part))
    kept: list[Any] = []
    if isinstance(part, dict):
        kept = [*part, *part.values()]
    elif isinstance(part, (list, tuple, set, deque)):
        kept = [*part]
    elif type(part).__module__.startswith("jacaros.fleet"):
        kept = list(getattr(part, "__dict__", {}).values())
    yield len(kept)
    for each in kept:
        yield from _entries(each, seen)


@pytest.mark.slow
@pytest.mark.parametrize("fault", [cut, restart])
def test_memory_is_flat(fault: Callable[[Week], Awaitable[None]], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(member, "PING", 60.0)  # a week has a million otherwise

    async def main() -> None:
        week = Week()
        await week.begin(week.here, "here")
        week.here.add_artifact_types(Counter)
        await week.here.make_artifact("counter", Counter, workspace=week.here.create_workspace("lab"))
        await week.begin(week.there, "there")
        sizes, entries = [], []
        for number in range(1, 8):
            await week.day(number, fault)
            gc.collect()
            sizes.append(tracemalloc.get_traced_memory()[0])
            here = week.members["here"]
            ended = id(here._departed)  # a hundred ids, which a week does not fill
            entries.append(sum(_entries(here, {ended})))
        joined = week.members["here"].peers["there"]
        assert joined.is_there
        assert joined.backlog == 0
        await week.there.__aexit__(None, None, None)
        await week.here.__aexit__(None, None, None)
        assert len(set(entries[3:])) == 1, entries
        assert sizes[-1] - sizes[3] < GROWTH, sizes

    tracemalloc.start()
    try:
        jacaros.run(main(), clock="fast")
    finally:
        tracemalloc.stop()
