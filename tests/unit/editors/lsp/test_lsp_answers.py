"""Code actions and colours of the language server."""

from pathlib import Path

import pytest
from lsprotocol import types
from pygls.workspace import PositionCodec

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.editors.lsp import fixes
from jacaros.editors.lsp.colours import LEGEND, colours
from jacaros.editors.lsp.editing import formatting
from jacaros.editors.lsp.positions import Positions
from jacaros.editors.lsp.projects import Projects

CODEC = PositionCodec()


def applied(text: str, edits: list[types.TextEdit]) -> str:
    """Apply edits to a text without characters outside the first plane of Unicode."""
    lines = text.split("\n")
    for edit in sorted(
        edits, key=lambda each: (each.range.start.line, each.range.start.character), reverse=True
    ):
        start, end = edit.range.start, edit.range.end
        before = lines[start.line][: start.character]
        behind = lines[end.line][end.character :]
        lines[start.line : end.line + 1] = f"{before}{edit.new_text}{behind}".split("\n")
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("before", "title", "after"),
    [
        ("!start.\n+!start <- !go.\n+!goo.", "Change to `goo`", "!start.\n+!start <- !goo.\n+!goo."),
        ("!go.\n", "Add `+!go.`", "!go.\n\n+!go.\n"),
        ("p(1)\nq(2).", "Add `.`", "p(1).\nq(2)."),
        ("!a.\n+!a : p(1) and q(2).\np(1). q(2).", "Change to `&`", "!a.\n+!a : p(1) & q(2).\np(1). q(2)."),
        ("!a.\n+!a : p(1), q(2).\np(1). q(2).", "Change to `&`", "!a.\n+!a : p(1)& q(2).\np(1). q(2)."),
        ("p(f(1).", "Add `)`", "p(f(1))."),
        ("!go.\n!go <- .print(1).", "Change to `+!`", "!go.\n+!go <- .print(1)."),
        ("!a.\n+!a <- ?.print(1).", "Remove `?`", "!a.\n+!a <- .print(1)."),
        (
            "!a.\n  p(X) :- q(Y, X).\n+!a : p(1).\nq(1, 2).",
            "Allow `singleton-variable` here",
            "!a.\n  // jacaros: allow singleton-variable\n  p(X) :- q(Y, X).\n+!a : p(1).\nq(1, 2).",
        ),
    ],
)
def test_the_fix_is_an_edit(tmp_path: Path, before: str, title: str, after: str) -> None:
    path = tmp_path / "a.asl"
    found = Projects([tmp_path]).update([path], {path: before})[path]
    actions = {action.title: action for each in found for action in fixes.actions(each, "a", CODEC, True)}
    assert title in actions, list(actions)
    edit = actions[title].edit
    assert edit is not None
    assert edit.changes is not None
    assert applied(before, list(edit.changes["a"])) == after


@pytest.mark.parametrize(
    "text",
    ["p( 1 ).\nq.\n", "p.\nq( 2 ).", "p.\n\n\n\nq.\n\n\n", "!s.\n+!s<-a;b.\n\n// end", "p( 1 )."],
)
def test_formatting_edits_only_the_lines_that_change(text: str) -> None:
    from jacaros.agents.language.formatting import format_program
    from jacaros.agents.mind.actions.internal_action import STANDARD

    edits = formatting(SourceFile("a.asl", text))
    assert applied(text, edits) == format_program("a.asl", text, STANDARD)
    assert edits


def test_each_word_has_its_colour() -> None:
    text = '@l[atomic] +!go(X) : at(a) & not b::c(X) <- move(X, "t"); .print(1); // end'
    expected = [
        *(
            ("l", "decorator"),
            ("atomic", "decorator"),
            ("go", "event"),
            ("X", "variable"),
            ("at", "property"),
        ),
        *(("a", "enumMember"), ("not", "keyword"), ("b", "namespace"), ("c", "property"), ("X", "variable")),
        *(("move", "method"), ("X", "variable"), ('"t"', "string"), (".print", "function"), ("1", "number")),
        ("// end", "comment"),
    ]

    file = SourceFile("a.asl", text)
    data = colours(file, Positions(file, CODEC))
    column, words = 0, []
    for at in range(0, len(data), 5):
        column += data[at + 1]
        words.append((text[column : column + data[at + 2]], LEGEND.token_types[data[at + 3]]))
    assert words == expected
