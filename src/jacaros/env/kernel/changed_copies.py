"""Find ``self.value("path").append(x)``, which changes only a copy, not the property."""

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterator
from typing import Any, Final

_CHANGING: Final = frozenset(
    {
        *("append", "extend", "insert", "remove", "pop", "clear", "sort", "reverse"),
        *("update", "setdefault", "popitem"),
    }
)
"""Mutating methods of lists and dictionaries."""


def changed_copies(artifact_type: type) -> Iterator[str]:
    """Return the methods of a class that change the copy that ``self.value`` returned, with the call and its line."""
    for member in vars(artifact_type).values():
        function = getattr(member, "plain", member)
        code = getattr(function, "__code__", None)
        # Only methods that use such names have their source read.
        if code is not None and "value" in code.co_names and not _CHANGING.isdisjoint(code.co_names):
            yield from _in_method(function)


def _in_method(function: Callable[..., Any]) -> Iterator[str]:
    try:
        lines, first = inspect.getsourcelines(function)
        tree = ast.parse(textwrap.dedent("".join(lines)))
    except (OSError, SyntaxError, TypeError):  # created at run time, or its file is gone
        return
    for node in ast.walk(tree):
        # `last = self.value("path").pop()` uses the copy; a statement does not.
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call) and _changes_copy(node.value.func):
            yield f"{function.__qualname__} (line {first + node.lineno - 1}): {ast.unparse(node.value)}"


def _changes_copy(method: ast.expr) -> bool:
    if not (isinstance(method, ast.Attribute) and method.attr in _CHANGING):
        return False
    owner = method.value
    return (
        isinstance(owner, ast.Call)
        and isinstance(owner.func, ast.Attribute)
        and owner.func.attr == "value"
        and isinstance(owner.func.value, ast.Name)
        and owner.func.value.id == "self"
    )
