"""The parts of a program or project file, for outlines, folding and search."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from lsprotocol import types
from pygls.workspace import PositionCodec

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.agents.language.lexer import Comment, tokenize
from jacaros.agents.language.loader import read_program
from jacaros.agents.language.lowering import format_term
from jacaros.editors.lsp.membership import PROGRAM, files_in
from jacaros.editors.lsp.positions import Positions, uri_of
from jacaros.runtime.files.texts import file_text, unsaved
from jacaros.runtime.mas.checks.files import PROJECTS
from jacaros.runtime.mas.project.declarations import ProjectPart
from jacaros.runtime.mas.project.reading import reader_of

_LONGEST: Final = 60
_MOST: Final = 500


@dataclass(frozen=True)
class Entry:
    """One part of a text.

    Attributes:
        name: as the outline shows it.
        kind: of the part, for its icon.
        span: the whole part.
        chosen: its name in the text, which is selected when you choose it.
        detail: shown after the name.
        node: the node of a program.
        children: the parts within.
    """

    name: str
    kind: types.SymbolKind
    span: Span
    chosen: Span
    detail: str = ""
    node: nodes.Node | None = None
    children: tuple["Entry", ...] = field(default=())


def outline_of(file: SourceFile) -> list[Entry]:
    """Return the parts of a text, as far as it can be parsed; none of other kinds of files."""
    if file.name.endswith(PROGRAM):
        program, _ = read_program(file)
        return [each for each in _of_program(program) if each.span.file is file]
    if file.name.endswith(PROJECTS):
        reported: list[Diagnostic] = []
        return list(_of_project(reader_of(file, reported).read()))
    return []


def _of_program(program: nodes.Program) -> Iterator[Entry]:
    clauses: list[nodes.Node] = [*program.beliefs, *program.goals, *program.plans]
    known = [each for each in clauses if each.span is not None]
    for clause in sorted(known, key=lambda each: (each.span.line, each.span.column) if each.span else (0, 0)):
        yield from _of_clause(clause)


def _of_clause(clause: nodes.Node) -> Iterator[Entry]:
    span = clause.span
    if span is None:
        return
    match clause:
        case nodes.Plan():
            trigger, label = clause.trigger, clause.label
            name = f"{trigger.operator}{trigger.kind}{_short(trigger.literal)}"
            detail = (
                f"@{label.functor}" if isinstance(label, nodes.Literal) and label.span is not None else ""
            )
            inner = tuple(each for plan in clause.subplans for each in _of_clause(plan))
            yield Entry(name, types.SymbolKind.Event, span, trigger.span or span, detail, clause, inner)
        case nodes.Rule():
            head = clause.head
            yield Entry(_short(head), types.SymbolKind.Function, span, head.span or span, "rule", clause)
        case nodes.Literal():
            yield Entry(_short(clause), types.SymbolKind.Property, span, span, "", clause)


def _short(term: nodes.Term) -> str:
    text = format_term(term)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def _of_project(part: ProjectPart) -> Iterator[Entry]:
    for agent in part.agents:
        yield Entry(agent.name, types.SymbolKind.Class, agent.span, agent.span, agent.source or "agent")
    for space in part.workspaces:
        inner = tuple(
            Entry(each.name, types.SymbolKind.Object, each.span, each.span, each.type_name)
            for each in (artifact.spec for artifact in space.artifacts)
            if each.span is not None
        )
        yield Entry(space.name, types.SymbolKind.Namespace, space.span, space.span, "workspace", None, inner)
    for node in part.nodes:
        if node.span is not None:
            yield Entry(node.name, types.SymbolKind.Module, node.span, node.span, "node")


def symbols(entries: list[Entry], positions: Positions) -> list[types.DocumentSymbol]:
    """Return the outline of a document. The range of a part includes its parts."""
    return [_symbol(each, positions) for each in entries]


def _symbol(entry: Entry, positions: Positions) -> types.DocumentSymbol:
    children = [_symbol(each, positions) for each in entry.children]
    whole, chosen = positions.range(entry.span), positions.range(entry.chosen)
    last = max([whole.end, chosen.end, *(each.range.end for each in children)])
    first = min(whole.start, chosen.start)
    return types.DocumentSymbol(
        entry.name or "?",
        entry.kind,
        types.Range(first, last),
        chosen,
        entry.detail or None,
        children=children,
    )


def folds(file: SourceFile, entries: list[Entry]) -> list[types.FoldingRange]:
    """Return the foldable ranges: clauses, blocks in braces of project files, and comments of several lines."""
    found = [
        types.FoldingRange(first - 1, last - 1)
        for first, last in sorted(
            {*((each.span.line, each.span.end_line) for each in _all(entries)), *_braces(file)}
        )
        if last > first
    ]
    return [*found, *_of_comments(file)]


def _braces(file: SourceFile) -> Iterator[tuple[int, int]]:
    opened: list[int] = []
    for token in tokenize(file, lambda _: None):
        if token.kind == "{":
            opened.append(token.line)
        elif token.kind == "}" and opened:
            yield opened.pop(), token.line - 1


def _of_comments(file: SourceFile) -> Iterator[types.FoldingRange]:
    comments: list[Comment] = []
    tokenize(file, lambda _: None, comments)
    first = last = 0
    for comment in [*comments, Comment("", 0, 0, 0)]:
        end = comment.line + comment.text.count("\n")
        own = not file.lines[comment.line - 1][: comment.column - 1].strip() if comment.line else False
        if own and first and comment.line == last + 1:
            last = end
            continue
        if last > first:
            yield types.FoldingRange(first - 1, last - 1, kind=types.FoldingRangeKind.Comment)
        first, last = (comment.line, end) if own else (0, 0)


def search(
    roots: Iterable[Path], query: str, texts: Mapping[Path, str], codec: PositionCodec
) -> list[types.WorkspaceSymbol]:
    """Return the parts whose names contain the letters of the query in this order, at most 500."""
    found: list[types.WorkspaceSymbol] = []
    with unsaved({str(path): text for path, text in texts.items()}):
        for path in files_in(roots, (PROGRAM, *PROJECTS)):
            try:
                file = SourceFile(path.as_posix(), file_text(path))
            except (OSError, UnicodeError):
                continue
            positions = Positions(file, codec)
            for entry in _all(outline_of(file)):
                if fits(query, entry.name):
                    where = types.Location(uri_of(path), positions.range(entry.chosen))
                    found.append(
                        types.WorkspaceSymbol(where, entry.name, entry.kind, container_name=path.name)
                    )
                    if len(found) == _MOST:
                        return found
    return found


def fits(query: str, name: str) -> bool:
    """Return whether a name contains the letters of a query in this order, in any case."""
    letters = iter(name.lower())
    return all(letter in letters for letter in query.lower())


def _all(entries: Iterable[Entry]) -> Iterator[Entry]:
    for each in entries:
        yield each
        yield from _all(each.children)
