"""The agent programs of a run: found, read once and shared by all agents that run them."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from errno import ENOTDIR
from pathlib import Path

from jacaros import asl
from jacaros.asl import nodes
from jacaros.asl.checker import check_for_run
from jacaros.asl.checks.actions import KnownActions
from jacaros.asl.diagnostics import AslError, Diagnostic
from jacaros.asl.loader import load_program, parse_literals
from jacaros.asl.suppression import wanted
from jacaros.mas.deployment import AgentSpec
from jacaros.mas.python_code import PythonCode
from jacaros.text_files import file_text, is_file

NEVER_SELECTED = "plan-never-selected"
"""What is told of plans behind those that are always taken first: agents of a class of their own may take them."""

_LIBRARY = "$jacaros/"
TEST_LIBRARY = (
    "mock_agent.asl",
    "test_assert.asl",
    "test_manager.asl",
    "test_performance.asl",
    "tester_agent.asl",
)
"""Files that programs of Jason include for their tests; ours stand for them."""
_OF_JASON = re.compile(r"\$jason(Jar)?/test/jason/inc/|\btest_manager\b|\bmock_owner\b")
"""What is found in Jason's own copies of them, which projects have beside their tests."""


def asks_why(program: nodes.Program) -> bool:
    """Whether the text of a program mentions ``.why``: then the history of the run is kept from its start on."""
    clauses = (*program.beliefs, *program.plans)
    files = {id(each.span.file): each.span.file for each in clauses if each.span is not None}
    return any(".why(" in file.text for file in files.values())


