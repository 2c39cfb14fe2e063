"""Python source being written: indentation, fresh names, and the AgentSpeak line behind each line of the compiled code."""

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from types import CodeType

from jacaros.asl.source import SourceFile

_READ = re.compile(r" +(v\d+) = deref\(\w+\)")
_SETTLED = re.compile(r"\bv\d+\b")


class Writer:
    """Collects the lines of one piece of generated code.

    Attributes:
        file, origin: file and line of the agent program that the next lines come from.
        files, origins: the same of each line that is written.
        loops: how many loops are open; Python allows 20 nested ones.
    """

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.files: list[SourceFile | None] = []
        self.origins: list[int] = []
        self.file: SourceFile | None = None
        self.origin = 1
        self.depth = 0
        self.loops = 0
        self._count = 0

    def line(self, text: str) -> None:
        """Write one line."""
        self.lines.append("    " * self.depth + text)
        self.files.append(self.file)
        self.origins.append(self.origin)

    def fresh(self, prefix: str = "t") -> str:
        """A local name that is used nowhere else."""
        self._count += 1
        return f"{prefix}{self._count}"

    @contextmanager
    def block(self, head: str) -> Iterator[None]:
        """A compound statement; the lines written inside belong to it."""
        self.line(head)
        self.depth += 1
        loop = head.startswith(("for ", "while "))
        self.loops += loop
        before = len(self.lines)
        yield
        if len(self.lines) == before:
            self.line("pass")
        self.loops -= loop
        self.depth -= 1

    def prune(self) -> None:
        """Remove the values of variables that are read and never used."""
        names = Counter(name for line in self.lines for name in _SETTLED.findall(line))
        kept = [
            index
            for index, line in enumerate(self.lines)
            if (read := _READ.fullmatch(line)) is None or names[read[1]] > 1
        ]
        self.lines = [self.lines[i] for i in kept]
        self.files = [self.files[i] for i in kept]
        self.origins = [self.origins[i] for i in kept]

    def text(self) -> str:
        """The source."""
        return "\n".join(self.lines) + "\n"


def compile_all(writers: Iterable[Writer], filename: str) -> CodeType:
    """Python code of several pieces, whose line numbers are those of the agent program *filename*."""
    lines: list[str] = []
    origins = [0]
    for writer in writers:
        lines += writer.lines
        origins += writer.origins
    origins.append(origins[-1])
    return compile_text("\n".join(lines) + "\n", origins, filename)


_TABLES_ARE_KNOWN = sys.implementation.name == "cpython" and sys.version_info < (3, 15)
"""Whether this Python's tables of line numbers have the form that `_moved` writes (Objects/locations.md of CPython)."""

_NO_COLUMNS, _NO_LINE = 0x80 | 13 << 3, 0x80 | 15 << 3
_MOST_UNITS = 8
"""How many units of code one entry of such a table can stand for."""


def compile_text(text: str, origins: Sequence[int], filename: str) -> CodeType:
    """Compile *text*; its line n gets the number ``origins[n]`` of the file *filename*."""
    if _TABLES_ARE_KNOWN:
        return _moved(compile(text, filename, "exec"), origins)
    tree = ast.parse(text)
    _move(tree, origins)
    return compile(tree, filename, "exec")


def _moved(code: CodeType, origins: Sequence[int]) -> CodeType:
    """The same code with other line numbers: half the work of `_move`."""
    last = first = origins[code.co_firstlineno]
    table = bytearray()
    for start, end, line in code.co_lines():
        units = (end - start) // 2
        head, delta = _NO_LINE, 0
        if line is not None:
            head, delta = _NO_COLUMNS, origins[line] - last
            last += delta
        while units > 0:
            table.append(head | min(units, _MOST_UNITS) - 1)
            if head == _NO_COLUMNS:
                _write(delta, table)
            delta = 0
            units -= _MOST_UNITS
    inner = tuple(_moved(c, origins) if c.__class__ is CodeType else c for c in code.co_consts)
    return code.replace(co_linetable=bytes(table), co_firstlineno=first, co_consts=inner)


def _write(number: int, table: bytearray) -> None:
    """A number with a sign: six bits a byte, the lowest first; the lowest of all is the sign."""
    rest = -number << 1 | 1 if number < 0 else number << 1
    while rest > 63:
        table.append(64 | rest & 63)
        rest >>= 6
    table.append(rest)


def _move(tree: ast.AST, origins: Sequence[int]) -> None:
    """Give each node of a syntax tree the line that its own line comes from; for any Python.

    Written without `ast.walk`, which takes longer than the compiler.
    """
    stack: list[ast.AST] = [tree]
    while stack:
        parts = stack.pop().__dict__
        if "lineno" in parts:
            parts["lineno"] = parts["end_lineno"] = origins[parts["lineno"]]
            parts["col_offset"] = parts["end_col_offset"] = 0
        for part in parts.values():
            if part.__class__ is list:
                stack += [item for item in part if isinstance(item, ast.AST)]
            elif isinstance(part, ast.AST):
                stack.append(part)
