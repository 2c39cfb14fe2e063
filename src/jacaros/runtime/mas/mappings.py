"""Mapping files of a run: their artifacts, as if the project declared them, and their errors."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.robots.mapping.checking import UNCERTAIN, type_problems
from jacaros.robots.mapping.file import (
    MappingFile,
    find_mapping,
    misspelt_expectations,
    read_with_problems,
    shipped_mappings,
)
from jacaros.robots.mapping.interfaces import stored_interfaces
from jacaros.robots.mapping.offer_codec import offer_problems
from jacaros.runtime.files.texts import suggestion
from jacaros.runtime.files.yaml import Problem, top_keys
from jacaros.runtime.mas.deployment import ArtifactSpec, Deployment, FocusSpec, ProjectError, WorkspaceSpec

if TYPE_CHECKING:
    from jacaros.runtime.mas.checks.observables import Observables

MAIN = "main"
"""The workspace of mapped artifacts."""

SUFFIXES = (".yaml", ".yml")
"""Suffixes of mapping files."""
WRONG = "wrong-mapping"
WRONG_WORLD = "wrong-world"
UNKNOWN_TYPE = "unknown-message-type"
UNKNOWN_PROPERTY = "unknown-property"
WRONG_UNIT = "wrong-unit"
_FINER = {"0 to 1": "percent", "radians": "degrees"}
"""For units with few whole numbers, one with more."""


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
    if UNCERTAIN in problem.message and "did you mean" not in problem.help:
        return Diagnostic("warning", problem.message, span, problem.help or None, UNKNOWN_TYPE)
    return Diagnostic("error", problem.message, span, problem.help or None, wrong)


def check_mapping_file(
    path: Path, observables: "Observables", beside: Sequence[Path] = ()
) -> list[Diagnostic]:
    """Return the errors of a mapping file, also against the message types that are known without a robot, and against
    the files *beside* it in a project.
    """
    mapping, problems = read_with_problems(path)
    # A line with an error has placeholder values, so its types are not checked.
    wrong = {problem.line for problem in problems}
    uncertain = [
        each
        for part in mapping.artifacts.values()
        for each in type_problems(part, stored_interfaces(part.interfaces))
    ] + offer_problems(mapping.offers, stored_interfaces(mapping.interfaces))
    problems += [each for each in uncertain if each.line not in wrong]
    # Another artifact of the robot may have the property; an alias repeats a problem.
    misspelt = [
        each for each in dict.fromkeys(misspelt_expectations(mapping, beside)) if each.line not in wrong
    ]
    warnings = diagnostics_of(mapping.file, mapping.text, misspelt, UNKNOWN_PROPERTY)
    errors = diagnostics_of(mapping.file, mapping.text, problems)
    if not problems:
        warnings += diagnostics_of(
            mapping.file, mapping.text, _coarse_fields(mapping, observables), WRONG_UNIT
        )
    return errors + [replace(each, severity="warning") for each in warnings]


def _coarse_fields(mapping: MappingFile, observables: "Observables") -> Iterator[Problem]:
    """Yield fields that are rounded to whole numbers in a unit in which that leaves nearly nothing of the value."""
    from jacaros.robots.mapping.artifact import mapped_type  # here: few runs check

    for name, part in mapping.artifacts.items():
        values = observables.of([mapped_type(mapping, name)]) or {}
        for topic in part.topics:
            fields = [field for field in topic.fields or () for _ in range(field.count)]
            for field, value in zip(fields, values[topic.name][0].values, strict=False):
                if value.whole and value.unit in _FINER:
                    text = f"`{topic.name}` is rounded to whole numbers, but goes from 0 to 1"
                    if value.unit == "radians":
                        text = f"`{topic.name}` is rounded to whole radians"
                    yield field.place.problem(
                        text, f"add `unit: {_FINER[value.unit]}`, or round to 2 decimals"
                    )


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
    spaces = list(deployment.workspaces)
    mains = [each for each in spaces if each.name == MAIN and each.parent is None]
    main = mains[0] if mains else WorkspaceSpec(MAIN)
    seen = {artifact.name for artifact in main.artifacts}
    for artifact in artifacts:
        if artifact.name in seen:
            help = "name the artifacts of a file under `artifacts:`"
            wrong.append(Diagnostic("error", f"duplicate artifact `{artifact.name}`", None, help))
        seen.add(artifact.name)
    if wrong:
        raise ProjectError(wrong)
    agents = deployment.agents
    if len(agents) == 1 and agents[0].span is None:
        focus = tuple(FocusSpec(artifact.name, MAIN) for artifact in artifacts)
        agents = (replace(agents[0], focus=(*agents[0].focus, *focus)),)
    filled = replace(main, artifacts=(*artifacts, *main.artifacts))
    spaces = [filled if each is main else each for each in (spaces if mains else [main, *spaces])]
    return replace(deployment, agents=agents, workspaces=tuple(spaces), artifact_environment=True)


def files_with_offers(deployment: Deployment, names: Iterable[str | Path]) -> list[Path]:
    """Return the mapping files of a run that say what its agents offer in the ROS graph.

    Args:
        deployment: the project.
        names: further mapping files.
    """
    types = [artifact.type_name for workspace in deployment.workspaces for artifact in workspace.artifacts]
    files = [each.partition("#")[0] for each in (*map(str, names), *types)]
    found = [find_mapping(each, (Path(), deployment.base_path)) for each in files if each.endswith(SUFFIXES)]
    return [path for path in dict.fromkeys(found) if path is not None and "offers" in top_keys(path)]