class Programs:
    """Reads agent programs.

    Args:
        folders: where programs and included files are looked for, in order.
        warn: takes the text of a warning about a program.
        code: the project's Python code, which adds internal actions and functions.
        prepare: gives what is run of a program that was read, and may add actions to the code; all of it unless given.

    Attributes:
        folders: where they are looked for.
    """

    def __init__(
        self,
        folders: Sequence[Path],
        warn: Callable[[str], None],
        code: PythonCode,
        prepare: Callable[[nodes.Program, PythonCode], nodes.Program] | None = None,
    ) -> None:
        self.folders = tuple(folders)
        self._code = code
        self._warn = warn
        self._prepare = prepare
        self._read: dict[Path, nodes.Program] = {}

    def load_all(self, agents: Sequence[AgentSpec]) -> list[nodes.Program]:
        """The programs of all agents, with the beliefs and goals that the project adds.

        Raises:
            AslError: with the errors of all programs.
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
        """The programs of agents, as `load_all`, from their files as they are now.

        Raises:
            AslError: with the errors of all programs; agents made later run what was read before.
        """
        before, self._read = self._read, {}
        try:
            return self.load_all(agents)
        except BaseException:
            self._read = before
            raise

    def load(self, agent: AgentSpec, written: str | None = None) -> nodes.Program:
        """The program of one agent; of one that is written in Python an empty one.

        Args:
            agent: the agent.
            written: the text of its program, in place of that of its file.

        Raises:
            AslError: the program, or what the project adds, is wrong.
        """
        if agent.is_python and written is None:
            return nodes.Program()
        chooses = agent.agent_class is not None
        if written is None:
            program = self.read(agent.source_path, chooses)
        else:
            program = self._checked(agent.source_path, written, chooses)
        place = f"the declaration of {agent.name}"
        # As in Jason: the project's beliefs are believed first, and its goals come first.
        beliefs = parse_literals(agent.beliefs, place) if agent.beliefs.strip() else ()
        goals = parse_literals(agent.goals, place) if agent.goals.strip() else ()
        if not beliefs and not goals:
            return program
        return replace(program, beliefs=(*program.beliefs, *beliefs), goals=(*goals, *program.goals))

    def read(self, path: Path, chooses: bool = False) -> nodes.Program:
        """The program in a file.

        Args:
            path: of the file.
            chooses: its agent is of a class that may choose among plans in its own way.

        Raises:
            AslError: it is wrong, or not there.
        """
        program = self._read.get(path)
        if program is None:
            program = self._read[path] = self._checked(path, text_of(path), chooses)
        return program

    def _checked(self, path: Path, written: str, chooses: bool) -> nodes.Program:
        program, warnings = self._parse(path, written)
        if self._prepare is not None:
            program = self._prepare(program, self._code)
        found = check_for_run(program, KnownActions(self._code.actions, self._code.help))
        for warning in wanted([*warnings, *found]):
            if _concerns_author(warning, path) and not (chooses and warning.code == NEVER_SELECTED):
                self._warn(warning.render())
        return program

    def _parse(self, path: Path, written: str) -> tuple[nodes.Program, list[Diagnostic]]:
        """The program in a text; the project's modules that it names are imported, too."""
        try:
            program, warnings = load_program(
                path.as_posix(), written, self.include, self._code.functions, self._code.actions
            )
        except AslError as wrong:
            raise AslError([*wrong.diagnostics, *self._code.take_errors()]) from wrong
        errors = self._code.take_errors()
        if errors:
            raise AslError(errors)
        return program, warnings

    def find(self, name: str) -> Path:
        """The file of a program named by another program.

        Raises:
            FileNotFoundError: there is none.
        """
        candidates = [name] if name.endswith(".asl") else [f"{name}.asl", name]
        for folder in self.folders:
            for candidate in candidates:
                if is_file(folder / candidate):
                    return folder / candidate
        raise FileNotFoundError(name)

    def list_files(self, folder: str, base: Path) -> list[str]:
        """The files below a folder, as paths that begin with *folder*, sorted; *base* is the project's folder.

        Raises:
            OSError: the folder cannot be read.
        """
        root = base / folder
        if not root.is_dir():
            raise NotADirectoryError(ENOTDIR, "not a folder", str(root))
        return sorted(
            (Path(folder) / path.relative_to(root)).as_posix() for path in root.rglob("*") if path.is_file()
        )

    def include(self, path: str, including: str) -> tuple[str, str]:
        """Name and text of an included file: beside the including one, in one of the folders, or (``$jacaros/…``)
        in the library that comes with the package.  Jason's files for tests are in that library too, whatever folder
        is written before their name.

        Raises:
            FileNotFoundError: there is none.
        """
        if path.startswith(_LIBRARY):
            return _of_library(path.removeprefix(_LIBRARY))
        name = path.rpartition("/")[2]
        beside = Path(including).parent / path
        try:
            # A program that is no file has nothing beside it.
            file = beside if is_file(beside) and not including.startswith("<") else self.find(path)
        except FileNotFoundError:
            if name in TEST_LIBRARY:
                return _of_library(name)
            raise
        text = file_text(file)
        if name in TEST_LIBRARY and _OF_JASON.search(text):
            return _of_library(name)
        return file.as_posix(), text


def _concerns_author(warning: Diagnostic, path: Path) -> bool:
    """Whether a warning is for whoever wrote the program at *path*.

    A library that comes with the package is of no concern; and a plan that stands before an include is often meant to
    take the place of one in it, as in tests.
    """
    if warning.span is None:
        return True
    file = warning.span.file.name
    return not file.startswith("$") and (warning.code != NEVER_SELECTED or file == path.as_posix())


def library_file(name: str) -> Path:
    """The path of a program that comes with the package; it need not be there."""
    return Path(asl.__file__).parent / "library" / name


def _of_library(name: str) -> tuple[str, str]:
    return f"{_LIBRARY}{name}", library_file(name).read_text(encoding="utf-8")


def text_of(path: Path) -> str:
    """The text of a program.

    Raises:
        AslError: it is not there, or no text.
    """
    try:
        return file_text(path)
    except FileNotFoundError:
        raise AslError([_unreadable(f"file not found: {path}")]) from None
    except (OSError, UnicodeError) as error:
        raise AslError([_unreadable(f"cannot read {path}: {error}")]) from error


def _unreadable(message: str) -> Diagnostic:
    return Diagnostic("error", message, code="unreadable-file")
