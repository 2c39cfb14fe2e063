"""Artifacts are created and disposed, properties change, agents focus and stop: the number of objects stays constant."""

import gc
from pathlib import Path
from typing import Any

import pytest

from jacaros.agents.mind.state.act import Percept
from jacaros.agents.terms.values import Reference
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.property import ObservableProperty
from jacaros.artifacts.kernel.steps import Steps
from jacaros.testing import run_project

ARTIFACTS = """
from jacaros.artifacts import Artifact, operation

class Lamp(Artifact):
    def init(self, number: int = 0) -> None:
        self.define_property("lit", number)

    @operation
    def switch(self, number: int) -> None:
        self.update_property("lit", number)
"""
COMES_AND_GOES = """
!go(COUNT).
+!go(0) <- .wait(1000).
+!go(N) <-
    makeArtifact("lamp", "Lamp", [N], Id);
    focus(Id);
    switch(N + 1)[artifact_id(Id)];
    TEST
    disposeArtifact(Id);
    !go(N - 1).
"""
CHANGES = """
!begin.
+!begin <- makeArtifact("lamp", "Lamp", [], Id); focus(Id); !go(COUNT).
+!go(0) <- .wait(1000).
+!go(N) <- switch(N); !go(N - 1).
+lit(N) : N mod 2 = 0 <- -+seen(N).
"""
KINDS = (ArtifactId, Steps, ObservableProperty, Percept, Reference)


def kept(folder: Path, program: str, count: int) -> tuple[dict[str, int], dict[str, int]]:
    """How many objects there are, and entries in what lives as long as the run, when the program waits at its end."""
    files = {
        "artifacts.py": ARTIFACTS,
        "agent.asl": program.replace("COUNT", str(count)),
        "run.mas2j": "MAS run { environment: jacaros.Environment agents: agent agent.asl; }",
    }
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    gc.collect()
    before = objects()
    found: list[tuple[dict[str, int], dict[str, int]]] = []

    def look(system: Any) -> None:
        gc.collect()
        there = objects()
        host = system.directory.find("agent")
        surroundings = system.run_environment()
        entries = {
            "references": len(surroundings._writer.references._kept),
            "annotations": len(surroundings._writer._annotations),
            "held percepts": len(host.mind.beliefs.held_percepts),
            "beliefs": sum(map(len, host.mind.beliefs.values())),
            "pending": len(host.body.pending),
            "intentions": len(host.mind.alive),
        }
        found.append(({kind: there[kind] - before[kind] for kind in there}, entries))

    def started(system: Any) -> None:
        system.clock.call_later(0.9, lambda: look(system))

    result = run_project(folder / "run.mas2j", when_started=started, seconds=1.0)
    assert result.errors == []
    return found[0]


def objects() -> dict[str, int]:
    counts = dict.fromkeys((kind.__name__ for kind in KINDS), 0)
    for each in gc.get_objects():
        if type(each) in KINDS:
            counts[type(each).__name__] += 1
    return counts


FOCUSES = "stopFocus(Id); focus(Id); stopFocus(Id);"


@pytest.mark.parametrize(
    ("program", "many"),
    [
        (COMES_AND_GOES.replace("TEST", "?lit(_);"), 520),
        (CHANGES, 2020),
        (COMES_AND_GOES.replace("TEST", FOCUSES), 520),
    ],
    ids=["created and disposed artifacts", "updates", "focusing and stopping"],
)
def test_a_long_run_leaves_nothing_behind(tmp_path: Path, program: str, many: int) -> None:
    """A long run keeps as much as a short one; what earlier tests have left may go meanwhile."""
    objects_of_few, entries_of_few = kept(tmp_path, program, 20)
    objects_of_many, entries_of_many = kept(tmp_path, program, many)
    assert entries_of_many == entries_of_few
    for kind, number in objects_of_many.items():
        assert number - max(objects_of_few[kind], 0) < (many - 20) / 10, kind
