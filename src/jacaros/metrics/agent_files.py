"""The agent programs of a folder, with the files that they include and the names that are in each."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.loader import read_program
from jacaros.asl.source import SourceFile
from jacaros.mas.action_check import artifact_types
from jacaros.mas.programs import TEST_LIBRARY, Programs, library_file
from jacaros.mas.python_code import PythonCode
from jacaros.metrics.agentspeak import clauses_of, identifiers_of, names_of
from jacaros.metrics.counted_file import CountedFile
from jacaros.metrics.sources import Sources
from jacaros.project_modules import ProjectModules

_LIBRARY: Final = "$jacaros/"


@dataclass
class AgentFile:
    """A file of programs: identifiers and names in it, from every program that it is a part of."""

    path: Path
    identifiers: set[str] = field(default_factory=set)
    names: set[str] = field(default_factory=set)


@dataclass(frozen=True)
class AgentProgram:
    """A program with all that it includes.

    Attributes:
        path: of its file.
        tree: all of its clauses.
        included: the other files, as messages call them; those of the package begin with ``$jacaros/``.
        problems: what is wrong with it.
    """

    path: Path
    tree: nodes.Program
    included: frozenset[str]
    problems: tuple[Diagnostic, ...]

    @property
    def is_test(self) -> bool:
        """Whether it is a test of other programs: it includes the library for tests."""
        return any(name.removeprefix(_LIBRARY) in TEST_LIBRARY for name in self.included)

    @property
    def artifact_types(self) -> list[str]:
        """The types of artifacts that it makes, as far as they are written in it."""
        return artifact_types(self.tree)


def read_agent(path: Path, folders: Sequence[Path], sources: Sources) -> AgentProgram | None:
    """Read a program; None after reporting that its file cannot be read.

    Args:
        path: of its file.
        folders: where included files are looked for, apart from beside it.
        sources: takes the report.
    """
    text = sources.text(path)
    if text is None:
        return None
    # Problems of Python files are reported where they are counted.
    code = PythonCode(ProjectModules(*folders, unseen=set()))
    programs = Programs(folders, lambda _: None, code)
    included: set[str] = set()

    def include(name: str, including: str) -> tuple[str, str]:
        found, content = programs.include(name, including)
        included.add(found)
        return found, content

    tree, problems = read_program(SourceFile(path.as_posix(), text), include, code.functions, code.actions)
    # Our files that stand for those of other systems are read without being asked for.
    included.update(
        span.file.name
        for clause, _ in clauses_of(tree)
        if (span := clause.span) is not None and span.file.name.startswith(_LIBRARY)
    )
    return AgentProgram(path, tree, frozenset(included), tuple(problems))


class AgentFiles:
    """Collects the files of programs.

    Attributes:
        own: files of the user, by their resolved paths.
        library: files that come with the package.
    """

    def __init__(self) -> None:
        self.own: dict[Path, AgentFile] = {}
        self.library: dict[Path, AgentFile] = {}

    def add(self, program: AgentProgram) -> None:
        """Add a program and all that it includes, with the names that are in each file."""
        files = {str(program.path): self._file(str(program.path))}
        files.update((name, self._file(name)) for name in program.included)
        for clause, is_goal in clauses_of(program.tree):
            # The clauses of patterns may come from texts within a directive.
            where = "" if clause.span is None else clause.span.file.name
            file = files.get(where, files[str(program.path)])
            file.identifiers |= identifiers_of(clause, is_goal)
            file.names |= names_of(clause, is_goal)

    def _file(self, name: str) -> AgentFile:
        ours = name.startswith(_LIBRARY)
        path = library_file(name.removeprefix(_LIBRARY)) if ours else Path(name)
        return (self.library if ours else self.own).setdefault(path.resolve(), AgentFile(path))


def counted_agents(files: Iterable[AgentFile], sources: Sources) -> list[CountedFile]:
    """The files with what is counted in them."""
    return [
        sources.agentspeak(each.path, frozenset(each.identifiers), frozenset(each.names)) for each in files
    ]
