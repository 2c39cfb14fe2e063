"""What `jacaros check` reports about artifacts that agents do not focus or cannot reach."""

from pathlib import Path

import pytest

from jacaros.runtime.mas.checks.files import check_files

ARTIFACTS = """
from jacaros.artifacts import Artifact, operation

class Counter(Artifact):
    def init(self):
        self.define_property("count", 0)

    @operation
    def inc(self):
        self.update_property("count", self.value("count") + 1)

class Lamp(Artifact):
    def init(self):
        self.define_property("lit", False)
"""
PROJECT = """
mas p {{
    agent ann: a.asl {{ {} }}
    workspace lab {{ artifact c: Counter() artifact l: Lamp() }}
}}
"""
COUNTS = "+count(N) <- .print(N)."


def found(folder: Path, declared: str | None, program: str) -> list[tuple[str, str | None]]:
    """Return messages and helps about focus in a project, or in a lone program if nothing is declared."""
    (folder / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
    (folder / "a.asl").write_text(program, encoding="utf-8")
    (folder / "p.jcm").write_text(PROJECT.format(declared), encoding="utf-8")
    name = "a.asl" if declared is None else "p.jcm"
    diagnostics = check_files([folder / name]).diagnostics
    return [(each.message, each.help) for each in diagnostics if each.code == "unfocused-artifact"]


def test_a_property_of_an_artifact_that_the_agent_does_not_focus_is_reported(tmp_path: Path) -> None:
    assert found(tmp_path, "focus: lab.l", COUNTS) == [
        (
            "`count` comes from artifact `c`, which agent `ann` does not focus",
            "write `focus: lab.c` in the declaration of agent `ann`",
        )
    ]


def test_artifacts_of_a_workspace_that_no_agent_joins_are_reported(tmp_path: Path) -> None:
    (c, lamp) = found(tmp_path, "", "!go.\n+!go <- .print(go).")
    assert c == (
        "no agent can use `c`: none joins workspace `lab`",
        "write `focus: lab.c` in the declaration of an agent",
    )
    assert lamp[0] == "no agent can use `l`: none joins workspace `lab`"


@pytest.mark.parametrize("declared", [None, "join: lab"])
def test_an_artifact_that_a_program_makes_and_does_not_focus_is_reported(
    tmp_path: Path, declared: str | None
) -> None:
    program = f'!go.\n+!go <- makeArtifact("mine", "Counter", [], _); inc.\n{COUNTS}'
    ((message, help),) = found(tmp_path, declared, program)
    assert message.startswith("`count` comes from artifact")
    assert help is not None
    assert "focus" in help


@pytest.mark.parametrize(
    ("declared", "program"),
    [
        ("focus: lab.c", COUNTS),
        ("join: lab", f'!go.\n+!go <- lookupArtifact("c", Id); focus(Id).\n{COUNTS}'),
        ("join: lab", f'!go.\n+!go <- focusWhenAvailable("lab.c").\n{COUNTS}'),
        ("join: lab", f"!go.\n+!go <- ?name(N); lookupArtifact(N, Id); focus(Id).\nname(c).\n{COUNTS}"),
        ("", '!go.\n+!go <- joinWorkspace("lab", W).'),
        (None, f'!go.\n+!go <- makeArtifact("mine", "Counter", [], Id); focus(Id).\n{COUNTS}'),
        (
            None,
            f'{{ include("$jacaros/artifacts.asl") }}\n!go.\n+!go <- !use_artifact("c", "Counter").\n{COUNTS}',
        ),
        ("join: lab", f"!go.\n+!go <- +count(3).\n{COUNTS}"),
    ],
)
def test_agents_that_focus_or_get_the_belief_otherwise_are_not_reported(
    tmp_path: Path, declared: str | None, program: str
) -> None:
    assert found(tmp_path, declared, program) == []


def test_an_artifact_beside_those_that_the_library_focuses_is_reported(tmp_path: Path) -> None:
    library = '{ include("$jacaros/artifacts.asl") }'
    program = (
        f'{library}\n!go.\n+!go <- !use_artifact("l", "Lamp"); makeArtifact("c", "Counter", [], _).\n{COUNTS}'
    )
    assert len(found(tmp_path, None, program)) == 1


def test_agents_with_the_same_program_count_as_one(tmp_path: Path) -> None:
    both = "focus: lab.l }\n agent bob: a.asl { focus: lab.c"
    assert found(tmp_path, both, COUNTS) == []


def test_operations_of_a_workspace_that_only_another_agent_joins_are_reported(tmp_path: Path) -> None:
    def reported(bob: str) -> list[tuple[str, str | None]]:
        (tmp_path / "b.asl").write_text(bob, encoding="utf-8")
        return found(
            tmp_path, "focus: lab.c }} agent bob: b.asl {{".replace("{{", "{").replace("}}", "}"), COUNTS
        )

    assert reported("!go.\n+!go <- inc.") == [
        (
            "`inc` is an operation of `c` in workspace `lab`, which agent `bob` does not join",
            "write `focus: lab.c` in the declaration of agent `bob`",
        )
    ]
    assert reported('!go.\n+!go <- joinWorkspace("lab", _); inc.') == []
    assert reported("!go.\n+!go <- .print(go).") == []


def test_a_file_of_plans_that_others_include_is_not_reported(tmp_path: Path) -> None:
    made = '+!made <- makeArtifact("c", "artifacts.Counter", [], _).'
    assert found(tmp_path, None, f"{made}\n{COUNTS}") == []
    (reported,) = found(tmp_path, None, f"!made.\n{made}\n{COUNTS}")
    assert "which agent `a` does not focus" in reported[0]


def test_agents_in_python_do_not_hide_what_other_agents_do_not_focus(tmp_path: Path) -> None:
    def reported(body: str) -> list[str]:
        code = f"from jacaros import PythonAgent\nclass Bob(PythonAgent):\n    async def run(self):\n        {body}\n"
        (tmp_path / "bob.py").write_text(code, encoding="utf-8")
        both = "focus: lab.l }\n agent bob: bob.py { focus: lab.c"
        return [message for message, _ in found(tmp_path, both, COUNTS)]

    assert reported("self.print(1)") == ["`count` comes from artifact `c`, which agent `ann` does not focus"]
    assert reported('self.send("ann", "tell", Structure("count", (1,)))') == []
    assert reported('await self.act("makeArtifact", "d", "Counter")') == []


def test_the_help_names_the_step_that_finds_the_artifact(tmp_path: Path) -> None:
    program = (
        '!go.\n+!go <- makeArtifact("mine", "Counter", [], _); ?mine(Id); {}inc.\n'
        f'+?mine(Id) <- lookupArtifact("mine", Id).\n{COUNTS}'
    )
    assert found(tmp_path, None, program.format("focus(Id); ")) == []
    ((_, help),) = found(tmp_path, None, program.format(""))
    assert help == "focus the artifact after it is made: `?mine(Id); focus(Id)`"
