"""What the name at a position means, as Markdown."""

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.editors.symbols.completion import names_of
from jacaros.editors.symbols.descriptions import about_action, described, signature_of
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Hover, Position, Symbol
from jacaros.editors.symbols.navigation import occurrence_at


def hover(index: Index, file: SourceFile, at: Position) -> Hover | None:
    """Return what is known of the name at a position; None if there is no name or nothing is known."""
    found = occurrence_at(index, file, at)
    if found is None:
        return None
    text = _text(index, found.symbol)
    return Hover(text, found.span) if text else None


def _text(index: Index, symbol: Symbol) -> str:
    match symbol.kind:
        case "variable":
            return ""
        case "internal action":
            return about_action(symbol.name, index.actions.get(symbol.name))
        case "operation":
            return "\n\n---\n\n".join(map(signature_of, index.offered(symbol)))
    offered = "\n\n---\n\n".join(map(signature_of, index.offered(symbol)))
    names = [each or "_" for each in names_of(index, symbol)]
    sign = {"goal": "!", "plan": "@"}.get(symbol.kind, "")
    space = f"{symbol.scope}::" if symbol.scope else ""
    usage = f"{space}{sign}{symbol.name}" + (f"({', '.join(names)})" if names else "")
    _, where = described(index, symbol)
    own = f"```\n{usage}\n```\n\n{symbol.kind}\n\n{where}".rstrip()
    return f"{offered}\n\n{where}".rstrip() if offered else own
