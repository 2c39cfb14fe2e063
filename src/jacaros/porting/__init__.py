"""Java artifacts and environments in Python: a first version, and what is left to do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from jacaros.porting.model import FileModel, model_of
from jacaros.porting.reading import COMMENTS, NotPortable, every, line_of, read
from jacaros.porting.writing import Writer

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tree_sitter import Node

__all__ = ["NotPortable", "Ported", "port"]


@dataclass(frozen=True, slots=True)
class Ported:
    """The Python file for a Java file.

    Attributes:
        text: of the file.
        artifacts: names of the artifact types.
        environments: those of them that are environments of Jason.
        lines: lines of code in Java.
        left: numbers of those that are left to a person.
        windows: numbers of those that only show windows, which are left out.
    """

    text: str
    artifacts: list[str]
    environments: list[str]
    lines: int
    left: list[int]
    windows: list[int]


def port(name: str, text: str) -> Ported:
    """Port a Java file.

    Args:
        name: of the file.
        text: its content.

    Raises:
        NotPortable: it is not Java, or has neither an artifact nor an environment.
        UsageError: the parser is not installed.
    """
    model = model_of(read(name, text))
    artifacts = [each.name for each in model.classes.values() if each.is_artifact]
    if not artifacts:
        raise NotPortable(f"{name}: error: no class in it is an artifact or an environment")
    writer = Writer(model)
    python = writer.file()
    code = _code_lines(model)
    windows = _lines(writer.windows) & code
    return Ported(
        python,
        artifacts,
        [each.name for each in model.classes.values() if each.is_environment],
        len(code),
        sorted((_lines(writer.left) & code) - windows),
        sorted(windows),
    )


def _lines(nodes: Iterable[Node]) -> set[int]:
    return {line for node in nodes for line in range(line_of(node), node.end_point[0] + 2)}


def _code_lines(model: FileModel) -> set[int]:
    """Return the numbers of the lines of the classes that have code on them."""
    found: set[int] = set()
    for each in model.classes.values():
        for node in every(each.node):
            if node.child_count == 0 and node.type not in COMMENTS:
                found.add(line_of(node))
    return found
