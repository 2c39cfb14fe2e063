"""Diagnostics of the checker as an editor shows them."""

from typing import Final

from lsprotocol import types
from pygls.workspace import PositionCodec

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.editors.lsp.positions import Positions
from jacaros.runtime.files.texts import printable

SOURCE: Final = "jacaros"
_LEVELS: Final = {
    "error": types.DiagnosticSeverity.Error,
    "warning": types.DiagnosticSeverity.Warning,
    "note": types.DiagnosticSeverity.Information,
}
_PAGE: Final = "https://github.com/jacaros/jacaros/blob/main/docs/reference/diagnostics.md"
_UNUSED: Final = frozenset({"plan-never-selected", "goal-never-posted", "unused-handler", "unused-offer"})
"""Codes about clauses without effect, which editors show in grey."""
_START: Final = types.Range(types.Position(0, 0), types.Position(0, 0))


def as_shown(found: Diagnostic, codec: PositionCodec) -> types.Diagnostic:
    """Return a diagnostic for the client. Its suggested fix is the last line of the message."""
    help = f"\nhelp: {printable(found.help)}" if found.help else ""
    return types.Diagnostic(
        range=_START if found.span is None else Positions.of(found.span.file, codec).range(found.span),
        message=printable(found.message) + help,
        severity=_LEVELS[found.severity],
        code=found.code or None,
        code_description=types.CodeDescription(f"{_PAGE}#{found.code}") if found.code else None,
        source=SOURCE,
        tags=[types.DiagnosticTag.Unnecessary] if found.code in _UNUSED else None,
    )
