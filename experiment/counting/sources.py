"""Source files of all languages: their names, comments and imports, read without running them."""

import ast
import io
import tokenize
import warnings
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple

from ruamel.yaml import YAML

from counting.counts import CountedFile, Stretch
from jacaros.agents.checks.formulas import conditions
from jacaros.agents.language import lexer, nodes
from jacaros.agents.language.diagnostics import AslError, Diagnostic, SourceFile, Span
from jacaros.agents.language.nodes import parts_of, walk
from jacaros.robots.mapping.file import MappingFile
from jacaros.runtime.files.texts import file_bytes
from jacaros.runtime.mas.agents.programs import text_of

_RECEIVERS: Final = frozenset({"self", "cls"})
"""First parameters of methods, whose names are not the author's choice."""


class Import(NamedTuple):
    """A module that a file imports, or a name that it takes from one, with dots.

    Attributes:
        name: of it.
        level: the number of dots in front: 0 for an absolute name, 1 for one in the package of the file.
    """

    name: str
    level: int = 0

    def absolute(self, package: str) -> str:
        """The whole name, when *package* is the package of the file."""
        if not self.level:
            return self.name
        parts = package.split(".")
        return ".".join([*parts[: len(parts) - self.level + 1], self.name])


@dataclass(frozen=True)
class PythonFile:
    """A parsed Python file."""

    counted: CountedFile
    tree: ast.Module

    @cached_property
    def imports(self) -> frozenset[Import]:
        """All imports of the file, those in functions too, but for those that only type checkers see."""
        found: set[Import] = set()
        nodes: list[ast.AST] = [self.tree]
        while nodes:  # expressions may be deeper than Python's stack
            node = nodes.pop()
            if isinstance(node, ast.Import):
                found.update(Import(each.name) for each in node.names)
            elif isinstance(node, ast.ImportFrom):
                module = f"{node.module}." if node.module else ""
                found.update(Import(f"{module}{each.name}", node.level) for each in node.names)
            elif isinstance(node, ast.If) and _last_name(node.test) == "TYPE_CHECKING":
                nodes += node.orelse
            else:
                nodes += ast.iter_child_nodes(node)
        return frozenset(found)

    @property
    def modules(self) -> set[str]:
        """The names of absolute imports."""
        return {each.name for each in self.imports if not each.level}

    def uses(self, *packages: str) -> bool:
        """Return whether the file imports one of these packages, or a part of it."""
        return any(f"{name}.".startswith(f"{package}.") for name in self.modules for package in packages)

    @property
    def base_names(self) -> set[str]:
        """The last names of the base classes of all classes."""
        classes = (node for node in ast.walk(self.tree) if isinstance(node, ast.ClassDef))
        return {_last_name(base) for each in classes for base in each.bases}


def _last_name(expression: ast.expr) -> str:
    return str(getattr(expression, "attr", getattr(expression, "id", "")))


class Sources:
    """Reads source files once for all programs that use them, and collects their errors.

    Attributes:
        problems: errors of all files in the order of reading, without repetition.
    """

    def __init__(self) -> None:
        self.problems: dict[Diagnostic, None] = {}
        self._python: dict[Path, PythonFile | None] = {}

    def report(self, *problems: Diagnostic) -> None:
        """Add the errors among *problems*."""
        self.problems.update(dict.fromkeys(each for each in problems if each.severity == "error"))

    def text(self, path: Path) -> str | None:
        """Return the text of a file; None after reporting that it is unreadable or not text."""
        try:
            return text_of(path)
        except AslError as error:
            self.report(*error.diagnostics)
            return None

    def python(self, path: Path) -> PythonFile | None:
        """Return a Python file; None after reporting that it is not Python."""
        key = path.resolve()
        if key not in self._python:
            try:
                self._python[key] = _python_file(path, text_of(path))
            except AslError as error:
                self.report(*error.diagnostics)
                self._python[key] = None
        return self._python[key]


def counted(
    path: Path,
    text: str,
    comments: Iterable[Stretch],
    names: Iterable[str],
    identifiers: Iterable[str] | None = None,
) -> CountedFile:
    """Return a file with its counts; all *names* are identifiers unless these are given."""
    every = frozenset(names)
    chosen = every if identifiers is None else frozenset(identifiers)
    return CountedFile(path, file_bytes(path), text, tuple(comments), chosen, every)


def _line_starts(text: str) -> list[int]:
    """Return the offset of each line; only a line feed ends a line."""
    starts = [0]
    for line in text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    return starts


def between(text: str, tokens: Iterable[Stretch]) -> Iterator[Stretch]:
    """Yield the non-blank text between tokens, which can only be comments."""
    at = 0
    for start, stop in (*tokens, (len(text), len(text))):
        gap = text[at : max(at, start)]
        if not gap.isspace() and gap:
            yield at + len(gap) - len(gap.lstrip()), at + len(gap.rstrip())
        at = max(at, stop)


# Python


