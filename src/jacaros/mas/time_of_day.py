"""Code of a project that reads the time of day, which does not follow a virtual clock."""

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.files.texts import file_text, shown_from

_INSTEAD: Final = {
    "time": "self.clock.now()",
    "time_ns": "self.clock.now()",
    "monotonic": "self.clock.elapsed",
    "monotonic_ns": "self.clock.elapsed",
    "sleep": "await self.sleep(seconds)",
}
"""Functions of the module `time`, and what artifacts and agents in Python have instead."""


def readings(files: Iterable[Path]) -> Iterator[Diagnostic]:
    """Yield a warning for the first such call in each file; installed packages may lie below the project's folder."""
    for file in files:
        if "site-packages" in file.parts:
            continue
        text = file_text(file)
        found = next(_calls(text), None) if "time" in text else None
        if found is not None:
            place, name = found
            span = Span(
                SourceFile(shown_from(Path.cwd(), file), text),
                place.lineno,
                place.col_offset + 1,
                place.end_lineno or place.lineno,
                (place.end_col_offset or place.col_offset) + 1,
            )
            message = f"`time.{name}` follows the time of day, not the virtual clock of this run"
            yield Diagnostic("warning", message, span, f"use `{_INSTEAD[name]}`, or run with --clock real")


def _calls(text: str) -> Iterator[tuple[ast.expr, str]]:
    """Yield the calls of functions of `time`, however imported, with their names there."""
    names: dict[str, str] = {}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            modules = [each.asname or each.name for each in node.names if each.name == "time"]
            names |= {f"{module}.{name}": name for module in modules for name in _INSTEAD}
        elif isinstance(node, ast.ImportFrom) and node.module == "time":
            names |= {each.asname or each.name: each.name for each in node.names if each.name in _INSTEAD}
        elif isinstance(node, ast.Call) and (name := names.get(ast.unparse(node.func))):
            yield node.func, name
