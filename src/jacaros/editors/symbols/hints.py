"""Notes inside the lines of a program: units, and names of parameters of operations and goals."""

from collections.abc import Iterator

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.lexer import Token
from jacaros.editors.symbols.docstrings import short_unit
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Hint, Occurrence, Position
from jacaros.editors.symbols.tokens_at import tokens_of

_FURTHER = 20
"""Number of lines below the last one that a call may reach into."""


def hints(index: Index, file: SourceFile, first: int = 1, last: int | None = None) -> list[Hint]:
    """Return the notes for the lines from *first* to *last*, in order."""
    last = len(file.lines) if last is None else last
    tokens = tokens_of(file, first, last + _FURTHER)
    places = {(each.line, each.column): number for number, each in enumerate(tokens)}
    found: list[Hint] = []
    for occurrence in index.in_file(file.name):
        span = occurrence.span
        if first <= span.line <= last and occurrence.symbol.arity:
            number = places.get((span.line, span.column))
            if number is not None and tokens[number].text == occurrence.symbol.name:
                found += _of(index, occurrence, tokens, number)
    return sorted(found, key=lambda each: each.at)


def _of(index: Index, occurrence: Occurrence, tokens: list[Token], number: int) -> Iterator[Hint]:
    symbol = occurrence.symbol
    offered = index.offered(symbol)
    if not offered or len({each.arguments for each in offered}) > 1:
        return  # unknown, or several artifacts have it
    arguments = offered[0].arguments
    for place, (start, end) in enumerate(_arguments(tokens, number + 1)):
        if place >= len(arguments):
            return
        argument, token = arguments[place], tokens[start]
        is_value = token.kind != "variable" and argument.name
        if symbol.kind == "operation" and is_value and token.text.casefold() != argument.name.casefold():
            at = Position(token.line, token.column)
            yield Hint(at, f"{argument.name}:", "parameter", argument.meaning)
        if argument.unit and tokens[end - 1].text != "_":
            at = Position(tokens[end - 1].line, tokens[end - 1].end)
            yield Hint(at, short_unit(argument.unit), "unit", argument.unit)


def _arguments(tokens: list[Token], opener: int) -> Iterator[tuple[int, int]]:
    """Yield begin and end of each argument of a call, as indices of tokens."""
    if opener >= len(tokens) or tokens[opener].kind != "(":
        return
    depth, start = 0, opener + 1
    for number in range(opener, len(tokens)):
        kind = tokens[number].kind
        depth += (kind in "([{") - (kind in ")]}")
        if (kind == "," and depth == 1) or depth == 0:
            if number > start:
                yield start, number
            start = number + 1
        if depth == 0:
            return
