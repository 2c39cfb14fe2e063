"""What `jacaros.editors.symbols` knows about a place, and what the checker reports, in the terms of the protocol."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from lsprotocol import types
from pygls.workspace import PositionCodec

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.editors.lsp.positions import START, Positions, uri_of
from jacaros.editors.symbols.model import Completion, Edit, Hint, Hover, Occurrence
from jacaros.runtime.files.texts import printable
from jacaros.runtime.mas.agents.programs import SourcePath

_KINDS: Final = {
    "belief": types.CompletionItemKind.Field,
    "goal": types.CompletionItemKind.Event,
    "plan": types.CompletionItemKind.Reference,
    "operation": types.CompletionItemKind.Method,
    "internal action": types.CompletionItemKind.Function,
    "variable": types.CompletionItemKind.Variable,
    "keyword": types.CompletionItemKind.Keyword,
    "annotation": types.CompletionItemKind.Property,
    "property": types.CompletionItemKind.Property,
    "key": types.CompletionItemKind.Property,
    "value": types.CompletionItemKind.EnumMember,
}
_PLACE: Final = re.compile(r"\$\{\d+:(?P<text>[^}]*)\}|\$\d+|\\(?P<escaped>[$}\\])")
_WRITES: Final = frozenset({"defines", "adds", "removes", "tells", "handles", "offers"})
SOURCE: Final = "jacaros"
_LEVELS: Final = {
    "error": types.DiagnosticSeverity.Error,
    "warning": types.DiagnosticSeverity.Warning,
    "note": types.DiagnosticSeverity.Information,
}
_PAGE: Final = "https://github.com/jacaros/jacaros/blob/main/docs/reference/diagnostics.md"
_UNUSED: Final = frozenset({"plan-never-selected", "goal-never-posted", "unused-handler", "unused-offer"})
"""Codes about clauses without effect, which editors show in grey."""


class Answers:
    """Converts answers about one document.

    Args:
        file: the text of the document.
        codec: knows the client's unit of columns.
        has_snippets: whether the client can insert snippets.
    """

    def __init__(self, file: SourceFile, codec: PositionCodec, has_snippets: bool = True) -> None:
        self.file, self._codec, self._has_snippets = file, codec, has_snippets
        self.positions = Positions(file, codec)

    def place(self, span: Span) -> types.Location | None:
        """Return a place in any file, also of the library; None in a text that is not in a file."""
        path = _path_of(span)
        where = Positions(span.file, self._codec).range(span)
        return None if path is None else types.Location(uri_of(path), where)

    def places(self, spans: Iterable[Span]) -> list[types.Location]:
        """Return places in any files."""
        return [place for each in spans if (place := self.place(each)) is not None]

    def completion(self, found: Completion) -> types.CompletionItem:
        """Return a proposal."""
        form = types.InsertTextFormat
        insert = found.insert if self._has_snippets else _without_places(found.insert)
        documentation = types.MarkupContent(types.MarkupKind.Markdown, found.documentation)
        return types.CompletionItem(
            found.label,
            kind=_KINDS.get(found.kind),
            detail=found.detail or None,
            documentation=documentation if found.documentation else None,
            sort_text=f"{found.rank:04}{found.label}",
            insert_text_format=form.Snippet if self._has_snippets else form.PlainText,
            text_edit=types.TextEdit(self.positions.range(found.replaces), insert),
        )

    def hover(self, found: Hover) -> types.Hover:
        """Return what a name means."""
        text = types.MarkupContent(types.MarkupKind.Markdown, found.text)
        return types.Hover(text, self.positions.range(found.span))

    def highlight(self, found: Occurrence) -> types.DocumentHighlight:
        """Return an occurrence in this document."""
        kind = types.DocumentHighlightKind
        return types.DocumentHighlight(
            self.positions.range(found.span), kind.Write if found.role in _WRITES else kind.Read
        )

    def hint(self, found: Hint) -> types.InlayHint:
        """Return a note within a line."""
        is_unit = found.kind == "unit"
        return types.InlayHint(
            self.positions.to_client(*found.at),
            found.text,
            kind=types.InlayHintKind.Type if is_unit else types.InlayHintKind.Parameter,
            tooltip=found.tooltip or None,
            padding_left=is_unit,
            padding_right=not is_unit,
        )

    def edit(self, edits: Iterable[Edit]) -> types.WorkspaceEdit:
        """Return changes of any files."""
        changes: dict[str, list[types.TextEdit]] = {}
        for each in edits:
            path = None if each.span.file.name.startswith("$") else _path_of(each.span)
            if path is not None:
                where = Positions(each.span.file, self._codec).range(each.span)
                changes.setdefault(uri_of(path), []).append(types.TextEdit(where, each.text))
        return types.WorkspaceEdit(changes)


def as_shown(found: Diagnostic, codec: PositionCodec) -> types.Diagnostic:
    """Return a diagnostic for the client. Its suggested fix is the last line of the message."""
    help = f"\nhelp: {printable(found.help)}" if found.help else ""
    return types.Diagnostic(
        range=START if found.span is None else Positions(found.span.file, codec).range(found.span),
        message=printable(found.message) + help,
        severity=_LEVELS[found.severity],
        code=found.code or None,
        code_description=types.CodeDescription(f"{_PAGE}#{found.code}") if found.code else None,
        source=SOURCE,
        tags=[types.DiagnosticTag.Unnecessary] if found.code in _UNUSED else None,
    )


def _without_places(snippet: str) -> str:
    """Return a snippet as plain text, with the proposed names of arguments."""
    return _PLACE.sub(lambda found: found["text"] or found["escaped"] or "", snippet)


def _path_of(span: Span) -> Path | None:
    name = span.file.name
    if name.startswith("$"):
        return SourcePath(()).find(name)
    return None if name.startswith("<") else Path(name).resolve()
