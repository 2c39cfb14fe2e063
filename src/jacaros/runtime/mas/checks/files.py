"""Check programs and projects without running them."""

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Final

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.checks.checker import Suppressions, check, place, wanted
from jacaros.agents.checks.flow import is_own
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.checks.handlers import missing_marks, never_posted
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, Diagnostic, SourceFile
from jacaros.agents.language.loader import new_names, read_program
from jacaros.agents.mind.actions.internal_action import STANDARD, InternalAction
from jacaros.robots.registry import type_finder
from jacaros.runtime.files.python_modules import ModuleUnreadable, ProjectModules
from jacaros.runtime.files.texts import file_text, files_below, is_file
from jacaros.runtime.files.yaml import Problem
from jacaros.runtime.mas.agents.lifecycle import check_classes
from jacaros.runtime.mas.agents.programs import (
    NEVER_SELECTED,
    SourcePath,
    concerns_author,
    source_folders,
    text_of,
    with_declared,
)
from jacaros.runtime.mas.agents.python_code import PythonCode
from jacaros.runtime.mas.checks.artifacts import (
    NamedTypes,
    check_artifacts,
    is_wrong_mapping,
    made_types,
    named_types,
    operations_as_goals,
    unknown_types,
)
from jacaros.runtime.mas.checks.beliefs import Surroundings, Whole, check_beliefs
from jacaros.runtime.mas.checks.focusing import check_focus
from jacaros.runtime.mas.checks.observables import Observables
from jacaros.runtime.mas.deployment import AgentSpec, Deployment, ProjectError
from jacaros.runtime.mas.environment import types_of
from jacaros.runtime.mas.project.reading import read_project

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact
    from jacaros.runtime.mas.checks.artifacts import FindType

PROJECTS: Final = (".mas2j", ".jcm")
MAPPINGS: Final = (".yaml", ".yml")
_BUILDS: Final = frozenset({"makeArtifact", "linkWorkspace", "mountWorkspace", "tellHow", "create_agent"})
"""Words in the code of a Python agent that may add artifacts, or plans to other agents."""


@dataclass
class Findings:
    """The result of checking files.

    Attributes:
        diagnostics: sorted by file and location, without duplicates.
        files: all files that have been read: programs, included files and projects.
        unseen: Python files with names that are known only after running them; None if they are run.
        observables: reads the properties and signals of artifact types, each once in a run.
        checked: the projects and lone programs, with what has been read of them.
    """

    diagnostics: list[Diagnostic] = field(default_factory=list)
    files: set[Path] = field(default_factory=set)
    unseen: set[Path] | None = field(default_factory=set)
    observables: Observables = field(default_factory=Observables)
    checked: "list[Checked]" = field(default_factory=list)

    def apart(self) -> "Findings":
        """Return the empty findings of a further project of the same run."""
        return Findings(unseen=self.unseen, observables=self.observables, checked=self.checked)


def check_files(
    paths: Sequence[Path],
    mappings: Sequence[str] = (),
    imports: bool = False,
    observables: Observables | None = None,
    named: bool = True,
) -> Findings:
    """Check programs, projects with the programs of their agents, and whole folders.

    In a folder, a program is checked by itself only if no project there names it and no other program includes it.
    World files and mapping files are checked, too. Other YAML files are skipped.

    Args:
        paths: files and folders.
        mappings: mapping files for programs that are given by themselves. Their actions are compared with these.
        imports: run the Python files of projects, to know everything that they declare. Otherwise they are only parsed.
        observables: those of an earlier call, which save time.
        named: report a YAML file in *paths* of another kind, instead of skipping it.
    """
    findings = Findings(unseen=None if imports else set(), observables=observables or Observables())
    try:
        _check_paths(paths, mappings, findings, named)
    finally:
        for each in findings.checked if not imports else ():
            each.forget()
    findings.diagnostics += map(_not_imported, sorted(findings.unseen or ()))
    findings.diagnostics = sorted(dict.fromkeys(wanted(findings.diagnostics)), key=place)
    return findings


def _check_paths(paths: Sequence[Path], mappings: Sequence[str], findings: Findings, named: bool) -> None:
    for path in paths:
        if os.path.isdir(path):
            _check_folder(path, findings)
            continue
        own = findings.apart()  # so that the order of files changes nothing
        if path.suffix in PROJECTS:
            _check_project(path, own)
        elif path.suffix == ".py":
            _check_python_agent(path, own)
        elif path.suffix in MAPPINGS:
            _check_yaml(path, own, named)
        elif mappings:
            _check_program_with_mappings(path, mappings, own)
        else:
            _check_lone_program(path, own)
        findings.diagnostics += own.diagnostics
        findings.files |= own.files


