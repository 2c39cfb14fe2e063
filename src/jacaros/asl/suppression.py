"""Comments that switch warnings off.

    p(X) :- q(Y).     // jacaros: ignore singleton-variable       for this line
    // jacaros: ignore singleton-variable                         on its own line: for the next clause or line
    // jacaros: ignore-file singleton-variable, missing-context   for the file

Errors cannot be switched off. Text after ``(`` is a comment for the reader.

>>> text = "p(X) :- q.   // jacaros: ignore singleton-variable"
>>> file = SourceFile("robot.asl", text)
>>> list(wanted([problem("singleton-variable", "variable `X`", Span(file, 1, 3, 1, 4))]))
[]
"""

import re
from collections.abc import Iterable, Iterator
from typing import Final

from jacaros.asl.diagnostics import KINDS, Diagnostic, problem
from jacaros.asl.lexer import Comment, Token, tokenize
from jacaros.asl.source import SourceFile, Span

_ORDER: Final = re.compile(r"jacaros:\s*ignore(?P<file>-file)?\b(?P<codes>[^(\n]*)")
_CODE: Final = re.compile(r"[A-Za-z][\w-]*")


class Suppressions:
    """The suppression comments of one file; ``unknown`` warns of unknown codes."""

    def __init__(self, file: SourceFile) -> None:
        self.unknown: list[Diagnostic] = []
        self._everywhere: set[str] = set()
        self._lines: list[tuple[range, frozenset[str]]] = []
        comments: list[Comment] = []
        if "jacaros:" in file.text:
            tokens = tokenize(file, lambda _: None, comments)
            for comment in comments:
                self._take(file, comment, tokens)

    def _take(self, file: SourceFile, comment: Comment, tokens: list[Token]) -> None:
        order = _ORDER.search(comment.text)
        if order is None:
            return
        codes = frozenset(_CODE.findall(order["codes"]))
        for code in sorted(codes - KINDS.keys()):
            span = Span(file, comment.line, comment.column, comment.line, comment.column + len(comment.text))
            self.unknown.append(problem("unknown-code", f"unknown code `{code}`", span))
        if order["file"]:
            self._everywhere |= codes
        else:
            self._lines.append((_lines_of(comment, tokens), codes))

    def switch_off(self, diagnostic: Diagnostic) -> bool:
        """Return whether a comment suppresses *diagnostic*, which is about this file."""
        if diagnostic.severity == "error" or diagnostic.span is None:
            return False
        if diagnostic.code in self._everywhere:
            return True
        line = diagnostic.span.line
        return any(line in lines and diagnostic.code in codes for lines, codes in self._lines)


def _lines_of(comment: Comment, tokens: list[Token]) -> range:
    """Return the lines that a comment applies to: its own, or the clause that begins below, or the next line."""
    if any(token.line == comment.line and token.column < comment.column for token in tokens[:-2]):
        return range(comment.line, comment.line + 1)
    at = comment.next_token
    first = tokens[at].line
    last = first
    if at == 0 or tokens[at - 1].kind in (".", "}"):
        while tokens[at].kind not in (".", "end"):
            at += 1
        last = tokens[at].line
    return range(first, last + 1)


def wanted(diagnostics: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield the diagnostics that no comment of their files suppresses."""
    known: dict[str, Suppressions] = {}
    for diagnostic in diagnostics:
        if diagnostic.severity == "error" or diagnostic.span is None:
            yield diagnostic
            continue
        file = diagnostic.span.file
        orders = known.get(file.name)
        if orders is None:
            orders = known[file.name] = Suppressions(file)
        if not orders.switch_off(diagnostic):
            yield diagnostic
