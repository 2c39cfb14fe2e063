"""Two nodes of one project that are joined by a queue: agents join the workspaces of the other one when they appear."""

from pathlib import Path

import pytest
from loopback import join, share

import jacaros
from jacaros import Mas
from jacaros.runtime.mas.launch import load_deployment
from jacaros.runtime.mas.project.nodes import at_node

HOUSE = """
mas house {
  agent bob { node: robot  goals: work  focus: lab.counter@base, main.door }
  workspace main { artifact door : Door }
  workspace lab { node: base  artifact counter : Counter(5) { focused-by: bob } }
  node base
  node robot
}
"""
BOB = """
+!work <- .wait("+count(5)"); inc; ?count(N); ?joinedWsp(_, lab, Path); .print(N, " ", Path).
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


@pytest.fixture
def house(tmp_path: Path) -> Path:
    for name, text in (("house.jcm", HOUSE), ("bob.asl", BOB), ("artifacts.py", ARTIFACTS)):
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path / "house.jcm"


def test_an_agent_uses_the_artifacts_of_another_node(house: Path) -> None:
    deployment = load_deployment(house)
    lines: list[str] = []

    async def scene() -> None:
        async with (
            Mas(at_node(deployment, "base"), on_log=lambda text, _: lines.append(text)) as base,
            Mas(at_node(deployment, "robot"), on_print=lambda _, text: lines.append(text)) as robot,
        ):
            await robot.sleep(1)
            assert lines == []
            served, client = join(base.system, robot.system)
            share(served, client, "/main", "/main@base")
            share(served, client, "/main/lab")
            await robot.sleep(1)
            await robot.until_idle(timeout=10)

    jacaros.run(scene(), clock="fast")
    assert sorted(lines) == ["6 /main/lab", "open(1)"]
