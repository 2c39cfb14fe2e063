"""What the name at a position means, as Markdown."""

from collections.abc import Iterator

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.editors.symbols.descriptions import (
    about_action,
    comment_above,
    described,
    names_of,
    prefix_of,
    signature_of,
)
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Hover, Occurrence, Position, Symbol
from jacaros.editors.symbols.navigation import occurrence_at

_SIGNS = {"goal": "!", "plan": "@"}


def hover(index: Index, file: SourceFile, at: Position) -> Hover | None:
    """Return what is known of the name at a position; None if there is no name or nothing is known."""
    found = occurrence_at(index, file, at)
    if found is None:
        return None
    text = _text(index, found)
    return Hover(text, found.span) if text else None


def _text(index: Index, found: Occurrence) -> str:
    symbol = found.symbol
    match symbol.kind:
        case "variable":
            return "\n".join(dict.fromkeys(_of_variable(index, found)))
        case "internal action":
            return about_action(symbol.name, index.actions.get(symbol.name))
    offered = [signature_of(each) for each in index.offered(symbol)]
    if symbol.kind == "operation":
        return "\n\n---\n\n".join(offered)
    own = [] if offered else [f"```\n{_usage(index, symbol)}\n```", symbol.kind, _comment(index, symbol)]
    parts = ["\n\n---\n\n".join(offered), *own, described(index, symbol)[1]]
    return "\n\n".join(filter(None, parts))


def _usage(index: Index, symbol: Symbol) -> str:
    names = [each or "_" for each in names_of(index, symbol)]
    arguments = f"({', '.join(names)})" if names else ""
    return f"{prefix_of(symbol)}{_SIGNS.get(symbol.kind, '')}{symbol.name}{arguments}"


def _comment(index: Index, symbol: Symbol) -> str:
    """Return the comment above the first fact, rule or plan."""
    clauses = [each.clause for each in index.of(symbol) if each.role in ("defines", "handles")]
    return next(filter(None, map(comment_above, clauses)), "")


def _of_variable(index: Index, variable: Occurrence) -> Iterator[str]:
    """Say what properties and operations of its clause tell about the values of a variable."""
    for each in index.in_file(variable.span.file.name):
        if each.clause == variable.clause and variable.symbol.name in each.arguments:
            for offered in index.offered(each.symbol):
                for name, argument in zip(each.arguments, offered.arguments, strict=False):
                    if name == variable.symbol.name and argument.meaning:
                        yield f"- {argument.meaning} (`{argument.name}` of `{offered}`)"
