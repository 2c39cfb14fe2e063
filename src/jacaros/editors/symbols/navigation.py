"""Where a name is defined and used."""

from collections.abc import Iterable
from typing import Final

from jacaros.agents.language.diagnostics import SourceFile, Span
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Kind, Occurrence, Position, Role, Symbol
from jacaros.editors.symbols.occurrences import scope_of
from jacaros.editors.symbols.tokens_at import Reading, reading_at
from jacaros.runtime.mas.checks.files import PROJECTS

_DEFINING: Final[tuple[tuple[Role, ...], ...]] = (("defines",), ("handles",), ("offers",), ("adds", "tells"))
"""What counts as the definition of a goal or plan, the best first."""
_OF_BELIEFS: Final[tuple[tuple[Role, ...], ...]] = (("defines", "offers"), ("adds", "tells"), ("handles",))
"""What counts as the definition of a belief, unless it is a property of an artifact."""
_SIGNS: Final[dict[str, Kind]] = {"!": "goal", "!!": "goal", "@": "plan", "?": "belief", "-+": "belief"}


def occurrence_at(index: Index, file: SourceFile, at: Position) -> Occurrence | None:
    """Return the name at a position and what it means; in a clause that does not parse, by the tokens around it."""
    found = index.at(file.name, at)
    if found is not None and _is_there(file, found):
        return found
    reading = reading_at(file, at)
    if reading.word_span is None or file.name.endswith(PROJECTS):
        return None
    return Occurrence(_guessed(reading, file), "mentions", reading.word_span, reading.word_span)


def definitions(index: Index, file: SourceFile, at: Position) -> list[Span]:
    """Return where the name at a position is defined: the facts, rules and plans, or the code of the artifact."""
    found = occurrence_at(index, file, at)
    if found is None:
        return []
    symbol, all_of_it = found.symbol, index.of(found.symbol)
    if symbol.kind == "variable":
        return [each.span for each in _in_order(all_of_it)[:1]]
    declared = [span for each in index.offered(symbol) if (span := each.find()) is not None]
    if declared:
        return declared
    for roles in _OF_BELIEFS if symbol.kind == "belief" else _DEFINING:
        spans = [each.span for each in all_of_it if each.role in roles]
        if spans:
            return spans
    return []


def references(
    index: Index, file: SourceFile, at: Position, with_definitions: bool = True
) -> list[Occurrence]:
    """Return all occurrences of the name at a position, in the whole project."""
    found = occurrence_at(index, file, at)
    if found is None:
        return []
    defining = () if with_definitions else definitions(index, file, at)
    return [each for each in _in_order(index.of(found.symbol)) if each.span not in defining]


def highlights(index: Index, file: SourceFile, at: Position) -> list[Occurrence]:
    """Return the occurrences of the name at a position in the same file."""
    return [each for each in references(index, file, at) if each.span.file.name == file.name]


def _in_order(occurrences: Iterable[Occurrence]) -> list[Occurrence]:
    return sorted(occurrences, key=lambda each: (each.span.file.name, *each.span[1:]))


def _is_there(file: SourceFile, found: Occurrence) -> bool:
    """Return whether the text still has a name where it was when it was read."""
    span = found.span
    line = file.lines[span.line - 1] if span.line <= len(file.lines) else ""
    return line[span.column - 1 : span.end_column - 1] == found.symbol.name


def _guessed(reading: Reading, file: SourceFile) -> Symbol:
    """Return the likely meaning of a name in a clause that does not parse."""
    word, sign = reading.word, reading.sign
    if word[:1].isupper() or word[:1] == "_":
        first = reading.tokens[0] if reading.tokens else None
        place = Span(file, first.line, first.column, 0, 0) if first is not None else reading.replaces
        return Symbol("variable", word, 0, scope_of(place))
    if "." in word:
        return Symbol("internal action", word)
    is_step = reading.part == "body" and not reading.calls and sign not in ("+", "-", "=")
    kind = _SIGNS.get(sign, "operation" if is_step else "belief")
    return Symbol(kind, word, 0 if kind == "plan" else reading.arity)