def _not_imported(file: Path) -> Diagnostic:
    return Diagnostic(
        "note",
        f"names from {file} were not checked: they are only known at run time",
        None,
        "run the Python code of the project with --import to check them",
        "not-imported",
    )


def _check_folder(folder: Path, findings: Findings) -> None:
    _check_each(files_below(folder, PROJECTS), _check_project, findings)
    _check_each(files_below(folder, (".asl",)), _check_lone_program, findings)
    for path in files_below(folder, MAPPINGS):
        _check_yaml(path, findings, named=False)


def _check_each(
    paths: Iterable[Path], check_file: Callable[[Path, Findings], Set[Path]], findings: Findings
) -> None:
    """Check files that have not been read. One that another one uses is checked only as part of that one."""
    alone: dict[Path, Findings] = {}
    used: set[Path] = set()
    for path in paths:
        if path.resolve() not in findings.files:
            own = alone[path.resolve()] = findings.apart()
            used |= check_file(path, own)
    for file, own in alone.items():
        if file not in used:
            findings.diagnostics += own.diagnostics
        findings.files |= own.files


def _check_project(path: Path, findings: Findings) -> Set[Path]:
    """Check a project with all its files. Return the project files that it uses."""
    findings.files.add(path.resolve())
    try:
        reading = read_project(path)
    except ProjectError as error:
        findings.diagnostics += map(_of_project, error.diagnostics)
        return frozenset()
    deployment = reading.deployment
    findings.files |= reading.used
    findings.diagnostics += map(_of_project, reading.diagnostics)
    checked = Checked(deployment, (deployment.base_path, *deployment.source_paths), findings)
    checked.check_classes()
    different = {(agent.source_path, agent.beliefs, agent.goals): agent for agent in deployment.agents}
    for agent in different.values():
        if agent.is_python:
            findings.files.add(agent.source_path.resolve())
        elif is_file(agent.source_path):
            checked.check_program(agent)
    checked.check_mappings()
    _check_world(deployment, findings)
    # What programs with errors would add is not known, nor which goals Python agents post.
    in_python = sum(agent.is_python for agent in different.values())
    is_known = len(checked.programs) + in_python == len(different)
    if deployment.artifact_environment:
        findings.diagnostics += checked.of_artifacts(is_known and not checked.is_built_in_python())
    if is_known and not in_python:
        checked.check_goals()
    if is_known:
        checked.check_beliefs(is_partial=in_python > 0)
    return reading.used


def _check_lone_program(path: Path, findings: Findings) -> Set[Path]:
    """Check a program that no project names. Return the files that it includes."""
    folders = source_folders(path.parent)
    checked = Checked(Deployment(path.stem, path.parent), folders, findings)
    if checked.check_program(AgentSpec(path.stem, path)):
        checked.check_beliefs(is_lone=True)
        checked.check_mappings()
        # Without any artifacts, its actions may belong to any artifact.
        if any(each.found for each in checked.named_types):
            # A run may add artifacts with --mapping: an operation unlike all known ones may be theirs.
            findings.diagnostics += [
                each
                for each in checked.of_artifacts()
                if each.code != "unknown-operation" or (each.help or "").startswith("did you mean")
            ]
        else:
            for _, program in checked.programs:
                findings.diagnostics += missing_marks(program, KnownActions(STANDARD))
    return findings.files - {path.resolve()}


def _check_program_with_mappings(path: Path, mappings: Sequence[str], findings: Findings) -> None:
    """Check a lone program, and whether the artifacts of mapping files offer its actions."""
    from jacaros.robots.mapping.file import find_mapping  # here: see `_check_mapping`
    from jacaros.runtime.mas.mappings import with_mappings

    agent = AgentSpec(path.stem, path, path.stem)
    lone = Deployment(path.stem, path.parent, (agent,), artifact_environment=True)
    checked = Checked(lone, (path.parent,), findings)
    is_read = checked.check_program(agent)
    for name in mappings:
        file = find_mapping(name, (Path(), path.parent))
        if file is not None:
            _check_mapping(file, findings)
    try:
        checked.deployment = with_mappings(lone, mappings)
    except ProjectError as error:
        # The errors in a file have been reported, including those that only the check finds; a missing file has not.
        findings.diagnostics += [_of_project(each) for each in error.diagnostics if not each.code]
        return
    if is_read:
        findings.diagnostics += checked.of_artifacts()
        checked.check_beliefs()


