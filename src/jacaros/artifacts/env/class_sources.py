"""The code of classes, read from their files.

>>> ClassSources().mentions(ClassSources, re.compile("getsourcefile"))
True
"""

import ast
import inspect
import os
import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

_MOST_FILES = 500


class ClassSources:
    """Reads the code of classes, and each version of a file once: `inspect.getsource` reads it for each class."""

    def __init__(self) -> None:
        self._of_file = lru_cache(_MOST_FILES)(_of_file)

    def of(self, kind: type) -> ast.ClassDef | None:
        """Return the code of a class; None for a class that was made at run time."""
        try:
            file = inspect.getsourcefile(kind)
            changed = os.stat(file).st_mtime_ns if file else 0
        except (OSError, TypeError):
            return None
        return self._of_file(file, changed).get(kind.__qualname__) if file else None

    def mentions(self, kind: type, pattern: re.Pattern[str]) -> bool | None:
        """Return whether a pattern is in the code of a class; None if its code is not known."""
        code = self.of(kind)
        return None if code is None else pattern.search(ast.unparse(code)) is not None


def _of_file(file: str, _changed: int) -> dict[str, ast.ClassDef]:
    try:
        tree = ast.parse(Path(file).read_bytes())
    except (OSError, SyntaxError, ValueError):
        return {}
    return dict(reversed(list(_classes(tree))))  # of several with the same name, the first one


def _classes(node: ast.AST, outer: str = "") -> Iterator[tuple[str, ast.ClassDef]]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.ClassDef):
            yield outer + child.name, child
            yield from _classes(child, f"{outer}{child.name}.")
        elif isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from _classes(child, f"{outer}{child.name}.<locals>.")
        elif isinstance(child, ast.stmt | ast.excepthandler | ast.match_case):
            yield from _classes(child, outer)
