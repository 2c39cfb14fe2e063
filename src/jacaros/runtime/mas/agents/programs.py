"""The agent programs of a run: where they are found, and read once for all agents that run them."""

import os
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from errno import ENOTDIR
from pathlib import Path
from typing import Final

from jacaros.agents import language
from jacaros.agents.checks.checker import check_for_run, wanted
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, Diagnostic
from jacaros.agents.language.loader import load_program, parse_literals
from jacaros.runtime.files.texts import file_text, is_file
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.deployment import AgentSpec

NEVER_SELECTED = "plan-never-selected"
"""Code of the warning about unreachable plans. Agents of user-defined classes may select them."""


def asks_why(program: nodes.Program) -> bool:
    """Return whether the text of a program mentions ``.why``. Then the run keeps its history from the start."""
    clauses = (*program.beliefs, *program.plans)
    files = {id(each.span.file): each.span.file for each in clauses if each.span is not None}
    return any(".why(" in file.text for file in files.values())


class Programs:
    """Reads agent programs.

    Args:
        folders: searched for programs and included files, in order.
        warn: takes the text of a warning about a program.
        code: the project's Python code, which adds internal actions and functions.
        prepare: returns the part of a program to run, and may add actions to the code. Default: all of it.

    Attributes:
        path: finds programs and included files.
    """

    def __init__(
        self,
        folders: Sequence[Path],
        warn: Callable[[str], None],
        code: PythonCode,
        prepare: Callable[[nodes.Program, PythonCode], nodes.Program] | None = None,
    ) -> None:
        self.path = SourcePath(folders)
        self._code = code
        self._warn = warn
        self._prepare = prepare
        self._read: dict[Path, nodes.Program] = {}

    def load_all(self, agents: Sequence[AgentSpec]) -> list[nodes.Program]:
        """Return the programs of all agents, with the beliefs and goals that the project adds.

        Raises:
            AslError: the errors of all programs.
        """
        wrong: list[Diagnostic] = []
        programs = []
        for agent in agents:
            try:
                programs.append(self.load(agent))
            except AslError as error:
                wrong += [d for d in error.diagnostics if d not in wrong]
        if wrong:
            raise AslError(wrong)
        return programs

    def read_again(self, agents: Sequence[AgentSpec]) -> list[nodes.Program]:
        """Return the programs of agents, as `load_all`, from the current files.

        Raises:
            AslError: the errors of all programs. Agents created later run what was read before.
        """
        before, self._read = self._read, {}
        try:
            return self.load_all(agents)
        except BaseException:
            self._read = before
            raise

    def load(self, agent: AgentSpec, written: str | None = None) -> nodes.Program:
        """Return the program of one agent; for a Python agent, an empty one.

        Args:
            agent: the agent.
            written: the text of its program, instead of its file.

        Raises:
            AslError: the program, or what the project adds, has errors.
        """
        if agent.is_python and written is None:
            return nodes.Program()
        chooses = agent.agent_class is not None
        if written is None:
            program = self.read(agent.source_path, chooses)
        else:
            program = self._checked(agent.source_path, written, chooses)
        return with_declared(program, agent, f"the declaration of {agent.name}")

    def read(self, path: Path, chooses: bool = False) -> nodes.Program:
        """Return the program in a file.

        Args:
            path: path of the file.
            chooses: whether its agent is of a class that may select plans in its own way.

        Raises:
            AslError: it has errors, or does not exist.
        """
        program = self._read.get(path)
        if program is None:
            program = self._read[path] = self._checked(path, text_of(path), chooses)
        return program

    def _checked(self, path: Path, written: str, chooses: bool) -> nodes.Program:
        try:
            program, warnings = load_program(
                name_of(path), written, self.path.include, self._code.functions, self._code.actions
            )
        except AslError as wrong:
            raise AslError([*wrong.diagnostics, *self._code.take_errors()]) from wrong
        if errors := self._code.take_errors():  # in the modules that it names
            raise AslError(errors)
        if self._prepare is not None:
            program = self._prepare(program, self._code)
        found = check_for_run(program, KnownActions(self._code.actions, self._code.help))
        for warning in wanted([*warnings, *found]):
            if concerns_author(warning, path) and not (chooses and warning.code == NEVER_SELECTED):
                self._warn(warning.render())
        return program

    def list_files(self, folder: str, base: Path) -> list[str]:
        """Return the files below a folder, sorted, as paths that begin with *folder*. *base* is the project's folder.

        Raises:
            OSError: the folder cannot be read.
        """
        root = base / folder
        if not root.is_dir():
            raise NotADirectoryError(ENOTDIR, "not a folder", str(root))
        return sorted(
            (Path(folder) / path.relative_to(root)).as_posix() for path in root.rglob("*") if path.is_file()
        )


def with_declared(program: nodes.Program, agent: AgentSpec, place: str) -> nodes.Program:
    """Return a program with the beliefs and goals that the project declares. As in Jason, its goals come first.

    Raises:
        AslError: they have errors. *place* is their file in diagnostics.
    """
    beliefs = parse_literals(agent.beliefs, place) if agent.beliefs.strip() else ()
    goals = parse_literals(agent.goals, place) if agent.goals.strip() else ()
    if not beliefs and not goals:
        return program
    return replace(program, beliefs=(*program.beliefs, *beliefs), goals=(*goals, *program.goals))


def concerns_author(warning: Diagnostic, path: Path) -> bool:
    """Return whether a warning concerns the author of the program at *path*.

    A library of JaCaROS does not. And a plan before an include often replaces one in it, as in tests.
    """
    if warning.span is None:
        return True
    file = warning.span.file.name
    return not file.startswith("$") and (warning.code != NEVER_SELECTED or file == path.as_posix())


