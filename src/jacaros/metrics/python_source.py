"""Names, comments and imports of Python files, read from their syntax tree without running them."""

import ast
import io
import tokenize
import warnings
from collections.abc import Iterator
from typing import Final, NamedTuple

from jacaros.agents.language.diagnostics import AslError, Diagnostic, SourceFile, Span
from jacaros.metrics.comments import Stretch, line_starts

_RECEIVERS: Final = frozenset({"self", "cls"})
"""First parameters of methods, whose names are not the author's choice."""


def parse(file: SourceFile) -> ast.Module:
    """Return the syntax tree of a file.

    Raises:
        AslError: it is not Python.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about the code that is counted, not about ours
            return ast.parse(file.text, file.name)
    except SyntaxError as error:
        raise AslError([_not_python(file, error)]) from error
    except (ValueError, RecursionError, MemoryError) as error:
        # Python's own parser has limits of nesting.
        why = str(error) or "nested too deeply"
        raise AslError([Diagnostic("error", f"cannot parse {file.name}: {why}")]) from error


def _not_python(file: SourceFile, error: SyntaxError) -> Diagnostic:
    line, column = error.lineno or 1, max(1, error.offset or 1)
    end_line, end = error.end_lineno or line, max(column + 1, error.end_offset or 0)
    return Diagnostic(
        "error",
        f"not Python: {error.msg}",
        Span(file, line, column, end_line, end),
    )


def identifiers_of(tree: ast.AST) -> frozenset[str]:
    """Names of classes, functions, parameters and variables, and of attributes that are assigned.

    A variable is whatever name the code binds, but for imports; ``_``, ``self`` and ``cls`` do not count.
    """
    return frozenset(name for node in ast.walk(tree) for name in _bound(node) if name != "_")


def _bound(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
        yield node.name
    elif isinstance(node, ast.arg):
        if node.arg not in _RECEIVERS:
            yield node.arg
    elif isinstance(node, ast.Name):
        if isinstance(node.ctx, ast.Store):
            yield node.id
    elif isinstance(node, ast.Attribute):
        if isinstance(node.ctx, ast.Store):
            yield node.attr
    elif isinstance(node, ast.ExceptHandler | ast.MatchAs | ast.MatchStar):
        if node.name is not None:
            yield node.name
    elif isinstance(node, ast.MatchMapping) and node.rest is not None:
        yield node.rest


def comments_of(tree: ast.Module, text: str) -> list[Stretch]:
    """The comments of a file, and its docstrings: the string literals that are statements by themselves."""
    starts = line_starts(text)
    found = [
        (starts[line - 1] + column, starts[line - 1] + column + len(token.string))
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type == tokenize.COMMENT
        for line, column in (token.start,)
    ]
    lines = text.split("\n")
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Expr)
            and isinstance(node.value, ast.Constant)
            and isinstance(node.value.value, str)
        ):
            end_line, end = node.end_lineno or node.lineno, node.end_col_offset or node.col_offset
            found.append(
                (
                    starts[node.lineno - 1] + _characters(lines[node.lineno - 1], node.col_offset),
                    starts[end_line - 1] + _characters(lines[end_line - 1], end),
                )
            )
    return _apart(sorted(found))


def _characters(line: str, offset: int) -> int:
    """From an offset in bytes, as the syntax tree has it, to one in characters."""
    return offset if line.isascii() else len(line.encode()[:offset].decode())


def _apart(stretches: list[Stretch]) -> list[Stretch]:
    """Without those within others: a docstring of several literals may have comments between them."""
    kept: list[Stretch] = []
    for each in stretches:
        if not kept or each[0] >= kept[-1][1]:
            kept.append(each)
    return kept


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


def imports_of(tree: ast.AST) -> frozenset[Import]:
    """All imports of a file, those in functions too, but for those that only type checkers see."""
    found: set[Import] = set()
    nodes = [tree]
    while nodes:  # expressions may be deeper than Python's stack
        node = nodes.pop()
        if isinstance(node, ast.Import):
            found.update(Import(each.name) for each in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = f"{node.module}." if node.module else ""
            found.update(Import(f"{module}{each.name}", node.level) for each in node.names)
        elif isinstance(node, ast.If) and _is_type_checking(node.test):
            nodes += node.orelse
        else:
            nodes += ast.iter_child_nodes(node)
    return frozenset(found)


def _is_type_checking(test: ast.expr) -> bool:
    return getattr(test, "id", getattr(test, "attr", "")) == "TYPE_CHECKING"


def base_names(tree: ast.AST) -> frozenset[str]:
    """The last names of the base classes of all classes of a file."""
    bases = (base for node in ast.walk(tree) if isinstance(node, ast.ClassDef) for base in node.bases)
    return frozenset(str(getattr(base, "attr", getattr(base, "id", ""))) for base in bases)
