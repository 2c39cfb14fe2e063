"""Change a name wherever it occurs in a project."""

import re
from typing import Final

from jacaros.agents.language.diagnostics import SourceFile, Span
from jacaros.agents.language.lexer import RESERVED
from jacaros.agents.language.term_parser import KEYWORDS
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Edit, Occurrence, Position, RenameRefused, Symbol
from jacaros.editors.symbols.navigation import occurrence_at
from jacaros.editors.symbols.tokens_at import tokens_of

_ATOM: Final = re.compile(r"[a-z]\w*|'[^'\n]+'", re.ASCII)
_SIGNS: Final = frozenset({"!", "!!", "?", "+", "-", "-+"})
"""What is before the name of a goal or belief, and not before a term."""
_VARIABLE: Final = re.compile(r"[A-Z_]\w*", re.ASCII)


def renamable(index: Index, file: SourceFile, at: Position) -> Span:
    """Return the range of the name at a position.

    Raises:
        RenameRefused: there is no name, or it is not a name of this project.
    """
    return _renamable(index, file, at).span


def rename(index: Index, file: SourceFile, at: Position, name: str) -> list[Edit]:
    """Return the edits that change a name in all programs.

    Raises:
        RenameRefused: it cannot be changed, *name* is not valid, or it would mean something else somewhere.
    """
    symbol = _renamable(index, file, at).symbol
    if name == symbol.name:
        return []
    _check_form(symbol, name)
    _check_clash(index, symbol, name)
    _check_errors(index, symbol)
    return [Edit(each.span, name) for each in index.of(symbol)]


def _renamable(index: Index, file: SourceFile, at: Position) -> Occurrence:
    found = occurrence_at(index, file, at)
    if found is None:
        raise RenameRefused("nothing to rename here", "put the cursor on a name")
    symbol = found.symbol
    if symbol.kind == "internal action":
        raise RenameRefused(f"`{symbol.name}` is an internal action", "rename it where it is declared")
    offered = index.offered(symbol)
    if offered:
        help = f"rename it in `{offered[0].holder}` and in the programs"
        raise RenameRefused(f"`{symbol.name}` is {offered[0].role}", help)
    if symbol.kind == "operation":
        raise RenameRefused(f"`{symbol.name}` is an operation of an artifact", "rename it in the artifact")
    occurrences = index.of(symbol)
    if not occurrences:
        raise RenameRefused(f"`{symbol.name}` is in a clause with errors", "correct the clause first")
    foreign = next((each.span.file.name for each in occurrences if each.span.file.name.startswith("$")), "")
    if foreign:
        raise RenameRefused(
            f"`{symbol.name}` is also a name in the library `{foreign}`", "use another name beside it"
        )
    return found


def _check_form(symbol: Symbol, name: str) -> None:
    if symbol.kind == "variable":
        if _VARIABLE.fullmatch(name) is None or name == "_":
            raise RenameRefused(f"`{name}` is not a variable", "begin variables with a capital letter")
    elif _ATOM.fullmatch(name) is None:
        raise RenameRefused(
            f"`{name}` is not a name", "use letters, digits and `_`, and begin with a small letter"
        )
    elif name in RESERVED | KEYWORDS:
        raise RenameRefused(f"`{name}` is a word of the language", "choose another name")


def _check_clash(index: Index, symbol: Symbol, name: str) -> None:
    """Refuse a name that already means something: both would become one."""
    wanted = symbol._replace(name=name)
    there = index.of(wanted)
    if there:
        span = there[0].span
        where = f"{span.file.name}:{span.line}"
        raise RenameRefused(f"`{wanted}` exists already ({where})", "choose another name")
    offered = index.offered(wanted)
    if offered:
        raise RenameRefused(f"`{wanted}` is {offered[0].role}", "choose another name")


def _check_errors(index: Index, symbol: Symbol) -> None:
    """Refuse if the name is also in a directive, or in a step that does not parse: it would keep the old name there."""
    for file, occurrences in index.files() if symbol.kind != "variable" else ():
        known = {each.span[1:3] for each in occurrences if each.symbol.name == symbol.name}
        if file.text.count(symbol.name) == len(known):
            continue
        clauses = {each.clause[1:] for each in occurrences}
        before = None
        for token in tokens_of(file, 1, len(file.lines)):
            at = token.line, token.column
            if token.text == symbol.name and at not in known:
                in_term = any(each[:2] <= at < each[2:] for each in clauses) and before not in _SIGNS
                if not in_term:
                    where = f"({file.name}:{token.line})"
                    message = f"`{symbol.name}` is also in a directive or a clause with errors {where}"
                    raise RenameRefused(message, "change it there first")
            before = token.kind