def _check_python_agent(path: Path, findings: Findings) -> None:
    findings.files.add(path.resolve())
    agent = AgentSpec(path.stem, path, path.stem)
    Checked(Deployment(path.stem, path.parent, (agent,)), (path.parent,), findings).check_classes()


class Checked:
    """A project, or a lone program, with what belongs to it.

    Attributes:
        deployment: its declarations.
        programs: the programs without errors, with their agents.
        read: what is valid of all programs, by the names of their files.
        sources: the names of all files of programs, with included ones.
    """

    def __init__(self, deployment: Deployment, folders: tuple[Path, ...], findings: Findings) -> None:
        self.deployment, self._folders, self._findings = deployment, folders, findings
        self._modules = ProjectModules(*folders, unseen=findings.unseen)
        findings.checked.append(self)
        self._code = PythonCode(self._modules)
        self._path = SourcePath(folders)
        self._names = new_names(self._code.functions, self._code.actions)
        self._walked: dict[int, tuple[nodes.Plan, nodes.ByKind]] = {}
        self.programs: list[tuple[AgentSpec, nodes.Program]] = []
        self.read: dict[str, nodes.Program] = {}
        self.sources: set[str] = set()

    @cached_property
    def _find_type(self) -> "FindType":
        return type_finder(self._modules)

    @property
    def actions(self) -> Mapping[str, InternalAction]:
        """The internal actions that programs can use: the standard ones, and those of the project."""
        return self._code.actions

    def known_types(self) -> "list[type[Artifact]]":
        """Return the artifact types that the project and its programs name, without those that are unknown."""
        spaces = self.deployment.workspaces
        names = [artifact.type_name for workspace in spaces for artifact in workspace.artifacts]
        names += [each.name for program in self.read.values() for each in named_types(program).found]
        found: dict[type[Artifact], None] = {}
        for name in dict.fromkeys(names):
            with suppress(Exception):  # an unknown type, or a module with an error, has been reported
                found[self._find_type(name)] = None
        self.forget()
        return list(found)

    def forget(self) -> None:
        """Let the modules of the project go once nothing refers to them."""
        self._modules.forget()

    def check_classes(self) -> None:
        found: dict[str, Diagnostic] = {}  # a class without effect is reported once
        wrong: tuple[Diagnostic, ...] = ()
        try:
            check_classes(
                self._modules, self.deployment.agents, lambda each: found.setdefault(each.message, each)
            )
        except ProjectError as error:
            wrong = error.diagnostics
        self._findings.diagnostics += map(_of_project, (*found.values(), *wrong))

    def check_program(self, agent: AgentSpec) -> bool:
        """Check the program of an agent with its includes and declarations. Return whether it can run."""
        path, findings = agent.source_path, self._findings
        findings.files.add(path.resolve())
        code = self._code
        sources: list[SourceFile] = []

        def include(name: str, including: str) -> tuple[str, str]:
            found, text = self._path.include(name, including)
            if not found.startswith("$"):
                findings.files.add(Path(found).resolve())
                sources.append(SourceFile(found, text))
            return found, text

        try:
            sources.append(SourceFile(path.as_posix(), text_of(path)))
        except AslError as error:
            findings.diagnostics += error.diagnostics
            return False
        program, diagnostics = read_program(sources[0], include, self._names.for_program())
        program = replace(program, walked=self._walked)
        self.read[sources[0].name] = program
        self.sources |= {each.name for each in sources}
        diagnostics += [replace(error, code="unreadable-file") for error in code.take_errors()]
        errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity == "error"]
        known = KnownActions(code.actions, code.help, code.is_unseen)
        added = f"the declaration of {agent.declared_name}"
        try:
            whole = with_declared(program, agent, added)
        except AslError:
            whole = program  # the error has been reported in the project file
        own = [*diagnostics, *check(whole, known, errors)]
        if not errors:
            own += _of_size(whole, code)
            self.programs.append((agent, whole))
        for source in sources:
            own += Suppressions(source).unknown
        for each in own:
            if not concerns_author(each, path) or (
                agent.agent_class is not None and each.code == NEVER_SELECTED
            ):
                continue
            if each.span is not None and each.span.file.name == added:
                each = replace(each, span=agent.span, opened=None)
            findings.diagnostics.append(each)
        return not errors

    def check_mappings(self) -> None:
        """Check the mapping files that the project, or ``makeArtifact`` in its programs, names."""
        spaces = self.deployment.workspaces
        names = [artifact.type_name for workspace in spaces for artifact in workspace.artifacts]
        names += [each.name for named in self.named_types for each in named.found]
        files = [
            file
            for file in dict.fromkeys(each.partition("#")[0] for each in names)
            if file.endswith(MAPPINGS)
        ]
        if not files:
            return
        from jacaros.robots.mapping.file import SHIPPED, find_mapping  # here: see `_check_mapping`

        known = [found for file in files if (found := find_mapping(file, self._folders)) is not None]
        for each in known:
            if each.parent != SHIPPED:
                _check_mapping(each, self._findings, [other for other in known if other != each])

    def of_artifacts(self, is_known: bool = True) -> list[Diagnostic]:
        """Return the errors in the artifacts of a project and, if all programs are known, in what agents do with them."""
        names = {artifact.type_name for each in self.deployment.workspaces for artifact in each.artifacts}
        wrong = {name for name in names if is_wrong_mapping(name, self._folders)}
        artifacts = [
            artifact
            for workspace in self.deployment.workspaces
            for artifact in workspace.artifacts
            if artifact.type_name not in wrong
        ]
        try:
            types_of(artifacts, self._find_type)
        except ModuleUnreadable as error:
            return [Diagnostic("error", str(error), code="wrong-project")]
        except ProjectError as error:
            return list(map(_of_project, error.diagnostics))
        found: list[Diagnostic] = []
        types = self._made_types if is_known else None
        if is_known:
            self._findings.diagnostics[:] = map(operations_as_goals(types or ()), self._findings.diagnostics)
            found += unknown_types(self.named_types, self._folders, self._find_type)
        if types is None:
            known = KnownActions(STANDARD)
            return [*found, *(each for _, program in self.programs for each in missing_marks(program, known))]
        found += check_artifacts(self.programs, types, self._findings.observables)
        return [*found, *self._of_focus(types)]

    def _of_focus(self, types: Sequence[type]) -> list[Diagnostic]:
        # Plans that other programs include, and that those focus for.
        is_part = not self.deployment.agents and not any(program.goals for _, program in self.programs)
        if not types or self.deployment.ignored or is_part:
            return []
        find_type = self._find_type

        @cache
        def properties(kind: str) -> Set[str] | None:
            found = self._findings.observables.of([find_type(kind)])
            return None if found is None else found.keys()

        # The same program may be that of several agents.
        read = {agent.source_path: program for agent, program in self.programs}
        every = [
            (each, read[each.source_path]) for each in self.deployment.agents if each.source_path in read
        ]

        @cache
        def offers(kind: str, name: str, arity: int) -> bool:
            return find_type(kind).interface.operations.find(name, arity) is not None

        in_python = _words(self._python_agents())
        flows = {id(each): flow for each, flow in zip(self._whole.programs, self._whole.flows, strict=True)}
        return check_focus(self.deployment, every or self.programs, properties, offers, flows, in_python)

    def is_built_in_python(self) -> bool:
        """Return whether Python agents, or modules beside them, may make artifacts or give other agents plans."""
        beside = {path for each in self._python_agents() for path in each.parent.glob("*.py")}
        return not _BUILDS.isdisjoint(_words(beside))

    def _python_agents(self) -> list[Path]:
        agents = self.deployment.agents
        return [each.source_path for each in agents if each.is_python and is_file(each.source_path)]

    def check_goals(self) -> None:
        """Note plans for goals that no agent posts, in the folder of the project, unless parts of it are not run."""
        if self.deployment.ignored or any(agent.agent_class for agent, _ in self.programs):
            return
        base = self.deployment.base_path.resolve()
        self._findings.diagnostics += never_posted(
            [program for _, program in self.programs],
            KnownActions(STANDARD),
            lambda span: Path(span.file.name).resolve().is_relative_to(base),
        )

    def check_beliefs(self, is_lone: bool = False, is_partial: bool = False) -> None:
        """Report beliefs that nothing adds, unless classes of the project may add more.

        Args:
            is_lone: there is only one program, which may be run with mapping files that are not given.
            is_partial: other agents are written in Python.
        """
        if any(agent.agent_class for agent, _ in self.programs):
            return
        # The working folder may be any, with any words in its files.
        base = self.deployment.base_path.absolute()
        own = tuple(each for each in self._folders if each.absolute().is_relative_to(base))
        around = Surroundings(own, self._findings.files, self._others, is_lone, is_partial)
        self._findings.diagnostics += check_beliefs(self._whole, around)

    @cached_property
    def _whole(self) -> Whole:
        """The project as the check of beliefs sees it. Asked for when all programs are read."""
        programs = [program for _, program in self.programs]
        return Whole(programs, self._made_types, self._findings.observables)

    @cached_property
    def named_types(self) -> list[NamedTypes]:
        """The artifact types that each program names. Asked for when all programs are read."""
        return [named_types(program) for _, program in self.programs]

    @cached_property
    def _made_types(self) -> "list[type[Artifact]] | None":
        """The types of all artifacts; None if they are not known. Asked for when all programs are read."""
        try:
            return made_types(self.deployment, self.named_types, self._find_type)
        except ModuleUnreadable:  # reported with the artifacts
            return None

    def _others(self) -> list[Whole] | None:
        """Return the other projects that run these programs; None if one of them is not known."""
        found: list[Whole] = []
        # Under the same path, a program counts as the same one.
        own = {agent.source_path.resolve(): agent.source_path for agent, _ in self.programs}
        base = self.deployment.base_path.resolve()
        for path in (each for folder in (base, *base.parents[:2]) for each in folder.iterdir()):
            if path.suffix not in PROJECTS or path in self._findings.files:
                continue
            try:
                deployment = read_project(path).deployment
            except ProjectError:
                continue
            agents = [
                replace(each, source_path=own.get(each.source_path.resolve(), each.source_path))
                for each in deployment.agents
            ]
            if not any(each.source_path in own.values() for each in agents):
                continue
            folders = (deployment.base_path, *deployment.source_paths)
            other = Checked(deployment, folders, self._findings.apart())
            for agent in agents:
                if agent.agent_class or agent.is_python or not other.check_program(agent):
                    return None
            found.append(other._whole)
        return found


