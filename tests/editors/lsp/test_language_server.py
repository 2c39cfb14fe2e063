"""``jacaros lsp`` as an editor meets it: over its standard input and output."""

import subprocess
import sys
from pathlib import Path

import pytest
from editor import Editor, with_editor
from lsprotocol import types

ROOT = Path(__file__).parents[3]
SUFFIXES = (".asl", ".jcm", ".mas2j", ".yaml")
PROGRAM = """\
// A robot that
// goes home.
at(kitchen).
near(X) :- at(X).
!start.

@begin
+!start : near(kitchen)
  <- !go(home);
     .print("𝄞", unknown_word).

+!go(Place) <- -+at(Place).
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "robot.asl").write_text(PROGRAM, encoding="utf-8")
    (tmp_path / "p.jcm").write_text("mas p { agent robot : robot.asl }", encoding="utf-8")
    return tmp_path


def applied(text: str, edits: list[types.TextEdit]) -> str:
    """Apply edits as an editor does that counts UTF-16 units; the texts here have none outside the first plane there."""
    lines = text.split("\n")
    for edit in sorted(
        edits, key=lambda each: (each.range.start.line, each.range.start.character), reverse=True
    ):
        start, end = edit.range.start, edit.range.end
        before = lines[start.line][: start.character]
        behind = lines[end.line][end.character :]
        lines[start.line : end.line + 1] = f"{before}{edit.new_text}{behind}".split("\n")
    return "\n".join(lines)


def test_reports_errors_as_you_type(folder: Path) -> None:
    async def use(editor: Editor) -> None:
        await editor.open("robot.asl")
        editor.edit("robot.asl", PROGRAM.replace("!go(home)", "!goo(home)"))
        await editor.until(lambda: bool(editor.diagnostics("robot.asl")))
        found, unused = editor.diagnostics("robot.asl")
        assert (found.code, found.source, unused.code) == ("unknown-goal", "jacaros", "goal-never-posted")
        assert unused.tags == (types.DiagnosticTag.Unnecessary,)
        assert found.message == "no plan for `!goo/1`\nhelp: did you mean `!go`?"
        assert found.range == types.Range(types.Position(8, 6), types.Position(8, 15))
        editor.edit("robot.asl", PROGRAM)
        await editor.until(lambda: not editor.diagnostics("robot.asl"))

    with_editor(folder, use)


@pytest.mark.parametrize(
    ("encoding", "character"),
    [
        (types.PositionEncodingKind.Utf8, 21),
        (types.PositionEncodingKind.Utf16, 19),
        (types.PositionEncodingKind.Utf32, 18),
    ],
)
def test_columns_count_in_the_negotiated_unit(
    folder: Path, encoding: types.PositionEncodingKind, character: int
) -> None:
    async def use(editor: Editor) -> None:
        assert editor.capabilities is not None
        assert editor.capabilities.position_encoding == encoding
        await editor.open("robot.asl", '!start.\n+!start <- p("𝄞", .pritn).')
        await editor.until(lambda: bool(editor.diagnostics("robot.asl")))
        found = next(
            each for each in editor.diagnostics("robot.asl") if each.code == "unknown-internal-action"
        )
        assert found.range.start.character == character
        params = types.CodeActionParams(
            editor.document("robot.asl"), found.range, types.CodeActionContext([found])
        )
        actions = await editor.client.text_document_code_action_async(params)
        assert actions is not None
        action = next(each for each in actions if each.title == "Change to `.print`")
        assert isinstance(action, types.CodeAction)
        assert action.edit is not None
        assert action.edit.changes is not None
        (edit,) = action.edit.changes[editor.uri("robot.asl")]
        assert edit == types.TextEdit(found.range, ".print")

    with_editor(folder, use, [encoding])


def test_answers_about_a_program(folder: Path) -> None:
    async def use(editor: Editor) -> None:
        ask, name = editor.client, "robot.asl"
        document = editor.document(name)
        untidy = PROGRAM.replace("at(kitchen).", "at( kitchen ) .").replace("-+at(Place).\n", "-+at(Place).")
        await editor.open(name, untidy)

        outline = await ask.text_document_document_symbol_async(types.DocumentSymbolParams(document)) or ()
        assert [each.name for each in outline] == [
            "at(kitchen)",
            "near(X)",
            "start",
            "+!start",
            "+!go(Place)",
        ]

        folds = await ask.text_document_folding_range_async(types.FoldingRangeParams(document)) or ()
        assert {(each.start_line, each.end_line) for each in folds} == {(0, 1), (6, 9)}

        options = types.FormattingOptions(4, insert_spaces=True)
        edits = await ask.text_document_formatting_async(types.DocumentFormattingParams(document, options))
        ends = [
            types.Position(each.range.end.line, min(each.range.end.character, 999)) for each in edits or ()
        ]
        assert len(ends) == 2
        assert applied(untidy, list(edits or ())) == PROGRAM

        lenses = await ask.text_document_code_lens_async(types.CodeLensParams(document)) or ()
        assert [each.command.command for each in lenses if each.command] == ["jacaros.run"]

        found = await ask.workspace_symbol_async(types.WorkspaceSymbolParams("robot")) or ()
        assert [each.name for each in found] == ["robot"]

    with_editor(folder, use)


def test_names_of_the_project(folder: Path) -> None:
    """The index of names is made after the diagnostics, so the first ones are awaited."""

    async def use(editor: Editor) -> None:
        ask, name = editor.client, "robot.asl"
        text = PROGRAM + "+!x <- !"
        await editor.open(name, text)
        await editor.until(lambda: bool(editor.diagnostics(name)))
        while not (shown := await ask.text_document_hover_async(types.HoverParams(**editor.at(name, 8, 6)))):
            pass
        assert "!go(Place)" in str(shown.contents)
        places = await ask.text_document_definition_async(types.DefinitionParams(**editor.at(name, 8, 6)))
        assert [each.range.start.line for each in places or ()] == [11]
        context = types.ReferenceContext(include_declaration=True)
        found = await ask.text_document_references_async(
            types.ReferenceParams(context=context, **editor.at(name, 8, 6))
        )
        assert [each.range.start.line for each in found or ()] == [8, 11]
        edit = await ask.text_document_rename_async(
            types.RenameParams(new_name="drive", **editor.at(name, 8, 6))
        )
        assert edit is not None
        assert edit.changes is not None
        assert [each.new_text for each in edit.changes[editor.uri(name)]] == ["drive", "drive"]
        last = text.count("\n")
        params = types.CompletionParams(**editor.at(name, last, len("+!x <- !")))
        proposals = await ask.text_document_completion_async(params)
        assert isinstance(proposals, types.CompletionList)
        assert {"go(Place)", "start"} <= {each.label for each in proposals.items}

    with_editor(folder, use)


def test_a_recording_says_why_a_plan_did_not_run(folder: Path) -> None:
    run = [sys.executable, "-m", "jacaros", "run", "robot.asl", "--clock", "fast", "--for", "1"]
    subprocess.run([*run, "--record", "run.jsonl"], cwd=folder, check=True, capture_output=True)

    async def use(editor: Editor) -> None:
        await editor.open("robot.asl")
        lenses = await editor.client.text_document_code_lens_async(
            types.CodeLensParams(editor.document("robot.asl"))
        )
        whys = [
            each.command for each in lenses or () if each.command and each.command.command == "jacaros.why"
        ]
        assert [each.arguments for each in whys] == [
            (editor.uri("robot.asl"), 8),
            (editor.uri("robot.asl"), 12),
        ]
        told = await editor.client.workspace_execute_command_async(
            types.ExecuteCommandParams("jacaros.explain", [editor.uri("robot.asl"), 12])
        )
        assert str(told).startswith("run.jsonl: ")
        assert "!go(home)" in str(told)

    with_editor(folder, use)


def programs() -> list[str]:
    """The programs and projects of this repository."""
    folders = ("examples", "tests", "src/jacaros/agents/language/library")
    found = [
        each for folder in folders for suffix in SUFFIXES for each in (ROOT / folder).rglob(f"*{suffix}")
    ]
    return sorted(each.relative_to(ROOT).as_posix() for each in found)


@pytest.mark.slow
def test_answers_about_all_programs_of_the_repository() -> None:
    """Each is opened, cut in the middle of a word, asked about and closed."""

    async def use(editor: Editor) -> None:
        ask = editor.client
        for name in programs():
            document = editor.document(name)
            text = (ROOT / name).read_text(encoding="utf-8")
            cut = text[: 2 * len(text) // 3].rstrip()
            line, character = cut.count("\n"), len(cut.rpartition("\n")[2])
            await editor.open(name, cut)
            await ask.text_document_completion_async(
                types.CompletionParams(**editor.at(name, line, character))
            )
            await ask.text_document_hover_async(types.HoverParams(**editor.at(name, line, character)))
            await ask.text_document_semantic_tokens_full_async(types.SemanticTokensParams(document))
            await ask.text_document_document_symbol_async(types.DocumentSymbolParams(document))
            await ask.text_document_folding_range_async(types.FoldingRangeParams(document))
            await ask.text_document_code_lens_async(types.CodeLensParams(document))
            editor.close(name)
        await editor.open("robot.asl", "!go.")
        await editor.until(lambda: bool(editor.diagnostics("robot.asl")))
        assert editor.logged == []

    with_editor(ROOT, use)
