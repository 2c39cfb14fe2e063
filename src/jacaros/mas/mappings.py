"""Mapping files of a run: their artifacts, as if the project declared them, and their errors."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.artifacts.mapping.checking import UNCERTAIN, type_problems
from jacaros.artifacts.mapping.file import find_mapping, read_with_problems, shipped_mappings
from jacaros.artifacts.mapping.interfaces import stored_interfaces
from jacaros.files.texts import suggestion
from jacaros.files.yaml import Problem
from jacaros.mas.deployment import ArtifactSpec, Deployment, FocusSpec, ProjectError, WorkspaceSpec

MAIN = "main"
"""The workspace of mapped artifacts."""

WRONG = "wrong-mapping"
WRONG_WORLD = "wrong-world"
UNKNOWN_TYPE = "unknown-message-type"


def read_mapping_file(
    name: str, folders: Sequence[Path], span: Span | None = None
) -> tuple[list[ArtifactSpec], list[Diagnostic]]:
    """Return the artifacts of a mapping file, and its errors.

    Args:
        name: path below one of the folders, or file name of a mapping that comes with JaCaROS.
        folders: searched in this order.
        span: where it is named.
    """
    path = find_mapping(name, folders)
    if path is None:
        known = [each.name for folder in folders for each in folder.glob("*.y*ml")] + shipped_mappings()
        help = suggestion(name, known, f"expected in {folders[0]}")
        return [], [Diagnostic("error", f"mapping file not found: {name}", span, help)]
    mapping, problems = read_with_problems(path)
    specs = [
        ArtifactSpec(each, f"{path.resolve()}#{each}", span=span, type_span=span)
        for each in mapping.artifacts
    ]
    return specs, diagnostics_of(mapping.file, mapping.text, problems)


def diagnostics_of(file: str, text: str, problems: Iterable[Problem], wrong: str = WRONG) -> list[Diagnostic]:
    """Return the problems of a YAML file as diagnostics. *wrong* is the code of errors."""
    source = SourceFile(file, text)
    return [_diagnostic(source, problem, wrong) for problem in problems]


def _diagnostic(source: SourceFile, problem: Problem, wrong: str) -> Diagnostic:
    end = problem.column + 1
    if 0 < problem.line <= len(source.lines):
        rest = source.lines[problem.line - 1][problem.column - 1 :]
        word = rest.split("#")[0].split(",")[0].rstrip()
        end = problem.column + max(1, len(word))
    span = Span(source, problem.line, problem.column, problem.line, end)
    # The robot's own middleware may know more types than JaCaROS.
    uncertain = UNCERTAIN in problem.message and "did you mean" not in problem.help
    level, code = ("warning", UNKNOWN_TYPE) if uncertain else ("error", wrong)
    return Diagnostic(
        "warning" if level == "warning" else "error", problem.message, span, problem.help or None, code
    )


def check_mapping_file(path: Path) -> list[Diagnostic]:
    """Return the errors of a mapping file, also against the message types that are known without a robot."""
    mapping, problems = read_with_problems(path)
    # A line with an error has placeholder values, so its types are not checked.
    wrong = {problem.line for problem in problems}
    uncertain = [
        each
        for part in mapping.artifacts.values()
        for each in type_problems(part, stored_interfaces(part.interfaces))
    ]
    problems += [each for each in uncertain if each.line not in wrong]
    return diagnostics_of(mapping.file, mapping.text, problems)


def is_wrong(name: str, folders: Sequence[Path]) -> bool:
    """Return whether *name* is the type of a mapping file with errors, which are reported at their location."""
    path = find_mapping(name.partition("#")[0], folders)
    return path is not None and bool(read_with_problems(path)[1])


def with_mappings(deployment: Deployment, names: Sequence[str]) -> Deployment:
    """Return a deployment with the artifacts of further mapping files. A lone program focuses all of them.

    Raises:
        ProjectError: all errors of the files.
    """
    artifacts: list[ArtifactSpec] = []
    wrong: list[Diagnostic] = []
    for name in names:
        found, errors = read_mapping_file(name, (Path(), deployment.base_path))
        artifacts += found
        wrong += errors
    wrong += _repeated(deployment, artifacts)
    if wrong:
        raise ProjectError(wrong)
    agents = deployment.agents
    if len(agents) == 1 and agents[0].span is None:
        focus = tuple(FocusSpec(artifact.name, MAIN) for artifact in artifacts)
        agents = (replace(agents[0], focus=(*agents[0].focus, *focus)),)
    return replace(
        deployment,
        agents=agents,
        workspaces=added(deployment.workspaces, artifacts),
        artifact_environment=True,
    )


def _repeated(deployment: Deployment, artifacts: Sequence[ArtifactSpec]) -> list[Diagnostic]:
    seen = {each.name for space in deployment.workspaces if space.name == MAIN for each in space.artifacts}
    found = []
    for artifact in artifacts:
        if artifact.name in seen:
            help = "name the artifacts of a file under `artifacts:`"
            found.append(Diagnostic("error", f"duplicate artifact `{artifact.name}`", None, help))
        seen.add(artifact.name)
    return found


def added(
    workspaces: Sequence[WorkspaceSpec], artifacts: Sequence[ArtifactSpec]
) -> tuple[WorkspaceSpec, ...]:
    """Return the workspaces with more artifacts in ``main``."""
    if not any(space.name == MAIN and space.parent is None for space in workspaces):
        workspaces = (WorkspaceSpec(MAIN), *workspaces)
    return tuple(
        replace(space, artifacts=(*artifacts, *space.artifacts))
        if space.name == MAIN and space.parent is None
        else space
        for space in workspaces
    )
