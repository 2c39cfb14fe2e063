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
    (folder / "p.jcm").write_text(project, encoding="utf-8")
    return check_files([folder / "p.jcm"]).diagnostics


def told(diagnostics: list[Diagnostic]) -> list[tuple[str, str, str | None]]:
    return [(each.code, each.message, each.help) for each in diagnostics]


def test_unknown_operations_are_reported(folder: Path) -> None:
    program = """
    !go.
    +!go <- inc; inc(2); inc(1, 2); incc; println("x", 1, 2); out(a, 1, 2, 3); jump; joinWorkspace(lab).
    """
    assert told(check(folder, program)) == [
        (
            "unknown-operation",
            "unknown operation `inc/2`: no artifact of the project has it",
            "did you mean `inc/0` or `inc/1`?",
        ),
        (
            "unknown-operation",
            "unknown operation `incc/0`: no artifact of the project has it",
            "did you mean `inc`?",
        ),
        ("unknown-operation", "unknown operation `jump/0`: no artifact of the project has it", None),
    ]


def test_operations_of_artifacts_that_programs_make_count(folder: Path) -> None:
    project = "mas p {\n agent ann: a.asl\n}"
    program = '!go.\n+!go <- makeArtifact("c", "Counter", [], Id); focus(Id); inc; hop.'
    assert [each.message for each in check(folder, program, project)] == [
        "unknown operation `hop/0`: no artifact of the project has it"
    ]


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
        "unknown operation `jump/0`: no artifact of the project has it",
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


def test_details_of_organisations_are_notes_of_the_checker(folder: Path) -> None:
    project = """
    mas p {
        agent ann: a.asl { roles: boss in o.g, guard in o.g }
        organisation o: o.xml {
            group g: team {
                players: ann cook
                responsible-for: s
            }
            scheme s: work
        }
    }
    """
    found = check(folder, "!go.\n+!go <- .print(x).", project)
    assert [
        (each.severity, each.code, each.span.line if each.span else 0, each.message) for each in found
    ] == [
        (
            "warning",
            "no-effect",
            3,
            "the role `boss` in `o.g` has no effect: roles in organisations are not supported",
        ),
        (
            "warning",
            "no-effect",
            3,
            "the role `guard` in `o.g` has no effect: roles in organisations are not supported",
        ),
        ("warning", "no-effect", 4, "the organisation `o` has no effect: organisations are not supported"),
        ("note", "no-effect", 5, "the group `g` has no effect: organisations are not supported"),
        (
            "warning",
            "no-effect",
            6,
            "the role `cook` of `ann` in `g` has no effect: roles in organisations are not supported",
        ),
        ("note", "no-effect", 9, "the scheme `s` has no effect: organisations are not supported"),
    ]


def test_a_comment_in_the_project_file_switches_a_warning_off(folder: Path) -> None:
    project = PROJECT.replace(
        "focus: lab.c }", "focus: lab.c  roles: boss in o.g } // jacaros: ignore no-effect"
    )
    assert check(folder, "!go.\n+!go <- inc.", project) == []


@pytest.mark.parametrize(
    "architecture", ["", " agentArchClass jaca.CAgentArch", " agentArchClass c4jason.CAgentArch"]
)
def test_operations_are_checked_in_a_project_for_jaca(folder: Path, architecture: str) -> None:
    program = '!go.\n+!go <- makeArtifact("c", "Counter", [], Id); focus(Id); inc; hop.'
    (folder / "a.asl").write_text(program, encoding="utf-8")
    project = folder / "p.mas2j"
    project.write_text(
        f"MAS p {{ environment: jaca.CartagoEnvironment agents: a{architecture}; }}", encoding="utf-8"
    )
    assert [each.message for each in check_files([project]).diagnostics] == [
        "unknown operation `hop/0`: no artifact of the project has it"
    ]


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
    lone = folder / "lone.asl"
    lone.write_text(
        f'{{ include("$jacaros/artifacts.asl") }}\n!go.\n+!go <- {make}; inc; inc(1, 2); incc; offered_by_a_mapping.',
        encoding="utf-8",
    )
    assert [(each.message, each.help) for each in check_files([lone]).diagnostics] == [
        ("unknown operation `inc/2`: no artifact of the project has it", "did you mean `inc/0` or `inc/1`?"),
        ("unknown operation `incc/0`: no artifact of the project has it", "did you mean `inc`?"),
    ]


def test_library_plans_create_the_requested_artifacts(folder: Path) -> None:
    lone = folder / "lone.asl"
    lone.write_text(
        '{ include("$jacaros/artifacts.asl") }\n!go.\n+!go <- !create_cmd_vel; move(3); moove(3).',
        encoding="utf-8",
    )
    assert [each.message for each in check_files([lone]).diagnostics] == [
        "unknown operation `moove/1`: no artifact of the project has it"
    ]


def test_actions_of_a_lone_program_without_artifacts_are_not_reported(folder: Path) -> None:
    lone = folder / "lone.asl"
    lone.write_text("!go.\n+!go <- hop.", encoding="utf-8")
    assert check_files([lone]).diagnostics == []


def test_a_mapping_file_that_a_goal_names_is_checked(folder: Path) -> None:
    (folder / "robot.yaml").write_text(
        "properties:\n  pose:\n    topic: odom\n    type: nav_msgs/msg/Odometry\n    rat: 2\n",
        encoding="utf-8",
    )
    lone = folder / "lone.asl"
    lone.write_text(
        '{ include("$jacaros/artifacts.asl") }\n!go.\n+!go <- !use_artifact("r", "robot.yaml").',
        encoding="utf-8",
    )
    assert "wrong-mapping" in {each.code for each in check_files([folder]).diagnostics}
