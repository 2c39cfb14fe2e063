"""Check programs and projects without running them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.checks.checker import Suppressions, check, place, wanted
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, Diagnostic, SourceFile
from jacaros.agents.language.loader import parse_literals, read_program
from jacaros.files.python_modules import ModuleUnreadable, ProjectModules
from jacaros.files.texts import is_file
from jacaros.files.yaml import Problem
from jacaros.mas.agent_classes import AgentClasses
from jacaros.mas.deployment import AgentSpec, Deployment, ProjectError
from jacaros.mas.loading import load_deployment
from jacaros.mas.programs import NEVER_SELECTED, Programs, text_of
from jacaros.mas.project.reading import read_project
from jacaros.mas.python_code import PythonCode
from jacaros.mas.source_path import source_folders

if TYPE_CHECKING:
    from jacaros.artifacts.env.artifact import Artifact

PROJECTS: Final = (".mas2j", ".jcm")
MAPPINGS: Final = (".yaml", ".yml")
_SKIPPED: Final = frozenset({"__pycache__", "node_modules", "build", "dist"})


@dataclass
class Findings:
    """The result of checking files.

    Attributes:
        diagnostics: sorted by file and location, without duplicates.
        files: all files that have been read: programs, included files and projects.
        unseen: Python files with names that are known only after running them; None if they are run.
    """

    diagnostics: list[Diagnostic] = field(default_factory=list)
    files: set[Path] = field(default_factory=set)
    unseen: set[Path] | None = field(default_factory=set)


def check_files(paths: Sequence[Path], mappings: Sequence[str] = (), imports: bool = False) -> Findings:
    """Check programs, projects with the programs of their agents, and whole folders.

    In a folder, a program is checked by itself only if no project there names it and no other program includes it.
    World files and mapping files are checked, too. Other YAML files are skipped.

    Args:
        paths: files and folders.
        mappings: mapping files for programs that are given by themselves. Their actions are compared with these.
        imports: run the Python files of projects, to know everything that they declare. Otherwise they are only parsed.
    """
    findings = Findings(unseen=None if imports else set())
    for path in paths:
        if path.is_dir():
            _check_folder(path, findings)
        elif path.suffix in PROJECTS:
            _check_project(path, findings)
        elif path.suffix == ".py":
            _check_python_agent(path, findings)
        elif path.suffix in MAPPINGS:
            _check_yaml(path, findings)
        elif mappings:
            _check_program_with_mappings(path, mappings, findings)
        else:
            _check_lone_program(path, findings)
    findings.diagnostics += map(_not_imported, sorted(findings.unseen or ()))
    findings.diagnostics = sorted(dict.fromkeys(wanted(findings.diagnostics)), key=place)
    return findings


def _not_imported(file: Path) -> Diagnostic:
    return Diagnostic(
        "note",
        f"names from {file} were not checked: they are only known at run time",
        None,
        "run the Python code of the project with --import to check them",
        "not-imported",
    )


def files_below(folder: Path, suffixes: Sequence[str]) -> Iterator[Path]:
    """Return the files of these kinds in a folder and its subfolders, without hidden and generated ones, sorted."""
    for path in sorted(folder.iterdir()):
        if path.name.startswith(".") or path.name in _SKIPPED:
            continue
        if path.is_dir():
            yield from files_below(path, suffixes)
        elif path.suffix in suffixes:
            yield path


def _check_folder(folder: Path, findings: Findings) -> None:
    _check_projects(folder, findings)
    alone: dict[Path, Findings] = {}
    included: set[Path] = set()
    for path in files_below(folder, (".asl",)):
        if path.resolve() in findings.files:
            continue
        own = alone[path.resolve()] = Findings(unseen=findings.unseen)
        _check_lone_program(path, own)
        included |= own.files - {path.resolve()}
    for file, own in alone.items():
        if file not in included:
            findings.diagnostics += own.diagnostics
        findings.files |= own.files
    for path in files_below(folder, MAPPINGS):
        _check_yaml(path, findings, named=False)


def _check_projects(folder: Path, findings: Findings) -> None:
    """Check the projects in a folder. One that another project uses is checked only as part of that one."""
    used: set[Path] = set()
    alone: dict[Path, Findings] = {}
    for path in files_below(folder, PROJECTS):
        own = alone[path.resolve()] = Findings(unseen=findings.unseen)
        used |= _check_project(path, own)
    for file, own in alone.items():
        if file not in used:
            findings.diagnostics += own.diagnostics
        findings.files |= own.files


def _check_project(path: Path, findings: Findings) -> frozenset[Path]:
    """Check a project with all its files. Return the project files that it uses."""
    findings.files.add(path.resolve())
    try:
        reading = read_project(path)
    except ProjectError as error:
        findings.diagnostics += [_of_project(each) for each in error.diagnostics]
        return frozenset()
    deployment = reading.deployment
    findings.files |= reading.used
    findings.diagnostics += [_of_project(each) for each in reading.diagnostics]
    folders = (deployment.base_path, *deployment.source_paths)
    findings.diagnostics += [_of_project(each) for each in _of_classes(deployment, folders, findings.unseen)]
    different = {(agent.source_path, agent.beliefs, agent.goals): agent for agent in deployment.agents}
    programs = []
    for agent in different.values():
        if agent.is_python:
            findings.files.add(agent.source_path.resolve())
        elif is_file(agent.source_path):
            program = _check_program(agent.source_path, folders, findings, agent)
            if program is not None:
                programs.append((agent, program))
    for mapping in _mapping_files(deployment, programs, folders):
        _check_mapping(mapping, findings)
    _check_world(deployment, findings)
    if deployment.artifact_environment:
        # What Python agents, and programs with errors, would add is not known.
        known = programs if len(programs) == len(different) else []
        findings.diagnostics += _of_artifacts(deployment, known, folders, findings.unseen)
    if len(programs) == len(different):
        findings.diagnostics += _of_beliefs(deployment, programs, folders, findings.unseen)
    return reading.used


def _of_beliefs(
    deployment: Deployment,
    programs: list[tuple[AgentSpec, nodes.Program]],
    folders: tuple[Path, ...],
    unseen: set[Path] | None,
) -> list[Diagnostic]:
    """Report misspelt beliefs unless classes of the project may add more."""
    from jacaros.mas.action_check import made_types
    from jacaros.mas.belief_check import check_beliefs  # here: see `_of_artifacts`

    def types() -> "list[type[Artifact]] | None":
        from jacaros.artifacts.registry import type_finder  # here: see `_of_artifacts`

        return made_types(deployment, trees, type_finder(ProjectModules(*folders, unseen=unseen)))

    trees = [program for _, program in programs]
    if any(agent.agent_class for agent, _ in programs):
        return []
    base = deployment.base_path.absolute()  # the working folder may be any, with any words in its files
    return check_beliefs(trees, types, [each for each in folders if each.absolute().is_relative_to(base)])


def _check_lone_program(path: Path, findings: Findings) -> None:
    """Check a program that no project names."""
    folders = source_folders(path.parent)
    program = _check_program(path, folders, findings)
    if program is not None:
        lone = Deployment(path.stem, path.parent)
        programs = [(AgentSpec(path.stem, path), program)]
        findings.diagnostics += _of_beliefs(lone, programs, folders, findings.unseen)
        _check_lone_artifacts(lone, programs, folders, findings)


def _check_lone_artifacts(
    lone: Deployment,
    programs: list[tuple[AgentSpec, nodes.Program]],
    folders: tuple[Path, ...],
    findings: Findings,
) -> None:
    """Check the artifacts that a lone program creates. Without any, its actions may belong to any artifact."""
    for mapping in _mapping_files(lone, programs, folders):
        _check_mapping(mapping, findings)
    from jacaros.mas.action_check import artifact_types  # here: see `_of_artifacts`

    if any(map(artifact_types, (program for _, program in programs))):
        told = _of_artifacts(lone, programs, folders, findings.unseen)
        # A run may add artifacts with --mapping: an operation unlike all known ones may be theirs.
        findings.diagnostics += [each for each in told if each.code != "unknown-operation" or each.help]


def _of_artifacts(
    deployment: Deployment,
    programs: list[tuple[AgentSpec, nodes.Program]],
    folders: tuple[Path, ...],
    unseen: set[Path] | None,
) -> list[Diagnostic]:
    """Return the errors in the artifacts of a project, and in what its agents do with them."""
    # Imported on demand: programs without artifacts do not need them.
    from jacaros.artifacts.registry import type_finder
    from jacaros.mas.action_check import check_actions, made_types, unknown_types
    from jacaros.mas.environment import types_of
    from jacaros.mas.need_check import check_needs

    artifacts = [
        artifact
        for workspace in deployment.workspaces
        for artifact in workspace.artifacts
        if not _is_wrong_mapping(artifact.type_name, folders)
    ]
    try:
        find_type = type_finder(ProjectModules(*folders, unseen=unseen))
        types_of(artifacts, find_type)
    except ModuleUnreadable as error:
        return [Diagnostic("error", str(error), code="wrong-project")]
    except ProjectError as error:
        return [_of_project(each) for each in error.diagnostics]
    trees = [program for _, program in programs]
    told = list(unknown_types(trees, find_type))
    types = made_types(deployment, trees, find_type)
    if types is not None:
        told += [*check_actions(programs, types), *check_needs(trees, types)]
    return [each for each in told if not _is_of_wrong_mapping(each, folders)]


def _is_wrong_mapping(type_name: str, folders: tuple[Path, ...]) -> bool:
    """Return whether an artifact's type is a mapping file with errors, which are reported there."""
    if not type_name.partition("#")[0].endswith(MAPPINGS):
        return False
    from jacaros.mas.mappings import is_wrong  # here: see `_check_mapping`

    return is_wrong(type_name, folders)


