"""Source files, read once for all programs that use them."""

import ast
from pathlib import Path
from typing import NamedTuple

from jacaros.agents.language.diagnostics import AslError, Diagnostic, SourceFile
from jacaros.files.texts import file_bytes
from jacaros.mas.agents.programs import text_of
from jacaros.metrics import agentspeak, python_source
from jacaros.metrics.comments import Stretch
from jacaros.metrics.counted_file import CountedFile


class PythonFile(NamedTuple):
    """A parsed Python file."""

    counted: CountedFile
    tree: ast.Module


class Sources:
    """Reads source files, and collects their errors.

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
            self._python[key] = self._parsed(path)
        return self._python[key]

    def _parsed(self, path: Path) -> PythonFile | None:
        text = self.text(path)
        if text is None:
            return None
        try:
            tree = python_source.parse(SourceFile(path.as_posix(), text))
        except AslError as error:
            self.report(*error.diagnostics)
            return None
        names = python_source.identifiers_of(tree)
        return PythonFile(counted(path, text, python_source.comments_of(tree, text), names, names), tree)

    def agentspeak(self, path: Path, identifiers: frozenset[str], names: frozenset[str]) -> CountedFile:
        """Return the file of a parsed program."""
        text = text_of(path)
        return counted(
            path, text, agentspeak.comments_of(SourceFile(path.as_posix(), text)), identifiers, names
        )


def counted(
    path: Path, text: str, comments: list[Stretch], identifiers: frozenset[str], names: frozenset[str]
) -> CountedFile:
    """Return a file with its counts."""
    return CountedFile(path, file_bytes(path), text, tuple(comments), identifiers, names)
