"""Pygments' lexers know every program and project file of the repository."""

import tomllib
from pathlib import Path

import pytest
from pygments.lexers import get_lexer_by_name
from pygments.token import Comment, Error, Keyword, Name, Operator, String, Whitespace

from jacaros.editors.highlighting import AgentSpeakLexer, ProjectLexer

ROOT = Path(__file__).parents[3]
FOLDERS = [ROOT / "examples", ROOT / "tests" / "conformance", ROOT / "src"]
PROGRAMS = [file for folder in FOLDERS for file in sorted(folder.rglob("*.asl"))]
PROJECTS = [
    file for folder in FOLDERS for kind in ("jcm", "mas2j") for file in sorted(folder.rglob(f"*.{kind}"))
]


def tokens(text: str, lexer: type = AgentSpeakLexer) -> list[tuple[object, str]]:
    return [(kind, part) for kind, part in lexer().get_tokens(text) if kind is not Whitespace]


@pytest.mark.parametrize(("lexer", "files"), [(AgentSpeakLexer, PROGRAMS), (ProjectLexer, PROJECTS)])
def test_no_file_of_the_repository_has_an_unknown_character(lexer: type, files: list[Path]) -> None:
    assert len(files) > 20
    for file in files:
        if "syntax_errors" in file.parts:
            continue
        text = file.read_text(encoding="utf-8")
        unknown = [part for kind, part in tokens(text, lexer) if kind in Error]
        assert unknown == [], file
        assert "".join(part for _, part in lexer(stripnl=False, ensurenl=False).get_tokens(text)) == text


def test_a_goal_is_not_a_belief() -> None:
    assert tokens("+!go(X) <- +at(X).")[:2] == [(Operator, "+!"), (Name.Function, "go")]
    assert (Name, "at") in tokens("+!go(X) <- +at(X).")


@pytest.mark.parametrize(
    ("text", "kind", "part"),
    [
        ("x :- not y.", Operator.Word, "not"),
        ('!g <- .print("a \\" b").', Name.Builtin, ".print"),
        ('!g <- .print("a \\" b").', String.Double, '"a \\" b"'),
        ("@label[atomic] +!g.", Name.Decorator, "@label"),
        ("+!g : at(Where).", Name.Variable, "Where"),
        ('{ include("a.asl") }', Keyword.Namespace, "include"),
        ("+!g <- if (true) { a }.", Keyword, "if"),
        ("ns::b(1).", Name.Namespace, "ns::"),
        ("a. // why", Comment.Single, "// why"),
        ("+!iffy <- forward(math.pi).", Name, "forward"),
    ],
)
def test_a_part_has_its_kind(text: str, kind: object, part: str) -> None:
    assert (kind, part) in tokens(text)


def test_a_declaration_and_a_key_of_a_project_have_their_kinds() -> None:
    found = tokens("mas house { agent bob : b.asl { focus: w.a } }", ProjectLexer)
    assert found[:2] == [(Keyword.Declaration, "mas"), (Name.Class, "house")]
    assert (Name.Attribute, "focus") in found


def test_pygments_finds_the_lexers_by_the_names_that_pages_use() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert declared["project"]["entry-points"]["pygments.lexers"] == {
        "agentspeak": "jacaros.editors.highlighting:AgentSpeakLexer",
        "jacamo": "jacaros.editors.highlighting:ProjectLexer",
    }
    assert [get_lexer_by_name(name).name for name in ("agentspeak", "asl", "jcm", "mas2j")] == [
        "AgentSpeak",
        "AgentSpeak",
        "JaCaMo project",
        "JaCaMo project",
    ]