def _is_of_wrong_mapping(diagnostic: Diagnostic, folders: tuple[Path, ...]) -> bool:
    """Return whether a warning about an unknown type concerns a mapping file with errors."""
    span = diagnostic.span
    if diagnostic.code != "unknown-artifact-type" or span is None:
        return False
    written = span.file.lines[span.line - 1][span.column - 1 : span.end_column - 1].strip("\"'")
    return _is_wrong_mapping(written, folders)


def _check_world(deployment: Deployment, findings: Findings) -> None:
    """Check the world that a project names."""
    if deployment.world is None:
        return
    from jacaros.mas.ros_graph import NO_WORLD  # here: most projects name none
    from jacaros.sim.data.world import UnknownWorld
    from jacaros.sim.files.world import find_world, shipped_worlds, world_problems

    if deployment.world in (NO_WORLD, *shipped_worlds()):
        return
    try:
        _check_world_file(find_world(deployment.world), findings, world_problems)
    except UnknownWorld as unknown:
        findings.diagnostics.append(
            Diagnostic("error", unknown.message, deployment.world_span, unknown.help, "wrong-project")
        )


def _check_yaml(path: Path, findings: Findings, named: bool = True) -> None:
    """Check a world, fault or mapping file. Other YAML files are an error only if they are *named* on the command line."""
    from jacaros.artifacts.mapping.file import is_mapping  # here: see `_check_mapping`
    from jacaros.sim.files.faults import fault_file_problems, is_fault_file
    from jacaros.sim.files.world import is_world, world_problems

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
    from jacaros.mas.mappings import WRONG_WORLD, diagnostics_of  # here: see `_check_mapping`

    findings.files.add(path.resolve())
    findings.diagnostics += diagnostics_of(str(path), *problems_of(path), wrong=WRONG_WORLD)


