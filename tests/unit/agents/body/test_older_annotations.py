"""The annotations of CArtAgO 2.0, with which the programs of the thesis tell artifacts apart."""

from pathlib import Path

import pytest

from jacaros.testing import run_project

ARTIFACTS = """
from jacaros.artifacts import Artifact, operation

class Counter(Artifact):
    def init(self):
        self.define_property("count", 0)

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 1)
        self.signal("tick")
"""
PROGRAM = """
!go.
+!go <- makeArtifact("c0", "Counter", [], A); makeArtifact("c1", "Counter", [], B); focus(A); focus(B);
        inc[artifact_id(A)]; inc[artifact_id(B)]; .wait(10); .stopMAS.
+tick[artifact_name(Id,"c0")] <- .print("the first ticks").
+tick[artifact_name(c1)] <- .print("the second ticks").
+count(1)[artifact_name(_,N),artifact_type(_,T),workspace(_,W),percept_type("obs_prop")]
  <- .print(N, " ", T, " ", W).
"""


@pytest.mark.parametrize(
    ("environment", "lines"),
    [
        (
            "c4jason.CartagoEnvironment",
            ["the first ticks", "c0 Counter main", "the second ticks", "c1 Counter main"],
        ),
        ("jaca.CartagoEnvironment", ["the second ticks"]),
    ],
)
def test_projects_of_cartago_2_have_its_annotations(
    tmp_path: Path, environment: str, lines: list[str]
) -> None:
    (tmp_path / "artifacts.py").write_text(ARTIFACTS)
    (tmp_path / "a.asl").write_text(PROGRAM)
    (tmp_path / "old.mas2j").write_text(f"MAS old {{ environment: {environment} agents: a; }}")
    result = run_project(tmp_path / "old.mas2j", seconds=10)
    assert not result.errors
    assert sorted(result.of("a")) == sorted(lines)
