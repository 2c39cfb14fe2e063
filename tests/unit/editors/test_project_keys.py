"""Keys and names of project files, and the beliefs and goals that they declare."""

import pytest
from edited import edited, opened

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.editors.symbols.model import Position
from jacaros.editors.symbols.navigation import references
from jacaros.editors.symbols.renaming import rename
from jacaros.editors.symbols.yaml_keys import yaml_completions

PROJECT = """mas house {
    agent guard : guard.asl {
        beliefs: at(home), level(3)
        goals: watch, go(hall)
    }
    workspace lab { artifact lamp : Lamp() }
}
"""


def proposed(marked: str, ending: str = "jcm") -> set[str]:
    return {each.label for each in yaml_completions(*opened(marked, f"house.{ending}"))}


@pytest.mark.parametrize(
    ("marked", "has", "lacks"),
    [
        ("mas house {\n  ‸", "workspace", "beliefs"),
        ("mas house {\n  agent a : a.asl {\n    ‸", "goals", "parent"),
        ("mas house {\n  agent a { fo‸ }", "focus", "goals"),
        ("mas house {\n  workspace w { ‸ }", "artifact", "goals"),
        ("mas house {\n  workspace w { artifact a : X() { ‸ } }", "focused-by", "artifact"),
        ("mas house {\n  workspace w { artifact a : ‸ }", "ArtCmdVel", "artifact"),
        ("mas house {\n  agent a { focus: ‸ }\n  workspace w { artifact lamp : Lamp() }", "lamp", "w"),
        ("mas house {\n  agent a { focus: b, ‸ }\n  workspace w { artifact lamp : Lamp() }", "lamp", "w"),
        ("mas house {\n  agent a { join: ‸ }\n  workspace lab { }", "lab", "a"),
        ("mas house {\n  world: ‸", "flat", "workspace"),
    ],
)
def test_keys_and_names_are_those_of_the_block(marked: str, has: str, lacks: str) -> None:
    found = proposed(marked)
    assert has in found
    assert lacks not in found


def test_a_mas2j_file_has_its_own_sections() -> None:
    assert "aslSourcePath" in proposed("MAS house {\n  ‸", "mas2j")
    assert proposed("MAS house { agents: a [‸", "mas2j") >= set()


def test_declared_beliefs_and_goals_are_references() -> None:
    index, file, at = edited("+!go‸(R) : at(R) <- stop.")
    index.put_project(SourceFile("house.jcm", PROJECT))
    found = [(each.span.file.name, *each.span[1:3]) for each in references(index, file, at)]
    assert found == [("house.jcm", 4, 23), ("robot.asl", 1, 3)]
    edits = rename(index, SourceFile("house.jcm", PROJECT), Position(3, 19), "near")
    assert sorted((each.span.file.name, *each.span[1:3]) for each in edits) == [
        ("house.jcm", 3, 18),
        ("robot.asl", 1, 11),
    ]


def test_declared_beliefs_may_be_quoted() -> None:
    index, file, at = edited("+!go : at‸(R) <- stop.")
    index.put_project(SourceFile("house.mas2j", 'MAS house { agents: a [beliefs="at(home)"]; }'))
    assert [each.span[1:3] for each in references(index, file, at)] == [(1, 33), (1, 8)]