def _check_world(deployment: Deployment, findings: Findings) -> None:
    if deployment.world is None:
        return
    from jacaros.robots.world.data.world import UnknownWorld
    from jacaros.robots.world.files.world import find_world, shipped_worlds, world_problems
    from jacaros.runtime.mas.ros_graph import NO_WORLD  # here: most projects name none

    if deployment.world in (NO_WORLD, *shipped_worlds()):
        return
    try:
        _check_world_file(find_world(deployment.world), findings, world_problems)
    except UnknownWorld as unknown:
        span = deployment.world_span
        findings.diagnostics.append(Diagnostic("error", unknown.message, span, unknown.help, "wrong-project"))


def _check_yaml(path: Path, findings: Findings, named: bool = True) -> None:
    """Check a world, fault or mapping file. Other YAML files are an error only if they are *named* on the command line."""
    from jacaros.robots.mapping.file import is_mapping  # here: see `_check_mapping`
    from jacaros.robots.world.files.faults import fault_file_problems, is_fault_file
    from jacaros.robots.world.files.world import is_world, world_problems

    if is_world(path):
        _check_world_file(path, findings, world_problems)
    elif is_fault_file(path):
        _check_world_file(path, findings, fault_file_problems)
    elif named or is_mapping(path):  # other YAML files belong to other programs
        _check_mapping(path, findings)