def _check_mapping(path: Path, findings: Findings) -> None:
    """Check a mapping file, once for all artifacts that come from it."""
    if path.resolve() in findings.files:
        return
    from jacaros.mas.mappings import check_mapping_file  # here: programs are checked without

    findings.files.add(path.resolve())
    findings.diagnostics += check_mapping_file(path)


def _check_program_with_mappings(path: Path, mappings: Sequence[str], findings: Findings) -> None:
    """Check a lone program, and whether the artifacts of mapping files offer its actions."""
    from jacaros.artifacts.mapping.file import find_mapping  # here: see `_check_mapping`
    from jacaros.mas.mappings import with_mappings

    program = _check_program(path, (path.parent,), findings)
    for name in mappings:
        file = find_mapping(name, (Path(), path.parent))
        if file is not None:
            _check_mapping(file, findings)
    lone = load_deployment(path)
    try:
        deployment = with_mappings(lone, mappings)
    except ProjectError as error:
        # The errors in a file have been reported, including those that only the check finds; a missing file has not.
        findings.diagnostics += [_of_project(each) for each in error.diagnostics if not each.code]
        return
    if program is not None:
        agents = [(deployment.agents[0], program)]
        findings.diagnostics += _of_artifacts(deployment, agents, (path.parent,), findings.unseen)
        findings.diagnostics += _of_beliefs(deployment, agents, (path.parent,), findings.unseen)


def _mapping_files(
    deployment: Deployment, programs: list[tuple[AgentSpec, nodes.Program]], folders: tuple[Path, ...]
) -> Iterator[Path]:
    """Return the mapping files that a project, or ``makeArtifact`` in its programs, names."""
    from jacaros.mas.action_check import artifact_types  # here: see `_of_artifacts`

    names = [artifact.type_name for workspace in deployment.workspaces for artifact in workspace.artifacts]
    for _, program in programs:
        names += artifact_types(program)
    for name in dict.fromkeys(names):
        file = name.partition("#")[0]
        if file.endswith(MAPPINGS):
            yield from [folder / file for folder in folders if is_file(folder / file)][:1]


