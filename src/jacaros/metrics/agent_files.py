"""The agent programs of a folder, with included files and the names in each file."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.agents.language.loader import read_program
from jacaros.files.python_modules import ProjectModules
from jacaros.mas.agents.programs import TEST_LIBRARY, Programs, SourcePath
from jacaros.mas.agents.python_code import PythonCode
from jacaros.mas.checks.artifacts import artifact_types
from jacaros.metrics.agentspeak import clauses_of, identifiers_of, names_of
from jacaros.metrics.counted_file import CountedFile
from jacaros.metrics.sources import Sources

_LIBRARY: Final = "$jacaros/"


@dataclass
class AgentFile:
    """A file of programs, with the identifiers and names in it, over all programs that include it."""

    path: Path
    identifiers: set[str] = field(default_factory=set)
    names: set[str] = field(default_factory=set)


@dataclass(frozen=True)
class AgentProgram:
    """A program with its included files.

    Attributes:
        path: path of its file.
        tree: all its clauses.
        included: included files, named as in messages; those of the package begin with ``$jacaros/``.
        problems: errors in the program.
    """

    path: Path
    tree: nodes.Program
    included: frozenset[str]
    problems: tuple[Diagnostic, ...]

    @property
    def is_test(self) -> bool:
        """Whether the program tests other programs: it includes the library for tests."""
        return any(name.removeprefix(_LIBRARY) in TEST_LIBRARY for name in self.included)

    @property
    def artifact_types(self) -> list[str]:
        """Types of the artifacts that it creates, as far as they are literals."""
        return artifact_types(self.tree)


def read_agent(path: Path, folders: Sequence[Path], sources: Sources) -> AgentProgram | None:
    """Read a program; return None after reporting that its file cannot be read.

    Args:
        path: path of its file.
        folders: folders to search for included files, in addition to its own.
        sources: collects the report.
    """
    text = sources.text(path)
    if text is None:
        return None
    # Problems of Python files are reported where they are counted.
    code = PythonCode(ProjectModules(*folders, unseen=set()))
    programs = Programs(folders, lambda _: None, code)
    included: set[str] = set()

    def include(name: str, including: str) -> tuple[str, str]:
        found, content = programs.path.include(name, including)
        included.add(found)
        return found, content

    tree, problems = read_program(SourceFile(path.as_posix(), text), include, code.functions, code.actions)
    # Our replacements for files of other systems are read implicitly.
    included.update(
        span.file.name
        for clause, _ in clauses_of(tree)
        if (span := clause.span) is not None and span.file.name.startswith(_LIBRARY)
    )
    return AgentProgram(path, tree, frozenset(included), tuple(problems))


class AgentFiles:
    """Collects the files of programs.

    Attributes:
        own: files of the user, by resolved path.
        library: files of the package.
    """

    def __init__(self) -> None:
        self.own: dict[Path, AgentFile] = {}
        self.library: dict[Path, AgentFile] = {}

    def add(self, program: AgentProgram) -> None:
        """Add a program and its included files, with the names in each."""
        files = {str(program.path): self._file(str(program.path))}
        files.update((name, self._file(name)) for name in program.included)
        for clause, is_goal in clauses_of(program.tree):
            # The clauses of patterns may come from strings in a directive.
            where = "" if clause.span is None else clause.span.file.name
            file = files.get(where, files[str(program.path)])
            file.identifiers |= identifiers_of(clause, is_goal)
            file.names |= names_of(clause, is_goal)

    def _file(self, name: str) -> AgentFile:
        ours = name.startswith(_LIBRARY)
        path = SourcePath(()).find(name) if ours else Path(name)
        return (self.library if ours else self.own).setdefault(path.resolve(), AgentFile(path))


def counted_agents(files: Iterable[AgentFile], sources: Sources) -> list[CountedFile]:
    """Return the files with their counts."""
    return [
        sources.agentspeak(each.path, frozenset(each.identifiers), frozenset(each.names)) for each in files
    ]
