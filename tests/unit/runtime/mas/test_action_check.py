"""What `jacaros check` reports about a project's artifacts and the actions of its agents."""

from pathlib import Path

import pytest

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.mas.checks.files import check_files

ARTIFACTS = """
from jacaros.artifacts import Artifact, Out, operation

class Counter(Artifact):
    def init(self, start: int = 0):
        self.define_property("count", start)

    @operation
    def inc(self, by: int = 1):
        self.update_property("count", self.value("count") + by)

class Growing(Artifact):
    def init(self):
        self.define_operation("more", lambda: None)
"""

PROJECT = """
mas p {
    agent ann: a.asl { focus: lab.c }
    workspace lab { artifact c: Counter(5) }
}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    return tmp_path


def check(folder: Path, program: str, project: str = PROJECT) -> list[Diagnostic]:
    (folder / "a.asl").write_text(program, encoding="utf-8")
    name = "p.mas2j" if project.startswith("MAS") else "p.jcm" if project else "a.asl"
    if project:
        (folder / name).write_text(project, encoding="utf-8")
    return check_files([folder / name]).diagnostics


def unknown(operation: str) -> str:
    return f"unknown operation `{operation}`: no artifact of the project has it"


INC = (unknown("inc/2"), "did you mean `inc/0` or `inc/1`?")
INCC = (unknown("incc/0"), "did you mean `inc`?")


def test_unknown_operations_are_reported(folder: Path) -> None:
    steps = 'inc; inc(2); inc(1, 2); incc; println("x", 1, 2); out(a, 1, 2, 3); jump; joinWorkspace(lab)'
    found = check(folder, f"!go. +!go <- {steps}.")
    assert [(each.message, each.help) for each in found] == [INC, INCC, (unknown("jump/0"), None)]
    assert {each.code for each in found} == {"unknown-operation"}


JACA = "MAS p {{ environment: jaca.CartagoEnvironment agents: a{}; }}"


@pytest.mark.parametrize(
    "project",
    [
        "mas p {\n agent ann: a.asl\n}",
        JACA.format(""),
        JACA.format(" agentArchClass jaca.CAgentArch"),
        JACA.format(" agentArchClass c4jason.CAgentArch"),
    ],
)
def test_operations_of_artifacts_that_programs_make_count(folder: Path, project: str) -> None:
    program = '!go.\n+!go <- makeArtifact("c", "Counter", [], Id); focus(Id); inc; hop.'
    assert [each.message for each in check(folder, program, project)] == [unknown("hop/0")]


@pytest.mark.parametrize(
    "step",
    [
        "makeArtifact(d, Type, [])",
        '.create_agent(bob, "b.asl")',
        'makeArtifact("g", "Growing")',
        '+kind("Counter"); ?kind(Type); makeArtifact(d, Type)',
    ],
)
def test_uncertain_cases_are_not_reported(folder: Path, step: str) -> None:
    assert check(folder, f"type(x).\n!go.\n+!go : type(Type) <- {step}; .print(Type); jump.") == []


def test_an_architecture_has_no_effect_so_its_actions_are_reported(folder: Path) -> None:
    project = PROJECT.replace("focus: lab.c", "focus: lab.c  ag-arch: body.Body")
    assert {each.message for each in check(folder, "!go.\n+!go <- jump.", project)} == {
        "the architecture `body.Body` has no effect: JaCaROS runs no architectures of projects",
        unknown("jump/0"),
    }


def test_unknown_types_are_reported(folder: Path) -> None:
    program = '!go.\n+!go <- makeArtifact("c", "Countr").'
    project = "mas p {\n agent ann: a.asl\n}"
    (found,) = check(folder, program, project)
    assert found.code == "unknown-artifact-type"
    assert "Countr" in found.message
    assert found.span is not None
    assert (found.span.line, found.span.column) == (2, 27)


def test_types_of_the_project_file_are_checked(folder: Path) -> None:
    (found,) = check(folder, "!go.\n+!go <- jump.", PROJECT.replace("Counter(5)", "Cuonter(5)"))
    assert (found.severity, found.code) == ("error", "wrong-project")
    assert "did you mean `Counter`?" in found.message


@pytest.mark.parametrize(
    ("python", "imports"), [("class Counter(:", False), ("import nothing_of_this_name\n", True)]
)
def test_an_error_in_the_artifacts_is_reported(folder: Path, python: str, imports: bool) -> None:
    (folder / "artifacts.py").write_text(python, encoding="utf-8")
    check(folder, "!go.\n+!go <- jump.")
    (found,) = check_files([folder / "p.jcm"], imports=imports).diagnostics
    assert (found.severity, found.code) == ("error", "wrong-project")
    assert "artifacts.py:1" in found.message


def test_a_comment_in_the_project_file_switches_a_warning_off(folder: Path) -> None:
    ignored = "focus: lab.c  roles: boss in o.g } // jacaros: ignore no-effect"
    assert check(folder, "!go.\n+!go <- inc.", PROJECT.replace("focus: lab.c }", ignored)) == []


@pytest.mark.parametrize(
    "make",
    [
        'makeArtifact("c", "Counter", [], Id); focus(Id)',
        '!use_artifact("c", "Counter")',
        '!use_artifact("c", "Counter", [5])',
        '!made("c", "Counter"); !done.\n+!made(Name, Type) <- makeArtifact(Name, Type).\n+!done <- focusWhenAvailable("c")',
    ],
)
def test_operations_are_checked_in_a_lone_program(folder: Path, make: str) -> None:
    program = f"{LIBRARY}!go.\n+!go <- {make}; inc; inc(1, 2); incc; offered_by_a_mapping."
    assert [(each.message, each.help) for each in check(folder, program, "")] == [INC, INCC]


LIBRARY = '{ include("$jacaros/artifacts.asl") }\n'


@pytest.mark.parametrize(
    ("program", "told"),
    [
        (f"{LIBRARY}!go.\n+!go <- !create_cmd_vel; move(3); moove(3).", [unknown("moove/1")]),
        ("!go.\n+!go <- hop.", []),
    ],
    ids=["library plans create the requested artifacts", "no artifacts"],
)
def test_actions_of_a_lone_program_are_checked_where_it_has_artifacts(
    folder: Path, program: str, told: list[str]
) -> None:
    assert [each.message for each in check(folder, program, "")] == told


def test_marks_of_goals_and_operations_are_distinguished(folder: Path) -> None:
    program = "!go.\n+!go <- rest; wait(3); !inc; !println(a).\n+!rest <- inc."
    assert [(each.message, each.help) for each in check(folder, program)] == [
        (unknown("rest/0"), "did you mean `!rest`?"),
        (unknown("wait/1"), "did you mean `.wait`?"),
        ("no plan for `!inc/0`", "to call the operation, write `inc` without `!`"),
        ("no plan for `!println/1`", "to call the operation, write `println` without `!`"),
        ("no agent of the project posts `!rest/0`", REST),
    ]


REST = "post it, offer it to callers with `{ offer(goal, ...) }`, or remove the plan"


def test_an_operation_of_a_shipped_mapping_is_known_by_its_file(folder: Path) -> None:
    (found,) = check(folder, "!go.\n+!go <- dock_at(home).")
    assert found.help == "the shipped mapping `nav2.yaml` has it; run with `--mapping nav2.yaml`"
    assert check(folder, '!go.\n+!go <- makeArtifact("c", "Counter"); dock_at(home).', "") == []


def test_inputs_of_operations_without_a_value_are_reported(folder: Path) -> None:
    program = "!go.\n+!go <- inc(N); inc(_); M = 3; inc(M); look(X); inc(X).\n+!add(N) <- inc(N).\n!add(3)."
    (folder / "artifacts.py").write_text(f"{ARTIFACTS}\n{LOOKING}", encoding="utf-8")
    project = PROJECT.replace("artifact c", "artifact l: Looking() artifact c")
    assert [(each.message, each.code) for each in check(folder, program, project)] == [
        ("variable `N` occurs only once in this plan", "singleton-variable"),
        ("`N` has no value here: `inc/1` needs one for `by`", "unbound-argument"),
        ("`_` has no value here: `inc/1` needs one for `by`", "unbound-argument"),
    ]


LOOKING = """
class Looking(Artifact):
    @operation
    def look(self, found: Out):
        found.set(3)
"""


def test_a_mapping_file_that_a_goal_names_is_checked(folder: Path) -> None:
    (folder / "robot.yaml").write_text(
        "properties:\n  pose:\n    topic: odom\n    type: nav_msgs/msg/Odometry\n    rat: 2\n",
        encoding="utf-8",
    )
    check(folder, f'{LIBRARY}!go.\n+!go <- !use_artifact("r", "robot.yaml").', "")
    assert "wrong-mapping" in {each.code for each in check_files([folder]).diagnostics}
