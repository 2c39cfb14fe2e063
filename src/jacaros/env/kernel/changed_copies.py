"""``self.value("path").append(x)``: changes a copy that nobody has, and no property."""

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
"""Methods of lists and dictionaries that change them."""


def changed_copies(artifact_type: type) -> Iterator[str]:
    """The methods of a class that change what ``self.value`` has just given, with the call and its line."""
    for member in vars(artifact_type).values():
        function = getattr(member, "plain", member)
        code = getattr(function, "__code__", None)
        # Source texts are read only for those few methods that use such names.
        if code is not None and "value" in code.co_names and not _CHANGING.isdisjoint(code.co_names):
            yield from _in_method(function)


def _in_method(function: Callable[..., Any]) -> Iterator[str]:
    try:
        lines, first = inspect.getsourcelines(function)
        tree = ast.parse(textwrap.dedent("".join(lines)))
    except (OSError, SyntaxError, TypeError):  # made at run time, or its file has gone
        return
    for node in ast.walk(tree):
        # `last = self.value("path").pop()` looks at the copy; a statement has no use for it.
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