def _check_world_file(
    path: Path, findings: Findings, problems_of: Callable[[Path], tuple[str, list[Problem]]]
) -> None:
    if path.resolve() in findings.files:
        return
    from jacaros.runtime.mas.mappings import WRONG_WORLD, diagnostics_of  # here: see `_check_mapping`

    findings.files.add(path.resolve())
    findings.diagnostics += diagnostics_of(str(path), *problems_of(path), wrong=WRONG_WORLD)


def _check_mapping(path: Path, findings: Findings, beside: Sequence[Path] = ()) -> None:
    if path.resolve() in findings.files:
        return
    from jacaros.runtime.mas.mappings import check_mapping_file  # here: programs are checked without

    findings.files.add(path.resolve())
    findings.diagnostics += check_mapping_file(path, findings.observables, beside)


def _words(files: Iterable[Path]) -> frozenset[str]:
    return frozenset(word for each in files for word in re.findall(r"\w+", file_text(each)))


def _of_project(diagnostic: Diagnostic) -> Diagnostic:
    return diagnostic if diagnostic.code else replace(diagnostic, code="wrong-project")


def _of_size(program: nodes.Program, code: PythonCode) -> Iterator[Diagnostic]:
    """Return warnings about plans that run slower because they are too large for Python's compiler."""
    from jacaros.agents.mind.generated.compiler import too_large
    from jacaros.agents.mind.mind import new_engine  # here: only a complete program is compiled
    from jacaros.agents.mind.state.plan_library import ProgramPlans

    own = tuple(filter(is_own, program.plans))
    plans = ProgramPlans(own, new_engine(code.actions)).plans
    for plan, fault in too_large(plans, code.actions):
        help = "write several plans, or rules for parts of it"
        yield Diagnostic("warning", f"{fault}, so it runs slower", plan.node.span, help, "plan-too-large")
