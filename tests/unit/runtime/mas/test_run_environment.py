"""Projects with an environment: declarations are created, joined and focused before agents begin."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.testing import RunResult

ARTIFACTS = """
from jacaros.artifacts import Artifact, operation

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


@pytest.fixture(autouse=True)
def folder(tmp_path: Path) -> Path:
    (tmp_path / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    return tmp_path


Ran = Callable[..., RunResult]


def test_declarations_of_a_jcm_file_exist_when_agents_begin(ran: Ran) -> None:
    result = ran(
        p_jcm="""mas p {
            agent ann: a.asl { goals: go  focus: lab.c2 }
            workspace lab { artifact c1: Counter(5)  artifact c2: Counter(7)  artifact c0: Counter() }
        }""",
        a_asl="""+!go <- ?count(X); .print(X); ?joinedWsp(_, lab, P); .print(P); ?focusing(_, N, T, _, W, _);
                .print(N, T, W); inc[artifact_name(c2)]; ?count(Y); .print(Y); .stopMAS.""",
    )
    assert result.of("ann") == ["7", "/main/lab", "c2Counterlab", "8"]
    made = [line for line in result.errors if "made" in line]
    assert made == [f"[{name}] made {name}" for name in ("c1", "c2", "c0")]


def test_focused_artifacts_are_perceived_before_goals(ran: Ran) -> None:
    result = ran(
        p_jcm="""mas p {
            agent ann: a.asl { beliefs: known(3)  goals: go  focus: lab.c }
            workspace lab { artifact c: Counter(5) }
        }""",
        a_asl="""!own.
        +!own <- .print(own). +!go <- .print(go); .stopMAS.
        +count(X) : known(Y) <- .print(X, Y).""",
    )
    assert result.of("ann")[0] == "53"


def test_an_error_in_the_artifacts_is_reported_before_anything_runs(folder: Path, ran: Ran) -> None:
    (folder / "artifacts.py").write_text("import nothing_of_this_name", encoding="utf-8")
    result = ran(p_mas2j=JACA.format("a;"), a_asl="!go. +!go <- .print(hi).")
    assert result.exit_code == 1
    assert result.lines == []
    assert "artifacts.py:1" in result.errors[-1]


JACA = "MAS p {{ environment: jaca.CartagoEnvironment agents: {} }}"


def test_an_agent_made_later_has_a_body_too(ran: Ran) -> None:
    result = ran(
        p_mas2j=JACA.format("a;"),
        a_asl='!go. +!go <- makeArtifact("c", "Counter"); .create_agent(b); .wait(100); .stopMAS.',
        b_asl='!go. +!go <- lookupArtifact("c", C); focus(C); inc; ?count(X); .print(X).',
    )
    assert result.lines == ["[b] 1"]


def test_a_killed_agent_stops_focusing(ran: Ran) -> None:
    result = ran(
        p_mas2j=JACA.format("a; b;"),
        a_asl='!go. +!go <- makeArtifact("c", "Counter"); .wait(100); .kill_agent(b); inc; .wait(50); .stopMAS.',
        b_asl="!go. +!go <- focusWhenAvailable(c). +count(X) <- .print(X).",
    )
    assert result.lines == ["[b] 0"]


def test_a_running_operation_keeps_the_run_alive(ran: Ran) -> None:
    assert ran('!go. +!go <- in("never"); .print(late).', seconds=5).seconds == pytest.approx(5)


def test_lines_printed_by_the_console_artifact_are_output(ran: Ran) -> None:
    assert ran('!go. +!go <- println("X: ", 3, b).').lines == ["[a] X: 3b"]


def test_artifacts_draw_from_the_seed(ran: Ran) -> None:
    program = '!go. +!go <- makeArtifact("c", "Counter", [], C); focus(C); draw; ?drawn(X); .print(X).'
    one, same, other = [ran(program, seed=seed).lines for seed in (1, 1, 2)]
    assert one == same
    assert one != other
    assert one


def test_a_program_without_actions_needs_no_environment(folder: Path, ran: Ran) -> None:
    (folder / "artifacts.py").unlink()
    environments: list[object] = []
    ran("!go. +!go <- .print(hi).", when_started=lambda mas: environments.append(mas.environment))
    assert environments == [None]


def test_an_artifact_that_an_agent_makes_later_is_focused_then(ran: Ran) -> None:
    result = ran(
        p_jcm="""mas p { agent ann: a.asl { focus: lab.late }  agent bob: b.asl { join: lab }  workspace lab }""",
        a_asl="+count(X)[artifact_name(late)] <- .print(X); .stopMAS.",
        b_asl='!go. +!go <- .wait(10); makeArtifact("late", "Counter", [4]).',
    )
    assert result.lines == ["[ann] 4"]
    assert "is not declared in workspace `lab`" in result.errors[0]


def test_a_killed_agent_does_not_focus_later_artifacts(ran: Ran) -> None:
    result = ran(
        p_jcm="""mas p { agent ann: a.asl { focus: lab.late }  agent bob: b.asl { join: lab }  workspace lab }""",
        a_asl="+count(X) <- .print(X).",
        b_asl='!go. +!go <- .kill_agent(ann); makeArtifact("late", "Counter", [4]); .wait(10); .stopMAS.',
    )
    assert result.lines == []
    assert result.exit_code == 0


def refused(ran: Ran, *artifacts: str) -> RunResult:
    """Run a project with these artifacts on its lines from 4 on; it refuses them."""
    declared = "\n".join(f"                artifact {each}" for each in artifacts)
    project = f"mas p {{\n    agent ann: a.asl\n    workspace lab {{\n{declared}\n    }}\n}}\n"
    result = ran(p_jcm=project, a_asl="!go. +!go <- .print(hi).")
    assert result.exit_code == 1
    assert result.lines == []
    return result


def test_all_unknown_types_are_reported_before_anything_is_created(ran: Ran) -> None:
    (text,) = refused(ran, "c: Counter(1)", "d: Count(-1)", "e: q.Zz").errors
    assert "p.jcm:5:29: error" in text
    assert "did you mean `Counter`?" in text
    assert "p.jcm:6:29: error" in text
    assert "  = help: write `class Zz(Artifact)` in q.py or artifacts.py beside the project file" in text
    assert "made c" not in text


def test_all_failed_creations_are_reported_with_their_location(ran: Ran) -> None:
    text = refused(ran, "c: Counter(-1)", "d: Counter(1, 2)").errors[-1]
    assert "p.jcm:4:26: error: cannot create artifact c (Counter): negative" in text
    assert "p.jcm:5:26: error: cannot create artifact d (Counter): expected" in text


def test_strings_become_numbers_where_the_type_expects_numbers(folder: Path, ran: Ran) -> None:
    (folder / "artifacts.py").write_text(
        """
from jacaros.artifacts import Artifact

class Taken(Artifact):
    def init(self, text: str, number: int, real: float, truth: bool, anything):
        self.define_property("taken", text, number, real, truth, anything)
""",
        encoding="utf-8",
    )
    assert ran(
        p_jcm="""mas p {
            agent ann: a.asl { focus: w.a, w.b }
            workspace w {
                artifact a: Taken("1", "2", "3.5", "true", "4")
                artifact b: Taken("x", -5, 6, false, [a, "b", p(-1)])
            }
        }""",
        a_asl="""!go.
        +!go <- for (taken(T,N,R,B,A)[artifact_name(W)]) { .print([W,T,N,R,B,A]) }; .stopMAS.""",
    ).of("ann") == ['[b,"x",-5,6,false,[a,"b",p(-1)]]', '[a,"1",2,3.5,true,"4"]']


def test_artifacts_of_the_project_have_no_creator(ran: Ran) -> None:
    assert ran(
        p_jcm="""mas p {
            agent ann: a.asl { focus: lab.one }
            workspace lab { artifact zero: Counter(0)  artifact one: Counter(10) }
        }""",
        a_asl="""!go.
        +!go <- inc; ?count(X); .print(X); makeArtifact("mine", "Counter", [100], M); inc;
                lookupArtifact("mine", Id); focus(Id); .findall(C, count(C), L); .print(L); .stopMAS.""",
    ).of("ann") == ["11", "[101,11]"]


def test_agents_with_plans_for_jacamos_own_goals_run(ran: Ran) -> None:
    assert ran(
        p_jcm="""mas p { agent ann: a.asl { focus: lab.c  goals: go }  workspace lab { artifact c: Counter(5) } }""",
        a_asl="""+!jcm::focus_env_art(Art, Delay) <- .print("never asked").
        +!go : count(X) <- .print(X); .stopMAS.""",
    ).lines == ["[ann] 5"]


def test_workspaces_with_the_same_name_are_distinguished_by_path(ran: Ran) -> None:
    result = ran(
        p_jcm="""mas p {
            agent ann: a.asl { focus: house/kitchen.lamp, in::hotel/kitchen.lamp }
            workspace hotel/kitchen { artifact lamp: Counter(1) }
            workspace kitchen { parent: house  artifact lamp: Counter(2) }
            workspace house
        }""",
        a_asl="""!go.
        +!go : count(X) & in::count(Y) <- .print(X, Y);
            .findall(P, joinedWsp(_, _, P), L); .print(L); .stopMAS.""",
    )
    assert result.errors == ["[lamp] made lamp", "[lamp] made lamp"]
    assert result.of("ann") == ["21", '["/main/hotel/kitchen","/main/house/kitchen","/main"]']


def test_standard_artifacts_can_be_focused_from_the_start(folder: Path, ran: Ran) -> None:
    (folder / "artifacts.py").unlink()
    result = ran(
        p_jcm="mas p {\n agent ann: a.asl { join: main  focus: main.workspace }\n}",
        a_asl="!go. +!go : focusing(_, Name, _, _, W, _) <- .print(Name, W); .stopMAS.",
    )
    assert (result.lines, result.errors) == (["[ann] workspacemain"], [])
