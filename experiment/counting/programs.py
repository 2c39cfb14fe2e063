"""The files of programs by their roles, with the library code that they use."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Final

import jacaros
from counting import sources as languages
from counting.counts import CountedFile, Group, ProgramMetrics
from counting.sources import PythonFile, Sources, counted
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import Diagnostic, SourceError, SourceFile
from jacaros.agents.language.loader import new_names, read_program
from jacaros.robots.mapping.file import SHIPPED, find_mapping, is_mapping, read_with_problems
from jacaros.robots.registry import type_finder
from jacaros.robots.world.files.faults import fault_file_problems, is_fault_file
from jacaros.robots.world.files.world import is_world, shipped_worlds, world_problems
from jacaros.runtime.files.python_modules import ProjectModules
from jacaros.runtime.files.texts import files_below, is_file, suggestion
from jacaros.runtime.files.yaml import plain_values
from jacaros.runtime.mas.agents.programs import TEST_LIBRARY, Programs, SourcePath, source_folders, text_of
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.checks.artifacts import named_types
from jacaros.runtime.mas.checks.files import MAPPINGS, PROJECTS
from jacaros.runtime.mas.deployment import Deployment, ProjectError
from jacaros.runtime.mas.mappings import diagnostics_of
from jacaros.runtime.mas.project.cursor import ProjectCursor
from jacaros.runtime.mas.project.reading import read_project

OWN: Final = (
    *(f"jacaros.robots.{each}" for each in ("artifacts", "kit", "map", "mapping", "registry")),
    *(f"jacaros.artifacts.{each}" for each in ("behaviour_trees", "tools")),
)
"""Our packages that a program could contain itself. Language, middleware and simulator are the platform."""

DEFAULT: Final = ("py_trees",)
"""Third-party packages that count as library code by default."""

_SHIPPED: Final = "$jacaros/"
_TEST_FOLDERS: Final = frozenset({"test", "tests"})
_TEST_MODULES: Final = ("jacaros.testing", "pytest", "unittest")

Files = dict[Group, tuple[CountedFile, ...]]


class MetricsError(SourceError):
    """Raised for source files that cannot be counted."""


def measure(folders: Sequence[Path], libraries: Sequence[str] = DEFAULT) -> list[ProgramMetrics]:
    """Count the programs in folders.

    Args:
        folders: folders of the programs.
        libraries: names of installed Python packages that count as library code if a program imports them.

    Raises:
        MetricsError: there are errors in programs; folders do not exist or have no programs.
    """
    sources = Sources()
    library = Library(sources, libraries)
    measured = [
        ProgramMetrics(_name(folder, folders), _program(folder, sources, library)) for folder in folders
    ]
    check_counted(sources, library)
    return measured


def check_counted(sources: Sources, library: "Library") -> None:
    """Check that all files were counted.

    Raises:
        MetricsError: files have errors, or libraries are not installed.
    """
    for package in sorted(library.missing):
        message = f"library not installed, so it cannot be counted: `{package}`"
        sources.report(Diagnostic("error", message, help=f"pip install {package}"))
    if sources.problems:
        raise MetricsError(list(sources.problems))


def _program(folder: Path, sources: Sources, library: "Library") -> Files:
    if not folder.is_dir():
        if folder.exists():
            message, help = f"not a folder: `{folder}`", f"name its folder: `{folder.parent}`"
        else:
            message = f"folder does not exist: `{folder}`"
            help = suggestion(str(folder), map(str, folder.parent.glob("*/")))
        sources.report(Diagnostic("error", message, help=help or None))
        return {}
    before = len(sources.problems)
    try:
        program = ProgramFiles(folder, sources, library)
        files = program.read()
    except OSError as error:
        sources.report(Diagnostic("error", f"cannot read `{folder}`: {error.strerror or error}"))
        return {}
    if len(sources.problems) == before and not program.has_agents:
        help = "name a folder with .asl files or Python agents"
        sources.report(Diagnostic("error", f"no agent programs in `{folder}`", help=help))
    return files


def _name(folder: Path, folders: Sequence[Path]) -> str:
    """Return the name of a folder, or its path if another folder has the same name."""
    name = folder.resolve().name
    return str(folder) if [each.resolve().name for each in folders].count(name) > 1 else name


class Library:
    """Finds the library modules that a program imports, directly or indirectly.

    Args:
        sources: reads the files.
        packages: names of installed top-level packages that count, in addition to `OWN`.

    Attributes:
        missing: packages that a program imports and that are not installed.
    """

    def __init__(self, sources: Sources, packages: Sequence[str]) -> None:
        self._sources = sources
        root = Path(jacaros.__file__).parent.parent
        self._folders: dict[str, Path | None] = {name: root.joinpath(*name.split(".")) for name in OWN}
        self._folders.update((name, _installed(name)) for name in packages)
        self.missing: set[str] = set()

    def files(self, modules: Iterable[str]) -> tuple[CountedFile, ...]:
        """Return the library files of modules, and of everything that they import within the libraries.

        Args:
            modules: names as in the program; the last part may be a name in a module.
        """
        seen: dict[Path, PythonFile | None] = {}
        wanted = list(modules)
        while wanted:
            for module, path in self._found(wanted.pop()):
                if path not in seen:
                    file = seen[path] = self._sources.python(path)
                    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
                    wanted += (each.absolute(package) for each in (file.imports if file else ()))
        return tuple(file.counted for path in sorted(seen) if (file := seen[path]) is not None)

    def _found(self, name: str) -> Iterator[tuple[str, Path]]:
        """Return the modules imported with *name*, as Python does: its packages, and itself."""
        for package, folder in self._folders.items():
            if not f"{name}.".startswith(f"{package}."):
                continue
            if folder is None:
                self.missing.add(package)
                continue
            module, place = package, folder
            parts = name[len(package) + 1 :].split(".")
            while (place / "__init__.py").is_file():
                yield module, place / "__init__.py"
                if not parts or not parts[0]:
                    return
                module, place = f"{module}.{parts[0]}", place / parts.pop(0)
            if (file := place.with_name(f"{place.name}.py")).is_file():
                yield module, file


def _installed(package: str) -> Path | None:
    """Return the folder of an installed package, or the path of a single module without its suffix; imports nothing."""
    try:
        spec = find_spec(package)
    except (ImportError, ValueError):
        return None
    if spec is None or spec.origin is None:
        return None
    origin = Path(spec.origin)
    return origin.parent if origin.name == "__init__.py" else origin.with_suffix("")


def _source_files(folder: Path, suffixes: Sequence[str]) -> list[Path]:
    """Return the files of these kinds below a folder, without those in test folders."""
    return [
        path
        for path in files_below(folder, suffixes)
        if _TEST_FOLDERS.isdisjoint(path.relative_to(folder).parent.parts)
    ]


@dataclass(frozen=True)
class AgentProgram:
    """A program of an agent with its included files.

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
        return any(name.removeprefix(_SHIPPED) in TEST_LIBRARY for name in self.included)

    def clauses(self) -> Iterator[tuple[nodes.Node, bool]]:
        """Yield all clauses, each with whether it is an initial goal."""
        yield from ((clause, False) for clause in (*self.tree.beliefs, *self.tree.plans))
        yield from ((goal, True) for goal in self.tree.goals)