def text_of(path: Path) -> str:
    """Return the text of a program.

    Raises:
        AslError: it does not exist, or is not text.
    """
    try:
        return file_text(path)
    except FileNotFoundError:
        raise AslError([_unreadable(f"file not found: {path}")]) from None
    except (OSError, UnicodeError) as error:
        raise AslError([_unreadable(f"cannot read {path}: {error}")]) from error


def _unreadable(message: str) -> Diagnostic:
    return Diagnostic("error", message, code="unreadable-file")


_USUAL: Final = (
    *(".", "src/agt", "src/agt/inc", "src/asl", "asl", "agents", "inc"),
    *(f"src/test/{each}" for each in ("jason/inc", "jason/asl", "inc", "agt")),
)
"""Folders of a project that have programs in the layouts of Jason, JaCaMo and ROS."""
PROJECTS: Final = (".jcm", ".mas2j")
_PROGRAMS: Final = (".asl", ".py")
_ROOTS: Final = (".git", "pyproject.toml", "build.gradle", "package.xml", "setup.py")
_LEVELS: Final = 6
_LIBRARY: Final = "$jacaros/"
_LIBRARY_FOLDER: Final = Path(language.__file__).parent / "library"
TEST_LIBRARY: Final = (
    "mock_agent.asl",
    "test_assert.asl",
    "test_manager.asl",
    "test_performance.asl",
    "tester_agent.asl",
)
"""Files that Jason programs include for tests. Those of JaCaROS replace them."""
_OF_JASON: Final = re.compile(r"\$jason(Jar)?/test/jason/inc/|\btest_manager\b|\bmock_owner\b")
"""Text that identifies Jason's own copies of them, which projects have beside their tests."""


def project_folders(folder: Path) -> list[Path]:
    """Return a folder and those above it, up to the root of its project."""
    found = [folder]
    above = start = Path(os.path.abspath(folder))
    relative = folder
    for _ in range(_LEVELS):
        if above != start and _is_root(above):
            return found
        if above.parent == above or (above / ".git").exists():
            break
        above, relative = above.parent, relative / ".."
        found.append(Path(os.path.normpath(relative)))
    return [folder]


def _is_root(folder: Path) -> bool:
    try:
        return any(name in _ROOTS or name.endswith(PROJECTS) for name in os.listdir(folder))
    except OSError:  # a folder that others must not read
        return False


def source_folders(base: Path, declared: Sequence[str] = (), above: Sequence[Path] = ()) -> tuple[Path, ...]:
    """Return the folders that are searched for the programs of a project, in order.

    They are the *declared* folders, then the usual ones: below the folder *base* of the project file, those *above* it,
    and, as in Jason and JaCaMo, the working folder. Missing folders are left out, except for declared ones below *base*.
    """
    places = [base, *above, Path()]
    written = [place / name for place in places for name in declared]
    usual = [place / name for place in places for name in _USUAL]
    required = written[: len(declared)]
    return _distinct([*required, *(folder for folder in (*written, *usual) if os.path.isdir(folder))])


def _distinct(folders: Iterable[Path]) -> tuple[Path, ...]:
    found: dict[str, Path] = {}
    for folder in folders:
        found.setdefault(os.path.abspath(folder), folder)
    return tuple(found.values())


class SourcePath:
    """The folders that are searched for programs and included files, and the library of JaCaROS.

    Attributes:
        folders: the folders, in order.
    """

    def __init__(self, folders: Iterable[Path]) -> None:
        self.folders = _distinct(folders)

    def find(self, name: str) -> Path:
        """Return the file of a program, with or without ``.asl`` in its name.

        ``$jacaros/NAME`` is a file of the library. The library also has the files that Jason programs include for tests,
        whatever folder is written before their name; a project's own file of that name comes first.

        Raises:
            FileNotFoundError: it does not exist; the text says where it was searched.
        """
        if name.startswith(_LIBRARY):
            return _library_file(name.removeprefix(_LIBRARY))
        name = name.removeprefix("file:")
        candidates = [name] if name.endswith(_PROGRAMS) else [f"{name}.asl", name]
        for folder in self.folders:
            for candidate in candidates:
                if is_file(folder / candidate):
                    return folder / candidate
        last = candidates[0].rpartition("/")[2]
        if last in TEST_LIBRARY:
            return _library_file(last)
        if "://" in name:
            raise FileNotFoundError("download the program: only files are supported")
        raise FileNotFoundError(f"expected in {', '.join(map(str, self.folders))}")

    def include(self, path: str, including: str) -> tuple[str, str]:
        """Return name and text of an included file: beside the including one, or else as `find`.

        Copies of Jason's files for tests are replaced by those of the library.

        Raises:
            FileNotFoundError: it does not exist; the text says where it was searched.
        """
        # A program that is not in a file has no files beside it.
        beside = () if including.startswith(("<", "$")) else (Path(including).parent,)
        file = SourcePath((*beside, *self.folders)).find(path)
        text = file_text(file)
        if file.name in TEST_LIBRARY and file.parent != _LIBRARY_FOLDER and _OF_JASON.search(text):
            file = _library_file(file.name)
            text = file_text(file)
        return name_of(file), text


def name_of(file: Path) -> str:
    """Return the name of a program file in diagnostics: ``$jacaros/NAME`` in the library."""
    return f"{_LIBRARY}{file.name}" if file.parent == _LIBRARY_FOLDER else file.as_posix()


def _library_file(name: str) -> Path:
    file = _LIBRARY_FOLDER / name
    if not is_file(file):
        shipped = sorted(each.name for each in _LIBRARY_FOLDER.glob("*.asl"))
        raise FileNotFoundError(f"the library has {', '.join(shipped)}")
    return file
