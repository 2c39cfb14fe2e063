"""The suggested fixes of diagnostics as code actions: the edit that a ``help:`` describes, and ``allow``."""

import re
from collections.abc import Iterator
from typing import Final

from lsprotocol import types
from pygls.workspace import PositionCodec

from jacaros.agents.language.diagnostics import Diagnostic, Fix, SourceFile, Span
from jacaros.editors.lsp.answers import as_shown
from jacaros.editors.lsp.positions import START, Positions
from jacaros.runtime.files.texts import Suggestion, close_matches

_WORD: Final = re.compile(r"(?P<mark>[-+^]*[!?.~]*)(?P<name>\w+(?:\.\w+)*)")
_MARK: Final = re.compile(r"[-+^]*[!?.~]*$")
_ARITY: Final = re.compile(r"/\d+$")


def actions(
    found: Diagnostic, uri: str, codec: PositionCodec, is_program: bool
) -> Iterator[types.CodeAction]:
    """Yield what an editor can do about a diagnostic. Comments switch off warnings in programs only."""
    span = found.span
    if span is None:
        return
    shown = as_shown(found, codec)
    positions = Positions(span.file, codec)
    edits = [*edits_of(found)]
    for where, text in edits:
        written = _text(where)
        does = "Change to" if written and text else "Add" if text else "Remove"
        title = f"{does} `{' '.join(text.split()) or written}`"
        edit = types.TextEdit(positions.range(where), text)
        yield _action(title, uri, edit, shown, is_preferred=len(edits) == 1)
    if is_program and found.severity != "error" and found.code:
        start = positions.to_client(span.line, 1)
        edit = types.TextEdit(types.Range(start, start), _allowing(span.file, span.line, found.code))
        yield _action(f"Allow `{found.code}` here", uri, edit, shown)
        edit = types.TextEdit(START, f"// jacaros: allow-file {found.code}\n")
        yield _action(f"Allow `{found.code}` in this file", uri, edit, shown)


def edits_of(found: Diagnostic) -> Iterator[tuple[Span, str]]:
    """Yield the texts that the help of a diagnostic proposes, with the range that each replaces."""
    if found.span is None:
        return
    if isinstance(found.help, Fix):
        yield found.help.where or found.span, found.help.text
    if not isinstance(found.help, Suggestion):
        return
    names = (_ARITY.sub("", name) for name in found.help.names)
    yield from filter(None, (_replaced(found.span, name) for name in names))


def _replaced(span: Span, name: str) -> tuple[Span, str] | None:
    """Return the word in a range that a name replaces: the most similar one."""
    meant = _WORD.fullmatch(name)
    written = _text(span)
    if meant is None:
        # A text, or a term with arguments, replaces only something simple.
        return (span, name) if _WORD.fullmatch(written) else None
    words = [each for each in _WORD.finditer(written) if not _is_quoted(written, each.start("name"))]
    close = close_matches(meant["name"], [each["name"] for each in words])
    lower = {each["name"].lower(): each["name"] for each in words}
    wanted = close[0] if close else lower.get(meant["name"].lower())
    word = next((each for each in words if each["name"] == wanted), None)
    if word is None or (word["name"] == meant["name"] and not meant["mark"]):
        return None
    whole = _part(span, word.start("name"), word.end())
    found = _MARK.search(span.file.lines[span.line - 1][: whole.column - 1])
    marks = found.group() if found is not None else ""
    is_before = whole.column - len(marks) < span.column  # a goal is marked without its `!`
    if not meant["mark"] or (is_before and marks.endswith(meant["mark"])):
        return whole, meant["name"]
    return whole._replace(column=whole.column - len(marks)), name


def _is_quoted(text: str, at: int) -> bool:
    return text.count('"', 0, at) % 2 == 1 and text.count('"') > 1 and not text.startswith('"')


def _text(span: Span) -> str:
    """Return the marked text of the first line of a range."""
    line = span.file.lines[span.line - 1] if span.line <= len(span.file.lines) else ""
    return line[span.column - 1 : span.end_column - 1 if span.end_line == span.line else None]


def _part(span: Span, begin: int, end: int) -> Span:
    return Span(span.file, span.line, span.column + begin, span.line, span.column + end)


def _allowing(file: SourceFile, line: int, code: str) -> str:
    """Return the comment above a line that allows a warning there."""
    text = file.lines[line - 1] if line <= len(file.lines) else ""
    indent = text[: len(text) - len(text.lstrip())]
    return f"{indent}// jacaros: allow {code}\n"


def _action(
    title: str, uri: str, edit: types.TextEdit, about: types.Diagnostic, is_preferred: bool = False
) -> types.CodeAction:
    return types.CodeAction(
        title,
        types.CodeActionKind.QuickFix,
        diagnostics=[about],
        is_preferred=is_preferred or None,
        edit=types.WorkspaceEdit({uri: [edit]}),
    )
