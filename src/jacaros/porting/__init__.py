"""Java artifacts and environments in Python: a first version, and what is left to do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from jacaros.porting.model import FileModel, model_of
from jacaros.porting.reading import COMMENTS, JavaFile, NotPortable, every, line_of, read
from jacaros.porting.writing import Writer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from jacaros.porting.statements import Place

__all__ = ["NotPortable", "Ported", "port"]


Line = tuple[str, int]
"""A file, and the number of a line."""


@dataclass(frozen=True, slots=True)
class Ported:
    """The Python file for a Java file.

    Attributes:
        text: of the file.
        artifacts: names of the artifact types.
        environments: those of them that are environments of Jason.
        lines: lines of code in Java, those of the files beside it that it uses included.
        left: those that are left to a person: names of files and numbers.
        windows: those that only show windows, which are left out.
    """

    text: str
    artifacts: list[str]
    environments: list[str]
    lines: int
    left: list[Line]
    windows: list[Line]


def port(name: str, text: str, beside: Callable[[str], str | None] = lambda _: None) -> Ported:
    """Port a Java file.

    Args:
        name: of the file.
        text: its content.
        beside: returns the text of another file in its folder, or None.

    Raises:
        NotPortable: it is not Java, or has neither an artifact nor an environment.
        UsageError: the parser is not installed.
    """

    def other(class_name: str) -> JavaFile | None:
        found = beside(f"{class_name}.java")
        try:
            return None if found is None else read(f"{class_name}.java", found)
        except NotPortable:
            return None

    model = model_of(read(name, text), other)
    own = [each for each in model.classes.values() if each.is_artifact]
    if not own:
        raise NotPortable(f"{name}: error: no class in it is an artifact or an environment")
    writer = Writer(model)
    python = writer.file()
    code = _code_lines(model)
    windows = _lines(writer.windows) & code
    return Ported(
        python,
        [each.name for each in own],
        [each.name for each in own if each.is_environment],
        len(code),
        sorted((_lines(writer.left) & code) - windows),
        sorted(windows),
    )


def _lines(places: Iterable[Place]) -> set[Line]:
    return {(name, line) for name, node in places for line in range(line_of(node), node.end_point[0] + 2)}


def _code_lines(model: FileModel) -> set[Line]:
    """Return the lines of the classes that have code on them."""
    found: set[Line] = set()
    for each in model.classes.values():
        if each.java is not model.java and each.name not in model.ported:
            continue
        for node in every(each.node):
            if node.child_count == 0 and node.type not in COMMENTS:
                found.add((each.java.name, line_of(node)))
    return found
