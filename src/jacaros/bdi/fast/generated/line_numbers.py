"""Python code compiled from generated text, with the line numbers of the agent program that the text was made from."""

import ast
import sys
from collections.abc import Sequence
from types import CodeType

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
