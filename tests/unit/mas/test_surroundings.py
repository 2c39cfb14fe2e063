"""Projects with an environment: what they declare is made, joined and focused before agents begin."""

from pathlib import Path

import pytest

from jacaros.testing import run_project

ARTIFACTS = """
from jacaros.env import Artifact, operation

class Counter(Artifact):
    made = []

    def init(self, start=0):
        if start < 0:
            self.fail("negative")
        self.define_property("count", start)
        self.log(f"made {self.name}")

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 1)

    @operation
    def draw(self):
        self.define_property("drawn", self.resources["random"].random())
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    return tmp_path


def write(folder: Path, **files: str) -> Path:
    paths = []
    for name, text in files.items():
        stem, _, suffix = name.rpartition("_")
        path = folder / f"{stem}.{suffix}"
        path.write_text(text, encoding="utf-8")
        paths.append(path)
    return paths[0]


def test_what_a_jcm_file_declares_is_there_when_agents_begin(folder: Path) -> None:
    file = write(
        folder,
        p_jcm="""
        mas p {
            agent ann: a.asl {
                goals: go
                focus: lab.c2
            }
            workspace lab {
                artifact c1: Counter(5)
                artifact c2: Counter(7)
                artifact c0: Counter()
            }
        }
        """,
        a_asl="""
        +!go <- ?count(X); .print(X); ?joinedWsp(_, lab, P); .print(P); ?focusing(_, N, T, _, W, _); .print(N, T, W);
                inc[artifact_name(c2)]; ?count(Y); .print(Y); .stopMAS.
        """,
    )
    result = run_project(file)
    assert result.of("ann") == ["7", "/main/lab", "c2Counterlab", "8"]
    assert [line for line in result.errors if "made" in line] == [
        "[c1] made c1",
        "[c2] made c2",
        "[c0] made c0",
    ]


def test_what_an_agent_focuses_is_noticed_before_its_goals(folder: Path) -> None:
    file = write(
        folder,
        p_jcm="""
        mas p {
            agent ann: a.asl {
                beliefs: known(3)
                goals: go
                focus: lab.c
            }
            workspace lab {
                artifact c: Counter(5)
            }
        }
        """,
        a_asl="""
        !own.
        +!own <- .print(own). +!go <- .print(go); .stopMAS.
        +count(X) : known(Y) <- .print(X, Y).
        """,
    )
    assert run_project(file).of("ann")[0] == "53"


def test_an_artifact_that_cannot_be_made_ends_the_run_at_its_place(folder: Path) -> None:
    file = write(
        folder,
        p_jcm="""
        mas p {
            agent ann: a.asl
            workspace lab {
                artifact c: Counter(-1)
            }
        }
        """,
        a_asl="!go. +!go <- .print(hi).",
    )
    result = run_project(file)
    assert result.exit_code == 1
    assert result.lines == []
    assert "p.jcm:5" in result.errors[-1]
    assert "negative" in result.errors[-1]


def test_a_mistake_in_the_artifacts_is_told_before_anything_runs(folder: Path) -> None:
    (folder / "artifacts.py").write_text("import nothing_of_this_name", encoding="utf-8")
    file = write(
        folder,
        p_mas2j="MAS p { environment: jaca.CartagoEnvironment agents: a; }",
        a_asl="!go. +!go <- .print(hi).",
    )
    result = run_project(file)
    assert result.exit_code == 1
    assert result.lines == []
    assert "artifacts.py:1" in result.errors[-1]


def test_an_agent_made_later_has_a_body_too(folder: Path) -> None:
    file = write(
        folder,
        p_mas2j="MAS p { environment: jaca.CartagoEnvironment agents: a; }",
        a_asl='!go. +!go <- makeArtifact("c", "Counter"); .create_agent(b); .wait(100); .stopMAS.',
        b_asl='!go. +!go <- lookupArtifact("c", C); focus(C); inc; ?count(X); .print(X).',
    )
    assert run_project(file).lines == ["[b] 1"]


def test_a_killed_agent_gives_up_what_it_focuses(folder: Path) -> None:
    file = write(
        folder,
        p_mas2j="MAS p { environment: jaca.CartagoEnvironment agents: a; b; }",
        a_asl='!go. +!go <- makeArtifact("c", "Counter"); .wait(100); .kill_agent(b); inc; .wait(50); .stopMAS.',
        b_asl="!go. +!go <- focusWhenAvailable(c). +count(X) <- .print(X).",
    )
    assert run_project(file).lines == ["[b] 0"]


def test_an_operation_under_way_keeps_the_run_alive(folder: Path) -> None:
    file = write(folder, a_asl='!go. +!go <- in("never"); .print(late).')
    assert run_project(file, until_idle=True, seconds=5).seconds == pytest.approx(5)


def test_what_is_printed_through_the_console_is_output(folder: Path) -> None:
    file = write(folder, a_asl='!go. +!go <- println("X: ", 3, b).')
    assert run_project(file, until_idle=True).lines == ["[a] X: 3b"]


def test_artifacts_draw_from_the_seed(folder: Path) -> None:
    file = write(
        folder,
        a_asl='!go. +!go <- makeArtifact("c", "Counter", [], C); focus(C); draw; ?drawn(X); .print(X).',
    )
    one, same, other = [run_project(file, seed=s, until_idle=True).lines for s in (1, 1, 2)]
    assert one == same
    assert one != other
    assert one


def test_a_program_without_actions_needs_no_environment(folder: Path) -> None:
    (folder / "artifacts.py").unlink()
    file = write(folder, a_asl="!go. +!go <- .print(hi).")
    environments: list[object] = []
    run_project(file, until_idle=True, when_started=lambda mas: environments.append(mas.environment))
    assert environments == [None]