def _python_file(path: Path, text: str) -> PythonFile:
    """Parse a Python file.

    Raises:
        AslError: it is not Python.
    """
    file = SourceFile(path.as_posix(), text)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about the code that is counted, not about ours
            tree = ast.parse(text, file.name)
    except SyntaxError as error:
        line, column = error.lineno or 1, max(1, error.offset or 1)
        span = Span(file, line, column, error.end_lineno or line, max(column + 1, error.end_offset or 0))
        raise AslError([Diagnostic("error", f"not Python: {error.msg}", span)]) from error
    except (ValueError, RecursionError, MemoryError) as error:
        # Python's own parser has limits of nesting.
        why = str(error) or "nested too deeply"
        raise AslError([Diagnostic("error", f"cannot parse {file.name}: {why}")]) from error
    names = {name for node in ast.walk(tree) for name in _bound(node)} - {"_"}
    return PythonFile(counted(path, text, _python_comments(tree, text), names), tree)


def _bound(node: ast.AST) -> Iterator[str]:
    """Yield the names that a node binds: of classes, functions, parameters and variables, and of assigned attributes.

    A variable is whatever name the code binds, but for imports.
    """
    match node:
        case ast.ClassDef(name=name) | ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
            yield name
        case ast.arg(arg=name) if name not in _RECEIVERS:
            yield name
        case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
            yield name
        case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
            yield name
        case ast.MatchMapping(rest=str(name)):
            yield name


def _python_comments(tree: ast.Module, text: str) -> list[Stretch]:
    """The comments of a file, and its docstrings: the string literals that are statements by themselves."""
    starts, lines = _line_starts(text), text.split("\n")
    found = [
        (starts[line - 1] + column, starts[line - 1] + column + len(token.string))
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type == tokenize.COMMENT
        for line, column in (token.start,)
    ]

    def offset(line: int, column: int) -> int:
        # The syntax tree counts bytes.
        return starts[line - 1] + len(lines[line - 1].encode()[:column].decode())

    for node in ast.walk(tree):
        match node:
            case ast.Expr(value=ast.Constant(value=str())):
                end = offset(node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)
                found.append((offset(node.lineno, node.col_offset), end))
    return sorted(found)


# AgentSpeak


_GOALS: Final = {
    nodes.Trigger: "literal",
    nodes.Achieve: "goal",
    nodes.Test: "formula",
    nodes.ExternalAction: "action",
}
"""What names a goal, event or operation in a node. The test of a compound condition has no name: it posts no goal."""
_OTHERS: Final = {nodes.BeliefChange: "operand", nodes.Rule: "head", nodes.Plan: "label"}


def goals_events_operations(clause: nodes.Node, is_goal: bool = False) -> Iterator[str]:
    """Yield the names of goals, events and operations in a clause of a program.

    Args:
        clause: a plan, rule, belief or initial goal.
        is_goal: the clause is an initial goal.
    """
    if is_goal:
        yield from _functor(clause)
    yield from _named(clause, _GOALS)


def other_names(clause: nodes.Node) -> Iterator[str]:
    """Yield the names of beliefs, rules, labels and variables in a clause."""
    if isinstance(clause, nodes.Literal):
        yield from _functor(clause)
    yield from _named(clause, _OTHERS)
    for node in walk(clause):
        for condition in conditions(node):
            for part in parts_of(condition):
                yield from _functor(part)
        if isinstance(node, nodes.Variable) and not node.unnamed:
            yield node.name


def _named(clause: nodes.Node, parts: Mapping[Any, str]) -> Iterator[str]:
    for node in walk(clause):
        if (part := parts.get(type(node))) is not None:
            yield from _functor(getattr(node, part))


def _functor(node: object) -> Iterator[str]:
    """Yield the name of a literal; none for a variable, a relation, or ``true``."""
    if isinstance(node, nodes.Literal) and node.functor not in ("true", "false"):
        yield node.functor.strip("'")


def agentspeak_comments(text: str) -> list[Stretch]:
    """Return the comments of a valid program."""
    comments: list[lexer.Comment] = []
    lexer.tokenize(SourceFile("", text), lambda _: None, comments)
    starts = _line_starts(text)
    places = ((starts[each.line - 1] + each.column - 1, len(each.text)) for each in comments)
    return [(start, start + length) for start, length in places]


# YAML


def yaml_comments(text: str) -> Iterator[Stretch]:
    """Yield the comments of a valid YAML text."""
    tokens = YAML(typ="safe", pure=True).scan(io.StringIO(text))
    # Block ends have no text: they are at the start of the next token.
    places = ((each.start_mark.index, each.end_mark.index) for each in tokens)
    return between(text, (place for place in places if place[0] < place[1]))


def mapping_names(mapping: MappingFile) -> Iterator[str]:
    """Yield the names defined in a mapping file: artifacts, properties, signals, operations and their parameters."""
    for part in mapping.artifacts.values():
        yield part.name
        for observable in (part.topics, part.frames, part.parameters, part.derived):
            yield from (each.name for each in observable)
        for operation in part.operations:
            yield operation.name
            yield from operation.parameters
            yield from (feedback.name for feedback in operation.feedback)


def world_names(document: dict[str, Any]) -> Iterator[str]:
    """Yield the names in a world file or fault file: of rooms, docks, doors, robots and so on."""
    yield from _named_things(document)
    if isinstance(rooms := document.get("rooms"), dict):
        yield from rooms


def _named_things(value: Any) -> Iterator[str]:
    """Yield the values of the keys ``name`` in a document."""
    if isinstance(value, dict):
        if isinstance(name := value.get("name"), str):
            yield name
        for each in value.values():
            yield from _named_things(each)
    elif isinstance(value, list):
        for each in value:
            yield from _named_things(each)