def _file_of(clause: nodes.Node) -> str:
    return "" if clause.span is None else clause.span.file.name


class ProgramFiles:
    """Collects the files of one program.

    Args:
        folder: folder of the program.
        sources: reads the files and collects the reports.
        library: finds library code.

    Attributes:
        has_agents: whether `read` has found the program of an agent.
    """

    def __init__(self, folder: Path, sources: Sources, library: Library) -> None:
        self._folder, self._sources, self._library = folder, sources, library
        self.has_agents = False
        self._files: dict[Group, dict[Path, CountedFile]] = {group: {} for group in Group}
        self._python_agents: set[Path] = set()
        self._modules: set[str] = set()

    def read(self) -> Files:
        """Return the files by group, after reporting their errors."""
        projects = list(self._projects())
        programs = {each.path.resolve(): each for each in self._programs([each for _, each in projects])}
        for path, project in projects:
            agents = [programs.get(each.source_path.resolve()) for each in project.agents]
            if not agents or any(each is None or not each.is_test for each in agents):
                self._add_project(path, project)
        tested = [each for each in programs.values() if not each.is_test]
        for program in tested:
            names = [each.name for each in named_types(program.tree).found]
            self._add_types(names, (self._folder, program.path.parent))
        for path in _source_files(self._folder, (".py",)):
            self._add_python(path)
        for path in _source_files(self._folder, MAPPINGS):
            self._add_yaml(path)
        self.has_agents = bool(tested or self._files[Group.AGENTS])
        if not self._sources.problems:
            self._add_agents(tested)
            self._add(Group.LIBRARY, *self._library.files(self._modules))
        return {group: tuple(files[path] for path in sorted(files)) for group, files in self._files.items()}

    def _add(self, group: Group, *files: CountedFile) -> None:
        self._files[group].update((each.path.resolve(), each) for each in files)

    # projects

    def _projects(self) -> Iterator[tuple[Path, Deployment]]:
        for path in _source_files(self._folder, PROJECTS):
            try:
                reading = read_project(path)
            except ProjectError as error:
                self._sources.report(*error.diagnostics)
                continue
            self._sources.report(*reading.diagnostics)
            yield path, reading.deployment

    def _add_project(self, path: Path, project: Deployment) -> None:
        text = self._sources.text(path)
        if text is None:
            return
        tokens = ProjectCursor(SourceFile(path.as_posix(), text), []).tokens
        comments = languages.between(text, ((each.start, each.stop) for each in tokens))
        self._add(Group.PROJECTS, counted(path, text, comments, _names(project)))
        for agent in project.agents:
            if agent.is_python and is_file(agent.source_path):
                self._python_agents.add(agent.source_path.resolve())
                self._add_python(agent.source_path)
        if project.world is not None and project.world not in shipped_worlds():
            world = Path(project.world)
            if is_file(world):
                self._add_world(world)
        types = [each.type_name for space in project.workspaces for each in space.artifacts]
        self._add_types(types, (project.base_path, *project.source_paths))

    # agents

    def _programs(self, projects: Sequence[Deployment]) -> Iterator[AgentProgram]:
        """Yield all programs: those of projects with their errors, and others unless a program includes them."""
        read: dict[Path, AgentProgram] = {}
        lone: dict[Path, AgentProgram] = {}

        def add(path: Path, folders: Sequence[Path], programs: dict[Path, AgentProgram]) -> None:
            key = path.resolve()
            if key not in read and (program := self._read_agent(path, folders)) is not None:
                programs[key] = program

        for project in projects:
            for agent in project.agents:
                if not agent.is_python and is_file(agent.source_path):
                    add(agent.source_path, (project.base_path, *project.source_paths), read)
        for path in _source_files(self._folder, (".asl",)):
            add(path, source_folders(path.parent), lone)
        included = _included([*read.values(), *lone.values()])
        roots = (each for key, each in lone.items() if key not in included)
        included = _included([*read.values(), *roots])  # without files that only include each other
        for path, program in (*read.items(), *lone.items()):
            if not program.is_test and (path in read or path not in included):
                self._sources.report(*program.problems)
        yield from (*read.values(), *lone.values())

    def _read_agent(self, path: Path, folders: Sequence[Path]) -> AgentProgram | None:
        """Read a program; return None after reporting that its file cannot be read.

        Args:
            path: path of its file.
            folders: folders to search for included files, in addition to its own.
        """
        text = self._sources.text(path)
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

        file = SourceFile(path.as_posix(), text)
        tree, problems = read_program(file, include, new_names(code.functions, code.actions))
        program = AgentProgram(path, tree, frozenset(), tuple(problems))
        # Our replacements for files of other systems are read implicitly.
        implicit = {
            name for clause, _ in program.clauses() if (name := _file_of(clause)).startswith(_SHIPPED)
        }
        return AgentProgram(path, tree, frozenset(included | implicit), tuple(problems))

    def _add_agents(self, programs: Iterable[AgentProgram]) -> None:
        """Add the files of programs, with the names in each file over all programs that include it."""
        found: dict[tuple[Group, Path], tuple[Path, set[str], set[str]]] = {}

        def names_in(name: str) -> tuple[Path, set[str], set[str]]:
            shipped = name.startswith(_SHIPPED)
            path = SourcePath(()).find(name) if shipped else Path(name)
            key = (Group.LIBRARY if shipped else Group.AGENTS, path.resolve())
            return found.setdefault(key, (path, set(), set()))

        for program in programs:
            own = str(program.path)
            files = {name: names_in(name) for name in (own, *program.included)}
            for clause, is_goal in program.clauses():
                # The clauses of patterns may come from strings in a directive.
                _, identifiers, others = files.get(_file_of(clause), files[own])
                identifiers.update(languages.goals_events_operations(clause, is_goal))
                others.update(languages.other_names(clause))
        for (group, _), (path, identifiers, others) in found.items():
            text = text_of(path)
            comments = languages.agentspeak_comments(text)
            self._add(group, counted(path, text, comments, identifiers | others, identifiers))

    # Python

    def _add_python(self, path: Path) -> None:
        file = self._sources.python(path)
        if file is None or file.uses(*_TEST_MODULES):
            return
        if file.uses("launch"):
            group = Group.PROJECTS
        elif path.resolve() in self._python_agents or "PythonAgent" in file.base_names:
            group = Group.AGENTS
        else:
            group = Group.ARTIFACTS
        self._add(group, file.counted)
        self._modules |= file.modules

    # YAML

    def _add_yaml(self, path: Path) -> None:
        if self._sources.text(path) is None:
            return
        if is_world(path) or is_fault_file(path):
            self._add_world(path)
        elif is_mapping(path):  # other programs use YAML files, too
            self._add_mapping(path, Group.ARTIFACTS)

    def _add_world(self, path: Path) -> None:
        text, problems = fault_file_problems(path) if is_fault_file(path) else world_problems(path)
        self._sources.report(*diagnostics_of(str(path), text, problems))
        if not problems:
            names = languages.world_names(plain_values(text)[0])
            self._add(Group.WORLDS, counted(path, text, languages.yaml_comments(text), names))

    def _add_mapping(self, path: Path, group: Group) -> None:
        mapping, problems = read_with_problems(path)
        self._sources.report(*diagnostics_of(mapping.file, mapping.text, problems))
        if not problems:
            comments = languages.yaml_comments(mapping.text)
            self._add(group, counted(path, mapping.text, comments, languages.mapping_names(mapping)))

    # the library

    def _add_types(self, names: Sequence[str], folders: Sequence[Path]) -> None:
        """Record the modules of artifact types, and add mapping files, of the package or elsewhere."""
        modules = ProjectModules(*folders, unseen=set())
        for name in dict.fromkeys(names):
            file = name.partition("#")[0]
            if file.endswith(MAPPINGS) and (path := find_mapping(file, folders)) is not None:
                shipped = path.resolve().parent == SHIPPED.resolve()
                self._add_mapping(path, Group.LIBRARY if shipped else Group.ARTIFACTS)
            try:
                made = type_finder(modules)(name)
            except Exception:  # `jacaros check` reports errors in types
                continue
            self._modules |= {each.__module__ for each in made.__mro__}


def _included(programs: Iterable[AgentProgram]) -> set[Path]:
    return {Path(name).resolve() for each in programs for name in each.included}


def _names(project: Deployment) -> Iterator[str]:
    """Yield the names that a project gives: to itself, agents, workspaces and artifacts."""
    yield project.name
    yield from (agent.declared_name or agent.name for agent in project.agents)
    for space in project.workspaces:
        yield space.name
        yield from (artifact.name for artifact in space.artifacts)