def _check_python_agent(path: Path, findings: Findings) -> None:
    """Check that the class of a lone Python agent exists."""
    findings.files.add(path.resolve())
    agent = AgentSpec(path.stem, path, path.stem)
    deployment = Deployment(path.stem, path.parent, (agent,))
    findings.diagnostics += [
        _of_project(each) for each in _of_classes(deployment, (path.parent,), findings.unseen)
    ]


def _of_classes(
    deployment: Deployment, folders: tuple[Path, ...], unseen: set[Path] | None
) -> list[Diagnostic]:
    """Return the errors in the classes that agents declare."""
    found: list[Diagnostic] = []
    try:
        AgentClasses(ProjectModules(*folders, unseen=unseen), found.append).check(deployment.agents)
    except ProjectError as error:
        found += error.diagnostics
    return found


def _of_project(diagnostic: Diagnostic) -> Diagnostic:
    return diagnostic if diagnostic.code else replace(diagnostic, code="wrong-project")


def _check_program(
    path: Path, folders: tuple[Path, ...], findings: Findings, agent: AgentSpec | None = None
) -> nodes.Program | None:
    """Check a program with its includes, and with what a project adds to it for *agent*.

    Returns:
        The whole program of the agent; None if it cannot run.
    """
    findings.files.add(path.resolve())
    code = PythonCode(ProjectModules(*folders, unseen=findings.unseen))
    programs = Programs(folders, lambda _: None, code)
    sources: list[SourceFile] = []

    def include(name: str, including: str) -> tuple[str, str]:
        found, text = programs.path.include(name, including)
        if not found.startswith("$"):
            findings.files.add(Path(found).resolve())
            sources.append(SourceFile(found, text))
        return found, text

    try:
        sources.append(SourceFile(path.as_posix(), text_of(path)))
    except AslError as error:
        findings.diagnostics += error.diagnostics
        return None
    program, diagnostics = read_program(sources[0], include, code.functions, code.actions)
    diagnostics += [replace(error, code="unreadable-file") for error in code.take_errors()]
    errors = [diagnostic for diagnostic in diagnostics if diagnostic.severity == "error"]
    known = KnownActions(code.actions, code.help, code.is_unseen)
    whole = _with_additions(program, agent)
    own = [*diagnostics, *check(whole, known, errors)]
    if not errors:
        own += _of_size(whole, code)
    for source in sources:
        own += Suppressions(source).unknown
    if agent is not None and agent.agent_class is not None:
        own = [each for each in own if each.code != NEVER_SELECTED]
    findings.diagnostics += [_located(each, agent) for each in own if _concerns_author(each, path)]
    return None if errors else whole


def _of_size(program: nodes.Program, code: PythonCode) -> Iterator[Diagnostic]:
    """Return warnings about plans that run slower because they are too large for Python's compiler."""
    from jacaros.agents.mind.generated.compiler import too_large
    from jacaros.agents.mind.mind import new_engine  # here: see `_of_artifacts`
    from jacaros.agents.mind.state.plan_library import ProgramPlans

    plans = ProgramPlans(program.plans, new_engine(code.actions)).plans
    for plan, fault in too_large(plans, code.actions):
        yield Diagnostic(
            "warning",
            f"{fault}, so it runs slower",
            plan.node.span,
            "write several plans, or rules for parts of it",
            "plan-too-large",
        )


def _concerns_author(diagnostic: Diagnostic, path: Path) -> bool:
    """Return whether a diagnostic concerns the author of the program at *path*.

    A library of JaCaROS does not. And a plan before an include often replaces one in it.
    """
    if diagnostic.span is None:
        return True
    file = diagnostic.span.file.name
    return not file.startswith("$") and (diagnostic.code != NEVER_SELECTED or file == path.as_posix())


def _declaration(agent: AgentSpec) -> str:
    """Return the name of the text that a project adds to a program."""
    return f"the declaration of {agent.declared_name}"


def _located(diagnostic: Diagnostic, agent: AgentSpec | None) -> Diagnostic:
    """Return the diagnostic at the agent's location in the project file, if it is about what the project adds."""
    span = diagnostic.span
    if agent is None or span is None or span.file.name != _declaration(agent):
        return diagnostic
    return replace(diagnostic, span=agent.span, opened=None)


def _with_additions(program: nodes.Program, agent: AgentSpec | None) -> nodes.Program:
    if agent is None:
        return program
    where = _declaration(agent)
    try:
        beliefs = parse_literals(agent.beliefs, where) if agent.beliefs.strip() else ()
        goals = parse_literals(agent.goals, where) if agent.goals.strip() else ()
    except AslError:
        # The error has been reported in the project file.
        return program
    return replace(program, beliefs=(*program.beliefs, *beliefs), goals=(*goals, *program.goals))
