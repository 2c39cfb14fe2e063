"""Nodes of one project as members of a fleet: agents join the workspaces of the others when they appear."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from queues import SimulatedNetwork

import jacaros
from jacaros import Mas
from jacaros.fleet.joining import joining
from jacaros.runtime.clock import clock_of
from jacaros.runtime.mas.launch import load_deployment
from jacaros.runtime.mas.project.nodes import at_node

HOUSE = """
mas house {
  agent bob { node: robot  focus: lab.counter@base, main.door }
  workspace main { artifact door : Door }
  workspace lab { node: base  artifact counter : Counter(5) { focused-by: bob } }
  node base
  node robot
}
"""
BOB = """
+count(N) : N < 7 <- .print("count ", N); inc.
+count(N) <- .print("enough").
-count(7) <- .print(lost).
+open(X) <- .print(open(X)).
"""
ARTIFACTS = """
from jacaros.artifacts import Artifact, operation

class Door(Artifact):
    def init(self):
        self.define_property("open", 1)

class Counter(Artifact):
    def init(self, start):
        self.define_property("count", start)

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 1)
"""


class House:
    """A project whose nodes run in one process, over a simulated network."""

    def __init__(self, file: Path) -> None:
        self.network = SimulatedNetwork(clock_of(asyncio.get_running_loop()))
        self.lines: list[str] = []
        self._deployment = load_deployment(file)

    def node(self, name: str) -> Mas:
        """Return one node. Its agents print into *lines*."""
        join = joining(self.network.carrier(), name)
        return Mas(
            at_node(self._deployment, name), join=join, on_print=self._print, on_log=lambda text, level: None
        )

    def _print(self, agent: str, text: str) -> None:
        self.lines.append(text)

    def printed(self) -> list[str]:
        """Return what has been printed since the last call, sorted."""
        lines, self.lines = self.lines, []
        return sorted(lines)


Scene = Callable[[House], Awaitable[None]]
BEFORE = ["count 5", "count 6", "enough", "open(1)"]


@pytest.fixture
def play(tmp_path: Path) -> Callable[[Scene], None]:
    for name, text in (("house.jcm", HOUSE), ("bob.asl", BOB), ("artifacts.py", ARTIFACTS)):
        (tmp_path / name).write_text(text, encoding="utf-8")

    def play(scene: Scene) -> None:
        async def main() -> None:
            await scene(House(tmp_path / "house.jcm"))

        jacaros.run(main(), clock="fast")

    return play


def test_an_agent_uses_the_artifacts_of_a_node_that_starts_later(play: Callable[[Scene], None]) -> None:
    async def scene(house: House) -> None:
        async with house.node("robot") as robot:
            await robot.sleep(1)
            assert house.printed() == []
            async with house.node("base"):
                await robot.sleep(1)
                assert house.printed() == BEFORE
            await robot.sleep(5)
            assert house.printed() == ["lost"]

    play(scene)


def test_an_agent_uses_a_node_that_has_restarted(play: Callable[[Scene], None]) -> None:
    async def scene(house: House) -> None:
        async with house.node("robot") as robot:
            for _ in range(2):
                async with house.node("base"):
                    await robot.sleep(5)
                    assert house.printed() == BEFORE
                await robot.sleep(5)
                assert house.printed() == ["lost"]

    play(scene)


def test_an_agent_focuses_again_after_a_cut(play: Callable[[Scene], None]) -> None:
    async def scene(house: House) -> None:
        async with house.node("base") as base, house.node("robot"):
            await base.sleep(1)
            assert house.printed() == BEFORE
            house.network.cut("base", "robot")
            await base.sleep(20)
            assert house.printed() == ["lost"]
            house.network.heal("base", "robot")
            await base.sleep(5)
            assert house.printed() == ["enough", "open(1)"]

    play(scene)
