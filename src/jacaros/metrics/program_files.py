"""The files of the program in a folder, by role."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.artifacts.mapping.file import SHIPPED, find_mapping, is_mapping, read_with_problems
from jacaros.artifacts.registry import type_finder
from jacaros.files.python_modules import ProjectModules
from jacaros.files.texts import is_file
from jacaros.files.yaml import plain_values
from jacaros.mas.checking import MAPPINGS, PROJECTS, files_below
from jacaros.mas.deployment import AgentSpec, Deployment, ProjectError
from jacaros.mas.mappings import diagnostics_of
from jacaros.mas.project.cursor import ProjectCursor
from jacaros.mas.project.reading import Reading, read_project
from jacaros.mas.source_path import source_folders
from jacaros.metrics import python_source, yaml_source
from jacaros.metrics.agent_files import AgentFiles, AgentProgram, counted_agents, read_agent
from jacaros.metrics.comments import between
from jacaros.metrics.counted_file import CountedFile
from jacaros.metrics.groups import Group
from jacaros.metrics.library import Library
from jacaros.metrics.sources import PythonFile, Sources, counted
from jacaros.sim.files.faults import fault_file_problems, is_fault_file
from jacaros.sim.files.world import is_world, shipped_worlds, world_problems

_TEST_FOLDERS: Final = frozenset({"test", "tests"})
_TEST_MODULES: Final = ("jacaros.testing", "pytest", "unittest")


def is_test(file: PythonFile) -> bool:
    """Return whether a Python file tests or evaluates programs: it imports a library for that."""
    return _imports(file, _TEST_MODULES)


def is_launch_file(file: PythonFile) -> bool:
    """Return whether a Python file is a launch file of ROS 2."""
    return _imports(file, ("launch",))


def _imports(file: PythonFile, packages: Iterable[str]) -> bool:
    return any(
        name == package or name.startswith(f"{package}.")
        for name in absolute_imports(file)
        for package in packages
    )


def absolute_imports(file: PythonFile) -> Iterator[str]:
    """Yield the names of absolute imports."""
    return (each.name for each in python_source.imports_of(file.tree) if not each.level)


def source_files(folder: Path, suffixes: Sequence[str]) -> list[Path]:
    """Yield the files of these kinds below a folder, without those in test folders."""
    return [
        path
        for path in files_below(folder, suffixes)
        if _TEST_FOLDERS.isdisjoint(path.relative_to(folder).parent.parts)
    ]


class ProgramFiles:
    """Collects the files of one program.

    Args:
        folder: folder of the program.
        sources: reads the files and collects the reports.
        library: finds library code.
    """

    def __init__(self, folder: Path, sources: Sources, library: Library) -> None:
        self._folder, self._sources, self._library = folder, sources, library
        self._files: dict[Group, dict[Path, CountedFile]] = {group: {} for group in Group}
        self._agents = AgentFiles()
        self._python_agents: set[Path] = set()
        self._modules: set[str] = set()

    def read(self) -> dict[Group, tuple[CountedFile, ...]]:
        """Return the files by group, after reporting their errors."""
        projects = list(self._projects())
        deployments = [reading.deployment for _, reading in projects]
        programs = {each.path.resolve(): each for each in self._programs(deployments)}
        for path, reading in projects:
            if not self._is_test_project(reading, programs):
                self._add_project(path, reading)
        for program in programs.values():
            if not program.is_test:
                self._agents.add(program)
                self._add_types(program.artifact_types, (self._folder, program.path.parent))
        for path in source_files(self._folder, (".py",)):
            self._add_python(path)
        for path in source_files(self._folder, MAPPINGS):
            self._add_yaml(path)
        if not self._sources.problems:
            self._finish()
        return {group: tuple(files[path] for path in sorted(files)) for group, files in self._files.items()}

    @property
    def has_agents(self) -> bool:
        """Whether a program of an agent was found."""
        return bool(self._agents.own or self._files[Group.AGENTS])

    def _add(self, group: Group, *files: CountedFile) -> None:
        self._files[group].update((each.path.resolve(), each) for each in files)

    def _finish(self) -> None:
        """Add what is known only after reading everything."""
        self._add(Group.AGENTS, *counted_agents(self._agents.own.values(), self._sources))
        self._add(Group.LIBRARY, *counted_agents(self._agents.library.values(), self._sources))
        self._add(Group.LIBRARY, *(each.counted for each in self._library.files(self._modules)))

    # projects

    def _projects(self) -> Iterator[tuple[Path, Reading]]:
        for path in source_files(self._folder, PROJECTS):
            try:
                reading = read_project(path)
            except ProjectError as error:
                self._sources.report(*error.diagnostics)
                continue
            self._sources.report(*reading.diagnostics)
            yield path, reading

    def _is_test_project(self, reading: Reading, programs: dict[Path, AgentProgram]) -> bool:
        """Return whether all agents of a project are tests."""
        agents = [programs.get(each.source_path.resolve()) for each in reading.deployment.agents]
        return bool(agents) and all(each is not None and each.is_test for each in agents)

    def _add_project(self, path: Path, reading: Reading) -> None:
        text = self._sources.text(path)
        if text is None:
            return
        deployment = reading.deployment
        names = frozenset(_names(deployment))
        tokens = ProjectCursor(SourceFile(path.as_posix(), text), []).tokens
        comments = list(between(text, ((each.start, each.stop) for each in tokens)))
        self._add(Group.PROJECTS, counted(path, text, comments, names, names))
        for agent in deployment.agents:
            if agent.is_python and is_file(agent.source_path):
                self._python_agents.add(agent.source_path.resolve())
                self._add_python(agent.source_path)
        if deployment.world is not None and deployment.world not in shipped_worlds():
            world = Path(deployment.world)
            if is_file(world):
                self._add_world(world)
        types = [each.type_name for space in deployment.workspaces for each in space.artifacts]
        self._add_types(types, (deployment.base_path, *deployment.source_paths))

    # agents

    def _programs(self, deployments: Sequence[Deployment]) -> Iterator[AgentProgram]:
        """Return all programs: those of projects with their errors, and others unless a program includes them."""
        read: dict[Path, AgentProgram] = {}
        for agent, folders in _declared(deployments):
            key = agent.source_path.resolve()
            if key not in read and is_file(agent.source_path):
                program = read_agent(agent.source_path, folders, self._sources)
                if program is not None:
                    read[key] = program
                    self._report(program)
        lone: dict[Path, AgentProgram] = {}
        for path in source_files(self._folder, (".asl",)):
            if path.resolve() not in read:
                program = read_agent(path, source_folders(path.parent), self._sources)
                if program is not None:
                    lone[path.resolve()] = program
        included = _included([*read.values(), *lone.values()])
        roots = (each for key, each in lone.items() if key not in included)
        included = _included([*read.values(), *roots])  # without files that only include each other
        for path, program in lone.items():
            if path not in included:
                self._report(program)
        yield from (*read.values(), *lone.values())

    def _report(self, program: AgentProgram) -> None:
        if not program.is_test:
            self._sources.report(*program.problems)

    # Python

    def _add_python(self, path: Path) -> None:
        file = self._sources.python(path)
        if file is None or is_test(file):
            return
        if is_launch_file(file):
            group = Group.PROJECTS
        elif path.resolve() in self._python_agents or "PythonAgent" in python_source.base_names(file.tree):
            group = Group.AGENTS
        else:
            group = Group.ARTIFACTS
        self._add(group, file.counted)
        self._modules.update(absolute_imports(file))

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
            document, _ = plain_values(text)
            rooms = document.get("rooms")
            names = frozenset(
                (*yaml_source.named_things(document), *(rooms if isinstance(rooms, dict) else ()))
            )
            self._add(Group.WORLDS, counted(path, text, yaml_source.comments_of(text), names, names))

    def _add_mapping(self, path: Path, group: Group) -> None:
        mapping, problems = read_with_problems(path)
        self._sources.report(*diagnostics_of(mapping.file, mapping.text, problems))
        if not problems:
            names = yaml_source.mapping_names(mapping)
            comments = yaml_source.comments_of(mapping.text)
            self._add(group, counted(path, mapping.text, comments, names, names))

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


def _declared(deployments: Sequence[Deployment]) -> Iterator[tuple[AgentSpec, tuple[Path, ...]]]:
    """The agents of projects that have programs, each with the folders in which included files are looked for."""
    for deployment in deployments:
        for agent in deployment.agents:
            if not agent.is_python:
                yield agent, (deployment.base_path, *deployment.source_paths)


def _names(deployment: Deployment) -> Iterator[str]:
    """What a project gives names to: itself, agents, workspaces and artifacts."""
    yield deployment.name
    yield from (agent.declared_name or agent.name for agent in deployment.agents)
    for space in deployment.workspaces:
        yield space.name
        yield from (artifact.name for artifact in space.artifacts)


def no_programs(folder: Path) -> Diagnostic:
    """The error of a folder in which no agent is found."""
    return Diagnostic(
        "error",
        f"no agent programs in `{folder}`",
        help="name the folder of a program; Python programs without agents are given by --baseline",
    )
